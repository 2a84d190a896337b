// SPDX-License-Identifier: MIT
// Prints the nanoseconds that this machine's OpenGL takes for a light evaluation, and the renderer's name: evaluation
// [SCENE.glb]. What the report is told.
#include <draw_times.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) try {
    const Scene scene = load_glb(argc > 1 ? argv[1] : LIGHTBIN_SCENES "/nova.glb", 0.01f);
    const DrawTimes times = draw_times(scene, scene.cameras[0], 1920, 1080, 0);
    std::printf("%.4g %s\n", times.evaluation_ns, times.renderer.c_str());
    return times.evaluation_ns > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "evaluation: %s\n", problem.what());
    return EXIT_FAILURE;
}
