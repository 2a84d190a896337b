// SPDX-License-Identifier: MIT
// Finds the slices of depths. A lookup table divides all depths into buckets and holds for each how many boundaries
// between slices lie before it, so that few or no boundaries are left to compare with. The buckets have equal lengths
// either in depth, which suits linear slices, or in a float's bit pattern, which grows about as the depth's logarithm
// and suits exponential ones.
#pragma once

#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/rounding.hpp>

#include <bit>
#include <span>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The map from view depths to buckets, each an entry of a lookup table. A depth is in the bucket
/// (coordinate(depth) - begin) * scale, clamped to 0..last; coordinate() is the depth or its bit pattern.
struct DepthBuckets {
    float begin = 0, scale = 0, last = 0;
    bool by_bits = false;  ///< whether depth buckets have equal lengths in the floats' bit patterns, or else in depth

    /// Returns the depth itself or, with by_bits, its bit pattern as an integer that ascends with it, rounded to float.
    float coordinate(float depth) const {
        if (!by_bits) return depth;
        const std::int32_t bits = bit_cast<std::int32_t>(depth + 0.0f);  // the sum makes -0 to 0
        return static_cast<float>(bits ^ (bits >> 31 & 0x7fffffff));
    }
    /// Returns the bucket of a depth. All steps are monotone and the same on all machines: a later bucket is deeper.
    std::size_t index_of(float depth) const {
        const float bucket = (coordinate(depth) - begin) * scale;
        // NaN, from an infinite depth and a scale of 0, goes to bucket 0, where all depths are then.
        return static_cast<std::size_t>(static_cast<std::int32_t>(bucket > 0 ? min_of(bucket, last) : 0));
    }
};

/// The nearest and farthest view depths of up to `size` lights, and the buckets, a lookup table's depth intervals, that
/// these lie in. Kernels store whole vectors, also over elements behind the last light's.
struct LightDepths {
    static constexpr std::uint32_t size = 64;
    float nearest[size], farthest[size];
    std::uint32_t first_bucket[size], last_bucket[size];
};

/// A lookup table of the depth slices between boundaries, which ascend and are finite.
class SliceTable {
public:
    explicit SliceTable(std::span<const float> boundaries) : count_(boundaries.size()) {
        const DefaultFloatEnvironment environment;
        float* const to = boundaries_.reserve(count_ + std::uint64_t{1});
        copy_items(boundaries.data(), count_, to);
        to[count_] = std::numeric_limits<float>::quiet_NaN();  // ends searches, as every comparison with it is false
        // Buckets of equal length in depth or, if fewer boundaries share a bucket then, in the depths' bit patterns.
        const std::size_t shared_by_depth = fill_buckets(false);
        if (fill_buckets(true) > shared_by_depth) fill_buckets(false);
    }

    std::span<const float> boundaries() const { return {boundaries_.data(), count_}; }

    /// How far the depths of lights and slices are widened, as a fraction of themselves: see Slices::with_margin().
    float margin = 0;

    /// Returns a depth lowered or raised by the margin and rounded outward: where a widened interval begins or ends.
    float nearer(float depth) const { return margin > 0 ? float_below(widened(depth, -margin)) : depth; }
    float farther(float depth) const { return margin > 0 ? float_above(widened(depth, margin)) : depth; }

    /// The slices first..last.
    struct Range {
        std::uint32_t first, last;
    };
    /// Returns the slices that meet the view depths from `nearest` to `farthest`, widened by the margin.
    Range met(float nearest, float farthest) const {
        nearest = nearer(nearest);
        farthest = farther(farthest);
        return met_from(nearest, farthest, buckets_.index_of(nearest), buckets_.index_of(farthest));
    }

    /// Calls found(i, range) for each footprint i: its light's view depths meet the slices of the Range.
    ///
    /// kernel        find_depth_buckets() for an instruction set: the view depths of lights and their buckets
    /// lights, runs  FootprintArrays and ranges of indices in them; overwrites `widest_lanes` elements of lights.ids
    ///               after each
    template <class Kernel, class Lights, class Runs, class Found>
    void find(Kernel kernel, float z_sign, const Lights& lights, Runs runs, Found found) const {
        for (const auto& run : runs) {
            fill_items(lights.ids + run.end, widest_lanes, lights.ids[run.begin]);  // kernels read whole vectors
            for (std::uint32_t i = run.begin; i < run.end; i += LightDepths::size) {
                const std::uint32_t count = min_of(run.end - i, LightDepths::size);
                LightDepths depths;
                kernel(buckets_, z_sign, lights, lights.ids + i, count, depths);
                for (std::uint32_t j = 0; j < count; ++j) {
                    const float nearest = depths.nearest[j], farthest = depths.farthest[j];
                    found(i + j, margin > 0
                                     ? met(nearest, farthest)
                                     : met_from(nearest, farthest, depths.first_bucket[j], depths.last_bucket[j]));
                }
            }
        }
    }

private:
    static constexpr std::size_t max_buckets = 0x8000;  // bounds the memory of the table

    static double widened(float depth, float fraction) {
        const double exact = static_cast<double>(depth);
        return exact + abs_of(exact) * static_cast<double>(fraction);  // a product of two floats is exact in double
    }

    /// Returns the slices that meet the depths from `nearest` to `farthest`, which lie in the given buckets.
    Range met_from(float nearest, float farthest, std::size_t first_bucket, std::size_t last_bucket) const {
        return {before(first_bucket, [=](float boundary) { return boundary < nearest; }),
                before(last_bucket, [=](float boundary) { return boundary <= farthest; })};
    }

    /// Returns for how many slice boundaries is_before(boundary) is true, a comparison with a depth in `bucket`.
    template <class IsBefore> std::uint32_t before(std::size_t bucket, IsBefore is_before) const {
        const float* const boundaries = boundaries_.data();
        std::uint32_t slice = before_.data()[bucket];
        // One boundary is counted without a branch. As buckets seldom hold two, the loop's branch is predicted well.
        slice += is_before(boundaries[slice]);
        while (is_before(boundaries[slice]))
            ++slice;
        return slice;
    }

    /// Divides the range of depths into buckets, and stores how many slice boundaries lie before each: the prefix sums
    /// of a histogram. Returns the number of boundaries that share a bucket with a lesser one.
    std::size_t fill_buckets(bool by_bits) {
        const std::span<const float> all = boundaries();
        buckets_.by_bits = by_bits;
        // Four times as many buckets as boundaries, so that few boundaries share one; but at least 512, whose table
        // stays in the cache anyway.
        const std::size_t buckets = min_of(max_of(std::bit_ceil(4 * count_), std::size_t{512}), max_buckets);
        buckets_.last = static_cast<float>(buckets - 1);
        buckets_.begin = count_ == 0 ? 0 : buckets_.coordinate(all[0]);
        const float length = count_ == 0 ? 0 : buckets_.coordinate(all[count_ - 1]) - buckets_.begin;
        buckets_.scale = buckets_.last / length;
        if (!is_finite(buckets_.scale)) buckets_.scale = 0;  // where `length` is 0 or tiny

        std::uint32_t* const counts = before_.reserve(buckets + 1);
        fill_items(counts, buckets + 1, 0);
        for (const float boundary : all)
            ++counts[buckets_.index_of(boundary) + 1];
        std::size_t shared = 0;
        for (std::size_t i = 1; i <= buckets; ++i) {
            shared += counts[i] > 1 ? counts[i] - 1 : 0;
            counts[i] += counts[i - 1];
        }
        return shared;
    }

    Buffer<float> boundaries_;      ///< the depths between slices, ascending, then a NaN that ends every search
    std::size_t count_;             ///< the number of boundaries between slices
    Buffer<std::uint32_t> before_;  ///< for each depth bucket the number of slice boundaries before it; last, the total
    DepthBuckets buckets_;
};

}}}  // namespace lightbin::detail
