// SPDX-License-Identifier: MIT
// Stage 3: footprints (+ Z bounds) -> the light grid.
#pragma once

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
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

namespace detail {

/// The edges of all tiles, for boxes.
class TileEdges {
public:
    void find(const Camera& camera) {
        const ImageAxis* axes[] = {&camera.x, &camera.y};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t capacity = static_cast<std::size_t>(axes[i]->tiles) + 8;  // vectors are read
            float *low = sides_[2 * i].reserve(capacity), *high = sides_[2 * i + 1].reserve(capacity);
            for (int tile = 0; tile < axes[i]->tiles; ++tile)
                tile_edges(*axes[i], tile, low[tile], high[tile]);
        }
    }
    void give(const float* (&edges)[4]) const {
        for (std::size_t i = 0; i < 4; ++i)
            edges[i] = sides_[i].data();
    }

private:
    Buffer<float> sides_[4];
};

}  // namespace detail

/// A light grid in memory of its own, kept from call to call.
template <class Id, Footprint footprint, DepthTest depth_test> class GridLists {
    static constexpr bool worded = detail::with_words<footprint, depth_test>,
                          with_boxes = depth_test == DepthTest::box || depth_test == DepthTest::split_box;

public:
    /// Builds the grid of the footprints with a kernel of an instruction set. Returns an Error if Z bounds
    /// are shorter than the grid, or 32-bit offsets can't reach the list's end; then there is no grid.
    ///
    /// footprints  Footprints or RankedFootprints, with spheres for a depth test
    /// parallel    Serial or Parallel
    /// spots       the lights are spots
    template <bool spots, class Lit, class Threads>
    detail::Maybe<Error> build(Isa isa, const View& view, const Lit& footprints, const ZBounds& bounds,
                               detail::Buffer<detail::Scratch>& scratch,
                               [[maybe_unused]] const Threads& parallel) {
        tile_count_ = entries_ = 0;  // until there is a grid
        const std::size_t tiles = view.tile_count();
        Job job = {};
        if (const auto error = prepare(view, footprints, bounds, job)) return error;
        const unsigned rows = static_cast<unsigned>(view.tiles_y());
        std::uint64_t capacity = footprints.area();
        // Where the rectangles' area is out of reach, what is left of it may still be within: counted exactly.
        if constexpr (worded)
            if (capacity > most)
                capacity = detail::scalar::count_entries<footprint, depth_test, false, spots>(
                    job, scratch.data()[0]);
        if (capacity > most) return Error{ErrorCode::too_many_entries, capacity, most};

        job.tiles = tiles_.reserve(tiles + job.spare_tiles);
        tile_count_ = tiles;
        const auto kernel = detail::bin_kernel<footprint, depth_test, Id, false, spots>(
            isa, view, footprints.visible(), footprints.area());
        Id* list = indices_.reserve(capacity + slack);
        shared_ = false;
        if constexpr (!std::is_same_v<Threads, Serial>) {
            const std::size_t parts = detail::min_of<std::size_t>(parallel.workers(), rows);
            const double lights = footprints.visible(), entries = static_cast<double>(capacity);
            shared_ = parts > 1 && footprints.area() <= most &&
                      parallel.pays_off(kernel == detail::scatter_kernel<Id>(isa)
                                            ? detail::scatter_ns(lights, entries)
                                            : detail::supertile_ns(isa, worded, lights, entries));
            if (shared_) {
                entries_ = build_parts(isa, job, kernel, list, scratch, parallel, parts);
                return {};
            }
        }
        entries_ = static_cast<std::size_t>(kernel(job, scratch.data()[0], {0, rows, list, 0}));
        return {};
    }

    /// Writes bitmasks of the footprints, `each` words a tile, see bits.inl. Errors as build() but for offsets. There is no
    /// grid then.
    template <bool spots, class Lit>
    detail::Maybe<Error> write_bits(Isa isa, const View& view, const Lit& footprints, const ZBounds& bounds,
                                    detail::Buffer<detail::Scratch>& scratch, const Parallel& parallel,
                                    std::uint32_t* bits, std::size_t each) {
        tile_count_ = entries_ = 0;
        Job job = {};
        if (const auto error = prepare(view, footprints, bounds, job)) return error;
        const auto kernel = detail::bits_kernel<footprint, depth_test, Id, spots>(isa);
        const std::size_t rows = static_cast<std::size_t>(view.tiles_y()), bands = (rows + 7) / 8;
        const bool share = parallel.pays_off(
            detail::supertile_ns(isa, true, footprints.visible(), static_cast<double>(footprints.area())));
        const std::size_t parts =
            share ? detail::max_of<std::size_t>(detail::min_of(parallel.workers(), bands), 1) : 1;
        scratch.reserve(parts, parts);
        parallel.run(parts, [&](std::size_t i) {
            const auto row = [&](std::size_t part) {
                return static_cast<unsigned>(detail::min_of(rows, part * bands / parts * 8));
            };
            kernel(job, scratch.data()[i], row(i), row(i + 1), bits, each);
        });
        return {};
    }

    template <class Range = ListRange> std::span<const Range> tiles() const {
        return {tiles_.data(), tile_count_};
    }
    std::span<const Id> indices() const { return {indices_.data(), entries_}; }

    /// Whether the last grid was built on several threads.
    bool shared() const { return shared_; }

private:
    using Job = detail::BinJob<Id>;
    static constexpr std::size_t slack = detail::BandJob<Id>::slack;
    static constexpr std::uint64_t most = (std::numeric_limits<std::uint32_t>::max)();

    /// Makes a job that has no table yet.
    template <class Lit>
    detail::Maybe<Error> prepare(const View& view, const Lit& footprints, const ZBounds& bounds, Job& job) {
        const std::size_t tiles = view.tile_count();
        job = {.camera = &detail::camera_of(view),
               .lights = footprints.arrays(),
               .runs = footprints.runs(),
               .visible = footprints.visible(),
               .bounds = {},
               .slab = {-detail::infinity, detail::infinity},
               .edges = {},
               .tiles = nullptr,
               .spare_tiles = Job::slack(static_cast<std::size_t>(view.tiles_x()))};
        const std::span<const float> sides[] = {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max};
        for (std::size_t side = 0; side < 4; ++side) {
            if (sides[side].empty()) continue;
            if (sides[side].size() < tiles)
                return Error{ErrorCode::z_bounds_too_small, tiles, sides[side].size()};
            job.bounds[side] = sides[side].data();
        }
        if constexpr (with_boxes) {
            edges_.find(*job.camera);
            edges_.give(job.edges);
        }
        if (footprints.area() > detail::surely_listed_area)
            if (const std::uint64_t places = detail::list_places(job); places > most)
                return Error{ErrorCode::too_many_list_places, places, most};
        return {};
    }

    /// Builds `count` parts on the caller's threads, see make_parts(). Returns the number of entries.
    std::size_t build_parts(Isa isa, const Job& job, detail::BinKernel<Id> kernel, Id* list,
                            detail::Buffer<detail::Scratch>& scratch, const Parallel& parallel,
                            std::size_t count) {
        scratch.reserve(count, count);
        detail::Part* parts = parts_.reserve(count);
        detail::make_parts(job, parallel, row_sums_, parts, count);
        if constexpr (!worded) {
            spares_.reserve(count, count);
            // Rectangles: a part's place in the list is known. Its last entries go there by way of spare memory,
            // as a kernel writes beyond its end, where the next part is at work.
            parallel.run(count, [&](std::size_t i) {
                const detail::Part& part = parts[i];
                Id* out = list + part.before;
                if (i + 1 == count ||
                    kernel == detail::scatter_kernel<Id>(isa)) {  // which writes nothing beyond
                    kernel(job, scratch.data()[i],
                           {part.begin, part.end, out, static_cast<std::uint32_t>(part.before)});
                    return;
                }
                Id* spare = spares_.data()[i].reserve(part.spare_area + slack);
                kernel(job, scratch.data()[i],
                       {part.begin, part.end, out, static_cast<std::uint32_t>(part.before), part.spare_row,
                        spare});
                detail::copy_items(spare, part.spare_area, out + part.area - part.spare_area);
            });
            return static_cast<std::size_t>(parts[count - 1].before + parts[count - 1].area);
        } else {
            return static_cast<std::size_t>(detail::build_apart(
                parallel, {parts, count}, job.tiles, static_cast<std::size_t>(job.camera->x.tiles), spares_,
                list, [&](std::size_t i, Id* out) {
                    return kernel(job, scratch.data()[i], {parts[i].begin, parts[i].end, out, 0});
                }));
        }
    }

    detail::Buffer<ListRange> tiles_;
    detail::Buffer<Id> indices_;
    detail::TileEdges edges_;
    detail::Buffer<detail::Part> parts_;
    detail::Buffer<detail::Buffer<Id>> spares_;  ///< one a part: what it can't put in its place at once
    detail::Buffer<std::uint64_t> row_sums_;
    std::size_t tile_count_ = 0, entries_ = 0;
    bool shared_ = false;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
