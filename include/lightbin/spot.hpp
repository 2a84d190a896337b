// SPDX-License-Identifier: MIT
// Lights that are not spheres, and the spheres around them: spots, tubes, rectangles.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/sphere.hpp>

#include <cfloat>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// A spot light's influence: the points of a sphere that a cone from its centre holds. Two vec4s.
///
/// axis_x, axis_y, axis_z  the direction that it shines in, of any length but zero: only the direction counts, so the
///                         rounding of a unit vector is no error in the length, and none need be normalised
/// cos_half_angle          the cosine of the angle between the axis and the cone's side, 1 (a ray) to -1 (a whole
///                         sphere); 0 is a half sphere. glTF: cos(outerConeAngle); Unity: of half the spotAngle. A point p
///                         is in the cone if  (p - centre).axis >= cos_half_angle |p - centre| |axis|,  for these floats
///                         and without rounding. The float nearest to a cosine may be above it, and the cone then
///                         narrower by up to 2^-12 radians where it is narrow: round down if your shader has the angle.
///
/// Radius +inf, and an angle of 90 degrees or more, count as the whole sphere. What is bad as a Sphere is bad here, too,
/// as are an axis with a NaN or infinite coordinate or of length zero, and a cosine that is NaN or beyond -1 to 1.
struct Spot {
    float x, y, z, radius;
    float axis_x, axis_y, axis_z, cos_half_angle;

    /// A whole sphere as a spot: for a callable that makes Spots of lights of which some are none.
    static constexpr Spot whole(const Sphere& sphere) {
        return {sphere.x, sphere.y, sphere.z, sphere.radius, 0, 0, 1, -1};
    }

    /// least_sphere(), for what takes spheres only. A Binner takes spots as they are, wherever it takes spheres: in an
    /// array, or made by a callable.
    operator Sphere() const;
};

namespace detail {

/// A point or vector of doubles.
struct Triple {
    double x, y, z;
};

/// Copies anything with x, y and z.
template <class Point> Triple triple(const Point& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Within 2^-51 of itself where no square of a double leaves its range.
inline double length(const Triple& v) {
    return root_of(rounded(v.x * v.x) + rounded(v.y * v.y) + rounded(v.z * v.z));
}

inline bool finite(const Triple& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

/// A sphere around one of doubles whose radius is known within 2^-50 of itself, and its centre within 2^-50 of the radius
/// and 2^-53 of each coordinate. 2^-124 is for what is flushed to zero.
inline Sphere sphere_around_nearly(const Triple& centre, double radius) {
    return sphere_around(centre.x, centre.y, centre.z,
                         rounded(radius * (1 + 0x1p-48)) +
                             rounded((abs_of(centre.x) + abs_of(centre.y) + abs_of(centre.z)) * 0x1p-52) +
                             0x1p-124);
}

inline constexpr Sphere bad_sphere = {0, 0, 0, -1};

}  // namespace detail

/// Returns a sphere that holds every point of a spot: the least there is, but for rounding to floats. Its radius is
/// above the least one's by at most 2^-22 (|x| + |y| + |z| + radius) + 2^-123, and never above the spot's own: where the
/// sphere found is no smaller, from half angles of 90 degrees on, and for an infinite radius, it is the spot's own sphere.
/// Of a bad spot it is a bad Sphere.
inline Sphere least_sphere(const Spot& spot) {
    const detail::Triple axis = {static_cast<double>(spot.axis_x), static_cast<double>(spot.axis_y),
                                 static_cast<double>(spot.axis_z)};
    const double axis_length = detail::length(axis), cosine = static_cast<double>(spot.cos_half_angle),
                 radius = static_cast<double>(spot.radius);
    if (!(axis_length > 0) || !detail::finite(axis) || !(detail::abs_of(cosine) <= 1))
        return detail::bad_sphere;
    const Sphere own = {spot.x, spot.y, spot.z, spot.radius};
    if (cosine <= 0 || spot.radius == detail::infinity) return own;

    // Farthest from a point of the axis lies the apex or the rim, where cone and sphere meet: to 45 degrees the least
    // sphere goes through both, beyond it is the one around the rim. Products of floats are exact in double.
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

inline Spot::operator Sphere() const {
    return least_sphere(*this);
}

/// Returns a sphere that holds all points within `radius` of the line from `a` to `b`, a tube with round ends: the least
/// there is, but for rounding. Its radius is above the least one's by at most 2^-22 of itself and of the sizes of the
/// centre's coordinates, and 2^-123.
///
/// a, b    anything with x, y and z, floats or doubles. NaN or infinite: a bad Sphere
/// radius  +inf gives a sphere that covers everything; negative or NaN, a bad one
template <class Point> Sphere tube_sphere(const Point& a, const Point& b, float radius) {
    const detail::Triple from = detail::triple(a), to = detail::triple(b);
    if (!detail::finite(from) || !detail::finite(to) || !(radius >= 0)) return detail::bad_sphere;
    const double half = 0.5 * detail::length({to.x - from.x, to.y - from.y, to.z - from.z});
    return detail::sphere_around_nearly(
        {0.5 * from.x + 0.5 * to.x, 0.5 * from.y + 0.5 * to.y, 0.5 * from.z + 0.5 * to.z},
        half + static_cast<double>(radius));
}

/// Returns a sphere that holds all points within `range` of a rectangle: the least there is, but for rounding as that of
/// tube_sphere().
///
/// centre          anything with x, y and z, floats or doubles. NaN or infinite: a bad Sphere; so for the next two
/// half_x, half_y  from the centre to the middles of two sides that meet; if not at right angles, the rectangle is a
///                 parallelogram
/// range           +inf gives a sphere that covers everything; negative or NaN, a bad one
template <class Point>
Sphere rectangle_sphere(const Point& centre, const Point& half_x, const Point& half_y, float range) {
    const detail::Triple c = detail::triple(centre), u = detail::triple(half_x), v = detail::triple(half_y);
    if (!detail::finite(c) || !detail::finite(u) || !detail::finite(v) || !(range >= 0))
        return detail::bad_sphere;
    const double half_diagonal = detail::max_of(detail::length({u.x + v.x, u.y + v.y, u.z + v.z}),
                                                detail::length({u.x - v.x, u.y - v.y, u.z - v.z}));
    return detail::sphere_around_nearly(c, half_diagonal + static_cast<double>(range));
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
