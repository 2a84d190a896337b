// Tests what the option --advise measures, against ray casting and against what the renderer draws and counts. No test
// asks how long anything takes.
#include <advise_scene.hpp>
#include <binned_lights.hpp>
#include <cpu_depth.hpp>
#include <gl_context.hpp>
#include <projection.hpp>
#include <renderer.hpp>
#include <value_of.hpp>
#include <way_costs.hpp>

#include <doctest/doctest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

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

        const glm::mat4 projection = projection_of(camera, 1.6);
        const glm::dmat4 world_to_view = glm::inverse(camera.to_world);
        const lightbin::View view =
            value_of(lightbin::View::from_projection(projection, {320, 200}, {.tile_size = 8}));
        BinnedLights lights(scene);
        lights.place(world_to_view);
        WayCosts costs(view, projection, lights,
                       draw_depth_on_cpu(scene, glm::dmat4(projection) * world_to_view, {320, 200}));
        costs.set({.evaluation_ns = 1, .upload_byte_ns = 0});

        const auto plan = [](bool depth_test, Slicing slicing) {
            return Way{.plan = {.depth_test = depth_test, .slicing = slicing, .tile_size = 16}};
        };
        const Way plain = plan(false, Slicing::none), bounded = plan(true, Slicing::none),
                  z_bins = plan(false, Slicing::z_bins), clusters = plan(true, Slicing::clusters);
        Way narrow = plain, threads = plain, spheres = plain, minimum = bounded, maximum = bounded;
        narrow.narrow_ids = threads.threads = true;
        spheres.cones = minimum.maximum = maximum.minimum = false;
        const std::vector<Way> ways = {plain,   bounded, z_bins,  clusters, narrow,
                                       threads, spheres, minimum, maximum,  {.plan = {.tiled = false}}};
        const std::vector<WayCost> measured = costs.measure(ways);
        REQUIRE(measured.size() == ways.size());
        for (const WayCost& cost : measured) {
            CHECK(cost.upload == 0);
            CHECK(cost.depth >= 0);
            CHECK(cost.build >= 0);
            CHECK(cost.total() == cost.depth + cost.build + cost.upload + cost.shade);
        }

        const DepthUse uses[] = {DepthUse::none, DepthUse::pre_pass, DepthUse::z_bins, DepthUse::clusters};
        for (std::size_t i = 0; i < std::size(uses); ++i) {
            frame.depth = uses[i];
            const double drawn = renderer.draw(camera, frame).evaluations_per_pixel * 320 * 200,
                         shaded = measured[i].shade / (uses[i] == DepthUse::pre_pass ? 1 : costs.overdraw());
            CAPTURE(i);
            CHECK(drawn > 10000);
            CHECK(std::fabs(shaded / drawn - 1) < 0.01);  // edges of triangles are not rounded alike
        }
        CHECK(measured[4].shade == measured[0].shade);
        CHECK(measured[5].shade == measured[0].shade);
        if (camera.orthographic) continue;  // few lights: no bound of these leaves one out
        CHECK((measured[6].shade > measured[0].shade) == costs.has_cones());
        for (const std::size_t side : {7u, 8u})
            CHECK(measured[side].shade > measured[1].shade);
        CHECK(measured[9].build == 0);
        CHECK(measured[9].shade > measured[0].shade);

        // The advice counts the same; where it is about slices, it counts one pixel of 16.
        const lightbin::Advice advice = costs.advise();
        for (const lightbin::AdvicePlan& advised : advice.plans()) {
            if (!advised.tiled || advised.tile_size != 16 || advised.has_z_bounds()) continue;
            for (std::size_t i = 0; i < 4; ++i)
                if (advised.slicing == ways[i].plan.slicing && advised.depth_test == ways[i].plan.depth_test)
                    CHECK(std::fabs(advised.evaluations / measured[i].shade - 1) < 0.1);
        }
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
