// SPDX-License-Identifier: MIT
// A block of 8x8 tiles of the finest grid, and in it the tiles of 2, 4 and 8 times their size: what advise() tests
// some lights against.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/lights.hpp>

#include <array>
#include <cstdint>

namespace lightbin::detail {

/// The place of a block's tile: x and y turn by turn, lowest bits first. So a tile's quarters are as far apart as
/// there are such tiles, and four grids are merged and told apart by whole words.
constexpr unsigned block_place(unsigned x, unsigned y) {
    const auto quarter = [=](unsigned shift) { return (y >> shift & 1) * 2 + (x >> shift & 1); };
    return 16 * quarter(0) + 4 * quarter(1) + quarter(2);
}

/// Bits of the block's tiles in the columns, or rows, before the i-th.
constexpr std::array<std::uint64_t, 9> tiles_before(bool rows) {
    std::array<std::uint64_t, 9> before = {};
    for (unsigned i = 0; i < 8; ++i) {
        before[i + 1] = before[i];
        for (unsigned j = 0; j < 8; ++j)
            before[i + 1] |= std::uint64_t{1} << (rows ? block_place(j, i) : block_place(i, j));
    }
    return before;
}
inline constexpr auto block_columns = tiles_before(false), block_rows = tiles_before(true);

/// The coarser tiles that hold any of the finest: from bit 0 on 16, then 4, then 1.
constexpr std::uint64_t coarser_tiles(std::uint64_t tiles) {
    std::uint64_t sixteen = tiles | tiles >> 32;
    sixteen = (sixteen | sixteen >> 16) & 0xffff;
    std::uint64_t four = sixteen | sixteen >> 8;
    four = (four | four >> 4) & 0xf;
    return sixteen | four << 16 | std::uint64_t{four != 0} << 20;
}

/// Tiles by place, and from 64, 80 and 84 on the coarser grids'. Where there is none, min > max.
struct SurveyBlock {
    static constexpr unsigned size = 112;

    float x0[size], x1[size], y0[size], y1[size];  ///< edges, see tile_edges()
    float min[size], max[size], gap_min[size], gap_max[size];
    std::uint64_t drawn;  ///< bits of the finest tiles that have something to light
};

/// Sums over lights, by rung (no depth test, box, split_box) and by grid.
struct BlockSums {
    std::uint32_t tiles[3][4] = {};  ///< that list a light
    std::uint32_t lit[3][4] = {};    ///< the finest tiles in these that have something to light
};

/// A light and the finest tiles in its rectangle.
struct BlockLight {
    static constexpr std::uint32_t most = 8;  ///< that are tested in a block

    Sphere sphere;
    std::uint64_t tiles;
};

}  // namespace lightbin::detail
