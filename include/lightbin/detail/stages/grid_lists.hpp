// SPDX-License-Identifier: MIT
// The binning stage: makes the light grid out of footprints and Z bounds, by the method that is fastest.
#pragma once

#include <lightbin/detail/stages/drawn_cells.hpp>
#include <lightbin/detail/stages/shares.hpp>
#include <lightbin/options.hpp>
#include <lightbin/z_bounds.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns the fastest binning kernel for lights whose rectangles have `area` tiles in all. Kernels without a depth
/// test read footprints only, so all kinds of lights use the kernels of spheres.
template <class Id, Tested tested, LightKind kind>
BinKernel<Id> bin_kernel(Isa isa, const View& view, std::uint64_t area) {
    if constexpr (tested == Tested::nothing)
        if (scatter_is_faster(isa, view.tile_count(), area)) return scatter_lights<Id>;
    return with_tier(isa, [](auto tier) { return tier.template bin_kernel<Id, tested, kind>(); });
}

/// Returns the binning kernel for one slice: the fastest for lights whose rectangles have `area` tiles in all.
template <class Id> using ChooseKernel = BinKernel<Id> (*)(Isa isa, const View& view, std::uint64_t area);

/// Returns what chooses kernels for lights of the kind `kind`. With clusters and a depth test, spheres and spots are
/// tested against boxes of equal depths, see SlabCells: a build takes 1.2 to 2 times as long with boxes that differ in
/// depth.
template <class Id, bool depth_test, bool clusters, LightKind kind> constexpr ChooseKernel<Id> choose_kernel() {
    if constexpr (depth_test)
        return bin_kernel<Id, clusters && kind != LightKind::box ? Tested::slab : Tested::cells, kind>;
    else
        return bin_kernel<Id, Tested::nothing, LightKind::sphere>;
}

/// A light grid, or with clusters one per depth slice, stored one after another. Its memory is kept from call to call.
///
/// How  see Stages
template <class Id, class How> class TileLists {
public:
    /// Builds the grid. Tiles are in row-major order, slice after slice. Returns an error, and has no grid, if Z bounds
    /// have too few elements, or 32 bits can't count the tiles of all rectangles, each of which may be an entry.
    ///
    /// all       the footprints, if there are no clusters; with a depth test, ones that keep the lights in view space
    /// sliced    with clusters SlicedFootprints, else not read
    /// parallel  Serial or Parallel
    template <class Sliced, class Threads>
    std::optional<Error> build(const How& how, Isa isa, const View& view, const FootprintSlice& all,
                               [[maybe_unused]] const Sliced& sliced, const ZBounds& bounds, ChooseKernel<Id> choose,
                               Buffer<Scratch>& scratch, [[maybe_unused]] const Threads& parallel) {
        tile_count_ = entries_ = 0;  // there is no grid until the end of this function
        BinJob common = {};
        if (const auto error = prepare(how, view, bounds, common)) return error;
        const bool clusters = how.is.slicing == Slicing::clusters;
        std::size_t slices = 1;
        const bool bounded = common.bounds[0] != nullptr || common.bounds[1] != nullptr;
        if constexpr (How::may(&Options::slicing, Slicing::clusters))
            if (clusters) {
                slices = sliced.slices();
                if (bounded) drawn_.find(view, sliced.table(), bounds);
                common.bounds[0] = common.bounds[1] = nullptr;  // boxes around cells lie between the slice's depths
            }
        const auto job_of = [&]([[maybe_unused]] std::size_t slice) {
            BinJob job = common;
            FootprintSlice& footprints = job;
            footprints = all;
            if constexpr (How::may(&Options::slicing, Slicing::clusters)) {
                if (clusters) footprints = sliced.slice(slice);
                if (clusters && bounded) job.drawn = drawn_.slice(slice).data();
            }
            return job;
        };
        const std::size_t tiles = view.tile_count();
        const unsigned rows = static_cast<unsigned>(view.tiles_y());
        std::uint64_t area = 0;
        for (std::size_t slice = 0; slice < slices; ++slice)
            area += job_of(slice).area;
        if (area > max_entries) return Error{ErrorCode::too_many_entries, area, max_entries};

        common.tiles = tiles_.reserve(std::uint64_t{tiles} * slices);
        Id* const list = indices_.reserve(area + widest_vector);
        tile_count_ = tiles * slices;
        const auto build_slices = [&](std::size_t begin, std::size_t end, Id* out, Scratch& memory) {
            std::uint32_t offset = 0;
            for (std::size_t slice = begin; slice < end; ++slice) {
                BinJob job = job_of(slice);
                job.tiles += slice * tiles;
                if constexpr (How::may(&Options::slicing, Slicing::clusters))
                    if (job.drawn != nullptr && drawn_.is_empty(slice)) {
                        fill_empty(job.tiles, tiles, offset);
                        continue;
                    }
                // Scattering would take sums over all tiles.
                const auto kernel = choose(isa, view, job.drawn != nullptr ? ~std::uint64_t{0} : job.area);
                offset += static_cast<std::uint32_t>(kernel(job, memory, {0, rows, out + offset, offset}));
            }
            return std::uint64_t{offset};
        };
        if constexpr (!std::is_same_v<Threads, Serial>) {
            const std::size_t steps = clusters ? slices : rows,
                              count = min_of<std::size_t>(parallel.workers(), steps);
            if (count > 1) {
                scratch.reserve(count, count);
                const std::span<Share> shares(shares_.reserve(count), count);
                const BinJob job = job_of(0);
                const auto kernel = choose(isa, view, job.area);
                if (clusters)
                    share_steps(shares, slices, tiles, [&](std::size_t slice) { return job_of(slice).area; });
                else
                    share_rows(job, parallel, row_sums_, shares);
                entries_ = static_cast<std::size_t>(
                    build_shares(parallel, shares, common.tiles, tiles / (clusters ? 1 : rows), share_lists_, list,
                                 [&](const Share& share, std::size_t i, Id* out) {
                                     Scratch& memory = scratch.data()[i];
                                     return clusters ? build_slices(share.begin, share.end, out, memory)
                                                     : kernel(job, memory, {share.begin, share.end, out, 0});
                                 }));
                return {};
            }
        }
        entries_ = static_cast<std::size_t>(build_slices(0, slices, list, scratch.data()[0]));
        return {};
    }

    std::span<const ListRange> tiles() const { return {tiles_.data(), tile_count_}; }
    std::span<const Id> indices() const { return {indices_.data(), entries_}; }

private:
    static constexpr std::uint64_t max_entries = (std::numeric_limits<std::uint32_t>::max)();

    /// Sets the camera, the Z bounds and the tiles' edges, which the jobs of all slices have in common.
    std::optional<Error> prepare([[maybe_unused]] const How& how, const View& view, const ZBounds& bounds,
                                 BinJob& common) {
        const std::size_t tiles = view.tile_count();
        common.camera = &camera_of(view);
        const std::span<const float> sides[] = {bounds.min, bounds.max};
        for (std::size_t side = 0; side < 2; ++side) {
            if (sides[side].empty()) continue;
            if (sides[side].size() < tiles) return Error{ErrorCode::z_bounds_too_small, tiles, sides[side].size()};
            common.bounds[side] = sides[side].data();
        }
        if constexpr (How::may(&Options::depth_test))
            if (how.is.depth_test) find_edges(common);
        return {};
    }

    /// Finds the edges of all columns and rows of tiles, from which the depth test makes boxes around cells. Zeros
    /// follow the edges, as whole vectors are read.
    void find_edges(BinJob& common) {
        const ImageAxis* axes[] = {&common.camera->x, &common.camera->y};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t count = static_cast<std::size_t>(axes[i]->tiles), capacity = count + widest_vector;
            float *low = edges_[2 * i].reserve(capacity), *high = edges_[2 * i + 1].reserve(capacity);
            for (int tile = 0; tile < axes[i]->tiles; ++tile)
                tile_edges(*axes[i], tile, low[tile], high[tile]);
            fill_items(low + count, widest_lanes, 0.0f);
            fill_items(high + count, widest_lanes, 0.0f);
            common.edges[2 * i] = low;
            common.edges[2 * i + 1] = high;
        }
    }

    Buffer<ListRange> tiles_;
    Buffer<Id> indices_;
    Buffer<float> edges_[4];
    DrawnCells drawn_;  ///< the cells that list lights, if clusters are given Z bounds
    Buffer<Share> shares_;
    Buffer<Buffer<Id>> share_lists_;
    Buffer<std::uint64_t> row_sums_;
    std::size_t tile_count_ = 0, entries_ = 0;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
