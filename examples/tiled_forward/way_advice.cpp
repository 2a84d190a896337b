// SPDX-License-Identifier: MIT
// In a unit of its own, as way_costs.cpp has Binners of all kinds already.
#include "value_of.hpp"
#include "way_costs.hpp"

#include <algorithm>
#include <utility>

lightbin::Advice WayCosts::advise() {
    const lightbin::AdviceCosts costs = {.evaluation_ns = prices_.evaluation_ns,
                                   .z_bounds_ns = z_bounds_ns({.plan = {.tile_size = 16}}),
                                   .upload_byte_ns = prices_.upload_byte_ns,
                                   .overdraw = depth_.overdraw};
    // A pixel of 16, where that leaves some.
    const auto [width, height] = view_.viewport();
    const int step = std::min(width, height) < 64 ? 1 : 4;
    std::vector<float> samples;
    const lightbin::ImageSize size = {width / step, height / step};
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            samples.push_back(
                view_depth_[static_cast<std::size_t>((y * step + step / 2) * width + x * step + step / 2)]);

    const auto advised = [&](const auto& first) {
        const auto lights = lightbin::lights(first, sets_[0].boxes);
        const lightbin::Advice bounded = value_of(lightbin::advise(
            view_, lights, costs, reduced(view_.tile_size(), true, true).bounds));
        const lightbin::Advice sliced =
            value_of(lightbin::advise_slices(view_, lights, {.clusters = clusters_, .z_bins = z_bins_},
                                             {.depths = samples, .size = size}, costs));
        std::vector<lightbin::AdvicePlan> plans(bounded.plans().begin(), bounded.plans().end());
        for (const lightbin::AdvicePlan& plan : sliced.plans())
            if (plan.slicing != lightbin::Slicing::none) plans.push_back(plan);
        const lightbin::Advice all(plans);
        masks_ = *std::find_if(all.plans().begin(), all.plans().end(), [](const auto& plan) { return plan.masks; });
        std::erase_if(plans,
                      [](const lightbin::AdvicePlan& plan) { return plan.masks; });  // WayCosts measures lists
        return lightbin::Advice(std::move(plans));
    };
    return has_cones() ? advised(sets_[0].spots) : advised(sets_[0].spheres);
}
