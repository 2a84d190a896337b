// SPDX-License-Identifier: MIT
// Depth samples by columns: the rows of a row of tiles become one, a vector of columns at a time. Included once a
// tier, after its vectors.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Writes to lower[i] and upper[i] the extremes of column i of `rows` rows of `columns` samples, -inf and +inf if
/// one of them is NaN. Samples equal to `skipped` (NaN: none are) do not count; +inf and -inf where none does.
///
/// by_split  Of column i, upper[i] is of those samples alone that are no larger than split[i], lower[i] of those that are.
///           NaN does not count.
template <bool by_split>
inline void column_extremes(const DepthRows& depth, float skipped, const float* split,
                                            float* lower, float* upper) {
    const Floats infinite = broadcast(infinity);
    for (std::size_t column = 0; column < depth.columns; column += lanes) {
        // The last vector may overlap the one before it.
        if (depth.columns - column < lanes) column = depth.columns - lanes;
        const float* samples = depth.samples + column;
        Floats least = infinite, most = -infinite;
        auto numbers = less_equal(infinite, infinite);
        for (std::size_t row = 0; row < depth.rows; ++row, samples += depth.pitch) {
            const Floats sample = load_floats(samples);
            const auto out = both(less_equal(sample, broadcast(skipped)), less_equal(broadcast(skipped), sample));
            if constexpr (by_split) {
                const Floats middle = load_floats(split + column);
                least = minimum(select(and_not(less(middle, sample), out), sample, infinite), least);
                most = maximum(select(and_not(less_equal(sample, middle), out), sample, -infinite), most);
            } else {
                least = minimum(select(out, infinite, sample), least);
                most = maximum(select(out, -infinite, sample), most);
                numbers = both(numbers, less_equal(sample, sample));
            }
        }
        store_floats(lower + column, select(numbers, least, -infinite));
        store_floats(upper + column, select(numbers, most, infinite));
    }
}

}}}}  // namespace lightbin::detail
