// SPDX-License-Identifier: MIT
// TiledDeferred (Tiled Shading, sections 6.1 and 6.3): draws surfaces to a G-buffer, then lights each pixel once with
// its tile's list. Lists are made on the CPU, from each tile's least and greatest depth, which the GPU finds.
#include "passes.hpp"
#include "technique.hpp"

#include <memory>

Technique tiled_deferred(int g_buffer_bits) {
    struct Memory {
        DepthBounds bounds;
        IntervalLists lists;
    };
    const auto memory = std::make_shared<Memory>();
    return {.name = "TiledDeferred",
            .draw =
                [memory](Stage& stage) {
                    fill_g_buffer(stage, stage.depth());
                    const auto bounds = memory->bounds.reduce(stage);
                    const auto grid = memory->lists.bin(stage, bounds);
                    stage.lap("bin");
                    upload_lists(stage, grid);
                    shade_deferred(stage, listed_lights());
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 3,
            .g_buffer_bits = g_buffer_bits};
}
