// SPDX-License-Identifier: MIT
// Blocks of 8x8 tiles, for which lights are listed first, and the working memory of the kernels that do so. A band is a row of
// blocks: 8 rows of tiles.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Whether the tiles of a light within its rectangle have to be found by a silhouette or a depth test.
template <Footprint footprint, DepthTest depth_test>
inline constexpr bool has_tests = footprint != Footprint::rectangle || depth_test != DepthTest::none;

/// Whether a kernel reads the spots themselves. Where it does not, spots and spheres share one kernel.
template <DepthTest depth_test> inline constexpr bool reads_spots = depth_test != DepthTest::none;

/// Whether a depth test needs the boxes around cells.
template <DepthTest depth_test>
inline constexpr bool with_boxes = depth_test == DepthTest::box || depth_test == DepthTest::split_box;

/// The list of the lights that meet a block: elements begin..begin + count - 1 of Scratch::list_ids, list_columns and
/// list_rows.
struct BlockList {
    std::uint32_t begin, count;

    /// The size rounded up to 8 or a multiple of 16: lights are emitted by as many.
    std::uint32_t padded_count() const { return count <= 8 ? 8 : (count + 15) & ~15u; }
};

/// Working memory of the binning kernels, kept from call to call.
struct Scratch {
    Buffer<std::uint32_t> corners;  ///< of scatter.inl: a difference array over the tiles

    // The lights of several bands, see lists.inl.
    Buffer<std::uint32_t> light_indices;  ///< 0, 1, 2 ...
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint32_t> band_ids, band_sizes;

    // The lists of one band's blocks.
    Buffer<BlockList> lists;
    Buffer<std::uint32_t> list_ids;                  ///< light ids; until the tests are done, indices into the footprint arrays
    Buffer<std::uint8_t> list_columns, list_rows;    ///< a bit for each of the block's columns, rows that the light's rectangle covers
    Buffer<std::uint64_t> tile_masks;                ///< of one list: a bit for each of the block's 64 tiles that the light is in
    Buffer<std::uint8_t> row_columns;                ///< see row_columns_of()

    // The lights of one row of a block, see pick_row().
    Buffer<std::uint32_t> row_ids;
    Buffer<std::uint8_t> picked_columns;
    Buffer<std::uint64_t> row_words;

    Buffer<float> slab_ends;  ///< of SlabBoxes

    /// What the emission reads of a list: for each of the block's 8 rows in turn a byte a light, with a bit for each column
    /// whose tile in this row the light is in. Rows are list.padded_count() bytes apart, filled up with 0. Readable, and to be
    /// written in this order, in whole vectors.
    std::uint8_t* row_columns_of(const BlockList& list) const {
        return row_columns.data() + std::size_t{8} * list.begin;
    }
};

/// An upper bound on the padded sizes of all lists of a kernel together, which it counts in 32 bits: one element for each light
/// and each block that its rectangle can meet, wherever the first block begins, and the padding.
inline std::uint64_t list_size_bound(const Camera& camera, const FootprintSlice& lit) {
    const std::uint64_t width = static_cast<std::uint64_t>(camera.x.tiles) / 8 + 3,
                        height = static_cast<std::uint64_t>(camera.y.tiles) / 8 + 3;
    std::uint64_t size = 64 * width * height;
    for (const FootprintRun& run : lit.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            size += (lit.lights.x1[i] / 8u - lit.lights.x0[i] / 8u + std::uint64_t{1}) *
                    ((lit.lights.y1[i] - lit.lights.y0[i] + 7u) / 8 + 1);
    return size;
}

/// Writes `count` tiles without lights whose lists begin at `offset`: some one by one, then copies of all so far, as memcpy() writes
/// whole vectors.
inline void fill_empty(ListRange* tiles, std::size_t count, std::uint32_t offset) {
    std::size_t filled = min_of<std::size_t>(count, 16);
    fill_items(tiles, filled, {offset, 0});
    for (std::size_t copied; filled < count; filled += copied) {
        copied = min_of(filled, count - filled);
        copy_items(tiles, copied, tiles + filled);
    }
}

/// A bit for each of the 8 tiles from `begin` on that first..last contains. The two ranges must meet.
inline unsigned covered(unsigned first, unsigned last, unsigned begin) {
    const unsigned low = first > begin ? first - begin : 0, high = last - begin < 7 ? last - begin : 7;
    return ((2u << high) - 1) & (~0u << low);
}

/// Reads 8 bytes as a word whose lowest byte is the first, in either byte order of the machine's memory.
inline std::uint64_t load_8_bytes(const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(&word, bytes, 8);
    else
        for (unsigned i = 8; i > 0; --i)
            word = word << 8 | bytes[i - 1];
    return word;
}

/// Writes a word as 8 bytes, the lowest first, in either byte order of the machine's memory.
inline void store_8_bytes(std::uint8_t* bytes, std::uint64_t word) {
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(bytes, &word, 8);
    else
        for (unsigned i = 0; i < 8; ++i, word >>= 8)
            bytes[i] = static_cast<std::uint8_t>(word);
}

/// Replaces each set bit i of a byte by the byte 0xff at byte i.
inline std::uint64_t spread_bits(std::uint8_t bits) {
    const std::uint64_t one_each = bits * std::uint64_t{0x0101010101010101} & 0x8040201008040201;
    return ((one_each + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101) * 0xff;
}

/// Transposes 8x8 bits: bit j of byte i becomes bit i of byte j (Warren, "Hacker's Delight", 7-3).
inline std::uint64_t transpose_bits(std::uint64_t x) {
    std::uint64_t t = (x ^ x >> 7) & 0x00aa00aa00aa00aa;
    x ^= t ^ t << 7;
    t = (x ^ x >> 14) & 0x0000cccc0000cccc;
    x ^= t ^ t << 14;
    t = (x ^ x >> 28) & 0x00000000f0f0f0f0;
    return x ^ t ^ t << 28;
}

/// Swaps the bytes of `mask` in b with the bytes `distance` bits above them in a.
template <unsigned distance> void swap_bytes(std::uint64_t& a, std::uint64_t& b, std::uint64_t mask) {
    const std::uint64_t t = (a >> distance ^ b) & mask;
    a ^= t << distance;
    b ^= t;
}

/// Transposes 8x8 bytes: byte j of word i becomes byte i of word j. The same method as transpose_bits(), on eight words.
inline void transpose_bytes(std::uint64_t (&words)[8]) {
    for (unsigned i = 0; i < 4; ++i)
        swap_bytes<32>(words[i], words[i + 4], 0x00000000ffffffff);
    for (unsigned i : {0u, 1u, 4u, 5u})
        swap_bytes<16>(words[i], words[i + 2], 0x0000ffff0000ffff);
    for (unsigned i = 0; i < 8; i += 2)
        swap_bytes<8>(words[i], words[i + 1], 0x00ff00ff00ff00ff);
}

}}}  // namespace lightbin::detail
