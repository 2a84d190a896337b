// SPDX-License-Identifier: MIT
// The functions of <cmath> that the core uses. With gcc and clang they are compiler builtins, because <cmath> costs
// every file that includes the core 0.07 s to compile.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#if defined(__GNUC__) || defined(__clang__)
#define LIGHTBIN_MATH(function) __builtin_##function
#else
#include <cmath>
#define LIGHTBIN_MATH(function) std::function
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

inline float abs_of(float a) {
    return LIGHTBIN_MATH(fabsf)(a);
}
inline double abs_of(double a) {
    return LIGHTBIN_MATH(fabs)(a);
}
inline float root_of(float a) {
    return LIGHTBIN_MATH(sqrtf)(a);
}
inline double root_of(double a) {
    return LIGHTBIN_MATH(sqrt)(a);
}
inline double arctan_of(double a) {
    return LIGHTBIN_MATH(atan)(a);
}
inline double power_of(double base, double exponent) {
    return LIGHTBIN_MATH(pow)(base, exponent);
}
template <class Real> bool is_nan(Real a) {
    return LIGHTBIN_MATH(isnan)(a);
}
template <class Real> bool is_finite(Real a) {
    return LIGHTBIN_MATH(isfinite)(a);
}

}}}  // namespace lightbin::detail

#undef LIGHTBIN_MATH
