// SPDX-License-Identifier: MIT
// Blocks of 8x8 tiles: the binning kernels first list the lights of each block, and then emit its tiles. A band is a
// row of blocks, that is 8 rows of tiles. Here are the types and the working memory of these kernels.
#pragma once

#include <lightbin/detail/base/bits.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// What the lights of a tile's rectangle are tested against before the tile lists them: nothing; the tile's cell; with
/// clusters, the boxes around the cells of a depth slice (a slab), which all lie between the same two depths.
enum class Tested : std::uint8_t { nothing, cells, slab };

/// Whether there are spheres alone, which are tested against the boxes in a slab. Other kinds are tested against cells.
template <Tested tested, LightKind kind>
inline constexpr bool slab_alone = tested == Tested::slab && kind == LightKind::sphere;

/// The list of the lights whose rectangles meet a block: elements begin..begin + count - 1 of Scratch::list_*.
struct BlockList {
    std::uint32_t begin, count;

    /// The number of lights, rounded up to 8 or to a multiple of 16: kernels emit 8 or 16 lights at a time.
    std::uint32_t padded_count() const { return count <= 8 ? 8 : (count + 15) & ~15u; }
};

/// The working memory of one thread's binning kernels, kept from call to call so that it is allocated once.
struct Scratch {
    Buffer<std::uint32_t> corners;  ///< a difference array over tiles: its prefix sums are their numbers of lights

    // Memory for BandLists, the lists of the lights in bands; a band is a row of blocks of 8x8 tiles.
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint32_t> band_ids, band_sizes;

    // The lists of one band's blocks.
    Buffer<BlockList> lists;
    Buffer<std::uint32_t> list_ids;     ///< the lights' FootprintArrays::ids
    Buffer<std::uint8_t> list_columns;  ///< a byte for each light: a bit for each tile column its rectangle meets
    Buffer<std::uint8_t> list_rows;     ///< a byte for each light: a bit for each tile row its rectangle meets
    Buffer<std::uint64_t> tile_masks;   ///< a word for each light of one list: a bit for each tile that it is in
    Buffer<std::uint8_t> met_boxes;     ///< for each tile row and light of a list, a bit for each box that it meets
    Buffer<std::uint8_t> row_columns;   ///< for each light of a list and each tile row, a bit for each tile it is in

    // Copies that pick_row() makes of the lights in one row of tiles: their ids, and bytes with a bit for each tile.
    // split_bits() transposes the bytes of each 64 lights to 8 words, one for each tile, with a bit for each light.
    Buffer<std::uint32_t> row_ids;
    Buffer<std::uint8_t> picked_columns;
    Buffer<std::uint64_t> row_words;

    Buffer<float> slab_ends;  ///< the memory of the arrays SlabBoxes::ends

    /// Returns the table from which a list's tiles are emitted. For each of the block's 8 rows of tiles it has one byte
    /// for each light, with a bit for each of the row's 8 tiles that the light is in. Rows begin list.padded_count()
    /// bytes apart, and bytes behind the last light are 0. Kernels read and write whole vectors, past a row's end: they
    /// write the rows in ascending order, so that each overwrites what the row before wrote too far.
    std::uint8_t* row_columns_of(const BlockList& list) const {
        return row_columns.data() + std::size_t{8} * list.begin;
    }
    /// Returns row_columns_of(list) for a list behind all others, with memory for its table.
    std::uint8_t* reserve_row_columns(const BlockList& list) {
        row_columns.reserve(std::uint64_t{8} * (list.begin + list.padded_count()) + widest_vector,
                            std::size_t{8} * list.begin);
        return row_columns_of(list);
    }
};

/// Writes the ranges of `count` tiles without lights, all at `offset` of the index list. The first 16 are written one
/// by one, and the rest are copies of all that were written so far, as memcpy() is faster than a loop.
inline void fill_empty(ListRange* tiles, std::size_t count, std::uint32_t offset) {
    std::size_t filled = min_of<std::size_t>(count, 16);
    fill_items(tiles, filled, {offset, 0});
    for (std::size_t copied; filled < count; filled += copied) {
        copied = min_of(filled, count - filled);
        copy_items(tiles, copied, tiles + filled);
    }
}

}}}  // namespace lightbin::detail
