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
#include <lightbin/options.hpp>
#include <lightbin/sphere.hpp>

#include <cstdint>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// The half space of the points with  x p_x + y p_y + z p_z <= most.
struct SpotPlane { float x, y, z, most; };

/// Seven vec4s. Of a whole sphere the axis is 0 and the sine 1, and no plane leaves out anything.
struct ViewSpot {
    Sphere ball;                           ///< view space as the caller has it, as is the axis
    float axis_x, axis_y, axis_z, cosine;  ///< the axis of unit length; of the half angle, 0 to 1
    float nearest, farthest;               ///< view depths
    float sine, blur;
    /// For boxes: half spaces around the cone, through the apex but for rounding. Here x and y are as in an ImageAxis, z
    /// is the view depth.
    SpotPlane planes[4];
};

/// What floats can make a ViewSpot of; others are binned as their least spheres. Squares neither over- nor underflow.
struct PlainSpots {
    static constexpr float least_size = 0x1p-40f, most_size = 0x1p40f;  ///< radius; and of the centre's |x| + |y| + |z|
    static constexpr float least_axis = 0x1p-20f, most_axis = 0x1p20f;  ///< |x| + |y| + |z|
};

/// A spot as the depth tests see it, see TestedLight. For each plane, which ends of a box are farthest from it, outward:
/// where their coordinates begin in a cell's planes of 64 floats, see arrange_cells().
struct TestedSpot {
    TestedSpot() = default;
    TestedSpot(const Camera& camera, const ViewSpot& of)
        : spot(&of), ball(camera, of.ball), nearest(of.nearest), farthest(of.farthest) {
        for (unsigned i = 0; i < 4; ++i) {
            const SpotPlane& plane = of.planes[i];
            ends[i][0] = static_cast<std::uint16_t>(128 + 64 * (plane.x < 0));
            ends[i][1] = static_cast<std::uint16_t>(256 + 64 * (plane.y < 0));
            ends[i][2] = static_cast<std::uint16_t>(64 * (plane.z < 0));
        }
    }

    const ViewSpot* spot;
    TestedLight ball;
    float nearest, farthest;
    std::uint16_t ends[4][3];
};

/// The same for the interval test.
struct SpotDepths {
    SpotDepths() = default;
    SpotDepths(const Camera&, const ViewSpot& of) : nearest(of.nearest), farthest(of.farthest) {}

    float nearest, farthest;
};

/// A light as a depth test sees it, by whether the lights are spots.
template <bool spots, DepthTest depth_test> struct Tested {
    using Light = TestedLight;
};
template <DepthTest depth_test> struct Tested<true, depth_test> {
    using Light = std::conditional_t<depth_test == DepthTest::interval, SpotDepths, TestedSpot>;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail

#include <lightbin/detail/warnings_on.inl>
