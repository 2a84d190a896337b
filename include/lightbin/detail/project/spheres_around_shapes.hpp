// SPDX-License-Identifier: MIT
// Float spheres, rounded outward, around Spots, Boxes and spheres of doubles. They need no kernels, so that coverage of
// mixed lights is the same function in all units, whether or not these include spot.hpp and box.hpp.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/sphere.hpp>

#include <initializer_list>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// Returns a Sphere that is in no list: switched off if this radius says so, else bad input, which is counted.
inline Sphere unlit_sphere(double radius) {
    return {0, 0, 0, is_off(radius) ? -1 : -infinity};
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
inline double size_of(const Triple& v) {
    return abs_of(v.x) + abs_of(v.y) + abs_of(v.z);
}
inline bool finite(const Triple& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

inline Triple scaled(const Triple& v, double factor) {
    return {rounded(v.x * factor), rounded(v.y * factor), rounded(v.z * factor)};
}
inline Triple sum(const Triple& a, const Triple& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Returns a float sphere that contains a sphere whose centre and radius were computed in double with rounding errors:
/// up to 2^-50 of the radius in the radius, and up to 2^-50 of the radius plus 2^-53 of each coordinate in the centre.
/// The radius is enlarged by more than these, by 2^-124 for values that were flushed to zero, and by the distance that
/// rounding to float moves the centre. A centre beyond the range of floats gives a sphere that covers everything.
inline Sphere sphere_around(const Triple& centre, double radius) {
    if (!finite(centre) || !(radius >= 0)) return unlit_sphere(radius);
    constexpr double most = static_cast<double>(FLT_MAX);
    if (abs_of(centre.x) > most || abs_of(centre.y) > most || abs_of(centre.z) > most) return {0, 0, 0, infinity};
    const Sphere nearest = {static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z),
                            0};
    const double enlarged = rounded(radius * (1 + 0x1p-48)) + rounded(size_of(centre) * 0x1p-52) + 0x1p-124,
                 moved = size_of(sum(centre, scaled(triple(nearest), -1)));
    return {nearest.x, nearest.y, nearest.z, float_above((enlarged + moved) * (1 + 0x1p-50))};
}

}  // namespace detail

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
    const Sphere least = detail::sphere_around(detail::sum(detail::triple(own), detail::scaled(axis, step)),
                                               narrow ? along : radius * detail::root_of(1 - cosine2));
    return least.radius < own.radius ? least : own;
}

namespace detail {

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
    return sphere_around(sum(centre, scaled(along, shift)), radius);
}

}  // namespace detail

/// Returns a sphere that contains all points of a Box: the Box's own sphere or, if smaller, one around the box's
/// corners. A bad Box gives a bad Sphere, and a Box that is switched off a Sphere that is.
inline Sphere bounding_sphere(const Box& box) {
    const Sphere own = {box.x, box.y, box.z, box.radius}, corners = detail::sphere_of_corners(box);
    if (!detail::finite(detail::triple(own)) || !(own.radius >= 0) || !(corners.radius > 0))
        return detail::unlit_sphere(static_cast<double>(own.radius));
    return corners.radius < own.radius ? corners : own;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
