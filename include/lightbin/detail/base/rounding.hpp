// SPDX-License-Identifier: MIT
// Outward rounding from double to float. The promise that no light is missed rests on this rounding and on IEEE
// comparisons with NaN, so compiler modes that break either are refused here.
#pragma once

#include <lightbin/detail/base/platform.hpp>

#include <cfloat>
#include <cstdint>
#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) ||                     \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error                                                                                                       \
    "lightbin: -ffast-math, /fp:fast and their parts let the compiler drop the NaN tests and reorder the sums that \
keep lights from being missed. Compile the files that include lightbin without them."
#endif

#if (defined(__FLT_EVAL_METHOD__) &&                                                                         \
     (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 1 || __FLT_EVAL_METHOD__ == 2)) ||                   \
    (defined(_M_IX86_FP) && _M_IX86_FP == 0)
#error                                                                                                       \
    "lightbin: here floats are kept in wider registers (x87), so that the same input gives other bytes than elsewhere. \
Compile the files that include lightbin with SSE2 arithmetic, -msse2 -mfpmath=sse or /arch:SSE2."
#endif

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

inline constexpr float infinity = std::numeric_limits<float>::infinity();

/// Lights are computed in floats if their radii or sizes lie between these limits, and no coordinate's absolute value
/// is above the upper one: then no square overflows, and none of a size underflows. Others are computed in doubles.
inline constexpr float float_safe_min = 0x1p-40f, float_safe_max = 0x1p40f;

/// Returns the largest float below a finite `value`. Unlike std::nextafter this is inlined.
inline float next_below(float value) {
    if (value == 0) return -FLT_TRUE_MIN;
    return bit_cast<float>(bit_cast<std::int32_t>(value) + (value > 0 ? -1 : 1));
}

/// Returns the largest float that is not above `value`; -inf below the float range.
inline float float_below(double value) {
    if (value > static_cast<double>(FLT_MAX)) return value > DBL_MAX ? infinity : FLT_MAX;
    if (value < -static_cast<double>(FLT_MAX)) return -infinity;
    const float nearest = static_cast<float>(value);
    return static_cast<double>(nearest) > value ? next_below(nearest) : nearest;
}

/// Returns the smallest float that is not below `value`; +inf above the float range.
inline float float_above(double value) {
    return -float_below(-value);
}

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
