// SPDX-License-Identifier: MIT
// Stage 3: footprints (+ Z bounds), of all lights in view or by slice -> the light grid.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/detail/engine/costs.hpp>
#include <lightbin/detail/engine/scratch.hpp>
#include <lightbin/detail/engine/shares.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/tiers/kernels.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Light grids in memory of their own, kept from call to call: one of all lights in view or, `sliced`, one of each slice.
template <class Id, Footprint footprint, DepthTest depth_test, bool sliced> class GridLists {
    static_assert(
        !sliced || depth_test == DepthTest::none || depth_test == DepthTest::box,
        "lightbin: with slices the depth test is none, as lights are in the slices that they meet, or box");
    static constexpr bool worded = detail::with_words<footprint, depth_test>,
                          with_boxes = detail::with_boxes<depth_test>,
                          by_slab = sliced && with_boxes && footprint == Footprint::rectangle;

public:
    /// Builds the grids with kernels of an instruction set: the tiles of the first slice row by row, then those of the next
    /// one. Returns an Error if Z bounds are shorter than a grid, or 32-bit offsets can't reach the list's end; then there is
    /// no grid.
    ///
    /// spots     the lights are spots
    /// lit       Footprints or RankedFootprints, with spheres for a depth test; sliced: SlicedFootprints
    /// parallel  Serial or Parallel
    template <bool spots, class Lit, class Threads>
    detail::Maybe<Error> build(Isa isa, const View& view, const Lit& lit, const ZBounds& bounds,
                               detail::Buffer<detail::Scratch>& scratch,
                               [[maybe_unused]] const Threads& parallel) {
        tile_count_ = entries_ = 0;  // until there is a grid
        Job all = {};
        if (const auto error = prepare(view, bounds, all)) return error;
        const std::size_t tiles = view.tile_count(), slices = static_cast<std::size_t>(lit.slices());
        const unsigned rows = static_cast<unsigned>(view.tiles_y());
        std::uint64_t lights = 0, area = 0;
        for (std::size_t slice = 0; slice < slices; ++slice) {
            const detail::LitSlice part = lit.slice(slice);
            lights += part.visible;
            area += part.area;
            if (const auto error = check_places(view, part)) return error;
        }
        std::uint64_t capacity = area;
        // Where the rectangles' area is out of reach, what is left of it may still be within: counted exactly.
        if constexpr (worded)
            if (area > most) {
                capacity = 0;
                for (std::size_t slice = 0; slice < slices; ++slice)
                    capacity += detail::scalar::count_entries<footprint, depth_test, by_slab, spots>(
                        job_of(all, lit, slice), scratch.data()[0]);
            }
        if (capacity > most) return Error{ErrorCode::too_many_entries, capacity, most};

        all.tiles = tiles_.reserve(std::uint64_t{tiles} * slices);
        Id* const list = indices_.reserve(capacity + slack);
        tile_count_ = tiles * slices;
        const auto build_slices = [&](std::size_t begin, std::size_t end, Id* out, detail::Scratch& memory) {
            std::uint32_t at = 0;
            for (std::size_t slice = begin; slice < end; ++slice) {
                Job job = job_of(all, lit, slice);
                job.tiles += slice * tiles;
                const auto kernel = kernel_of<spots>(isa, view, job);
                at += static_cast<std::uint32_t>(kernel(job, memory, {0, rows, out + at, at}));
            }
            return std::uint64_t{at};
        };
        shared_ = false;
        if constexpr (!std::is_same_v<Threads, Serial>) {
            const std::size_t parts = detail::min_of<std::size_t>(parallel.workers(), sliced ? slices : rows);
            const bool scatters = !worded && detail::scatter_is_faster(isa, tile_count_, lights, area);
            const double count = static_cast<double>(lights), entries = static_cast<double>(area);
            shared_ = parts > 1 && area <= most &&
                      parallel.pays_off(scatters ? detail::scatter_ns(count, entries)
                                                 : detail::supertile_ns(isa, worded, count, entries));
            if (shared_) {
                scratch.reserve(parts, parts);
                const detail::Items<detail::Part> shares = {parts_.reserve(parts), parts};
                if constexpr (sliced) {
                    detail::share_steps(shares, slices, detail::empty_row_cost(tiles),
                                        [&](std::size_t slice) { return lit.slice(slice).area; });
                    entries_ = static_cast<std::size_t>(detail::build_apart(
                        parallel, shares, all.tiles, tiles, spares_, list, [&](std::size_t i, Id* out) {
                            return build_slices(shares[i].begin, shares[i].end, out, scratch.data()[i]);
                        }));
                } else {
                    const Job job = job_of(all, lit, 0);
                    const auto kernel = kernel_of<spots>(isa, view, job);
                    entries_ = static_cast<std::size_t>(
                        build_parts(isa, job, kernel, list, scratch, parallel, shares));
                }
                return {};
            }
        }
        entries_ = static_cast<std::size_t>(build_slices(0, slices, list, scratch.data()[0]));
        return {};
    }

    /// Writes bitmasks of the footprints, `each` words a tile, see bits.inl. Errors as build() but for offsets. There is no
    /// grid then.
    template <bool spots, class Lit>
    detail::Maybe<Error> write_bits(Isa isa, const View& view, const Lit& lit, const ZBounds& bounds,
                                    detail::Buffer<detail::Scratch>& scratch, const Parallel& parallel,
                                    std::uint32_t* bits, std::size_t each) {
        tile_count_ = entries_ = 0;
        Job all = {};
        if (const auto error = prepare(view, bounds, all)) return error;
        const Job job = job_of(all, lit, 0);
        if (const auto error = check_places(view, job)) return error;
        const auto kernel = detail::bits_kernel<footprint, depth_test, Id, spots>(isa);
        const std::size_t rows = static_cast<std::size_t>(view.tiles_y()), bands = (rows + 7) / 8;
        const bool share =
            parallel.pays_off(detail::supertile_ns(isa, true, job.visible, static_cast<double>(job.area)));
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

    /// Makes what the jobs of all slices share, but for the table.
    detail::Maybe<Error> prepare(const View& view, const ZBounds& bounds, Job& all) {
        const std::size_t tiles = view.tile_count();
        all.camera = &detail::camera_of(view);
        const std::span<const float> sides[] = {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max};
        for (std::size_t side = 0; side < 4; ++side) {
            if (sides[side].empty()) continue;
            if (sides[side].size() < tiles)
                return Error{ErrorCode::z_bounds_too_small, tiles, sides[side].size()};
            all.bounds[side] = sides[side].data();
        }
        if constexpr (with_boxes) find_edges(all);
        return {};
    }

    /// Finds the edges of all tiles, for boxes.
    void find_edges(Job& all) {
        const detail::ImageAxis* axes[] = {&all.camera->x, &all.camera->y};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t capacity = static_cast<std::size_t>(axes[i]->tiles) + 8;  // vectors are read
            float *low = edges_[2 * i].reserve(capacity), *high = edges_[2 * i + 1].reserve(capacity);
            for (int tile = 0; tile < axes[i]->tiles; ++tile)
                detail::tile_edges(*axes[i], tile, low[tile], high[tile]);
            all.edges[2 * i] = low;
            all.edges[2 * i + 1] = high;
        }
    }

    template <class Lit> static Job job_of(const Job& all, const Lit& lit, std::size_t slice) {
        Job job = all;
        static_cast<detail::LitSlice&>(job) = lit.slice(slice);
        return job;
    }

    static detail::Maybe<Error> check_places(const View& view, const detail::LitSlice& lit) {
        if (lit.area > detail::surely_listed_area)
            if (const std::uint64_t places = detail::list_places(detail::camera_of(view), lit); places > most)
                return Error{ErrorCode::too_many_list_places, places, most};
        return {};
    }

    template <bool spots> static detail::BinKernel<Id> kernel_of(Isa isa, const View& view, const Job& job) {
        return detail::bin_kernel<footprint, depth_test, Id, by_slab, spots>(isa, view, job.visible,
                                                                             job.area);
    }

    /// Builds parts of tile rows on the caller's threads. Returns the number of entries.
    std::uint64_t build_parts(Isa isa, const Job& job, detail::BinKernel<Id> kernel, Id* list,
                              detail::Buffer<detail::Scratch>& scratch, const Parallel& parallel,
                              detail::Items<detail::Part> parts) {
        detail::make_parts(job, parallel, row_sums_, parts);
        if constexpr (worded) {
            return detail::build_apart(
                parallel, parts, job.tiles, static_cast<std::size_t>(job.camera->x.tiles), spares_, list,
                [&](std::size_t i, Id* out) {
                    return kernel(job, scratch.data()[i], {parts[i].begin, parts[i].end, out, 0});
                });
        } else {
            spares_.reserve(parts.size(), parts.size());
            // Rectangles: a part's place in the list is known. Its last entries go there by way of spare memory,
            // as a kernel writes beyond its end, where the next part is at work.
            parallel.run(parts.size(), [&](std::size_t i) {
                const detail::Part& part = parts[i];
                Id* out = list + part.before;
                detail::BandJob<Id> rows = {part.begin, part.end, out,
                                            static_cast<std::uint32_t>(part.before)};
                // The last part has room for that, and scattering writes nothing beyond.
                const bool beyond = i + 1 < parts.size() && kernel != detail::scatter_kernel<Id>(isa);
                if (beyond) {
                    rows.spare_row = part.spare_row;
                    rows.spare = spares_.data()[i].reserve(part.spare_area + slack);
                }
                kernel(job, scratch.data()[i], rows);
                if (beyond)
                    detail::copy_items(rows.spare, part.spare_area, out + part.area - part.spare_area);
            });
            const detail::Part& last = parts[parts.size() - 1];
            return last.before + last.area;
        }
    }

    detail::Buffer<ListRange> tiles_;
    detail::Buffer<Id> indices_;
    detail::Buffer<float> edges_[4];
    detail::Buffer<detail::Part> parts_;
    detail::Buffer<detail::Buffer<Id>> spares_;  ///< one a part: what it can't put in its place at once
    detail::Buffer<std::uint64_t> row_sums_;
    std::size_t tile_count_ = 0, entries_ = 0;
    bool shared_ = false;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
