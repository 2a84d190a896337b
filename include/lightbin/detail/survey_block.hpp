// SPDX-License-Identifier: MIT
// A block of 8x8 tiles of the finest grid, and in it the tiles of 2, 4 and 8 times their size: what a survey tests
// some lights against.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/lights.hpp>

#include <array>
#include <cstdint>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// The place of a block's tile: x and y turn by turn, lowest bits first. So the quarters of the n tiles of a coarser
/// grid lie n places apart, and whole words and vectors go from a grid to the next.
constexpr unsigned block_place(unsigned x, unsigned y) {
    const auto quarter = [=](unsigned shift) { return (y >> shift & 1) * 2 + (x >> shift & 1); };
    return 16 * quarter(0) + 4 * quarter(1) + quarter(2);
}

/// Bits of the tiles in the columns before column i, or in the rows before row i.
constexpr std::array<std::uint64_t, 9> tiles_before(bool rows) {
    std::array<std::uint64_t, 9> before = {};
    for (unsigned i = 0; i < 8; ++i) {
        before[i + 1] = before[i];
        for (unsigned j = 0; j < 8; ++j)
            before[i + 1] |= std::uint64_t{1} << (rows ? block_place(j, i) : block_place(i, j));
    }
    return before;
}
inline constexpr auto columns_before = tiles_before(false), rows_before = tiles_before(true);

/// The coarser grids' tiles that hold any of the finest: bits 0 to 15 of the first, then 4 and 1 of the others.
constexpr std::uint64_t coarser_tiles(std::uint64_t tiles) {
    std::uint64_t sixteen = tiles | tiles >> 32;
    sixteen = (sixteen | sixteen >> 16) & 0xffff;
    std::uint64_t four = sixteen | sixteen >> 8;
    four = (four | four >> 4) & 0xf;
    return sixteen | four << 16 | std::uint64_t{four != 0} << 20;
}

/// 64 tiles by place, then 16, 4 and 1 of the coarser grids, and room for vectors.
struct SurveyBlock {
    float low[3][112], high[3][112];   ///< edges along x and y, see tile_edges(); depths. low > high: none
    float gap_min[112], gap_max[112];  ///< as in ZBounds
    std::uint64_t in_grid, drawn;      ///< bits of the finest tiles: all there are; with something to light
};

/// A light, and the finest tiles in its rectangle.
struct BlockLight {
    static constexpr std::uint32_t most = 8;  ///< that are tested in a block

    Sphere sphere;
    std::uint64_t tiles;
};

/// Sums over lights, by depth test (none, box, split_box) and grid.
struct BlockSums {
    std::uint32_t tiles[3][4] = {};  ///< that list a light
    std::uint32_t drawn[3][4] = {};  ///< the finest tiles in these that have something to light
    std::uint32_t finest[4] = {};    ///< without a depth test, all the finest tiles in them
};

}  // namespace lightbin::detail
