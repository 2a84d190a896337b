// SPDX-License-Identifier: MIT
// Numbers with an error bound: long double, and a limit of the error that every operation carries on.
#pragma once

#include <array>
#include <cfloat>
#include <cmath>

namespace hunt {

/// A number within `error` of `value`. An operation rounds by half of LDBL_EPSILON; a full LDBL_EPSILON is added, which
/// leaves room for rounding of the bound itself.
struct Real {
    Real() = default;
    Real(long double exactly) : value(exactly) {}
    Real(long double about, long double bound) : value(about), error(bound) {}

    long double low() const { return value - error; }
    long double high() const { return value + error; }

    long double value = 0, error = 0;
};

inline Real operator-(Real a) {
    return {-a.value, a.error};
}
inline Real operator+(Real a, Real b) {
    const long double sum = a.value + b.value;
    return {sum, (a.error + b.error + LDBL_EPSILON * std::fabs(sum)) * (1 + 4 * LDBL_EPSILON)};
}
inline Real operator-(Real a, Real b) {
    return a + -b;
}
inline Real operator*(Real a, Real b) {
    const long double product = a.value * b.value;
    return {product, (std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error +
                      LDBL_EPSILON * std::fabs(product)) *
                         (1 + 4 * LDBL_EPSILON)};
}
/// By what is surely not 0.
inline Real operator/(Real a, Real b) {
    const long double quotient = a.value / b.value, least = std::fabs(b.value) - b.error;
    return {quotient,
            ((a.error + std::fabs(quotient) * b.error) / least + LDBL_EPSILON * std::fabs(quotient)) *
                (1 + 8 * LDBL_EPSILON)};
}
/// Returns true only if a is certainly less than b; false for NaN.
inline bool surely_less(Real a, Real b) {
    return a.high() < b.low();
}
inline bool surely_at_most(Real a, Real b) {
    return a.high() <= b.low();
}

using Point = std::array<long double, 3>;
using RealPoint = std::array<Real, 3>;

}  // namespace hunt
