// SPDX-License-Identifier: MIT
// Stage 2d: footprints + slices -> the footprints in order of depth, and the z-bins (Drobot, "Improved Culling for Tiled
// and Clustered Rendering", SIGGRAPH 2017).
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/slice_table.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/options.hpp>
#include <lightbin/project.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Footprints in the order of the bins in which their lights begin, in a bin in the caller's order; their ids are the ranks
/// in it. Keeps its memory from call to call.
///
/// with_spheres  have the spheres at hand, for a depth test
template <Footprint footprint, bool with_spheres> class RankedFootprints {
    static constexpr bool with_spans = footprint == Footprint::silhouette;

public:
    /// Takes each light to the bins that its depths, z - r to z + r, meet, their ends included.
    void rank(const View& view, const Footprints<footprint, true>& footprints, const Slices& slices) {
        const detail::FootprintArrays& lights = footprints.arrays();
        run_ = {0, footprints.visible()};
        area_ = footprints.area();
        bin_count_ = static_cast<std::size_t>(slices.count());
        reserve(lights);
        table_.set(slices.boundaries());
        find_bins(view, footprints);

        // Sorted by counting: how many lights begin in a bin, where those begin, and then where they end.
        std::uint32_t before = 0;
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            const std::uint32_t begin = before;
            before += ends_.data()[bin];
            ends_.data()[bin] = begin;
        }
        const Met* met = met_.data();
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i, ++met) {
                const std::uint32_t rank = ends_.data()[met->first]++;
                last_bins_.data()[rank] = met->last;
                put(lights, i, rank);
            }
        find_ranges();
    }

    std::uint32_t visible() const { return run_.end; }
    std::uint64_t area() const { return area_; }  ///< sum of the rectangles' tiles
    const detail::FootprintArrays& arrays() const { return arrays_; }
    std::span<const detail::FootprintRun> runs() const { return {&run_, 1}; }
    LightRanks ranks() const { return {{order_.data(), run_.end}, {bins_.data(), bin_count_}}; }

private:
    /// Bins first..last.
    struct Met {
        std::uint32_t first, last;
    };

    /// Finds the bins that each light meets, and counts in `ends_` those that begin in each.
    void find_bins(const View& view, const Footprints<footprint, true>& footprints) {
        const detail::FootprintArrays& lights = footprints.arrays();
        const float z_sign = detail::camera_of(view).z_sign;
        std::fill_n(ends_.data(), bin_count_, 0u);
        Met* met = met_.data();
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i, ++met) {
                const Sphere sphere = detail::load_sphere(lights.spheres + lights.ids[i]);
                const float z = sphere.z * z_sign;
                *met = {table_.before(z - sphere.radius), table_.up_to(z + sphere.radius)};
                ++ends_.data()[met->first];
            }
    }

    /// Finds the least and the greatest rank in each bin.
    void find_ranges() {
        std::fill_n(bins_.data(), bin_count_, BinRange{0xffffffff, 0});
        for (std::uint32_t rank = run_.end; rank-- > 0;)
            bins_.data()[last_bins_.data()[rank]].least = rank;
        // Of the lights that end in a bin or behind it, the one of least rank begins first: in the bin, before it, or none
        // of them does.
        for (std::size_t bin = bin_count_ - 1; bin-- > 0;)
            bins_.data()[bin].least = (std::min)(bins_.data()[bin].least, bins_.data()[bin + 1].least);

        // The lights that have begun and may not have ended, the last one on top; it stays until a bin finds it ended.
        std::uint32_t* const open = open_.data();
        std::uint32_t count = 0, rank = 0;
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            while (rank < ends_.data()[bin])
                open[count++] = rank++;
            while (count > 0 && last_bins_.data()[open[count - 1]] < bin)
                --count;
            bins_.data()[bin] = count > 0 ? BinRange{bins_.data()[bin].least, open[count - 1]} : BinRange{1, 0};
        }
    }

    void put(const detail::FootprintArrays& lights, std::uint32_t i, std::uint32_t rank) {
        const std::uint32_t id = lights.ids[i];
        order_.data()[rank] = id;
        arrays_.ids[rank] = rank;
        arrays_.x0[rank] = lights.x0[i];
        arrays_.y0[rank] = lights.y0[i];
        arrays_.x1[rank] = lights.x1[i];
        arrays_.y1[rank] = lights.y1[i];
        if constexpr (with_spans) arrays_.span_begin[rank] = lights.span_begin[i];
        if constexpr (with_spheres) spheres_.data()[rank] = detail::load_sphere(lights.spheres + id);
    }

    void reserve(const detail::FootprintArrays& lights) {
        const std::uint64_t capacity = std::uint64_t{run_.end} + detail::FootprintArrays::padding;
        arrays_ = {.ids = ids_.reserve(capacity),
                   .x0 = x0_.reserve(capacity),
                   .y0 = y0_.reserve(capacity),
                   .x1 = x1_.reserve(capacity),
                   .y1 = y1_.reserve(capacity),
                   .span_begin = with_spans ? span_begin_.reserve(capacity) : nullptr,
                   .spans = lights.spans,
                   .spheres = with_spheres ? spheres_.reserve(capacity) : nullptr};
        order_.reserve(run_.end);
        met_.reserve(run_.end);
        last_bins_.reserve(run_.end);
        open_.reserve(run_.end);
        ends_.reserve(bin_count_);
        bins_.reserve(bin_count_);
    }

    detail::SliceTable table_;
    detail::Buffer<Met> met_;
    detail::Buffer<std::uint32_t> ends_, order_, last_bins_, open_;
    detail::Buffer<BinRange> bins_;
    detail::Buffer<std::uint32_t> ids_, span_begin_;
    detail::Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
    detail::Buffer<Sphere> spheres_;
    detail::FootprintArrays arrays_ = {};
    detail::FootprintRun run_ = {};
    std::uint64_t area_ = 0;
    std::size_t bin_count_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
