// SPDX-License-Identifier: MIT
// Stability: settled.
// The output: a light grid (Tiled Shading, Figure 1). It has an offset and a count per tile, and one light index list.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/result.hpp>

#include <span>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The width of a light id in bytes.
enum class IdWidth : std::uint8_t {
    u8 = 1,   ///< ids of 8 bits, up to 256 lights; made by encode(), not by a Binner
    u16 = 2,  ///< ids of 16 bits, up to 65,536 lights
    u32 = 4,
};

constexpr const char* to_string(IdWidth width) {
    return detail::name_at(width, {"?", "u8", "u16", "?", "u32"});
}

/// The list of one tile: `count` ids of the light index list, from index `offset` on. Laid out as a GPU's uvec2.
struct ListRange {
    std::uint32_t offset, count;
};

/// How many lights a grid was made of, and how many of them it leaves out. All others have tiles in their footprints.
struct LightCounts {
    std::uint32_t lights = 0;
    std::uint32_t rejected = 0;  ///< the number of lights left out as bad input: see Sphere, Spot and Box
    std::uint32_t culled = 0;    ///< the number of lights left out as outside of the view, or switched off (radius -1)
    /// Ids below `first_spot` are those of Spheres, from there to `first_box` those of Spots, others those of Boxes.
    std::uint32_t first_spot = 0xffffffff, first_box = 0xffffffff;
};

/// The least and greatest rank of the lights whose depths meet a z-bin. A rank is a light's position in order of depth.
/// Ranks in between may belong to lights that do not meet the bin. A bin that no light meets has least > greatest.
struct BinRange {
    std::uint32_t least, greatest;
};

/// What Slicing::z_bins adds to a grid: the lights' order by depth, and the range of ranks (places in it) per z-bin.
struct LightRanks {
    std::span<const std::uint32_t> order;  ///< the lights' positions in the caller's array, in order of depth
    std::span<const BinRange> bins;        ///< per z-bin, the range in `order` of its lights; one z-bin per slice
};

/// A finished light grid. It does not own its memory; the function that returns the grid says how long that is valid.
template <class Id> class LightGrid {
public:
    LightGrid(int tiles_x, int tiles_y, std::span<const ListRange> ranges, std::span<const Id> ids,
              const LightCounts& counts = {}, int slices = 1, const LightRanks& ranks = {})
        : ranges_(ranges), ids_(ids), tiles_x_(tiles_x), tiles_y_(tiles_y), slices_(slices), counts_(counts),
          ranks_(ranks) {}

    int tiles_x() const { return tiles_x_; }
    int tiles_y() const { return tiles_y_; }
    int slices() const { return slices_; }  ///< the number of depth slices; 1 unless made with Slicing::clusters

    /// The range of ids() that each tile lists: tiles_x() * tiles_y() ranges, row-major; with clusters as many for each
    /// slice, one slice after another; with several views as many per view. Each begins where the range before it ends.
    std::span<const ListRange> ranges() const { return ranges_; }

    /// The light index list. A light's id is its position in the caller's array, or with Slicing::z_bins its rank,
    /// which is its position in order of depth. The ids of a tile ascend.
    std::span<const Id> ids() const { return ids_; }

    /// Returns the ids of the lights of tile (x, y) in a slice, where 0 <= x < tiles_x(), 0 <= y < tiles_y() and 0 <=
    /// slice < slices(). `view` is 0, or in a grid of several views, which copy_to() makes, the number of one of them.
    std::span<const Id> lights_in(int x, int y, int slice = 0, int view = 0) const {
        LIGHTBIN_ASSERT(x >= 0 && x < tiles_x_ && y >= 0 && y < tiles_y_ && slice >= 0 && slice < slices_);
        const std::int64_t row = (view * std::int64_t{slices_} + slice) * tiles_y_ + y;
        const auto cell = static_cast<std::size_t>(row * tiles_x_ + x);
        LIGHTBIN_ASSERT(view >= 0 && cell < ranges_.size());
        const ListRange range = ranges_[cell];
        return ids_.subspan(range.offset, range.count);
    }

    const LightCounts& light_counts() const { return counts_; }

    /// Filled in with Slicing::z_bins, else empty. A shader reads ranks as ids, so upload the lights in the order of
    /// ranks().order, or upload that order and look up each light in it.
    const LightRanks& ranks() const { return ranks_; }

    /// Copies ranges() and ids() to the beginning of the caller's buffers, and returns a grid that refers to the
    /// copies. The buffers are only written, in ascending order, so they may be mapped GPU memory. ranks() is not
    /// copied. Errors: a buffer is smaller than ranges() or ids(); then nothing is written.
    Result<LightGrid> copy_to(std::span<ListRange> ranges, std::span<Id> ids) const {
        return copy_to(ranges, ids, {tiles_x_, tiles_y_, ranges.first(0), ids.first(0), {}, slices_});
    }

    /// Copies ranges() and ids() behind those of other views, for shaders made with SnippetOptions::views. Returns the
    /// grid of all views so far: its ranges() are those of view 0, then those of view 1, and so on, and so are its
    /// ids(); every offset counts from the beginning of `ids`. Its light_counts() and ranks() are those of this grid.
    /// The buffers are only written, in ascending order, and keep what the earlier views filled.
    ///
    /// before  what copy_to() returned for the view before, with the same two buffers
    ///
    /// Errors, after which nothing is written: the grids have different numbers of tiles or slices; all views together
    /// have more cells or list entries than 32 bits count; a buffer is too small for all views.
    Result<LightGrid> copy_to(std::span<ListRange> ranges, std::span<Id> ids, const LightGrid& before) const {
        LIGHTBIN_ASSERT(before.ranges_.data() == ranges.data() && before.ids_.data() == ids.data());
        if (tiles_x_ != before.tiles_x_ || tiles_y_ != before.tiles_y_ || slices_ != before.slices_)
            return Error{ErrorCode::grids_differ};
        constexpr std::uint64_t limit = 0xffffffff;
        const std::uint64_t cells = std::uint64_t{before.ranges_.size()} + ranges_.size(),
                            entries = std::uint64_t{before.ids_.size()} + ids_.size();
        if (cells > limit) return Error{ErrorCode::too_many_cells, cells, limit};
        if (entries > limit) return Error{ErrorCode::too_many_entries, entries, limit};
        if (ranges.size() < cells) return Error{ErrorCode::range_buffer_too_small, cells, ranges.size()};
        if (ids.size() < entries) return Error{ErrorCode::id_buffer_too_small, entries, ids.size()};
        const auto base = static_cast<std::uint32_t>(before.ids_.size());
        ListRange* to = ranges.data() + before.ranges_.size();
        for (const ListRange range : ranges_)
            *to++ = {base + range.offset, range.count};
        detail::copy_items(ids_.data(), ids_.size(), ids.data() + base);
        return LightGrid(tiles_x_, tiles_y_, {ranges.data(), static_cast<std::size_t>(cells)},
                         {ids.data(), static_cast<std::size_t>(entries)}, counts_, slices_, ranks_);
    }

private:
    std::span<const ListRange> ranges_;
    std::span<const Id> ids_;
    int tiles_x_, tiles_y_, slices_;
    LightCounts counts_;
    LightRanks ranks_;
};

/// Returns the ids of a tile's list whose ranks lie in a z-bin: the lights that a shader evaluates at the bin's depths.
template <class Id> std::span<const Id> lights_of_bin(std::span<const Id> list, const BinRange& bin) {
    const Id* const end = list.data() + list.size();
    const Id* const begin = detail::first_not(list.data(), end, [&](Id id) { return id < bin.least; });
    return {begin, detail::first_not(begin, end, [&](Id id) { return id <= bin.greatest; })};
}

/// Returns the length of a grid's longest list. Reads all ranges.
template <class Id> std::uint32_t longest_list(const LightGrid<Id>& grid) {
    std::uint32_t longest = 0;
    for (const ListRange range : grid.ranges())
        longest = detail::max_of(longest, range.count);
    return longest;
}

}}  // namespace lightbin
