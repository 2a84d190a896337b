// SPDX-License-Identifier: MIT
// Stability: settled.
// Sphere, Spot and Box, the regions that lights can reach, and the usual falloff of a light to nothing at its range. A
// program that bins Spots or Boxes includes spot.hpp or box.hpp, too.
#pragma once

#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/rounding.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The sphere outside of which a light gives no light: centre and radius, in the units of the space that the lights are
/// given in. That is view space, which the projection matrix is applied to, or with world_space() world space.
///
/// Radius 0 is a point; radius +inf covers everything. A light with the radius -1 is switched off: it is in no list,
/// whatever its other numbers are. A light with a NaN or infinite centre, or a radius that is NaN or another negative
/// number, is bad input: it is skipped and counted, and all other lights are binned as usual.
struct Sphere {
    float x, y, z, radius;
};

/// The region that a spot light can reach: the points of a sphere in a cone from its centre. In memory two vec4s.
///
/// axis_x, axis_y, axis_z  the direction in which the light shines, of any length but zero
/// cos_half_angle          cosine of the angle between the axis and the cone's side: 1 for a ray, 0 for a half sphere,
///                         -1 for a whole sphere, whatever the axis. glTF: cos(outerConeAngle); Unity: cosine of half
///                         the spotAngle.
///
/// A point p is in the cone if  (p - centre).axis >= cos_half_angle |p - centre| |axis|,  evaluated without rounding
/// for the floats given. The float nearest to a cosine may be above the cosine, which makes the cone narrower: by up to
/// 2^-12 radians where it is narrow. If your shader compares with the angle itself, round the cosine down.
///
/// With a half angle above 90 degrees a spot is listed where its convex hull reaches, its sphere cut off at the circle
/// in which cone and sphere meet. With radius +inf, or a cosine of -0.75 or less, it is treated as its whole sphere.
/// What is bad input in a Sphere is so in a Spot, as are a cosine that is NaN or outside -1 to 1 and, unless the cosine
/// is -1, an axis with a NaN or infinite coordinate or of length zero.
struct Spot {
    float x, y, z, radius;
    float axis_x, axis_y, axis_z, cos_half_angle;

    /// A spot that covers a whole sphere, for callables that return Spots although some of their lights are spheres.
    static constexpr Spot whole(const Sphere& sphere) {
        return {sphere.x, sphere.y, sphere.z, sphere.radius, 0, 0, 1, -1};
    }
};

/// The region that a decal, a probe, a projector or a light in a room can reach: the points of a sphere that lie in
/// an oriented box. It is listed where both reach.
///
/// x, y, z, radius      the sphere. With radius +inf it covers everything, and the region is the whole box.
/// box_x, box_y, box_z  the box's centre
/// half_axes            vectors from the box's centre to the middles of three of its faces. They need not be at right
///                      angles. One that is zero makes the box flat, two make it a line segment.
/// taper                how large the face at centre - half_axes[2] is, as a fraction of the face at centre +
///                      half_axes[2]: 1 for a box, 0 for a pyramid, between them a frustum
///
/// The points of the box are  centre + a k half_axes[0] + b k half_axes[1] + c half_axes[2]  with a, b and c from -1
/// to 1, and  k = (1 + taper + c (1 - taper)) / 2.
///
/// What is bad input in a Sphere is so in a Box, as are coordinates that are NaN or infinite, three half axes of zero,
/// and a taper that is NaN or not from 0 to 1.
struct Box {
    float x, y, z, radius;
    float box_x, box_y, box_z;
    float half_axes[3][3];
    float taper = 1;
};

/// A point of world space.
struct WorldPoint {
    double x, y, z;
};

/// A Sphere, Spot or Box in a large world, whose centres, the sphere's and the box's, are relative to `origin`. That is
/// the light's own position, with centres of 0, or a sector's origin. world_space() with an eye takes these.
template <class Light> struct Placed {
    WorldPoint origin;
    Light light;
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
/// show. With SnippetOptions::window shaders get a function for the same factor. Range +inf gives 1.
inline float light_window(float distance, float range) {
    if (!(distance < range)) return 0;
    const float x = distance / range, w = 1 - x * x * x * x;
    return w * w;
}

namespace detail {

/// Whether a light is switched off: see Sphere.
inline bool is_off(double radius) {
    return radius <= -1 && radius >= -1;
}

/// Returns the sphere stored at `from`. The memory may hold objects of any type with the layout of a Sphere: its bytes
/// are copied, because access through a Sphere pointer would break the aliasing rules.
inline Sphere load_sphere(const Sphere* from) {
    Sphere sphere;
    std::memcpy(&sphere, from, sizeof sphere);
    return sphere;
}

}  // namespace detail

}}  // namespace lightbin
