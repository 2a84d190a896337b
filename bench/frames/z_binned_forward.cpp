// SPDX-License-Identifier: MIT
// Z-binned forward (Drobot, SIGGRAPH 2017): tiles' lists of lights in order of depth, of which a fragment takes those
// of its depth's bin; no pre-pass.
#include "passes.hpp"
#include "technique.hpp"

#include <memory>

Technique z_binned_forward() {
    using lightbin::Slicing;
    const auto binner = std::make_shared<lightbin::Binner<lightbin::Options{.slicing = Slicing::z_bins}>>();
    return {"ZBinnedForward", [binner](Stage& stage) {
                const auto slices = value_of(lightbin::Slices::linear(1024, 0, depth_of_lights(stage)));
                const auto grid = value_of(binner->bin(stage.view(), stage.lights(), {.slices = slices}));
                stage.lap("bin");
                stage.order_lights(grid.ranks().order);
                upload_slices(stage, slices, grid.ranks());
                upload_lists(stage, grid);
                begin_picture(stage);
                shade_forward(stage, listed_lights({.slicing = Slicing::z_bins}));
            }};
}
