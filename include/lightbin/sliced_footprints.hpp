// SPDX-License-Identifier: MIT
// Stage 2c: footprints + slices -> the footprints in each slice.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/slice_table.hpp>
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

namespace detail {

/// The footprints in a slice, a part of the footprint arrays, and the sum of their rectangles' tiles.
struct SliceRun {
    FootprintRun run;
    std::uint64_t area;
};

}  // namespace detail

/// Footprints by slice, in ascending order of id in each. Keeps its memory from call to call.
template <Footprint footprint> class SlicedFootprints {
    static constexpr bool with_spans = footprint == Footprint::silhouette;

public:
    /// Takes each light to the slices that its depths, z - r to z + r, meet, their ends included. Returns the number of
    /// pairs of a light and a slice; if 32 bits don't count them, there are no runs.
    std::uint64_t cut(const View& view, const Footprints<footprint, true>& footprints, const Slices& slices) {
        const detail::FootprintArrays& lights = footprints.arrays();
        run_count_ = static_cast<std::size_t>(slices.count());
        detail::SliceRun* const runs = runs_.reserve(run_count_ + 1);
        std::fill_n(runs, run_count_ + 1, detail::SliceRun{});
        Met* const met = met_.reserve(footprints.visible());
        table_.set(slices.boundaries());
        const float z_sign = detail::camera_of(view).z_sign;

        // First the steps of the lights' and tiles' numbers from slice to slice.
        std::uint64_t pairs = 0;
        std::uint32_t light = 0;
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i) {
                // Rounding is monotone and boundaries are floats, so rounded depths are on the same side of them, or on one.
                const Sphere sphere = detail::load_sphere(lights.spheres + lights.ids[i]);
                const float z = sphere.z * z_sign;
                const Met here = {table_.before(z - sphere.radius), table_.up_to(z + sphere.radius)};
                const std::uint64_t area =
                    (lights.x1[i] - lights.x0[i] + std::uint64_t{1}) * (lights.y1[i] - lights.y0[i] + 1u);
                met[light++] = here;
                pairs += here.last - here.first + std::uint64_t{1};
                ++runs[here.first].run.end;
                --runs[here.last + 1].run.end;  // sums wrap, and come out right
                runs[here.first].area += area;
                runs[here.last + 1].area -= area;
            }
        if (pairs > 0xffffffff) {
            run_count_ = 0;
            return pairs;
        }
        std::uint32_t place = 0, count = 0;
        std::uint64_t area = 0;
        for (detail::SliceRun* run = runs; run < runs + run_count_; ++run) {
            count += run->run.end;
            area += run->area;
            *run = {{place, place}, area};
            place += count;
        }
        reserve(lights, pairs);
        light = 0;
        for (const detail::FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i, ++light)
                for (std::uint32_t slice = met[light].first; slice <= met[light].last; ++slice) {
                    const std::uint32_t to = runs[slice].run.end++;
                    arrays_.ids[to] = lights.ids[i];
                    arrays_.x0[to] = lights.x0[i];
                    arrays_.y0[to] = lights.y0[i];
                    arrays_.x1[to] = lights.x1[i];
                    arrays_.y1[to] = lights.y1[i];
                    if constexpr (with_spans) arrays_.span_begin[to] = lights.span_begin[i];
                }
        return pairs;
    }

    const detail::FootprintArrays& arrays() const { return arrays_; }
    std::span<const detail::SliceRun> runs() const { return {runs_.data(), run_count_}; }

private:
    /// Slices first..last.
    struct Met {
        std::uint32_t first, last;
    };

    void reserve(const detail::FootprintArrays& lights, std::uint64_t pairs) {
        const std::uint64_t capacity = pairs + detail::FootprintArrays::padding;
        arrays_ = lights;
        arrays_.ids = ids_.reserve(capacity);
        arrays_.x0 = x0_.reserve(capacity);
        arrays_.y0 = y0_.reserve(capacity);
        arrays_.x1 = x1_.reserve(capacity);
        arrays_.y1 = y1_.reserve(capacity);
        if constexpr (with_spans) arrays_.span_begin = span_begin_.reserve(capacity);
    }

    detail::SliceTable table_;
    detail::Buffer<Met> met_;
    detail::Buffer<detail::SliceRun> runs_;
    detail::Buffer<std::uint32_t> ids_, span_begin_;
    detail::Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
    detail::FootprintArrays arrays_ = {};
    std::size_t run_count_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
