// SPDX-License-Identifier: MIT
// Z-binned forward (Drobot, SIGGRAPH 2017): a tile's list is sorted by depth, and a fragment evaluates only the lights
// that meet its depth interval (bin). No depth pre-pass.
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
