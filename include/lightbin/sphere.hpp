// SPDX-License-Identifier: MIT
// A light as the library takes it.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/rounding.hpp>

#include <cstring>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// A light's sphere of influence: centre and radius (the papers' range), in the units of the space that the lights are
/// given in. That is the space that the projection matrix takes, unless they go through world_space().
///
/// Radius 0 is a point; radius +inf covers everything. A light with a NaN or infinite centre, or a NaN or
/// negative radius, is bad input: it is skipped and counted, and the others are right.
struct Sphere {
    float x, y, z, radius;
};

/// Returns the distance at which a point light of `intensity` candela (lumen per steradian) has fallen to
/// `cutoff` lux (lumen per square metre, on a surface that faces it), rounded up: sqrt(intensity / cutoff),
/// in metres. What a light gives beyond its range is lost, so the cutoff is the largest error that one
/// light's missing tail can make.
///
/// intensity  0 or less gives range 0, infinite an infinite one, NaN gives NaN
/// cutoff     0 or less gives an infinite range
inline float light_range(float intensity, float cutoff) {
    if (intensity <= 0) return 0;
    if (cutoff <= 0 || (intensity > FLT_MAX && !detail::is_nan(cutoff))) return detail::infinity;
    return detail::float_above(detail::root_of(static_cast<double>(intensity) / static_cast<double>(cutoff)) *
                               (1 + 0x1p-50));
}

/// Returns what to multiply a light by so that it ends at its range, smoothly: 1 at the light, (1 - (distance /
/// range)^4)^2 on the way, and exactly 0 from the range on. Without such a window what a light still gives beyond its
/// range is lit in some tiles and not in their neighbours, and seams are seen. ShaderOptions::window makes the same of
/// shader text. Range +inf: 1.
///
/// Source: Karis, Real Shading in Unreal Engine 4, SIGGRAPH 2013.
inline float light_window(float distance, float range) {
    if (!(distance < range)) return 0;
    const float x = distance / range, w = 1 - x * x * x * x;
    return w * w;
}

namespace detail {

/// Returns the smallest sphere found around one of doubles: exact where floats hold it. A centre out of their range gives
/// one that covers everything; bad input stays bad.
inline Sphere sphere_around(double x, double y, double z, double radius) {
    if (!is_finite(x) || !is_finite(y) || !is_finite(z) || !(radius >= 0)) return {0, 0, 0, -1};
    constexpr double most = static_cast<double>(FLT_MAX);
    if (abs_of(x) > most || abs_of(y) > most || abs_of(z) > most) return {0, 0, 0, infinity};
    const Sphere nearest = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0};
    const double error = abs_of(x - static_cast<double>(nearest.x)) +
                         abs_of(y - static_cast<double>(nearest.y)) +
                         abs_of(z - static_cast<double>(nearest.z));
    const double reach = error > 0 ? (radius + error) * (1 + 0x1p-50) : radius;
    return {nearest.x, nearest.y, nearest.z, float_above(reach)};
}

/// Reads bytes, which may be of any type.
inline Sphere load_sphere(const Sphere* from) {
    Sphere sphere;
    std::memcpy(&sphere, from, sizeof sphere);
    return sphere;
}

}  // namespace detail
}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
