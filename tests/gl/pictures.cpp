// SPDX-License-Identifier: MIT
// pictures GLSL DROPPED_LIGHT [SCENE.glb]: one renderer draws the scene with tiles of many sizes and all uses of Z
// bounds, and by clusters, and each picture is that of every light in every fragment, which is drawn once, or once
// without a pre-pass. Without the dropped light it is not, so that the comparison is known to see a light that is
// missing from the lists.
#include "gl_context.hpp"
#include "renderer.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

int wrong = 0;

void check(bool good, const FrameSettings& frame, const char* what) {
    if (good) return;
    ++wrong;
    std::printf("tiles of %d, depth %d, Z bounds %d, dropped light %d: %s\n", frame.tile_size,
                static_cast<int>(frame.depth), static_cast<int>(frame.z_bounds), frame.dropped_light, what);
}

int draw_all(int glsl, int dropped_light, const Scene& scene) {
    const OffscreenContext context(glsl);
    Renderer renderer(scene, context.glsl());
    const Camera& camera = scene.cameras.front();
    FrameSettings frame;
    frame.width = 165;
    frame.height = 107;
    frame.exposure = renderer.meter(camera, frame);
    const auto every_light = [&](DepthUse depth) {
        frame.depth = depth;
        renderer.draw(camera, frame);
        renderer.draw_every_light(camera, frame);
        return renderer.read_picture();
    };
    // Of surfaces in one place, the last one is seen after a pre-pass, and the first one without.
    const Picture without_pre_pass = every_light(DepthUse::clusters),
                  expected = every_light(DepthUse::pre_pass);

    frame.count_evaluations = true;
    int pictures = 0;
    const auto draw_one = [&](const Picture& wanted) {
        const FrameReport report = renderer.draw(camera, frame);
        check(report.entries > 0 && report.evaluations_per_pixel > 0, frame, "the lists are empty");
        check(report.evaluations_per_pixel < static_cast<double>(scene.lights.size()), frame,
              "the lists have every light");
        check(compare(wanted, renderer.read_picture()).pixels == 0, frame, "another picture");
        ++pictures;
    };
    for (const int tile : {1, 8, 13, 16, 32, 64}) {
        if (glsl < 330 && tile != 13) continue;  // the lists are made and read as elsewhere
        frame.tile_size = tile;
        for (const ZBoundsUse use : {ZBoundsUse::none, ZBoundsUse::max, ZBoundsUse::both}) {
            frame.z_bounds = use;
            draw_one(expected);
        }
        frame.depth = DepthUse::clusters;
        draw_one(without_pre_pass);
        frame.depth = DepthUse::pre_pass;
    }
    frame.tile_size = 16;
    frame.dropped_light = dropped_light;
    renderer.draw(camera, frame);
    check(compare(expected, renderer.read_picture()).pixels > 0, frame, "no light is missing");
    return pictures;
}

}  // namespace

int main(int count, char** words) {
    if (count < 3) return 2;
    try {
        const int pictures = draw_all(std::atoi(words[1]), std::atoi(words[2]),
                                      count > 3 ? load_glb(words[3], 0.05f) : make_scene(1024));
        std::printf("%d pictures, %d complaints\n", pictures, wrong);
        return wrong != 0;
    } catch (const std::exception& problem) {
        std::printf("%s\n", problem.what());
        return EXIT_FAILURE;
    }
}
