// SPDX-License-Identifier: MIT
// Finds the cells of clusters that something may be drawn in, by the Z bounds of their tiles.
#pragma once

#include <lightbin/detail/dispatch/kernels.hpp>
#include <lightbin/z_bounds.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The cells whose depth slice meets the Z bounds of their tile. Memory is kept from call to call.
class DrawnCells {
public:
    /// bounds  of the view's tiles; without a bound, tiles are drawn in from the nearest or up to the farthest slice
    void find(const View& view, const SliceTable& slices, const ZBounds& bounds) {
        const int blocks_x = (view.tiles_x() + 7) / 8;
        blocks_ = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>((view.tiles_y() + 7) / 8);
        const std::uint64_t size = blocks_ * (slices.boundaries().size() + std::uint64_t{1});
        fill_items(words_.reserve(size), size, 0);
        for_each_drawn(view, bounds, [&](int x, int y, float low, float high) {
            const SliceTable::Range met = slices.met(low, high);
            std::uint64_t* const block = words_.data() + y / 8 * blocks_x + x / 8;
            for (std::size_t slice = met.first; slice <= met.last; ++slice)
                block[slice * blocks_] |= std::uint64_t{1} << (y % 8 * 8 + x % 8);
        });
    }

    /// For each block of 8x8 tiles a word with a bit for each tile, row by row, that the slice may be drawn in.
    std::span<const std::uint64_t> slice(std::size_t i) const { return {words_.data() + i * blocks_, blocks_}; }

    /// Whether nothing is drawn in a slice.
    bool is_empty(std::size_t i) const {
        for (const std::uint64_t word : slice(i))
            if (word != 0) return false;
        return true;
    }

private:
    Buffer<std::uint64_t> words_;
    std::size_t blocks_ = 0;
};

}}}  // namespace lightbin::detail
