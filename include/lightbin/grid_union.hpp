// SPDX-License-Identifier: MIT
// One grid for two views, such as two eyes: each tile lists the lights that either view lists in that tile.
#pragma once

#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/light_grid.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Makes the union of two grids, in memory that it keeps from frame to frame.
template <class Id = std::uint32_t> class GridUnion {
public:
    /// Returns a grid whose cell (x, y, slice) lists the lights that cell (x, y, slice) of either grid lists, each
    /// once, in ascending order of id. Pixels of both views that lie in the same tile read the same list, which has
    /// every light of the list of their own view. The result is valid until the next call; its light_counts() are those
    /// of `first`.
    ///
    /// first, second  grids of one array of lights; either may be what another GridUnion, but not this one, returned
    ///
    /// Errors: the grids have different numbers of tiles or slices; they have z-bins, whose ids are not the lights'
    /// positions in the array; both together have more entries than 32 bits count.
    Result<LightGrid<Id>> unite(const LightGrid<Id>& first, const LightGrid<Id>& second) {
        // The result is written over what this GridUnion returned before, which is so no grid to read from.
        LIGHTBIN_ASSERT(first.ids().empty() || first.ids().data() != ids_.data());
        LIGHTBIN_ASSERT(second.ids().empty() || second.ids().data() != ids_.data());
        const std::size_t cells = first.ranges().size();
        if (!first.same_cells(second) || second.ranges().size() != cells) return Error{ErrorCode::grids_differ};
        if (!first.ranks().bins.empty() || !second.ranks().bins.empty()) return Error{ErrorCode::ids_are_ranks};
        constexpr std::uint64_t limit = 0xffffffff;
        const std::uint64_t entries = std::uint64_t{first.ids().size()} + second.ids().size();
        if (entries > limit) return Error{ErrorCode::too_many_entries, entries, limit};

        ListRange* const ranges = ranges_.reserve(cells);
        Id* const ids = ids_.reserve(entries);
        std::uint32_t offset = 0;
        for (std::size_t i = 0; i < cells; ++i) {
            const std::uint32_t count = merge(list_of(first, i), list_of(second, i), ids + offset);
            ranges[i] = {offset, count};
            offset += count;
        }
        return LightGrid<Id>(first.tiles_x(), first.tiles_y(), {ranges, cells}, {ids, offset}, first.light_counts(),
                             first.slices());
    }

private:
    static std::span<const Id> list_of(const LightGrid<Id>& grid, std::size_t cell) {
        const ListRange range = grid.ranges()[cell];
        return grid.ids().subspan(range.offset, range.count);
    }

    /// Writes the union of two ascending lists to `out`, which has room for the ids of both, and returns its length.
    static std::uint32_t merge(std::span<const Id> a, std::span<const Id> b, Id* out) {
        auto from_a = a.begin(), from_b = b.begin();
        Id* to = out;
        while (from_a != a.end() && from_b != b.end()) {
            // The lesser id is taken from each list that goes on with it, so from both lists where both do.
            const Id next_a = *from_a, next_b = *from_b;
            *to++ = detail::min_of(next_a, next_b);
            from_a += next_a <= next_b;
            from_b += next_b <= next_a;
        }
        while (from_a != a.end())
            *to++ = *from_a++;
        while (from_b != b.end())
            *to++ = *from_b++;
        return static_cast<std::uint32_t>(to - out);
    }

    detail::Buffer<ListRange> ranges_;
    detail::Buffer<Id> ids_;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
