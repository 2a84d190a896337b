// SPDX-License-Identifier: MIT
// The binning stage: makes the light grid out of footprints and Z bounds.
#pragma once

#include <lightbin/detail/engine/shares.hpp>
#include <lightbin/z_bounds.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Whether spheres are tested by SlabCells, for a slice's boxes of equal depths. This is faster than the test for
/// boxes that differ in depth: a build of clusters without it takes 1.2 to 2 times as long.
template <bool depth_test, LightKind kind, bool sliced>
inline constexpr bool by_slab = sliced && depth_test && kind != LightKind::box;

/// The features that a TileLists needs, as constants. The implementation of lightbin.h passes a struct in place of this
/// whose `tested` and `sliced` are set at run time.
template <bool any_test, bool any_slice> struct FixedLists {
    static constexpr bool may_test = any_test, may_slice = any_slice;
    /// Whether a depth test decides in which tiles of its rectangle a light is listed, and whether there is a grid for
    /// each depth slice.
    static constexpr bool tested = any_test, sliced = any_slice;
};

/// A light grid, or if How::sliced one per depth slice, stored one after another. Its memory is kept from call to call.
/// The binning kernels are arguments of its functions.
///
/// How  a FixedLists, or a struct with the same members
template <class Id, class How> class TileLists {
public:
    using Job = BinJob<>;

    /// Builds the grid. Tiles are in row-major order, slice after slice. Returns an error, and has no grid, if Z bounds
    /// have too few elements, or 32 bits can't count the entries.
    ///
    /// footprints     SlicedFootprints if how.sliced, else Footprints or RankedFootprints; with a depth test, ones that
    ///                keep the lights in view space
    /// parallel       Serial or Parallel
    /// choose_kernel  choose_kernel(isa, view, job) returns the kernel, a BinKernel, for one slice
    /// count_entries  count_entries(job, scratch) returns how many entries the lists of one slice have; called if
    ///                how.tested
    template <class AnyFootprints, class Threads, class ChooseKernel, class CountEntries>
    LIGHTBIN_ONCE std::optional<Error> build(Isa isa, const View& view, const AnyFootprints& footprints,
                                             const ZBounds& bounds, Buffer<Scratch>& scratch,
                                             [[maybe_unused]] const Threads& parallel, const How& how,
                                             const ChooseKernel& choose_kernel,
                                             [[maybe_unused]] const CountEntries& count_entries) {
        tile_count_ = entries_ = 0;  // until there is a grid
        Job common = {};
        if (const auto error = prepare(view, bounds, how, common)) return error;
        const std::size_t tiles = view.tile_count(), slices = static_cast<std::size_t>(footprints.slices());
        const unsigned rows = static_cast<unsigned>(view.tiles_y());
        std::uint64_t area = 0;
        for (std::size_t slice = 0; slice < slices; ++slice) {
            const FootprintSlice part = footprints.slice(slice);
            area += part.area;
            if (const auto error = check_list_size(view, part)) return error;
        }
        std::uint64_t capacity = area;
        // Tests leave fewer entries than rectangles have tiles: if 32 bits can't count the tiles, count the entries.
        if constexpr (How::may_test)
            if (how.tested && area > max_entries) {
                capacity = 0;
                for (std::size_t slice = 0; slice < slices; ++slice)
                    capacity += count_entries(job_of(common, footprints, slice), scratch.data()[0]);
            }
        if (capacity > max_entries) return Error{ErrorCode::too_many_entries, capacity, max_entries};

        common.tiles = tiles_.reserve(std::uint64_t{tiles} * slices);
        Id* const list = indices_.reserve(capacity + BinShare<Id>::slack);
        tile_count_ = tiles * slices;
        const auto build_slices = [&](std::size_t begin, std::size_t end, Id* out, Scratch& memory) {
            std::uint32_t offset = 0;
            for (std::size_t slice = begin; slice < end; ++slice) {
                Job job = job_of(common, footprints, slice);
                job.tiles += slice * tiles;
                const auto kernel = choose_kernel(isa, view, job);
                offset += static_cast<std::uint32_t>(kernel(job, memory, {0, rows, out + offset, offset}));
            }
            return std::uint64_t{offset};
        };
        if constexpr (!std::is_same_v<Threads, Serial>) {
            const std::size_t steps = how.sliced ? slices : rows,
                              count = min_of<std::size_t>(parallel.workers(), steps);
            if (count > 1 && area <= max_entries) {
                scratch.reserve(count, count);
                const std::span<Share> shares(shares_.reserve(count), count);
                if constexpr (How::may_slice)
                    if (how.sliced) {
                        share_steps(shares, slices, empty_row_cost(tiles),
                                    [&](std::size_t slice) { return footprints.slice(slice).area; });
                        entries_ = static_cast<std::size_t>(build_shares(
                            parallel, shares, common.tiles, tiles, share_lists_, list,
                            [&](const Share& share, std::size_t i, Id* out) {
                                return build_slices(share.begin, share.end, out, scratch.data()[i]);
                            }));
                        return {};
                    }
                const Job job = job_of(common, footprints, 0);
                const auto kernel = choose_kernel(isa, view, job);
                share_rows(job, parallel, row_sums_, shares);
                entries_ = static_cast<std::size_t>(
                    build_shares(parallel, shares, common.tiles, tiles / rows, share_lists_, list,
                                 [&](const Share& share, std::size_t i, Id* out) {
                                     return kernel(job, scratch.data()[i], {share.begin, share.end, out, 0});
                                 }));
                return {};
            }
        }
        entries_ = static_cast<std::size_t>(build_slices(0, slices, list, scratch.data()[0]));
        return {};
    }

    template <class Range = ListRange> std::span<const Range> tiles() const { return {tiles_.data(), tile_count_}; }
    std::span<const Id> indices() const { return {indices_.data(), entries_}; }

private:
    static constexpr std::uint64_t max_entries = (std::numeric_limits<std::uint32_t>::max)();

    /// Sets the camera, the Z bounds and the tiles' edges, which the jobs of all slices have in common.
    std::optional<Error> prepare(const View& view, const ZBounds& bounds, [[maybe_unused]] const How& how,
                                 Job& common) {
        const std::size_t tiles = view.tile_count();
        common.camera = &camera_of(view);
        const std::span<const float> sides[] = {bounds.min, bounds.max};
        for (std::size_t side = 0; side < 2; ++side) {
            if (sides[side].empty()) continue;
            if (sides[side].size() < tiles) return Error{ErrorCode::z_bounds_too_small, tiles, sides[side].size()};
            common.bounds[side] = sides[side].data();
        }
        if constexpr (How::may_test)
            if (how.tested) find_edges(common);
        return {};
    }

    /// Finds the edges of all columns and rows of tiles, from which the depth test makes boxes around cells. Zeros
    /// follow the edges, as whole vectors are read.
    void find_edges(Job& common) {
        const ImageAxis* axes[] = {&common.camera->x, &common.camera->y};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t count = static_cast<std::size_t>(axes[i]->tiles), capacity = count + SlabBoxes::padding;
            float *low = edges_[2 * i].reserve(capacity), *high = edges_[2 * i + 1].reserve(capacity);
            for (int tile = 0; tile < axes[i]->tiles; ++tile)
                tile_edges(*axes[i], tile, low[tile], high[tile]);
            fill_items(low + count, SlabBoxes::padding, 0.0f);
            fill_items(high + count, SlabBoxes::padding, 0.0f);
            common.edges[2 * i] = low;
            common.edges[2 * i + 1] = high;
        }
    }

    template <class AnyFootprints>
    static Job job_of(const Job& common, const AnyFootprints& footprints, std::size_t slice) {
        Job job = common;
        static_cast<FootprintSlice&>(job) = footprints.slice(slice);
        return job;
    }

    static std::optional<Error> check_list_size(const View& view, const FootprintSlice& slice) {
        if (slice.area > surely_listed_area)
            if (const std::uint64_t size = list_size_bound(camera_of(view), slice); size > max_entries)
                return Error{ErrorCode::too_many_list_places, size, max_entries};
        return {};
    }

    Buffer<ListRange> tiles_;
    Buffer<Id> indices_;
    Buffer<float> edges_[4];
    Buffer<Share> shares_;
    Buffer<Buffer<Id>> share_lists_;
    Buffer<std::uint64_t> row_sums_;
    std::size_t tile_count_ = 0, entries_ = 0;
};

/// The TileLists for a depth test that is known when it is compiled, with its kernels.
template <class Id, bool depth_test, bool sliced> class GridLists {
    using How = FixedLists<depth_test, sliced>;

public:
    template <LightKind kind, class AnyFootprints, class Threads>
    std::optional<Error> build(Isa isa, const View& view, const AnyFootprints& footprints, const ZBounds& bounds,
                               Buffer<Scratch>& scratch, const Threads& parallel) {
        constexpr bool slab = by_slab<depth_test, kind, sliced>;
        return lists_.build(
            isa, view, footprints, bounds, scratch, parallel, How(),
            [](Isa set, const View& of, const BinJob<>& job) {
                return bin_kernel<depth_test, Id, slab, kind>(set, of, job.area);
            },
            [](const auto& job, Scratch& memory) {  // `auto`, so that it is not compiled where nothing is tested
                return least::count_entries<depth_test, slab, kind>(job, memory);
            });
    }

    template <class Range = ListRange> std::span<const Range> tiles() const { return lists_.tiles(); }
    std::span<const Id> indices() const { return lists_.indices(); }

private:
    TileLists<Id, How> lists_;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
