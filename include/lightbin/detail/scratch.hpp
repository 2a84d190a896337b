// SPDX-License-Identifier: MIT
// The working memory of all binning kernels.
#pragma once

#include <lightbin/detail/buffer.hpp>

#include <cstdint>

namespace lightbin::detail {

struct Scratch {
    Buffer<std::uint32_t> offsets;  ///< one a tile
    Buffer<std::uint32_t> cursors;  ///< one a tile or supertile
    Buffer<std::int32_t> corners;   ///< difference array of rectangles

    // Lists of the lights that reach a supertile: id, and which of its columns and rows.
    Buffer<std::uint32_t> list_begin, list_size, list_ids;
    Buffer<std::uint8_t> list_columns, list_rows;
    Buffer<std::uint64_t> words;  ///< of a band of supertiles: for 64 lights, one bit a light

    Buffer<float> tile_min, tile_max;  ///< Z bounds, 64 a supertile
    Buffer<std::uint64_t> lit_tiles;   ///< one bit a tile that has anything to light, a word a supertile

    // The same lists in the form of the AVX-512 kernel, and those of a band of supertiles.
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint16_t> band_ids, short_ids;
    Buffer<std::uint32_t> band_size, word_begin;
};

}  // namespace lightbin::detail
