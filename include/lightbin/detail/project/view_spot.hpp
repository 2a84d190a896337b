// SPDX-License-Identifier: MIT
// A spot in view space, as the kernels take it.
//
// Its floats are rounded, but every point of the true spot is within `blur` of the part of the ball that the cone of
// these floats holds, the cone's sector. So a test against a plane is right that asks for `blur` more, and no angle has to
// be made wider. With u = 2^-24, r the radius: the axis is within 5u of the true one, moved to view space within 18u, the
// sine within 3u of itself, and so the sector's farthest point in any direction is within 25u r of the true one. 2^-18 = 64u
// is blur / r at least; in world space what else the move takes comes to it, see world_to_view.hpp.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/detail/project/camera.hpp>
#include <lightbin/sphere.hpp>

#include <cstdint>
#include <type_traits>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The half space of the points with  x p_x + y p_y + z p_z <= offset.
struct SpotPlane {
    float x, y, z, offset;
};

/// A spot: x and y are as in an ImageAxis, z is the view depth. Of a whole sphere the axis is 0 and the sine 1, and no
/// plane leaves out anything.
struct ViewSpot {
    Sphere ball;
    float axis_x, axis_y, axis_z, cosine;  ///< the axis of unit length; of the half angle, 0 to 1
    float nearest, farthest;  ///< view depths; rounding is monotone, so comparing them with floats is exact
    float sine, blur;
    /// For boxes: half spaces around the cone, through the apex but for rounding.
    SpotPlane planes[4];
    /// And which corner of a box is deepest in each: where its coordinates begin among a supertile's, see arrange_cells().
    std::uint16_t corners[4][3];
};

/// A spot as the depth tests see it.
struct TestedSpot {
    TestedSpot() = default;
    TestedSpot(const Camera&, const ViewSpot& of) : spot(&of), nearest(of.nearest), farthest(of.farthest) {}

    const ViewSpot* spot;
    float nearest, farthest;
};

/// A light as a depth test sees it, by whether the lights are spots.
template <bool spots> using Tested = std::conditional_t<spots, TestedSpot, TestedLight>;

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
