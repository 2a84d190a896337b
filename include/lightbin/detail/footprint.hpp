// SPDX-License-Identifier: MIT
// The types that pass between the stages' kernels, apart from the kernels themselves.
#pragma once

#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin::detail {

/// Tiles x0..x1, y0..y1, both ends included.
struct TileRect {
    std::uint16_t x0, y0, x1, y1;
};

/// Parallel arrays, one element a light in view. depths is null where no depth test reads it.
struct FootprintArrays {
    std::uint32_t* ids;
    TileRect* rects;
    DepthInterval* depths;
};

struct ProjectCounts {
    std::uint32_t visible = 0, rejected = 0;
};

/// Z bounds in a form without branches: an absent side reads the one element of a constant.
struct TileDepths {
    const float* min;
    const float* max;
    std::size_t min_mask, max_mask;  ///< 0 for an absent side, all ones otherwise

    /// True unless the interval is surely out of the tile's bounds or the tile is empty. NaN tests nothing.
    bool meets(std::size_t tile, DepthInterval light) const {
        const float low = min[tile & min_mask], high = max[tile & max_mask];
        return !(light.max < low) && !(light.min > high) && !(low > high);
    }
};

}  // namespace lightbin::detail
