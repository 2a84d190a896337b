// SPDX-License-Identifier: MIT
// Sphere, the region that a light can reach, and the usual falloff of a light to nothing at its range.
#pragma once

#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/rounding.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The sphere outside of which a light gives no light: centre and radius, in the units of the space that the lights are
/// given in. That is view space, which the projection matrix is applied to, or with world_space() world space.
///
/// Radius 0 is a point; radius +inf covers everything. A light with a NaN or infinite centre, or a NaN or negative
/// radius, is bad input: it is skipped and counted, and all other lights are binned as usual.
struct Sphere {
    float x, y, z, radius;
};

/// Returns the distance in metres at which a point light of `intensity` candela (lumen per steradian) has fallen to
/// `cutoff` lux (lumen per square metre, on a surface that faces the light): sqrt(intensity / cutoff), rounded up.
/// Light beyond this range is lost, so the cutoff is also the greatest error per light that this can cause.
///
/// intensity  0 or less gives range 0, +inf an infinite range, NaN gives NaN
/// cutoff     0 or less gives an infinite range
inline float light_range(float intensity, float cutoff) {
    if (intensity <= 0) return 0;
    if (cutoff <= 0 || (intensity > FLT_MAX && !detail::is_nan(cutoff))) return detail::infinity;
    return detail::float_above(detail::root_of(static_cast<double>(intensity) / static_cast<double>(cutoff)) *
                               (1 + 0x1p-50));
}

/// Returns the factor by which to multiply a light so that it fades smoothly to nothing at its range: 1 at the light,
/// (1 - (distance / range)^4)^2 in between, and exactly 0 from the range on (Karis, Real Shading in Unreal Engine 4,
/// SIGGRAPH 2013). Without such a window the light that is left at the range is cut off at tile borders, and seams
/// show. With ShaderOptions::window shaders get a function for the same factor. Range +inf gives 1.
inline float light_window(float distance, float range) {
    if (!(distance < range)) return 0;
    const float x = distance / range, w = 1 - x * x * x * x;
    return w * w;
}

}}  // namespace lightbin
