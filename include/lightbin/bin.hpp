// SPDX-License-Identifier: MIT
// Stage 3: footprints (+ Z bounds) -> the light grid.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace lightbin {

/// A light grid in memory of its own, kept from call to call.
template <class Id, Footprint footprint, DepthTest depth_test> class GridLists {
    static constexpr bool with_depth = depth_test != DepthTest::none,
                          with_boxes = depth_test == DepthTest::box || depth_test == DepthTest::split_box;

public:
    /// Builds the grid of the footprints with a kernel of an instruction set. Returns an Error if Z bounds
    /// are shorter than the grid, or 32-bit offsets can't reach the list's end; then there is no grid.
    std::optional<Error> build(Isa isa, const View& view, const Footprints<footprint, with_depth>& footprints,
                               const ZBounds& bounds, detail::Scratch& scratch, const Parallel&) {
        const std::size_t tiles = view.tile_count();
        Job job = {.camera = &view.camera(),
                   .lights = footprints.arrays(),
                   .runs = footprints.runs(),
                   .bounds = {},
                   .edges = {},
                   .tiles = nullptr};
        const std::span<const float> sides[] = {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max};
        for (std::size_t side = 0; side < 4; ++side) {
            if (sides[side].empty()) continue;
            if (sides[side].size() < tiles)
                return Error{ErrorCode::z_bounds_too_small, tiles, sides[side].size()};
            job.bounds[side] = sides[side].data();
        }
        if constexpr (with_boxes) find_edges(job);

        const unsigned bands = static_cast<unsigned>(view.tiles_y() + 7) / 8;
        constexpr std::uint64_t most = (std::numeric_limits<std::uint32_t>::max)();
        std::uint64_t room = footprints.area();
        // Where the rectangles' area is out of reach, what is left of it may still be within: counted exactly.
        if constexpr (detail::masked<footprint, depth_test>)
            if (room > most)
                room = detail::scalar::bin_supertiles<footprint, depth_test>(job, scratch,
                                                                             {0, bands, nullptr, 0});
        if (room > most) return Error{ErrorCode::too_many_entries, room, most};

        tile_count_ = tiles;
        job.tiles = tiles_.room(tiles);
        const auto kernel =
            detail::bin_kernel<footprint, depth_test, Id>(isa, view, footprints.visible(), footprints.area());
        Id* list = indices_.room(static_cast<std::size_t>(room) + detail::BandJob<Id>::slack);
        entries_ = static_cast<std::size_t>(kernel(job, scratch, {0, bands, list, 0}));
        return std::nullopt;
    }

    std::span<const Tile> tiles() const { return {tiles_.data(), tile_count_}; }
    std::span<const Id> indices() const { return {indices_.data(), entries_}; }

private:
    using Job = detail::BinJob<Id>;

    void find_edges(Job& job) {
        const detail::ImageAxis* axes[] = {&job.camera->x, &job.camera->y};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t room = static_cast<std::size_t>(axes[i]->tiles) + 8;  // vectors are read
            float *low = edges_[2 * i].room(room), *high = edges_[2 * i + 1].room(room);
            detail::tile_edges(*axes[i], low, high);
            job.edges[2 * i] = low;
            job.edges[2 * i + 1] = high;
        }
    }

    detail::Buffer<Tile> tiles_;
    detail::Buffer<Id> indices_;
    detail::Buffer<float> edges_[4];
    std::size_t tile_count_ = 0, entries_ = 0;
};

}  // namespace lightbin
