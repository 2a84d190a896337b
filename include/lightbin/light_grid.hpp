// SPDX-License-Identifier: MIT
// The output: the light grid of Tiled Shading, Figure 1 - offset and count a tile, and one light index list.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/result.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Bytes of a light id.
enum class IdWidth : std::uint8_t {
    u8 = 1,   ///< up to 256 lights; encode() makes them, a Binner does not
    u16 = 2,  ///< up to 65,536 lights
    u32 = 4,
};

constexpr const char* to_string(IdWidth width) {
    return detail::name_at(width, {"?", "u8", "u16", "?", "u32"});
}

/// One tile's part of the light index list: `count` ids from `offset` on. 8 bytes, as a GPU's uvec2.
struct ListRange {
    std::uint32_t offset, count;
};

/// What became of the lights that a grid was made of. The others, lights - rejected - culled, have tiles in their
/// footprints.
struct LightCounts {
    std::uint32_t lights = 0;
    std::uint32_t rejected = 0;  ///< bad input, see Sphere
    std::uint32_t culled = 0;    ///< out of the view
};

/// The ranks of the lights in a depth bin: from the least to the greatest, with others possibly between them. A bin without
/// lights has least > greatest.
struct BinRange {
    std::uint32_t least, greatest;
};

/// What Slicing::z_bins adds to a grid.
struct LightRanks {
    std::span<const std::uint32_t> order;  ///< the light of each rank, as its position in the caller's array
    std::span<const BinRange> bins;        ///< one a slice
};

/// What Binner::bin_bits() returns beside the bitmasks.
struct LightBits {
    LightCounts counts;
    LightRanks ranks;  ///< with Slicing::z_bins
};

/// A finished light grid. It does not own its memory: see the call that returned it for how long that lives.
template <class Id> class LightGrid {
public:
    LightGrid(int tiles_x, int tiles_y, std::span<const ListRange> ranges, std::span<const Id> ids,
              const LightCounts& counts = {}, int slices = 1, const LightRanks& ranks = {})
        : ranges_(ranges), ids_(ids), tiles_x_(tiles_x), tiles_y_(tiles_y), slices_(slices), counts_(counts),
          ranks_(ranks) {}

    int tiles_x() const { return tiles_x_; }
    int tiles_y() const { return tiles_y_; }
    int slices() const { return slices_; }  ///< 1 without clusters

    /// The parts of ids() that are the tiles' lists: tiles_x() * tiles_y() of them, row-major; of each slice, one slice
    /// after another. Offsets ascend and leave no gap.
    std::span<const ListRange> ranges() const { return ranges_; }

    /// The light index list. A light's id is its position in the caller's array, or with Slicing::z_bins its rank; ids
    /// ascend within a tile.
    std::span<const Id> ids() const { return ids_; }

    /// Returns the ids of the lights of tile (x, y), 0 <= x < tiles_x(), 0 <= y < tiles_y(), in a slice.
    std::span<const Id> lights_in(int x, int y, int slice = 0) const {
        LIGHTBIN_ASSERT(x >= 0 && x < tiles_x_ && y >= 0 && y < tiles_y_ && slice >= 0 && slice < slices_);
        const std::size_t row = static_cast<std::size_t>(slice) * static_cast<std::size_t>(tiles_y_) +
                                static_cast<std::size_t>(y);
        const ListRange range =
            ranges_[row * static_cast<std::size_t>(tiles_x_) + static_cast<std::size_t>(x)];
        return ids_.subspan(range.offset, range.count);
    }

    const LightCounts& light_counts() const { return counts_; }

    /// With Slicing::z_bins. Upload the lights in this order, or read them by way of it.
    const LightRanks& ranks() const { return ranks_; }

    /// Copies ranges() and ids() to the beginning of the caller's memory, and returns the grid there, which is valid as
    /// long as that memory. Only writes there, in order, so it may be a mapped GPU buffer. Errors: a buffer is smaller
    /// than ranges() or ids(); then nothing is written. ranks() stay where they are.
    Result<LightGrid> copy_to(std::span<ListRange> ranges, std::span<Id> ids) const {
        if (ranges.size() < ranges_.size())
            return Error{ErrorCode::range_buffer_too_small, ranges_.size(), ranges.size()};
        if (ids.size() < ids_.size()) return Error{ErrorCode::id_buffer_too_small, ids_.size(), ids.size()};
        detail::copy_items(ranges_.data(), ranges_.size(), ranges.data());
        detail::copy_items(ids_.data(), ids_.size(), ids.data());
        return LightGrid(tiles_x_, tiles_y_, {ranges.data(), ranges_.size()}, {ids.data(), ids_.size()},
                         counts_, slices_, ranks_);
    }

private:
    std::span<const ListRange> ranges_;
    std::span<const Id> ids_;
    int tiles_x_, tiles_y_, slices_;
    LightCounts counts_;
    LightRanks ranks_;
};

/// Returns the part of a tile's list that lies in a bin, which is what a shader goes through at the bin's depths.
template <class Id> std::span<const Id> lights_of_bin(std::span<const Id> list, const BinRange& bin) {
    const Id* const end = list.data() + list.size();
    const Id* const begin = detail::first_not(list.data(), end, [&](Id id) { return id < bin.least; });
    return {begin, detail::first_not(begin, end, [&](Id id) { return id <= bin.greatest; })};
}

/// How long a grid's lists are.
struct ListLengths {
    std::uint32_t longest = 0;
    /// [0]: tiles without lights; [k]: tiles with 2^(k-1) to 2^k - 1 lights.
    std::array<std::uint64_t, 33> histogram = {};
};

/// Returns the lengths of a grid's lists; a pass over its tiles.
template <class Id> ListLengths list_lengths(const LightGrid<Id>& grid) {
    ListLengths lengths;
    for (const ListRange range : grid.ranges()) {
        lengths.longest = detail::max_of(lengths.longest, range.count);
        ++lengths.histogram[static_cast<std::size_t>(std::bit_width(range.count))];
    }
    return lengths;
}

}}  // namespace lightbin
