// SPDX-License-Identifier: MIT
// The working memory of all binning kernels.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/light_grid.hpp>

#include <cstdint>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// The lights of all runs at begin..end-1, no more than 2^16 places: their ids share their upper 16 bits, `upper`.
struct IdBlock {
    std::uint32_t begin, end, upper;
};

/// A supertile's list on AVX-512: how many lights, and the places of its ids and words.
struct SupertileList {
    std::uint32_t count, ids, words;
};

struct Scratch {
    Buffer<std::uint32_t> corners;  ///< difference array of rectangles, over tiles or supertiles
    Buffer<std::uint32_t> cursors;  ///< one a supertile
    Buffer<Tile> last_rows;         ///< of a part, where whole vectors of them have room

    // Lists of the lights that reach a supertile: id, and which of its columns and rows.
    Buffer<std::uint32_t> list_begin, list_size, list_ids;
    Buffer<std::uint8_t> list_columns, list_rows;
    Buffer<std::uint64_t> masks;      ///< of a supertile: a word a light, a bit a tile
    Buffer<std::uint64_t> words;      ///< of a band of supertiles: a bit a light
    Buffer<std::uint8_t> tile_bytes;  ///< the same, a byte a tile for 8 lights
    Buffer<std::uint8_t> packed_ids;  ///< of a band of supertiles: Packed, of the SSE2 tier

    // The same lists in the form of the AVX-512 kernel, and those of a band of supertiles (also AVX2's).
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint16_t> band_ids, short_ids;
    Buffer<std::uint32_t> band_size, band_light_ids;
    Buffer<SupertileList> supertile_lists;
    Buffer<IdBlock> blocks;
    Buffer<std::uint32_t> block_ends, uppers;  ///< of a band's list; of 64 lights of a supertile's
};

}  // namespace lightbin::detail
