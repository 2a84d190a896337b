// SPDX-License-Identifier: MIT
// A spot in view space, as the kernels read it: the sector of a sphere, here called its ball, that a cone from the
// sphere's centre, the apex, cuts out.
//
// A ViewSpot holds rounded numbers, but each point of the exact spot is within `tolerance` of the sector that these
// numbers describe. So a test against a plane never loses a light if it allows for `tolerance`, and the cone needs no
// wider angle. With the unit roundoff u = 2^-24 and the radius r, the unit axis is within 5u of the exact one, or
// within 18u if it was transformed to view space, and the sine has a relative error of at most 3u. So the sector's
// farthest point in any direction is within 25u r of the exact one. The tolerance is at least 2^-18 r = 64u r; for
// spots given in world space the errors of the transform are added, see world_to_view.hpp.
#pragma once

#include <lightbin/detail/engine/cell_boxes.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The half space of the points p with  x p_x + y p_y + z p_z <= offset.
struct SpotPlane {
    float x, y, z, offset;
};

/// A spot in view space, signed so that tile indices grow with x and y, and z is the view depth. A spot that is a whole
/// sphere has the axis 0, the sine 1 and the tolerance 0, so that no plane excludes any of it.
struct ViewSpot {
    Sphere ball;                           ///< the sphere that the cone cuts; its centre is the cone's apex
    float axis_x, axis_y, axis_z, cosine;  ///< the cone's unit axis; the cosine of the half angle, from 0 to 1
    /// The spot's view depths, rounded. Rounding is monotone: they meet each interval of floats that exact ones meet.
    float nearest, farthest;
    float sine;               ///< sine of the half angle
    float tolerance;          ///< how far the exact spot can reach outside of this one, which is rounded to float
    /// With a depth test against boxes, four half spaces around the cone, whose planes touch the apex but for rounding.
    SpotPlane planes[4];
    /// For each of the half spaces in `planes`, which corner of an axis-aligned box lies deepest inside: where the
    /// corner's x, y and z begin in the array of a block's boxes that arrange_cells() makes.
    std::uint16_t corners[4][3];
};

/// A spot as the depth tests read it.
struct TestedSpot {
    TestedSpot() = default;
    TestedSpot(const Camera&, const ViewSpot& of) : spot(&of), nearest(of.nearest), farthest(of.farthest) {}

    const ViewSpot* spot;
    float nearest, farthest;
};

/// The type of lights that the depth tests read: TestedSpot for spots, TestedLight for spheres.
template <bool spots> using Tested = std::conditional_t<spots, TestedSpot, TestedLight>;

}}}  // namespace lightbin::detail
