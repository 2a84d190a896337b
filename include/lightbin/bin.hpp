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
    static constexpr bool with_depth = depth_test != DepthTest::none;
    static_assert(depth_test != DepthTest::box && depth_test != DepthTest::split_box,
                  "lightbin: the depth tests box and split_box are not built yet");

public:
    /// Builds the grid of the footprints with a kernel of an instruction set. Returns an Error if Z bounds
    /// are shorter than the grid, or 32-bit offsets can't reach the list's end; then there is no grid.
    std::optional<Error> build(Isa isa, const View& view, const Footprints<footprint, with_depth>& footprints,
                               const ZBounds& bounds, detail::Scratch& scratch, const Parallel&) {
        const std::size_t tiles = view.tile_count();
        for (const std::span<const float> side : {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max})
            if (!side.empty() && side.size() < tiles)
                return Error{ErrorCode::z_bounds_too_small, tiles, side.size()};

        using Job = detail::BinJob<Id>;
        Job job = {.lights = footprints.arrays(),
                   .runs = footprints.runs(),
                   .count = footprints.visible(),
                   .tiles_x = view.tiles_x(),
                   .tiles_y = view.tiles_y(),
                   .bounds = tile_depths(view, bounds),
                   .offsets = scratch.offsets.room(tiles + Job::slack),
                   .indices = nullptr};
        // Every kernel fits in the rectangles' area. Where that is out of reach, Z bounds may still bring the
        // list below what 32-bit offsets reach: counted exactly, and the one kernel that needs no more room
        // than that.
        constexpr std::uint64_t most = (std::numeric_limits<std::uint32_t>::max)();
        std::uint64_t room = footprints.area();
        auto kernel = detail::bin_kernel<Id, with_depth>(isa, job, room);
        if (room > most / 2) {
            if constexpr (with_depth)
                room = detail::count_scalar<true>(job, scratch, scratch.cursors.room(tiles));
            if (room > most) return Error{ErrorCode::too_many_entries, room, most};
            kernel = detail::bin_scalar<with_depth, Id>;
        }
        job.indices = indices_.room(static_cast<std::size_t>(room) + Job::slack);
        entries_ = static_cast<std::size_t>(kernel(job, scratch));

        tile_count_ = tiles;
        Tile* grid = tiles_.room(tiles);
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            const std::uint32_t end =
                tile + 1 < tiles ? job.offsets[tile + 1] : static_cast<std::uint32_t>(entries_);
            grid[tile] = {job.offsets[tile], end - job.offsets[tile]};
        }
        return std::nullopt;
    }

    std::span<const Tile> tiles() const { return {tiles_.data(), tile_count_}; }
    std::span<const Id> indices() const { return {indices_.data(), entries_}; }

private:
    static detail::TileDepths tile_depths(const View& view, const ZBounds& bounds) {
        static constexpr float none = -detail::infinity, all = detail::infinity;
        constexpr std::size_t every = ~std::size_t{0};
        return {bounds.min.empty() ? &none : bounds.min.data(), bounds.max.empty() ? &all : bounds.max.data(),
                bounds.min.empty() ? 0 : every, bounds.max.empty() ? 0 : every, view.camera().z_sign};
    }

    detail::Buffer<Tile> tiles_;
    detail::Buffer<Id> indices_;
    std::size_t tile_count_ = 0, entries_ = 0;
};

}  // namespace lightbin
