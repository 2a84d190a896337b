// SPDX-License-Identifier: MIT
// The working memory of all binning kernels.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/light_grid.hpp>

#include <cstdint>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// The list of a supertile: its lights are at places begin..begin + count - 1 of the list_* below, and its words at
/// `words` of those.
struct SupertileList {
    std::uint32_t begin, count, words;
};

/// Memory of the lights in lists: in one of the two forms below.
struct ListIdBuffers {
    Buffer<std::uint32_t> whole;
    Buffer<std::uint16_t> low, high;
};

/// The lights in lists, ids or visible indices, as they are.
struct WholeIds {
    /// Room for `size`, keeping the first `used`.
    static WholeIds reserve(ListIdBuffers& buffers, std::uint64_t size, std::size_t used, bool) {
        return {buffers.whole.reserve(size, used)};
    }
    WholeIds from(std::size_t place) const { return {ids + place}; }
    std::uint32_t get(std::size_t place) const { return ids[place]; }
    void set(std::size_t place, std::uint32_t id) const { ids[place] = id; }

    std::uint32_t* ids;
};

/// The same with the lower and the upper 16 bits apart, which are 0 where there is no `high`.
struct SplitIds {
    /// wide  some have upper bits
    static SplitIds reserve(ListIdBuffers& buffers, std::uint64_t size, std::size_t used, bool wide) {
        return {buffers.low.reserve(size, used), wide ? buffers.high.reserve(size, used) : nullptr};
    }
    SplitIds from(std::size_t place) const { return {low + place, high != nullptr ? high + place : nullptr}; }
    std::uint32_t get(std::size_t place) const {
        return low[place] | (high != nullptr ? std::uint32_t{high[place]} << 16 : 0);
    }
    void set(std::size_t place, std::uint32_t id) const {
        low[place] = static_cast<std::uint16_t>(id);
        if (high != nullptr) high[place] = static_cast<std::uint16_t>(id >> 16);
    }

    std::uint16_t *low, *high;
};

struct Scratch {
    Buffer<std::uint32_t> corners;  ///< difference array of rectangles, over tiles or supertiles
    Buffer<Tile> last_rows;         ///< of a part, where whole vectors of them have room

    // The lists of a band's supertiles, or of all: ids or, until words are made, visible indices; and which of the
    // supertile's columns and rows each light covers.
    Buffer<SupertileList> supertile_lists;
    ListIdBuffers list_ids;
    Buffer<std::uint8_t> list_columns, list_rows;
    Buffer<std::uint8_t> packed_ids;  ///< list_ids as Packed, of the SSE2 tier
    Buffer<std::uint64_t> masks;      ///< of a supertile: a word a light, a bit per tile
    Buffer<std::uint32_t> uppers;     ///< of 64 of list_ids each, see emit_compress.inl
    Buffer<std::uint64_t> words;      ///< of a band of supertiles, in the form of step 3

    // The lists of bands, see lists_scan.inl.
    Buffer<std::uint8_t> band_x0, band_x1, band_rows;
    Buffer<std::uint32_t> band_size;
    ListIdBuffers band_ids;
};

}  // namespace lightbin::detail
