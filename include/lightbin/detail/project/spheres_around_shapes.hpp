// SPDX-License-Identifier: MIT
// Spheres around Spots and Boxes. They need no kernels, so that coverage of mixed lights is the same function in all
// units, whether or not these include spot.hpp and box.hpp.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/project/sphere_around.hpp>

#include <initializer_list>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Returns the least sphere that contains all points of a spot, up to rounding: its radius exceeds the exact one by at
/// most 2^-22 (|x| + |y| + |z| + radius) + 2^-123 and never exceeds the spot's own. Half angles of 90 degrees or more,
/// an infinite radius and a light switched off give the spot's own sphere; a bad spot gives a bad Sphere.
inline Sphere bounding_sphere(const Spot& spot) {
    const detail::Triple axis = {static_cast<double>(spot.axis_x), static_cast<double>(spot.axis_y),
                                 static_cast<double>(spot.axis_z)};
    const double axis_length = detail::length(axis), cosine = static_cast<double>(spot.cos_half_angle),
                 radius = static_cast<double>(spot.radius);
    const Sphere own = {spot.x, spot.y, spot.z, spot.radius};
    if (cosine <= -1 && cosine >= -1) return own;
    if (detail::is_off(radius)) return own;
    if (!(axis_length > 0) || !detail::finite(axis) || !(detail::abs_of(cosine) <= 1))
        return detail::unlit_sphere(radius);
    if (cosine <= 0 || spot.radius == detail::infinity) return own;

    // The spot's farthest points from any point on the axis are the apex or the rim, the circle where cone and sphere
    // meet. Up to a half angle of 45 degrees the least sphere passes through both; beyond, it is the sphere that has
    // the rim as a great circle. The square of a float is exact in double.
    const double cosine2 = cosine * cosine;
    const bool narrow = 2 * cosine2 >= 1;
    const double along = narrow ? radius / (2 * cosine) : radius * cosine;
    const double step = along / axis_length;
    const Sphere least =
        detail::sphere_around_nearly({static_cast<double>(spot.x) + detail::rounded(step * axis.x),
                                      static_cast<double>(spot.y) + detail::rounded(step * axis.y),
                                      static_cast<double>(spot.z) + detail::rounded(step * axis.z)},
                                     narrow ? along : radius * detail::root_of(1 - cosine2));
    return least.radius < own.radius ? least : own;
}

namespace detail {

inline Triple scaled(const Triple& v, double factor) {
    return {rounded(v.x * factor), rounded(v.y * factor), rounded(v.z * factor)};
}
inline Triple sum(const Triple& a, const Triple& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Triple half_axis(const Box& box, int i) {
    const float(&axis)[3] = box.half_axes[i];
    return {static_cast<double>(axis[0]), static_cast<double>(axis[1]), static_cast<double>(axis[2])};
}

/// Returns a sphere around all corners of a box; a bad Sphere for bad input. Its centre lies on the third half axis,
/// at equal distances from the corners of both faces that the axis ends in, where the half axes are at right angles.
inline Sphere sphere_of_corners(const Box& box) {
    const Triple centre = {static_cast<double>(box.box_x), static_cast<double>(box.box_y),
                           static_cast<double>(box.box_z)};
    const Triple across[] = {sum(half_axis(box, 0), half_axis(box, 1)),
                             sum(half_axis(box, 0), scaled(half_axis(box, 1), -1))};
    const Triple along = half_axis(box, 2);
    const double taper = static_cast<double>(box.taper), width = max_of(length(across[0]), length(across[1])),
                 depth = length(along);
    if (!finite(centre) || !is_finite(width) || !is_finite(depth) || !(width + depth > 0) || !(taper >= 0) ||
        !(taper <= 1))
        return unlit_sphere(0);
    double shift = rounded((1 - rounded(taper * taper)) * (width * width)) / rounded(4 * depth * depth);
    shift = shift < 1 ? shift : depth > 0 ? 1.0 : 0.0;
    double radius = 0;
    for (const Triple& diagonal : across)
        for (const double side : {-1.0, 1.0}) {
            const Triple wide = sum(scaled(along, 1 - shift), scaled(diagonal, side)),
                         narrow = sum(scaled(along, -1 - shift), scaled(diagonal, rounded(side * taper)));
            radius = max_of(radius, max_of(length(wide), length(narrow)));
        }
    return sphere_around_nearly(sum(centre, scaled(along, shift)), radius);
}

}  // namespace detail

/// Returns a sphere that contains all points of a Box: the Box's own sphere or, if smaller, one around the box's
/// corners. A bad Box gives a bad Sphere, and a Box that is switched off a Sphere that is.
inline Sphere bounding_sphere(const Box& box) {
    const Sphere own = {box.x, box.y, box.z, box.radius}, corners = detail::sphere_of_corners(box);
    const bool finite = detail::is_finite(box.x) && detail::is_finite(box.y) && detail::is_finite(box.z);
    if (!finite || !(own.radius >= 0) || !(corners.radius > 0))
        return detail::unlit_sphere(static_cast<double>(own.radius));
    return corners.radius < own.radius ? corners : own;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
