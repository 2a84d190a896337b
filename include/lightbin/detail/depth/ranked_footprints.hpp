// SPDX-License-Identifier: MIT
// Stage 2d: footprints + slices -> the footprints in order of depth, and the z-bins (Drobot, "Improved Culling for Tiled
// and Clustered Rendering", SIGGRAPH 2017).
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

/// Footprints in the order of the bins in which their lights begin, in a bin in the caller's order; their ids are the ranks
/// in it. Keeps its memory from call to call.
///
/// with_spheres  have the spheres or spots at hand, for a depth test
template <Footprint footprint, bool with_spheres> class RankedFootprints {
    static constexpr bool with_spans = footprint == Footprint::silhouette;

public:
    /// Takes each light to the bins that its depths, z - r to z + r and the margin, meet, ends included; also to the one before or
    /// behind them where they end close to the boundary.
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

        // Sorted by counting: how many lights begin in a bin, where those begin, and then where they end.
        std::uint32_t before = 0;
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            const std::uint32_t begin = before;
            before += ends_.data()[bin];
            ends_.data()[bin] = begin;
        }
        // Only this is written here and there: what is read so is sooner at hand than what is written.
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i)
                places_.data()[ends_.data()[first_bins_.data()[i]]++] = i;
        put_lights<spots>(footprints.arrays());
        find_ranges();
        return {};
    }

    /// All depths are one slice of tiles.
    int slices() const { return 1; }
    detail::FootprintSlice slice(std::size_t) const { return {arrays_, {&run_, 1}, run_.end, area_}; }
    template <class Ranks = LightRanks> Ranks ranks() const {
        return {{order_.data(), run_.end}, {bins_.data(), bin_count_}};
    }

private:
    /// Finds the bins that each light meets, and counts in `ends_` those that begin in each.
    template <bool spots>
    void find_bins(Isa isa, const View& view, const Footprints<footprint, true>& footprints,
                   const Slices& slices) {
        std::uint32_t *const begins = ends_.data(), *const first_bins = first_bins_.data(),
                             *const last_bins = last_bins_.data();
        detail::fill_items(begins, bin_count_, 0);
        const auto found = [=](std::uint32_t i, std::uint32_t first, std::uint32_t last) {
            first_bins[i] = first;
            last_bins[i] = last;
            ++begins[first];
        };
        detail::table_of(slices).find(detail::depth_buckets_kernel<spots>(isa), true,
                                      detail::camera_of(view).z_sign, footprints.arrays(), footprints.runs(),
                                      found);
    }

    /// Writes the lights in their order, an array at a time: what is read here and there is then one that is small.
    template <bool spots> void put_lights(const detail::FootprintArrays& lights) {
        for (std::uint32_t rank = 0; rank < run_.end; ++rank) {
            order_.data()[rank] = lights.ids[places_.data()[rank]];
            arrays_.ids[rank] = rank;
        }
        put(lights.x0, arrays_.x0);
        put(lights.y0, arrays_.y0);
        put(lights.x1, arrays_.x1);
        put(lights.y1, arrays_.y1);
        if constexpr (with_spans) put(lights.span_begin, arrays_.span_begin);
        if constexpr (with_spheres && spots)
            for (std::uint32_t rank = 0; rank < run_.end; ++rank)
                spots_.data()[rank] = lights.spots[order_.data()[rank]];
        else if constexpr (with_spheres)
            for (std::uint32_t rank = 0; rank < run_.end; ++rank)
                spheres_.data()[rank] = detail::load_sphere(lights.spheres + order_.data()[rank]);
    }

    template <class T> void put(const T* from, T* to) const {
        const std::uint32_t* const places = places_.data();
        for (std::uint32_t rank = 0; rank < run_.end; ++rank)
            to[rank] = from[places[rank]];
    }

    /// Finds the least and the greatest rank in each bin.
    void find_ranges() {
        const std::uint32_t *const places = places_.data(), *const last_bins = last_bins_.data();
        // The least is of the first one that ends in the bin or behind it: it begins in the bin, before it, or none of them
        // does.
        BinRange *to = bins_.data(), *const end = to + bin_count_;
        for (std::uint32_t rank = 0; rank < run_.end && to < end; ++rank)
            for (const BinRange* last = bins_.data() + last_bins[places[rank]]; to <= last; ++to)
                to->least = rank;
        detail::fill_items(to, static_cast<std::size_t>(end - to), {0xffffffff, 0});
        // The last one that begins in a bin or before it, or the one before that where it has ended, and so on; what has
        // ended is passed by once.
        std::uint32_t* const passed = first_bins_.data();
        detail::fill_items(passed, run_.end, 0);
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            BinRange& range = bins_.data()[bin];
            if (ends_.data()[bin] <= range.least) {
                range = {1, 0};
                continue;
            }
            const std::uint32_t begin = ends_.data()[bin] - 1;
            std::uint32_t rank = begin;
            while (last_bins_.data()[places_.data()[rank]] < bin)
                rank -= 1 + passed[rank];
            if (rank < begin) passed[begin] = begin - rank - 1;
            range.greatest = rank;
        }
    }

    /// places  of the lights in their arrays
    template <bool spots> void reserve(const detail::FootprintArrays& lights, std::uint32_t places) {
        arrays_ = buffers_.reserve(run_.end, with_spans);
        arrays_.spans = lights.spans;
        if constexpr (with_spheres && spots)
            arrays_.spots = spots_.reserve(run_.end);
        else if constexpr (with_spheres)
            arrays_.spheres = spheres_.reserve(run_.end);
        first_bins_.reserve(places);
        last_bins_.reserve(places);
        places_.reserve(run_.end);
        order_.reserve(run_.end);
        ends_.reserve(bin_count_);
        bins_.reserve(bin_count_);
    }

    detail::Buffer<std::uint32_t> first_bins_, last_bins_;   ///< of the lights in their old places
    detail::Buffer<std::uint32_t> places_, order_;           ///< of each rank: its light's old place, its id
    detail::Buffer<std::uint32_t> ends_;                     ///< of each bin: the first rank that begins behind it
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
