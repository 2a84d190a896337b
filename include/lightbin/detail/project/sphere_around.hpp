// SPDX-License-Identifier: MIT
// Float spheres around spheres that were computed in double, rounded outward.
#pragma once

#include <lightbin/sphere.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Whether a light is switched off: see Sphere.
template <class Real> bool is_off(Real radius) {
    return radius <= -1 && radius >= -1;
}

/// Returns a Sphere that is in no list: switched off if this radius says so, else bad input, which is counted.
inline Sphere unlit_sphere(double radius) {
    return {0, 0, 0, is_off(radius) ? -1 : -infinity};
}

/// Returns a float sphere that contains a sphere of doubles. The centre is rounded to nearest, and the radius is
/// enlarged by the distance that this moves the centre. A sphere that floats represent exactly stays as it is; a centre
/// beyond the range of floats gives a sphere that covers everything.
inline Sphere sphere_around(double x, double y, double z, double radius) {
    if (!is_finite(x) || !is_finite(y) || !is_finite(z) || !(radius >= 0)) return unlit_sphere(radius);
    constexpr double most = static_cast<double>(FLT_MAX);
    if (abs_of(x) > most || abs_of(y) > most || abs_of(z) > most) return {0, 0, 0, infinity};
    const Sphere nearest = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0};
    const double error = abs_of(x - static_cast<double>(nearest.x)) +
                         abs_of(y - static_cast<double>(nearest.y)) +
                         abs_of(z - static_cast<double>(nearest.z));
    const double reach = error > 0 ? (radius + error) * (1 + 0x1p-50) : radius;
    return {nearest.x, nearest.y, nearest.z, float_above(reach)};
}

struct Triple {
    double x, y, z;
};

template <class Point> Triple triple(const Point& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Returns the length of a vector, with a relative error of at most 2^-51 if no square underflows or overflows.
inline double length(const Triple& v) {
    return root_of(rounded(v.x * v.x) + rounded(v.y * v.y) + rounded(v.z * v.z));
}

inline bool finite(const Triple& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

/// Returns a float sphere that contains a sphere whose centre and radius were computed in double with rounding errors:
/// up to 2^-50 of the radius in the radius, and up to 2^-50 of the radius plus 2^-53 of each coordinate in the centre.
/// The radius is enlarged by more than these, and by 2^-124 for values that were flushed to zero.
inline Sphere sphere_around_nearly(const Triple& centre, double radius) {
    return sphere_around(centre.x, centre.y, centre.z,
                         rounded(radius * (1 + 0x1p-48)) +
                             rounded((abs_of(centre.x) + abs_of(centre.y) + abs_of(centre.z)) * 0x1p-52) +
                             0x1p-124);
}

}}}  // namespace lightbin::detail
