// SPDX-License-Identifier: MIT
// The slicing stage, between projection and binning: finds the footprints in each depth slice, for clusters.
#pragma once

#include <lightbin/detail/stages/footprints.hpp>
#include <lightbin/slices.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The footprints of the lights that intersect each slice, in ascending order of id. Memory is reused between calls.
class SlicedFootprints {
public:
    /// Puts each footprint in the slices that its light's view depths meet, ends included: those of a sphere, z +- r,
    /// widened by the slices' margin. Errors: there are more than 2^32 - 1 cells, or pairs of a light and a slice.
    ///
    /// kernel  find_depth_buckets() for the lights' kind
    std::optional<Error> order(DepthBucketsKernel kernel, const View& view, const Footprints& footprints,
                               const Slices& slices) {
        constexpr std::uint64_t max_count = (std::numeric_limits<std::uint32_t>::max)();
        const FootprintArrays& lights = footprints.arrays();
        table_ = &table_of(slices);
        run_count_ = static_cast<std::size_t>(slices.count());
        const std::uint64_t cells = std::uint64_t{view.tile_count()} * run_count_;
        if (cells > max_count) return Error{ErrorCode::too_many_cells, cells, max_count};
        const std::uint64_t size = find_slices(kernel, view, footprints);
        if (size > max_count) return Error{ErrorCode::too_many_pairs, size, max_count};
        arrays_ = buffers_.reserve(size);
        arrays_.view_lights = lights.view_lights;
        const SliceTable::Range* met = met_.data();
        for (const FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i, ++met) {
                const std::uint64_t area =
                    (lights.x1[i] - lights.x0[i] + std::uint64_t{1}) * (lights.y1[i] - lights.y0[i] + 1u);
                for (std::uint32_t slice = met->first; slice <= met->last; ++slice) {
                    SliceRun& in_slice = runs_.data()[slice];
                    const std::uint32_t to = in_slice.end++;
                    in_slice.area += area;
                    arrays_.ids[to] = lights.ids[i];
                    arrays_.x0[to] = lights.x0[i];
                    arrays_.y0[to] = lights.y0[i];
                    arrays_.x1[to] = lights.x1[i];
                    arrays_.y1[to] = lights.y1[i];
                }
            }
        return {};
    }

    std::size_t slices() const { return run_count_; }
    const SliceTable& table() const { return *table_; }
    FootprintSlice slice(std::size_t i) const {
        const SliceRun& run = runs_.data()[i];
        return {arrays_,
                {static_cast<const FootprintRun*>(&run), 1},
                run.end - run.begin,
                run.area,
                {i == 0 ? -infinity : table_->nearer(table_->boundaries()[i - 1]),
                 i + 1 == run_count_ ? infinity : table_->farther(table_->boundaries()[i])}};
    }

private:
    /// The footprints in one slice, and the number of tiles in their rectangles.
    struct SliceRun : FootprintRun {
        std::uint64_t area;
    };

    /// Finds which slices each light meets, and where in arrays_ each slice's footprints begin. Returns the number
    /// of elements of each array.
    std::uint64_t find_slices(DepthBucketsKernel kernel, const View& view, const Footprints& footprints) {
        SliceRun* const runs = runs_.reserve(run_count_ + 1);
        fill_items(runs, run_count_ + 1, {});
        SliceTable::Range* met = met_.reserve(footprints.visible());
        const auto found = [=](std::uint32_t, SliceTable::Range range) mutable {
            *met++ = range;
            // A difference array of the number of lights per slice, whose prefix sums are taken below. Its unsigned
            // elements wrap, and the sums come out right.
            ++runs[range.first].end;
            --runs[range.last + 1].end;
        };
        table_->find(kernel, camera_of(view).z_sign, footprints.arrays(), footprints.runs(), found);
        std::uint64_t size = 0;
        std::uint32_t count = 0;
        for (SliceRun* run = runs; run <= runs + run_count_; ++run) {
            count += run->end;
            run->begin = run->end = static_cast<std::uint32_t>(size);
            size += count;
        }
        return size;
    }

    const SliceTable* table_ = nullptr;  ///< the table of the caller's Slices, set by order()
    Buffer<SliceTable::Range> met_;      ///< for each footprint, the slices that its light meets
    /// Each slice's run of footprints, and one element more: find_slices() first makes a difference array of them.
    Buffer<SliceRun> runs_;
    FootprintBuffers buffers_;
    FootprintArrays arrays_ = {};
    std::size_t run_count_ = 0;
};

}}}  // namespace lightbin::detail
