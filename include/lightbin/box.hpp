// SPDX-License-Identifier: MIT
// Stability: settled.
// What a program that bins Boxes (sphere.hpp) includes: their kernels. And functions that make boxes of decals, probes,
// rooms, projectors and tubes.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/kinds/shape_kernels.hpp>
#include <lightbin/detail/project/spheres_around_shapes.hpp>
#include <lightbin/matrix.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Returns the part of a light's sphere that lies in a box, such as that of a room, a portal's frustum or a projector.
///
/// box  a Box, of which everything but its sphere is taken
inline Box clipped_sphere(const Sphere& light, Box box) {
    box.x = light.x;
    box.y = light.y;
    box.z = light.z;
    box.radius = light.radius;
    return box;
}

namespace detail {

template <> inline constexpr bool kernels_included<LightKind::box> = true;

/// Returns a Box that is in no list, as unlit_sphere() returns a Sphere.
inline Box unlit_box(double radius) {
    return {0, 0, 0, unlit_sphere(radius).radius, 0, 0, 0, {}};
}

/// Contains all points whose coordinates are floats: for shapes that reach farther.
inline constexpr Box endless_box = {0, 0, 0, infinity, 0, 0, 0, {{FLT_MAX, 0, 0}, {0, FLT_MAX, 0}, {0, 0, FLT_MAX}}};

/// Returns a box with these half axes, and the sphere of its own corners.
inline Box box_with_own_sphere(const Triple& centre, const Triple (&half_axes)[3], double taper) {
    const double size = size_of(centre) + size_of(half_axes[0]) + size_of(half_axes[1]) + size_of(half_axes[2]);
    if (!is_finite(size)) return unlit_box(0);
    if (size > static_cast<double>(FLT_MAX)) return endless_box;
    Box box = {};
    box.box_x = static_cast<float>(centre.x);
    box.box_y = static_cast<float>(centre.y);
    box.box_z = static_cast<float>(centre.z);
    box.taper = static_cast<float>(taper);
    for (int i = 0; i < 3; ++i) {
        const double axis[] = {half_axes[i].x, half_axes[i].y, half_axes[i].z};
        for (int k = 0; k < 3; ++k)
            box.half_axes[i][k] = static_cast<float>(axis[k]);
    }
    return clipped_sphere(sphere_of_corners(box), box);
}

/// Returns a vector of length 1 at right angles to a vector that is not zero.
inline Triple perpendicular(const Triple& v) {
    const Triple across = abs_of(v.x) < abs_of(v.y) ? Triple{0, -v.z, v.y} : Triple{v.z, 0, -v.x};
    return scaled(across, 1 / length(across));
}
inline Triple cross(const Triple& a, const Triple& b) {
    return {rounded(a.y * b.z) - rounded(a.z * b.y), rounded(a.z * b.x) - rounded(a.x * b.z),
            rounded(a.x * b.y) - rounded(a.y * b.x)};
}

/// Returns a right-angled box that contains the box given in double, whose half axes have the direction `along` of
/// length 1 and two directions at right angles to it. Its faces are moved outward by more than rounding to float
/// moves them. A box that is not finite gives one that contains everything.
inline Box right_angled_box(const Triple& centre, const Triple& along, double half_length, double half_width) {
    const double size = size_of(centre) + half_length + 2 * half_width, margin = rounded(size * 0x1p-21) + 0x1p-120;
    if (!(size <= static_cast<double>(FLT_MAX))) return endless_box;
    const Triple across = perpendicular(along), third = cross(along, across);
    const Triple half_axes[] = {scaled(across, half_width + margin), scaled(third, half_width + margin),
                                scaled(along, half_length + margin)};
    return box_with_own_sphere(centre, half_axes, 1);
}

}  // namespace detail

/// Returns a whole box, such as that of a decal or a reflection probe: its sphere is one around its corners.
///
/// centre, half_x, half_y, half_z  any type with members x, y and z, floats or doubles: the box's centre, and vectors
///                                 from there to the middles of three faces, of any lengths and angles
template <class Point>
Box oriented_box(const Point& centre, const Point& half_x, const Point& half_y, const Point& half_z) {
    return detail::box_with_own_sphere(detail::triple(centre),
                                       {detail::triple(half_x), detail::triple(half_y), detail::triple(half_z)}, 1);
}

/// Returns the image of a cube under a transform, as engines keep decals and probes, with a sphere around its
/// corners.
///
/// transform  from the cube's space to the space of the lights, any type that matrix.hpp lists; the last row is not
///            read
/// half_side  half of the cube's side: 1 for the cube from -1 to 1, 0.5 for the cube from -0.5 to 0.5
template <class Transform> Box oriented_box(const Transform& transform, double half_side) {
    const Matrix m = detail::to_matrix(transform);
    detail::Triple axes[3];
    for (int i = 0; i < 3; ++i)
        axes[i] = detail::scaled({m[i][0], m[i][1], m[i][2]}, half_side);
    return detail::box_with_own_sphere({m[3][0], m[3][1], m[3][2]}, axes, 1);
}

/// Returns the half of a sphere that lies on one side of its centre, where an area light shines: a Box that contains
/// the half sphere and exceeds it by at most 2^-19 of the sum of its radius and the sizes of the centre's
/// coordinates. A sphere that reaches beyond the range of floats, as with an infinite radius, is kept whole.
///
/// direction  a type with members x, y and z: towards the half that is kept, of any length but zero
template <class Direction> Box half_sphere(const Sphere& light, const Direction& direction) {
    const detail::Triple axis = detail::triple(direction);
    const double axis_length = detail::length(axis), radius = static_cast<double>(light.radius);
    if (!(axis_length > 0) || !detail::is_finite(axis_length)) return detail::unlit_box(radius);
    const detail::Triple along = detail::scaled(axis, 1 / axis_length);
    const detail::Triple middle = detail::sum(detail::triple(light), detail::scaled(along, radius / 2));
    return clipped_sphere(light, detail::right_angled_box(middle, along, radius / 2, radius));
}

/// Returns the frustum that a projector lights, with a sphere around its corners.
///
/// eye             where the rays of the projector meet; types as for oriented_box()
/// forward         vector from the eye to the middle of the far face
/// half_x, half_y  vectors from there to the middles of two sides of the far face
/// begin           where the frustum begins, as a fraction of `forward`: 0 for the whole pyramid, below 1
template <class Point>
Box projector_box(const Point& eye, const Point& forward, const Point& half_x, const Point& half_y,
                  double begin = 0) {
    const detail::Triple way = detail::triple(forward);
    return detail::box_with_own_sphere(
        detail::sum(detail::triple(eye), detail::scaled(way, 0.5 + 0.5 * begin)),
        {detail::triple(half_x), detail::triple(half_y), detail::scaled(way, 0.5 - 0.5 * begin)}, begin);
}

/// Returns a box and a sphere that contain all points within `radius` of the line segment from `a` to `b`, a tube with
/// round ends. It is listed in fewer tiles than tube_sphere(a, b, radius), which is its sphere.
///
/// a, b, radius  as for tube_sphere()
template <class Point> Box tube_box(const Point& a, const Point& b, float radius) {
    const detail::Triple from = detail::triple(a), to = detail::triple(b);
    const detail::Triple way = detail::sum(to, detail::scaled(from, -1));
    const double distance = detail::length(way), reach = static_cast<double>(radius);
    const detail::Triple middle = detail::sum(detail::scaled(from, 0.5), detail::scaled(to, 0.5));
    if (!detail::finite(from) || !detail::finite(to) || !(radius >= 0)) return detail::unlit_box(reach);
    const detail::Triple along = distance > 0 ? detail::scaled(way, 1 / distance) : detail::Triple{1, 0, 0};
    return clipped_sphere(detail::sphere_around(middle, 0.5 * distance + reach),
                          detail::right_angled_box(middle, along, 0.5 * distance + reach, reach));
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
