// SPDX-License-Identifier: MIT
// In a unit of its own, as it has Binners of all kinds in it.
#include "stage.hpp"

#include <vector>

lightbin::Advice Stage::advise(const lightbin::View& view, const FrameSettings& settings,
                               const lightbin::ZBounds& z_bounds, double z_bounds_ns) {
    place(settings);
    return binned_->visit_lights(settings.bin.dropped_light, [&](const auto& lights) {
        const auto advice = value_of(lightbin::advise(view, lights, {.z_bounds_ns = z_bounds_ns}, z_bounds));
        if (z_bounds.max.empty()) return advice;

        // The same in slices. What is farthest in each tile tells at which depths there is something to light.
        const auto slices = [&](DepthMethod method) {
            return slices_for({.method = method, .clusters = settings.bin.clusters}, view.orthographic(),
                              binned_->lights());
        };
        const lightbin::Slices clusters = slices(DepthMethod::clusters), z_bins = slices(DepthMethod::z_bins);
        const auto sliced = value_of(
            lightbin::advise_slices(view, lights, {.clusters = clusters, .z_bins = z_bins},
                                    {.depths = z_bounds.max, .size = {view.tiles_x(), view.tiles_y()}}));
        std::vector<lightbin::Plan> plans(advice.plans().begin(), advice.plans().end());
        for (const lightbin::Plan& plan : sliced.plans())
            if (plan.slicing != lightbin::Slicing::none) plans.push_back(plan);
        return lightbin::Advice(plans);
    });
}
