// SPDX-License-Identifier: MIT
#include "draw_times.hpp"

#include "gl_context.hpp"
#include "renderer.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace {

constexpr int turns = 7;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return std::max(*middle, 0.0);
}

// Milliseconds of drawing the picture, and the evaluations in it.
struct Shaded {
    double ms, evaluations;
};

Shaded shade(Renderer& renderer, const Camera& camera, FrameSettings settings, bool count) {
    settings.count_evaluations = count;
    const FrameReport report = renderer.draw(camera, settings);
    return {report.milliseconds.draw, report.evaluations_per_pixel * settings.width * settings.height};
}

// The same picture with few evaluations and with many: all lights in view at each pixel. What is left of the two times
// is divided by what is left of the two counts, so that all but the evaluations falls out. After a pre-pass a pixel is
// shaded once, so that the evaluations are those that are counted. The picture begins small and grows until the
// difference is well above the noise, so that it takes a processor no minutes.
double evaluation_ns(Renderer& renderer, const Camera& camera, int width, int height) {
    FrameSettings few, many;
    for (int part = 8;; part /= 2) {
        few.width = many.width = std::max(width / part, 1);
        few.height = many.height = std::max(height / part, 1);
        few.tile_size = 8;
        many.tile_size = std::max(many.width, many.height);
        many.z_bounds = ZBoundsUse::none;
        shade(renderer, camera, few, false);  // waits for shader compilers and memory
        const double evaluations =
            shade(renderer, camera, many, true).evaluations - shade(renderer, camera, few, true).evaluations;
        const auto difference_ms = [&] {
            return shade(renderer, camera, many, false).ms - shade(renderer, camera, few, false).ms;
        };
        if (part > 1 && difference_ms() < 20) continue;
        if (!(evaluations > 0)) return 0;
        std::vector<double> quotients;
        for (int turn = 0; turn < turns; ++turn)
            quotients.push_back(1e6 * difference_ms() / evaluations);
        return median(quotients);
    }
}

}  // namespace

DrawTimes draw_times(const Scene& scene, const Camera& camera, int width, int height, int wanted_glsl) {
    const OffscreenContext context(wanted_glsl);
    DrawTimes times;
    times.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    times.glsl = context.glsl();

    Scene opaque = scene;
    opaque.transparent.clear();
    opaque.lights.resize(std::min<std::size_t>(opaque.lights.size(), 10000));
    Renderer renderer(opaque, context.glsl());
    times.evaluation_ns = evaluation_ns(renderer, camera, width, height);

    const auto frames = [&](Renderer& by, const FrameSettings& settings, auto of) {
        by.draw(camera, settings);  // waits for memory
        std::vector<double> values;
        for (int turn = 0; turn < turns; ++turn)
            values.push_back(1e6 * of(by.draw(camera, settings).milliseconds));
        return median(values);
    };
    FrameSettings settings;
    settings.width = width;
    settings.height = height;
    const auto bytes = [](const FrameReport& report) {
        return 8.0 * report.tiles_x * report.tiles_y + 4.0 * static_cast<double>(report.entries);
    };
    settings.tile_size = 8;
    const double lights = sizeof(GpuLight) * static_cast<double>(opaque.lights.size() + opaque.suns.size());
    times.upload_byte_ns = frames(renderer, settings, [](const auto& ms) { return ms.upload; }) /
                           (bytes(renderer.draw(camera, settings)) + lights);

    // Depth is the same with one light, which takes no time to shade.
    opaque.lights.resize(std::min<std::size_t>(opaque.lights.size(), 1));
    Renderer depth(opaque, context.glsl());
    settings.tile_size = 16;
    settings.z_bounds = ZBoundsUse::none;
    times.depth_pass_ns = frames(depth, settings, [](const auto& ms) { return ms.pre_pass; });
    settings.z_bounds = ZBoundsUse::both;
    times.read_back_ns = std::max(
        frames(depth, settings, [](const auto& ms) { return ms.pre_pass; }) - times.depth_pass_ns, 0.0);
    settings.gpu_reduction = true;
    times.gpu_reduction_ns = frames(depth, settings, [](const auto& ms) { return ms.reduce; });
    return times;
}
