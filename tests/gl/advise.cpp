// Tests what the option --advise measures, against ray casting and against what the renderer draws and counts. No test
// asks how long anything takes.
#include <advise_scene.hpp>
#include <cpu_depth.hpp>
#include <gl_context.hpp>
#include <projection.hpp>
#include <renderer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>

using lightbin::Slicing;

namespace {

const std::string fixtures = LIGHTBIN_FIXTURES;

}  // namespace

TEST_CASE("evaluations are those that the renderer counts of the picture that it draws") {
    struct Seen {
        std::string file;  // or the made scene
        std::size_t view;
    };
    const OffscreenContext context(430);
    // The generated scene has triangles through the near plane; the second camera of everything.glb is orthographic.
    for (const Seen& seen : {Seen{fixtures + "/nova.glb", 0}, Seen{"nova_spots.glb", 0},
                             Seen{"everything.glb", 1}, Seen{"", 1}}) {
        CAPTURE(seen.file);
        Scene scene = seen.file.empty() ? make_scene(128) : load_glb(seen.file, 0.05f);
        scene.transparent.clear();  // the advice leaves glass out
        const Camera& camera = scene.cameras[seen.view];
        FrameSettings frame;
        frame.width = 320;
        frame.height = 200;
        frame.count_evaluations = true;
        Renderer renderer(scene, context.glsl());
        const auto drawn = [&](const lightbin::AdvicePlan& plan) {
            frame.depth = plan.has_z_bounds()                  ? DepthUse::pre_pass
                          : plan.slicing == Slicing::z_bins   ? DepthUse::z_bins
                          : plan.slicing == Slicing::clusters ? DepthUse::clusters
                                                              : DepthUse::none;
            return renderer.draw(camera, frame).evaluations_per_pixel * 320 * 200;
        };

        AdvisedView view(scene, camera, {320, 200});
        const lightbin::Advice advice = view.advise({.evaluation_ns = 1});
        const double plain = drawn({}) * view.overdraw();
        CHECK(std::fabs(view.plain_evaluations() / plain - 1) < 0.01);  // edges of triangles are not rounded alike
        int compared = 0;
        for (const lightbin::AdvicePlan& plan : advice.plans()) {
            if (!plan.tiled) {
                CHECK(plan.evaluations > plain);
                continue;
            }
            // The example draws clusters with the depth test.
            const bool draws = !plan.masks && plan.tile_size == 16 &&
                               plan.depth_test == (plan.has_z_bounds() || plan.slicing == Slicing::clusters);
            if (!draws) continue;
            CAPTURE(to_string(plan));
            const double expected = drawn(plan) * (plan.has_z_bounds() ? 1 : view.overdraw());
            CHECK(expected > 10000);
            // Without slices advise() counts whole tiles, and with slices one pixel of 16.
            CHECK(std::fabs(plan.evaluations / expected - 1) < 0.1);
            ++compared;
        }
        CHECK(compared == 4);
    }
}

TEST_CASE("overdraw is that of the fragments that OpenGL shades without a pre-pass") {
    const OffscreenContext context(430);
    Scene scene = load_glb(fixtures + "/nova.glb", 0.05f);
    const Camera camera = scene.cameras[0];
    Renderer renderer(scene, context.glsl());
    FrameSettings frame;
    frame.width = 320;
    frame.height = 200;
    GLuint query = 0;
    glGenQueries(1, &query);
    const auto fragments = [&](DepthUse depth) {
        frame.depth = depth;
        frame.z_bounds = ZBoundsUse::none;
        glBeginQuery(GL_SAMPLES_PASSED, query);
        renderer.draw(camera, frame);
        glEndQuery(GL_SAMPLES_PASSED);
        GLuint count = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
        return static_cast<double>(count);
    };
    // With a pre-pass, fragments are counted in the pre-pass, and then only those that are seen.
    const double without = fragments(DepthUse::none), seen = fragments(DepthUse::pre_pass) - without;
    const glm::mat4 projection = projection_of(camera, 1.6);
    const double overdraw =
        draw_depth_on_cpu(scene, glm::dmat4(projection) * glm::inverse(camera.to_world), {320, 200}).overdraw;
    CHECK(overdraw > 1.02);
    CHECK(std::fabs(without / seen / overdraw - 1) < 0.02);
}
