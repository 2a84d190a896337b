// SPDX-License-Identifier: MIT
// Stage 3b: footprints in slices -> the light grid of clusters. Each slice is a grid of tiles of its own.
#pragma once

#include <lightbin/bin.hpp>
#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/costs.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/detail/maybe.hpp>
#include <lightbin/detail/parts.hpp>
#include <lightbin/detail/plain.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/sliced_footprints.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// A light grid of clusters in memory of its own, kept from call to call.
template <class Id, Footprint footprint, DepthTest depth_test> class ClusterLists {
    static_assert(
        depth_test == DepthTest::none || depth_test == DepthTest::box,
        "lightbin: with slices the depth test is none, as lights are in the slices that they meet, or box");
    static constexpr bool with_boxes = depth_test == DepthTest::box,
                          worded = detail::with_words<footprint, depth_test>,
                          by_slab = with_boxes && footprint == Footprint::rectangle;

public:
    /// Builds the grid: the tiles of the first slice row by row, then those of the next one. Errors: more than 2^32 - 1
    /// cells, pairs of a light and a slice, or entries; then there is no grid.
    ///
    /// spots  the lights are spots
    template <bool spots, class Threads>
    detail::Maybe<Error> build(Isa isa, const View& view, const Footprints<footprint, true>& footprints,
                               const Slices& slices, detail::Buffer<detail::Scratch>& scratch,
                               [[maybe_unused]] const Threads& parallel) {
        cell_count_ = entries_ = 0;  // until there is a grid
        constexpr std::uint64_t most = (std::numeric_limits<std::uint32_t>::max)();
        const std::size_t tiles = view.tile_count(), count = static_cast<std::size_t>(slices.count());
        const std::uint64_t cells = std::uint64_t{tiles} * count;
        if (cells > most) return Error{ErrorCode::too_many_cells, cells, most};
        const std::uint64_t places = footprints_.template cut<spots>(isa, view, footprints, slices);
        if (places > most) return Error{ErrorCode::too_many_list_places, places, most};
        if constexpr (with_boxes) edges_.find(detail::camera_of(view));
        const std::size_t slack = Job::slack(static_cast<std::size_t>(view.tiles_x()));
        cells_.reserve(cells + slack);

        std::uint64_t capacity = 0;
        for (std::size_t slice = 0; slice < count; ++slice) {
            const std::uint64_t area = footprints_.runs()[slice].area;
            capacity += area;
            if (area <= detail::surely_listed_area) continue;
            const std::uint64_t listed = detail::list_places(job_of(view, slices, slice));
            if (listed > most) return Error{ErrorCode::too_many_list_places, listed, most};
        }
        // Where the rectangles' area is out of reach, what is left of it may still be within: counted exactly.
        if constexpr (worded)
            if (capacity > most) {
                capacity = 0;
                for (std::size_t slice = 0; slice < count; ++slice)
                    capacity += detail::scalar::count_entries<footprint, depth_test, by_slab, spots>(
                        job_of(view, slices, slice), scratch.data()[0]);
            }
        if (capacity > most) return Error{ErrorCode::too_many_entries, capacity, most};

        Id* const list = ids_.reserve(capacity + detail::BandJob<Id>::slack);
        const auto build_some = [&](std::size_t begin, std::size_t end, Id* out, detail::Scratch& memory) {
            std::uint32_t at = 0;
            for (std::size_t slice = begin; slice < end; ++slice) {
                Job job = job_of(view, slices, slice);
                // What is behind the last of these slices may be another thread's.
                job.spare_tiles = end == count ? slack : detail::min_of(slack, (end - slice - 1) * tiles);
                const auto kernel = detail::bin_kernel<footprint, depth_test, Id, by_slab, spots>(
                    isa, view, job.visible, footprints_.runs()[slice].area);
                const unsigned rows = static_cast<unsigned>(view.tiles_y());
                at += static_cast<std::uint32_t>(kernel(job, memory, {0, rows, out + at, at}));
            }
            return std::uint64_t{at};
        };
        cell_count_ = static_cast<std::size_t>(cells);
        shared_ = false;
        if constexpr (!std::is_same_v<Threads, Serial>) {
            const std::size_t parts = detail::min_of<std::size_t>(parallel.workers(), count);
            shared_ =
                parts > 1 && parallel.pays_off(detail::supertile_ns(isa, worded, static_cast<double>(places),
                                                                    static_cast<double>(capacity)));
            if (shared_) {
                scratch.reserve(parts, parts);
                const detail::Items<detail::Part> shares = {parts_.reserve(parts), parts};
                detail::share_steps(shares.first, parts, count, detail::empty_row_cost(tiles),
                                    [&](std::size_t slice) { return footprints_.runs()[slice].area; });
                entries_ = static_cast<std::size_t>(detail::build_apart(
                    parallel, shares, cells_.data(), tiles, spares_, list, [&](std::size_t i, Id* out) {
                        return build_some(shares[i].begin, shares[i].end, out, scratch.data()[i]);
                    }));
                return {};
            }
        }
        entries_ = static_cast<std::size_t>(build_some(0, count, list, scratch.data()[0]));
        return {};
    }

    template <class Range = ListRange> std::span<const Range> tiles() const {
        return {cells_.data(), cell_count_};
    }
    std::span<const Id> indices() const { return {ids_.data(), entries_}; }

    /// Whether the last grid was built on several threads.
    bool shared() const { return shared_; }

private:
    using Job = detail::BinJob<Id>;

    /// A slice as a grid of its own.
    Job job_of(const View& view, const Slices& slices, std::size_t slice) {
        const detail::FootprintRun& run = footprints_.runs()[slice].run;
        const std::span<const float> boundaries = slices.boundaries();
        Job job = {.camera = &detail::camera_of(view),
                   .lights = footprints_.arrays(),
                   .runs = {&run, 1},
                   .visible = run.end - run.begin,
                   .bounds = {},
                   .slab = {slice == 0 ? -detail::infinity : boundaries[slice - 1],
                            slice == boundaries.size() ? detail::infinity : boundaries[slice]},
                   .edges = {},
                   .tiles = cells_.data() + slice * view.tile_count(),
                   .spare_tiles = 0};
        if constexpr (with_boxes) edges_.give(job.edges);
        return job;
    }

    SlicedFootprints<footprint> footprints_;
    detail::TileEdges edges_;
    detail::Buffer<detail::Part> parts_;
    detail::Buffer<detail::Buffer<Id>> spares_;  ///< one a part: its list
    detail::Buffer<ListRange> cells_;
    detail::Buffer<Id> ids_;
    std::size_t cell_count_ = 0, entries_ = 0;
    bool shared_ = false;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
