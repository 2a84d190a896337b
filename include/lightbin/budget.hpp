// SPDX-License-Identifier: MIT
// Stability: may change.
// Budget: limits the lists of a light grid to a number of lights per cell, or of entries per frame. The caller's
// weights decide which lights stay, and what is left out is counted.
#pragma once

#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/light_grid.hpp>

#include <algorithm>
#include <concepts>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How many entries a Budget keeps. An entry is one light in one cell's list. By default all are kept.
struct BudgetLimits {
    std::uint32_t per_cell = 0xffffffff;   ///< the most lights in the list of a cell
    std::uint32_t per_frame = 0xffffffff;  ///< the most entries in the lists of all cells together
};

/// What Budget::limit() returns: a grid with shorter lists, and the number of entries that they lack.
template <class Id> struct BudgetedGrid {
    LightGrid<Id> grid;
    std::uint32_t entries_cut;                   ///< the number of entries that were left out
    std::span<const std::uint32_t> cut_in_cell;  ///< the number of entries left out per cell, in the order of ranges()
};

namespace detail {

/// Returns a number by which lights are sorted: heavier lights have lesser numbers, and of lights that weigh the same
/// the one with the lower index has. NaN weighs less than all other weights, and -0 as much as 0. Only the bits of the
/// weight are read, so that the caller's floating-point environment does not matter.
///
/// light  the light's index in the array that was binned; it is the lower half of the number
inline std::uint64_t weight_order(float weight, std::uint32_t light) {
    const std::uint32_t bits = bit_cast<std::uint32_t>(weight), size = bits & 0x7fffffff;
    constexpr std::uint32_t zero = 0x80000000, infinite = 0x7f800000;
    // The bits of floats without a sign ascend with the floats. All weights but NaN get a number greater than 0.
    const std::uint32_t ascending = size > infinite ? 0 : bits == size ? zero + size : zero - size;
    return std::uint64_t{~ascending} << 32 | light;
}

}  // namespace detail

/// Shortens the lists of light grids to BudgetLimits. The lights with the greatest of the caller's weights stay, and of
/// lights that weigh the same those with the lower index in the array that was binned.
///
/// A Budget keeps its memory from call to call. Not thread-safe: use one Budget per thread.
///
/// Id  the type of the grids' ids, Binner::Id
template <class Id = std::uint32_t> class Budget {
public:
    /// Returns a grid that lists in each cell the lights of `grid` that the limits keep, in ascending order of id.
    /// First, each cell keeps its per_cell heaviest lights. Then, of the entries that are left, the per_frame heaviest
    /// stay; of the entries of one light, those in the cells that come first in ranges(). The result is valid until the
    /// Budget's next call, and no longer than `grid` is: if no entry is left out, it refers to the memory of `grid`.
    ///
    /// grid     a grid of a Binner, with clusters or z-bins too, or a copy that copy_to() made of one
    /// weights  one weight for each element of the array that was binned, in its order, with z-bins too. NaN weighs
    ///          less than all numbers.
    ///
    /// Errors: fewer weights than grid.light_counts().lights.
    Result<BudgetedGrid<Id>> limit(const LightGrid<Id>& grid, std::span<const float> weights,
                                   const BudgetLimits& limits) {
        const std::uint32_t lights = grid.light_counts().lights;
        if (weights.size() < lights) return Error{ErrorCode::too_few_weights, lights, weights.size()};
        const std::span<const ListRange> ranges = grid.ranges();
        const std::size_t cells = ranges.size(), entries = grid.ids().size();
        const std::span<const std::uint32_t> by_rank = grid.ranks().order;
        const std::size_t id_count = by_rank.empty() ? lights : by_rank.size();  // all ids are less
        std::uint32_t* const cut = cut_.reserve(cells);
        std::uint64_t in_cells = 0;
        for (const ListRange range : ranges) {
            // Only a grid that the caller made can fail this: its LightCounts are missing or wrong.
            LIGHTBIN_ASSERT(range.count == 0 || grid.ids()[range.offset + range.count - 1] < id_count);
            in_cells += detail::min_of(range.count, limits.per_cell);
        }
        if (in_cells == entries && entries <= limits.per_frame) {
            detail::fill_items(cut, cells, 0);
            return BudgetedGrid<Id>{grid, 0, {cut, cells}};
        }

        std::uint64_t* const orders = orders_.reserve(id_count);
        for (std::size_t id = 0; id < id_count; ++id) {
            const std::uint32_t light = by_rank.empty() ? static_cast<std::uint32_t>(id) : by_rank[id];
            orders[id] = detail::weight_order(weights[light], light);
        }
        ranges_.reserve(cells);
        ids_.reserve(in_cells + 1);  // keep_if() writes one element past the end
        size_ = 0;
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const std::span<const Id> list = grid.ids().subspan(ranges[cell].offset, ranges[cell].count);
            std::uint64_t end = ~std::uint64_t{0};  // greater than all orders
            if (list.size() > limits.per_cell) {
                std::uint64_t* const sorted = sorted_.reserve(list.size());
                for (std::size_t i = 0; i < list.size(); ++i)
                    sorted[i] = orders[list[i]];
                std::nth_element(sorted, sorted + limits.per_cell, sorted + list.size());
                end = sorted[limits.per_cell];
            }
            keep_if(cell, list, [=](std::uint64_t order) { return order < end; });
        }
        if (size_ > limits.per_frame) {
            std::uint64_t* const sorted = sorted_.reserve(size_);
            for (std::size_t i = 0; i < size_; ++i)
                sorted[i] = orders[ids_.data()[i]];
            std::nth_element(sorted, sorted + limits.per_frame, sorted + size_);
            // Entries of this order, which are all of one light, stay in as many cells as the limit leaves room for.
            const std::uint64_t end = sorted[limits.per_frame];
            std::ptrdiff_t left = std::count(sorted, sorted + limits.per_frame, end);
            size_ = 0;
            for (std::size_t cell = 0; cell < cells; ++cell) {
                const ListRange range = ranges_.data()[cell];
                keep_if(cell, {ids_.data() + range.offset, range.count}, [&](std::uint64_t order) {
                    const bool stays = order == end && left > 0;
                    left -= stays;
                    return order < end || stays;
                });
            }
        }
        for (std::size_t cell = 0; cell < cells; ++cell)
            cut[cell] = ranges[cell].count - ranges_.data()[cell].count;
        const LightGrid<Id> shortened(grid.tiles_x(), grid.tiles_y(), {ranges_.data(), cells},
                                      {ids_.data(), size_}, grid.light_counts(), grid.slices(), grid.ranks());
        return BudgetedGrid<Id>{shortened, static_cast<std::uint32_t>(entries - size_), {cut, cells}};
    }

private:
    /// Appends to ids_ those ids of a cell's `list` for whose weight_order() `stays` returns true, and stores their
    /// range. `list` may be a part of ids_ from element size_ on, as each id is read before it can be overwritten.
    template <class Stays> void keep_if(std::size_t cell, std::span<const Id> list, Stays stays) {
        const std::size_t begin = size_;
        Id* const ids = ids_.data();
        for (const Id id : list) {  // without a branch, which would be mispredicted
            ids[size_] = id;
            size_ += stays(orders_.data()[id]);
        }
        ranges_.data()[cell] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(size_ - begin)};
    }

    detail::Buffer<std::uint64_t> orders_;  ///< for each id, the weight_order() of its light
    detail::Buffer<std::uint64_t> sorted_;  ///< the orders of a list's or all lists' entries, while they are sorted
    detail::Buffer<std::uint32_t> cut_;
    detail::Buffer<ListRange> ranges_;
    detail::Buffer<Id> ids_;
    std::size_t size_ = 0;  ///< the number of entries in ids_, which are those of the cells so far
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
