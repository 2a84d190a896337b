// SPDX-License-Identifier: MIT
// Reduces the rows of a depth buffer that lie in one row of tiles to the extremes of each column of samples, a vector
// of columns at a time. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/vectors/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Writes the minimum and the maximum of each column of `depth` to lower[column] and upper[column]: -inf and +inf if
/// one of its samples is NaN, and +inf and -inf if it has no samples that count. Samples equal to `skipped` don't
/// count; NaN skips none. There are at least as many columns as a vector has lanes.
inline void column_extremes(const DepthRows& depth, float skipped, float* lower, float* upper) {
    const Floats infinite = broadcast(infinity);
    for (std::size_t column = 0; column < depth.columns; column += lanes) {
        // The last vector begins earlier, so that it ends with the last column.
        if (depth.columns - column < lanes) column = depth.columns - lanes;
        const float* samples = depth.samples + column;
        Floats least = infinite, greatest = -infinite;
        auto numbers = less_equal(infinite, infinite);  // columns without NaN: at first all of them
        for (std::size_t row = 0; row < depth.rows; ++row, samples += depth.pitch) {
            const Floats sample = load_floats(samples);
            const auto skip = both(less_equal(sample, broadcast(skipped)), less_equal(broadcast(skipped), sample));
            least = minimum(select(skip, infinite, sample), least);
            greatest = maximum(select(skip, -infinite, sample), greatest);
            numbers = both(numbers, less_equal(sample, sample));
        }
        store_floats(lower + column, select(numbers, least, -infinite));
        store_floats(upper + column, select(numbers, greatest, infinite));
    }
}

}}}}  // namespace lightbin::detail
