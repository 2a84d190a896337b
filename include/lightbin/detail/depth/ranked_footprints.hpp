// SPDX-License-Identifier: MIT
// The ranking stage, between projection and binning: from footprints and depth slices to the footprints in order of
// depth, and for each slice, which is a z-bin here, the range of their ranks (Drobot, "Improved Culling for Tiled and
// Clustered Rendering", SIGGRAPH 2017).
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/project/footprints.hpp>
#include <lightbin/detail/tiers/kernels.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>
#include <lightbin/result.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Footprints sorted by the first bin that their light meets, and in the caller's order within a bin. A footprint's
/// rank is its index in this order, and stands for the light's id. Memory is reused from call to call.
///
/// with_spheres  sort the lights, spheres or spots, too, for a depth test
template <Footprint footprint, bool with_spheres> class RankedFootprints {
    static constexpr bool with_spans = footprint == Footprint::silhouette;

public:
    /// Sorts the footprints, and finds the bins that each light's view depths meet, ends included: a sphere's are
    /// z - r to z + r, widened by the slices' margin. A light that ends close to a boundary may also count for the bin
    /// on the other side.
    ///
    /// spots  the lights are spots
    template <bool spots>
    detail::Maybe<Error> order(Isa isa, const View& view, const Footprints<footprint, true>& footprints,
                               const Slices& slices) {
        run_ = {0, footprints.visible()};
        area_ = footprints.area();
        bin_count_ = static_cast<std::size_t>(slices.count());
        reserve<spots>(footprints.arrays(), footprints.runs().end()[-1].end);
        find_bins<spots>(isa, view, footprints, slices);

        // A counting sort: ends_ has the number of lights that begin in each bin, then the rank of the first of them,
        // and at last the rank after the last of them.
        std::uint32_t before = 0;
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            const std::uint32_t begin = before;
            before += ends_.data()[bin];
            ends_.data()[bin] = begin;
        }
        // Only indices are scattered here. The arrays are then gathered by them, as scattered reads are faster than
        // writes.
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i)
                sources_.data()[ends_.data()[first_bins_.data()[i]]++] = i;
        gather_lights<spots>(footprints.arrays());
        find_ranges();
        return {};
    }

    /// Tiles have one list each for all depths.
    int slices() const { return 1; }
    detail::FootprintSlice slice(std::size_t) const { return {arrays_, {&run_, 1}, run_.end, area_}; }
    template <class Ranks = LightRanks> Ranks ranks() const {
        return {{order_.data(), run_.end}, {bins_.data(), bin_count_}};
    }

private:
    /// Finds the bins that each light meets, and counts in ends_ the lights that begin in each bin.
    template <bool spots>
    void find_bins(Isa isa, const View& view, const Footprints<footprint, true>& footprints, const Slices& slices) {
        std::uint32_t *const begins = ends_.data(), *const first_bins = first_bins_.data(),
                             *const last_bins = last_bins_.data();
        detail::fill_items(begins, bin_count_, 0);
        const auto found = [=](std::uint32_t i, std::uint32_t first, std::uint32_t last) {
            first_bins[i] = first;
            last_bins[i] = last;
            ++begins[first];
        };
        detail::table_of(slices).find(detail::depth_buckets_kernel<spots>(isa), true, detail::camera_of(view).z_sign,
                                      footprints.arrays(), footprints.runs(), found);
    }

    /// Writes the sorted footprints, one array after another, so that the memory that is read in random order is small.
    template <bool spots> void gather_lights(const detail::FootprintArrays& lights) {
        for (std::uint32_t rank = 0; rank < run_.end; ++rank) {
            order_.data()[rank] = lights.ids[sources_.data()[rank]];
            arrays_.ids[rank] = rank;
        }
        gather(lights.x0, arrays_.x0);
        gather(lights.y0, arrays_.y0);
        gather(lights.x1, arrays_.x1);
        gather(lights.y1, arrays_.y1);
        if constexpr (with_spans) gather(lights.span_begin, arrays_.span_begin);
        if constexpr (with_spheres && spots)
            for (std::uint32_t rank = 0; rank < run_.end; ++rank)
                spots_.data()[rank] = lights.spots[order_.data()[rank]];
        else if constexpr (with_spheres)
            for (std::uint32_t rank = 0; rank < run_.end; ++rank)
                spheres_.data()[rank] = detail::load_sphere(lights.spheres + order_.data()[rank]);
    }

    template <class T> void gather(const T* from, T* to) const {
        const std::uint32_t* const sources = sources_.data();
        for (std::uint32_t rank = 0; rank < run_.end; ++rank)
            to[rank] = from[sources[rank]];
    }

    /// Finds the range of ranks in each bin, from the least to the greatest rank of the lights that meet it.
    void find_ranges() {
        const std::uint32_t *const sources = sources_.data(), *const last_bins = last_bins_.data();
        // The least rank is that of the first light in the order that ends in the bin or a later one. Where that light
        // begins after the bin, no light meets the bin.
        BinRange *to = bins_.data(), *const end = to + bin_count_;
        for (std::uint32_t rank = 0; rank < run_.end && to < end; ++rank)
            for (const BinRange* last = bins_.data() + last_bins[sources[rank]]; to <= last; ++to)
                to->least = rank;
        detail::fill_items(to, static_cast<std::size_t>(end - to), {0xffffffff, 0});
        // The greatest rank is that of the last light that begins in the bin or an earlier one, or if it ends before
        // the bin that of the light before it, and so on. passed[rank] is how many lights before that one are known to
        // have ended: they are skipped, so that each is passed only once.
        std::uint32_t* const passed = first_bins_.data();
        detail::fill_items(passed, run_.end, 0);
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            BinRange& range = bins_.data()[bin];
            if (ends_.data()[bin] <= range.least) {
                range = {1, 0};  // empty
                continue;
            }
            const std::uint32_t begin = ends_.data()[bin] - 1;
            std::uint32_t rank = begin;
            while (last_bins_.data()[sources_.data()[rank]] < bin)
                rank -= 1 + passed[rank];
            if (rank < begin) passed[begin] = begin - rank - 1;
            range.greatest = rank;
        }
    }

    /// lights, size  the footprints before they are sorted, and where the last one ends in their arrays
    template <bool spots> void reserve(const detail::FootprintArrays& lights, std::uint32_t size) {
        arrays_ = buffers_.reserve(run_.end, with_spans);
        arrays_.spans = lights.spans;
        if constexpr (with_spheres && spots)
            arrays_.spots = spots_.reserve(run_.end);
        else if constexpr (with_spheres)
            arrays_.spheres = spheres_.reserve(run_.end);
        first_bins_.reserve(size);
        last_bins_.reserve(size);
        sources_.reserve(run_.end);
        order_.reserve(run_.end);
        ends_.reserve(bin_count_);
        bins_.reserve(bin_count_);
    }

    detail::Buffer<std::uint32_t> first_bins_,
        last_bins_;                          ///< the bins that a light meets, by its index before sorting
    detail::Buffer<std::uint32_t> sources_;  ///< by rank, the index before sorting
    detail::Buffer<std::uint32_t> order_;    ///< by rank, the light's id
    detail::Buffer<std::uint32_t> ends_;     ///< by bin, the first rank that begins in a later bin
    detail::Buffer<BinRange> bins_;
    detail::FootprintBuffers buffers_;
    detail::Buffer<Sphere> spheres_;
    detail::Buffer<detail::ViewSpot> spots_;
    detail::FootprintArrays arrays_ = {};
    detail::FootprintRun run_ = {};
    std::uint64_t area_ = 0;
    std::size_t bin_count_ = 0;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
