// SPDX-License-Identifier: MIT
// Stability: settled.
// What a program that bins Spots (sphere.hpp) includes: their kernels, and spheres around spots, tubes and rectangles.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/kinds/shape_kernels.hpp>
#include <lightbin/detail/project/spheres_around_shapes.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {
template <> inline constexpr bool kernels_included<LightKind::spot> = true;
}  // namespace detail

/// Returns the least sphere that contains all points within `radius` of the line segment from `a` to `b`: a tube with
/// round ends. Up to rounding: the sphere's radius exceeds the exact one by at most 2^-22 of the sum of the exact
/// radius and the absolute values of the centre's coordinates, plus 2^-123.
///
/// a, b    any type with members x, y and z, floats or doubles. NaN or infinite coordinates give a bad Sphere
/// radius  +inf gives a sphere that covers everything; -1, one that is switched off; any other negative number or NaN,
///         a bad Sphere
template <class Point> Sphere tube_sphere(const Point& a, const Point& b, float radius) {
    const detail::Triple from = detail::triple(a), to = detail::triple(b);
    if (!detail::finite(from) || !detail::finite(to) || !(radius >= 0))
        return detail::unlit_sphere(static_cast<double>(radius));
    const double distance = detail::length(detail::sum(to, detail::scaled(from, -1)));
    return detail::sphere_around(detail::sum(detail::scaled(from, 0.5), detail::scaled(to, 0.5)),
                                 0.5 * distance + static_cast<double>(radius));
}

/// Returns the least sphere that contains all points within `range` of a rectangle, such as an area light. Types,
/// rounding and bad input are as for tube_sphere().
///
/// half_x, half_y  vectors from the centre to the middles of two adjacent sides. If they are not at right angles, the
///                 shape is a parallelogram
template <class Point>
Sphere rectangle_sphere(const Point& centre, const Point& half_x, const Point& half_y, float range) {
    const detail::Triple c = detail::triple(centre), u = detail::triple(half_x), v = detail::triple(half_y);
    if (!detail::finite(c) || !detail::finite(u) || !detail::finite(v) || !(range >= 0))
        return detail::unlit_sphere(static_cast<double>(range));
    const double half_diagonal = detail::max_of(detail::length(detail::sum(u, v)),
                                                detail::length(detail::sum(u, detail::scaled(v, -1))));
    return detail::sphere_around(c, half_diagonal + static_cast<double>(range));
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
