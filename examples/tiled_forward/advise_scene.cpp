// SPDX-License-Identifier: MIT
#include "advise_scene.hpp"

#include "draw_times.hpp"
#include "projection.hpp"
#include "value_of.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>

using lightbin::AdvicePlan;
using lightbin::Slicing;

namespace {

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
    char line[400];
    va_list values;
    va_start(values, format);
    std::vsnprintf(line, sizeof line, format, values);
    va_end(values);
    return line;
}

glm::mat4 projection_of(const Camera& camera, lightbin::ImageSize size) {
    return projection_of(camera, static_cast<double>(size.width) / size.height);
}

BinnedLights placed(const Scene& scene, const Camera& camera) {
    BinnedLights lights(scene);
    lights.place(glm::inverse(camera.to_world));
    return lights;
}

}  // namespace

AdvisedView::AdvisedView(const Scene& scene, const Camera& camera, lightbin::ImageSize size)
    : view_(value_of(lightbin::View::from_projection(projection_of(camera, size), size, {.tile_size = 8}))),
      lights_(placed(scene, camera)),
      depth_(draw_depth_on_cpu(scene, glm::dmat4(projection_of(camera, size)) * glm::inverse(camera.to_world),
                               size)),
      min_(view_.tile_count()), max_(min_), reduce_ns_(HUGE_VAL),
      clusters_(slices_for(DepthMethod::clusters, view_.orthographic(), lights_.listed())),
      z_bins_(slices_for(DepthMethod::z_bins, view_.orthographic(), lights_.listed())) {
    for (int turn = 0; turn < 5; ++turn) {
        const auto start = std::chrono::steady_clock::now();
        static_cast<void>(value_of(
            lightbin::reduce_depth(view_, {.depth = depth_.depth, .skip_background = true}, {min_, max_})));
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
        reduce_ns_ = std::min(reduce_ns_, time.count());
    }
}

double AdvisedView::plain_evaluations() {
    const lightbin::View view = value_of(view_.with_tile_size(16));
    const auto grid = lights_.bin(view, {}, {}, {}).opaque;
    const int width = view.viewport().width;
    double evaluations = 0;
    for (std::size_t i = 0; i < depth_.depth.size(); ++i) {
        const int pixel = static_cast<int>(i);
        if (depth_.depth[i] < 1)
            evaluations += static_cast<double>(grid.lights_in(pixel % width / 16, pixel / width / 16).size());
    }
    return evaluations * depth_.overdraw;
}

lightbin::Advice AdvisedView::advise(lightbin::AdviceCosts costs) const {
    costs.overdraw = depth_.overdraw;
    // A pixel of 16, where that leaves some.
    const auto [width, height] = view_.viewport();
    const int step = std::min(width, height) < 64 ? 1 : 4;
    const lightbin::ImageSize size = {width / step, height / step};
    std::vector<float> samples;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const float window =
                depth_.depth[static_cast<std::size_t>((y * step + step / 2) * width + x * step + step / 2)];
            const double z = static_cast<double>(window);
            samples.push_back(window < 1 ? view_.view_depths(z, z).min
                                         : std::numeric_limits<float>::infinity());
        }
    return lights_.visit_lights(-1, [&](const auto& lights) {
        const auto all = lightbin::lights(lights, lightbin::view_space(lights_.boxes(), box_of));
        const lightbin::Advice bounded = value_of(lightbin::advise(view_, all, costs, {min_, max_})),
                               sliced = value_of(lightbin::advise_slices(
                                   view_, all, {.clusters = clusters_, .z_bins = z_bins_},
                                   {.depths = samples, .size = size}, costs));
        std::vector<AdvicePlan> plans(bounded.plans().begin(), bounded.plans().end());
        for (const AdvicePlan& plan : sliced.plans())
            if (plan.slicing != Slicing::none) plans.push_back(plan);
        return lightbin::Advice(plans);
    });
}

// From their boundaries, as slices_for() lays them.
std::string AdvisedView::slices_in_words(Slicing slicing) const {
    const lightbin::Slices& slices = slicing == Slicing::z_bins ? z_bins_ : clusters_;
    const auto boundary = [&](std::size_t i) { return static_cast<double>(slices.boundaries()[i]); };
    const int count = slices.count();
    if (slicing == Slicing::z_bins || view_.orthographic())
        return text("linear(%d, 0, %#.4gf)", count, boundary(0) * count);
    return text("exponential(%d, %#.4gf, %#.4gf)", count, boundary(0),
                boundary(0) * std::pow(boundary(1) / boundary(0), count - 1));
}

namespace {

// The lines of C++ that do as is advised.
std::string code(const AdvicePlan& plan, const AdvisedView& seen, const Scene& scene, bool reduced_on_gpu) {
    if (!plan.tiled) return "// No lists: the shader goes through all lights.\n";
    const auto [width, height] = seen.view().viewport();
    std::string lines =
        text("auto view = lightbin::View::from_projection(projection, {%d, %d}, {.tile_size = %d});\n", width,
             height, plan.tile_size);
    const bool sliced = plan.slicing != Slicing::none;
    const std::string slicing = std::string(".slicing = lightbin::Slicing::") + to_string(plan.slicing);
    std::string inputs;
    if (sliced) {
        lines += "auto slices = lightbin::Slices::" + seen.slices_in_words(plan.slicing) + ";\n";
        inputs = plan.masks ? ", *slices" : ", {.slices = *slices}";
    } else if (plan.has_z_bounds()) {
        lines += "std::vector<float> min(view->tile_count()), max(min);";
        lines += reduced_on_gpu
                     ? "  // as lightbin::reduce_shader() writes them\n"
                     : "\nauto bounds = lightbin::reduce_depth(\n"
                       "    *view, {.depth = depth_buffer, .skip_background = true}, {min, max});\n";
        inputs = reduced_on_gpu ? ", {.bounds = {min, max}}" : ", {.bounds = *bounds}";
    }
    if (plan.masks)
        lines += "lightbin::MaskBinner binner;  // once\n";
    else
        lines += std::string("lightbin::Binner<lightbin::Options{") +
                 (plan.depth_test ? ".depth_test = true" : "") +
                 (plan.depth_test && sliced ? ",\n                                   " : "") +
                 (sliced ? slicing : "") + "}> binner;  // once\n";
    const bool spots = std::ranges::any_of(scene.lights, &Light::spot);
    const std::string lamps =
        std::string("lightbin::world_space(lamps, view_matrix, ") + (spots ? "to_spot)" : "to_sphere)");
    lines += "auto lights = " +
             (scene.boxes.empty() ? lamps
                                  : "lightbin::lights(" + lamps +
                                        ",\n                               "
                                        "lightbin::world_space(decals, view_matrix, to_box))") +
             ";\n";
    lines += std::string(plan.masks ? "auto masks" : "auto grid") + " = binner.bin(*view, lights" + inputs +
             ");\n";
    const std::string read =
        plan.masks ? (sliced ? slicing + ",\n                                        " : "") + ".masks = true"
                   : ".format = decltype(binner)::list_format" +
                         (sliced ? ",\n                                        " + slicing : "");
    return lines + "auto shader = lightbin::shader_snippet({" + read +
           text(", .tile_size = %d});\n", plan.tile_size);
}

// What this machine's OpenGL takes, or without one what is assumed of it.
struct Prices {
    lightbin::AdviceCosts costs = {.upload_byte_ns = 0.1};
    bool reduced_on_gpu = false;
    std::string words;
};

Prices prices_of(const Scene& scene, const Camera& camera, const AdviseSettings& settings, double reduce_ns) {
    Prices prices;
    lightbin::AdviceCosts& costs = prices.costs;
    costs.z_bounds_ns = reduce_ns;
    try {
        const DrawTimes times = draw_times(scene, camera, settings.width, settings.height, settings.glsl);
        const bool told = times.evaluation_ns > 0, reads_back = times.glsl >= 330;
        if (told) costs.evaluation_ns = times.evaluation_ns;
        if (times.upload_byte_ns > 0) costs.upload_byte_ns = times.upload_byte_ns;
        prices.reduced_on_gpu = !reads_back || times.gpu_reduction_ns < times.read_back_ns + reduce_ns;
        costs.z_bounds_ns = times.depth_pass_ns +
                            (prices.reduced_on_gpu ? times.gpu_reduction_ns : times.read_back_ns + reduce_ns);
        prices.words = text("OpenGL       %.60s, GLSL %d\n", times.renderer.c_str(), times.glsl);
        prices.words += text(
            "costs        %.4g ns a light evaluation%s %.3g ns a byte of the lists;\n", costs.evaluation_ns,
            told ? "," : " (assumed: there are too few to time),\n            ", costs.upload_byte_ns);
        prices.words += text("             the pre-pass %.3f ms; its Z bounds %.3f ms by %s\n",
                             1e-6 * times.depth_pass_ns, 1e-6 * (costs.z_bounds_ns - times.depth_pass_ns),
                             prices.reduced_on_gpu ? "a shader" : "the CPU, with the read-back");
    } catch (const std::runtime_error& problem) {
        prices.words = text("OpenGL       none: %.80s\n", problem.what());
        prices.words += text(
            "costs        assumed: %.4g ns a light evaluation, as on a GPU, %.3g ns a byte of the lists;\n"
            "             Z bounds %.3f ms by the CPU; the draw of the pre-pass is left out\n",
            costs.evaluation_ns, costs.upload_byte_ns, 1e-6 * costs.z_bounds_ns);
    }
    return prices;
}

}  // namespace

std::string advise_scene(const Scene& scene, const AdviseSettings& settings) {
    // The view that is asked for, or the one whose plain tiles shade most.
    std::unique_ptr<AdvisedView> seen;
    std::size_t at = 0;
    double evaluations = 0;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (settings.view >= 0 && i != static_cast<std::size_t>(settings.view)) continue;
        auto view = std::make_unique<AdvisedView>(scene, scene.cameras[i],
                                                  lightbin::ImageSize{settings.width, settings.height});
        const double count = view->plain_evaluations();
        if (seen != nullptr && count <= evaluations) continue;
        seen = std::move(view);
        at = i;
        evaluations = count;
    }
    const Camera& camera = scene.cameras[at];
    const Prices prices = prices_of(scene, camera, settings, seen->reduce_ns());
    const lightbin::Advice advice = seen->advise(prices.costs);
    std::string page =
        text("view         %zu, \"%.40s\", %d x %d pixels%s\n", at, camera.name.c_str(), settings.width,
             settings.height, settings.view < 0 ? ", the one that shades most" : "");
    page += prices.words;
    page += text(
        "overdraw     %.2f: without a pre-pass so many fragments are shaded for each pixel that is seen;\n"
        "             plain tiles of 16 px evaluate %.1f lights%s a pixel\n",
        seen->overdraw(), evaluations / settings.width / settings.height,
        scene.boxes.empty() ? "" : " and boxes");
    if (!scene.transparent.empty())
        page +=
            "             glass is left out; with Z bounds it needs lists of its own, by the maximum alone\n";
    return page + "advised      " + to_string(advice) + "code\n" +
           code(advice.best(), *seen, scene, prices.reduced_on_gpu);
}
