// SPDX-License-Identifier: MIT
// TiledFwd (Tiled Shading, section 6.1): lights each fragment as it is drawn, with the list of its tile.
#include "passes.hpp"
#include "technique.hpp"

#include <memory>

Technique tiled_forward() {
    const auto binner = std::make_shared<lightbin::Binner<>>();
    return {"TiledForward", [binner](Stage& stage) {
                const auto grid = value_of(binner->bin(stage.view(), stage.lights()));
                stage.lap("bin");
                upload_lists(stage, grid);
                begin_picture(stage);
                shade_forward(stage, listed_lights());
            }};
}
