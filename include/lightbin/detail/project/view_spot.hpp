// SPDX-License-Identifier: MIT
// A spot in view space, as the kernels read it: the sector of a sphere, here called its ball, that a cone from the
// sphere's centre, the apex, cuts out.
//
// Its numbers are rounded, but each point of the exact spot is within `tolerance` of the sector that these
// numbers describe. So a test against a plane never loses a light if it allows for `tolerance`, and the cone needs no
// wider angle. With the unit roundoff u = 2^-24 and the radius r, the unit axis is within 5u of the exact one, or
// within 18u if it was transformed to view space, and the sine has a relative error of at most 3u. So the sector's
// farthest point in any direction is within 25u r of the exact one. The tolerance is at least 2^-18 r = 64u r; for
// spots given in world space the errors of the transform are added, see world_to_view.hpp.
#pragma once

#include <lightbin/detail/project/light_kind.hpp>
#include <lightbin/detail/view/cell_planes.hpp>
#include <lightbin/sphere.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Spots whose cosine of the half angle is at most this, beyond 138 degrees, count as whole spheres. So do those made
/// by Spot::whole(), which are then listed as the same spheres are. Off other spots the rim's plane would cut next to
/// nothing.
inline constexpr float whole_ball_cosine = -0.75f;

/// A Spot in view space, signed so that tile indices grow with x and y, and z is the view depth. Its axis has length 1.
/// A spot that is a whole sphere has the axis 0, the cosine 0 and the tolerance 0: with these, the half spaces that
/// depth tests compute around a spot contain every point.
struct ViewSpot : Spot {
    /// The spot's least and greatest view depth. Rounding moved neither past any float that a test compares it with.
    float nearest, farthest;
    float tolerance;  ///< how far the exact spot can reach outside of this one, which is rounded to float
    float unused;     ///< fills up the last four numbers, as kernels store four at a time
    CellPlane around[4];  ///< with a depth test, four half spaces around the spot, see store_planes()
};

/// A ViewSpot or ViewBox as the depth tests read it.
template <class Shape> struct TestedShape {
    TestedShape() = default;
    TestedShape(const Shape& of) : shape(&of), nearest(of.nearest), farthest(of.farthest) {}

    const Shape* shape;
    float nearest, farthest;
};

}}}  // namespace lightbin::detail
