// SPDX-License-Identifier: MIT
// A spot in view space, as the kernels take it.
//
// Its floats are rounded, but every point of the true spot is within `blur` of the part of the ball that the cone of
// these floats holds, the cone's sector. So a test against a plane is right that asks for `blur` more, and no angle has to
// be made wider. With u = 2^-24, r the radius: the axis is within 5u of the true one, the sine within 3u of itself, and so
// the sector's farthest point in any direction is within 10u r of the true one. 2^-18 = 64u is blur / r at least; in world
// space what the move adds comes to it.
#pragma once

#include <lightbin/detail/camera.hpp>
#include <lightbin/detail/cell_boxes.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/sphere.hpp>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// Four vec4s. Of a whole sphere the axis is 0, the sine 1 and `least` the ball.
struct ViewSpot {
    Sphere ball;
    float axis_x, axis_y, axis_z, cosine;  ///< the axis of unit length; of the half angle, 0 to 1
    Sphere least;                          ///< holds the spot, see least_sphere()
    float nearest, farthest;               ///< view depths
    float sine, blur;
};

/// What floats can make a ViewSpot of; others are binned as their least spheres. Squares neither over- nor underflow.
struct PlainSpots {
    static constexpr float least_size = 0x1p-40f, most_size = 0x1p40f;  ///< radius; and of the centre's |x| + |y| + |z|
    static constexpr float least_axis = 0x1p-20f, most_axis = 0x1p20f;  ///< |x| + |y| + |z|
};

/// A spot as the depth tests see it, see TestedLight.
struct TestedSpot {
    TestedSpot() = default;
    TestedSpot(const Camera& camera, const ViewSpot& spot)
        : ball(camera, spot.ball), least(camera, spot.least), radius(spot.ball.radius), nearest(spot.nearest),
          farthest(spot.farthest), axis_x(camera.x.sign * spot.axis_x), axis_y(camera.y.sign * spot.axis_y),
          axis_z(camera.z_sign * spot.axis_z), cosine(spot.cosine), sine(spot.sine), blur(spot.blur) {}

    TestedLight ball, least;
    float radius, nearest, farthest;
    float axis_x, axis_y, axis_z, cosine, sine, blur;
};

/// A light as a depth test sees it, by whether the lights are spots.
template <bool spots> struct Tested {
    using Light = TestedLight;
};
template <> struct Tested<true> {
    using Light = TestedSpot;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail

#include <lightbin/detail/warnings_on.inl>
