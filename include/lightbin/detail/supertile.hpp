// SPDX-License-Identifier: MIT
// What the supertile kernels of all tiers share: the layout of their words and of the Z bounds.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lightbin::detail {

/// The words of 64 lights of a supertile, one bit a light: a word for each column and one for each row, or,
/// with Z, one for each tile.
template <bool with_depth> struct Words {
    static constexpr std::size_t size = with_depth ? 64 : 16;

    static std::uint64_t of_tile(const std::uint64_t* words, unsigned row, unsigned column) {
        if constexpr (with_depth)
            return words[8 * row + column];
        else
            return words[8 + row] & words[column];
    }
};

inline constexpr std::array<std::uint8_t, 64> every_byte = [] {
    std::array<std::uint8_t, 64> bytes = {};
    for (std::uint8_t i = 0; i < 64; ++i)
        bytes[i] = i;
    return bytes;
}();

inline namespace LIGHTBIN_FLAVOUR {

/// Fills tile_min, tile_max and lit_tiles of the scratch: the Z bounds in supertile order, `pitch` supertiles
/// a row.
template <class Id>
void arrange_bounds(const BinJob<Id>& job, Scratch& scratch, std::size_t pitch, std::size_t height) {
    float* low = scratch.tile_min.room(pitch * height * 64);
    float* high = scratch.tile_max.room(pitch * height * 64);
    std::uint64_t* lit = scratch.lit_tiles.room(pitch * height);
    std::memset(lit, 0, pitch * height * sizeof *lit);
    std::size_t tile = 0;
    for (unsigned y = 0; y < static_cast<unsigned>(job.tiles_y); ++y)
        for (unsigned x = 0; x < static_cast<unsigned>(job.tiles_x); ++x, ++tile) {
            const std::size_t supertile = y / 8 * pitch + x / 8;
            const unsigned place = y % 8 * 8 + x % 8;
            const float min_depth = job.bounds.min[tile & job.bounds.min_mask];
            const float max_depth = job.bounds.max[tile & job.bounds.max_mask];
            low[supertile * 64 + place] = min_depth;
            high[supertile * 64 + place] = max_depth;
            lit[supertile] |= std::uint64_t{!(min_depth > max_depth)} << place;
        }
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
