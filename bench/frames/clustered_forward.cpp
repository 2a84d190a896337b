// SPDX-License-Identifier: MIT
// Clustered forward (Tiled Forward Shading, section 4.8): a list for each tile in each slice of depth, and no pre-pass.
#include "passes.hpp"
#include "technique.hpp"

#include <memory>

Technique clustered_forward() {
    using lightbin::Slicing;
    const auto binner = std::make_shared<
        lightbin::Binner<lightbin::Options{.depth_test = true, .slicing = Slicing::clusters}>>();
    return {"ClusteredForward", [binner](Stage& stage) {
                const float reach = depth_of_lights(stage);
                const auto slices = value_of(lightbin::Slices::exponential(24, reach / 40, reach));
                const auto grid = value_of(binner->bin(stage.view(), stage.lights(), {.slices = slices}));
                stage.lap("bin");
                upload_slices(stage, slices, {});
                upload_lists(stage, grid);
                begin_picture(stage);
                shade_forward(stage, listed_lights({.slicing = Slicing::clusters}));
            }};
}
