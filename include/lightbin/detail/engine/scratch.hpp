// SPDX-License-Identifier: MIT
// The working memory of all binning kernels.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/light_grid.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The list of a supertile: its lights are at places begin..begin + count - 1 of the list_* below, and its words at
/// `words` of those.
struct SupertileList {
    std::uint32_t begin, count, words;
};

/// Memory of the lights in lists, ids or visible indices: all of each, or 16 bits, what it has more than its block.
struct ListIdBuffers {
    Buffer<std::uint32_t> whole;
    Buffer<std::uint16_t> low;

    template <class ListId> ListId* reserve(std::uint64_t size, std::size_t used = 0) {
        if constexpr (sizeof(ListId) == 4)
            return whole.reserve(size, used);
        else
            return low.reserve(size, used);
    }
};

/// Lights that lists of 16 bits tell apart: those of all runs at begin..end-1, no more than 2^16 places, whose ids
/// share their upper 16 bits, `upper`. Its lists have room for `capacity` lights, after those of `before` of the
/// blocks before.
struct IdBlock {
    std::uint32_t begin, end, upper;
    std::size_t before, capacity;
};

struct Scratch {
    Buffer<std::uint32_t> corners;  ///< difference array of rectangles, over tiles or supertiles
    Buffer<ListRange> last_rows;    ///< of a part, where whole vectors of them have room

    // The lists of a band's supertiles, or of all: ids or, until words are made, visible indices; and which of the
    // supertile's columns and rows each light covers.
    Buffer<SupertileList> supertile_lists;
    ListIdBuffers list_ids;
    Buffer<std::uint8_t> list_columns, list_rows;
    Buffer<std::uint8_t> packed_ids;  ///< list_ids as Packed, of the SSE2 tier
    Buffer<std::uint64_t> masks;      ///< of a supertile: a word a light, a bit per tile
    Buffer<IdBlock> blocks;
    Buffer<std::uint32_t> group_blocks;  ///< of 64 of list_ids each the number of their block
    Buffer<std::uint64_t> words;         ///< of a band of supertiles, in the form of step 3

    // The boxes of a slice, see cells.inl.
    SlabBoxes slab;
    Buffer<float> slab_ends;

    // Of a list, those picked for a row, see emit.inl.
    Buffer<std::uint32_t> row_ids;
    Buffer<std::uint8_t> row_columns;
    Buffer<std::uint64_t> row_words;

    // The lists of bands, see lists_scan.inl.
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint32_t> band_size;
    ListIdBuffers band_ids;
};

}}}  // namespace lightbin::detail
