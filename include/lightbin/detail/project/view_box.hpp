// SPDX-License-Identifier: MIT
// A Box in view space, as the kernels read it.
//
// Its numbers are rounded to float. A test that compares a linear form n.p with its greatest value m over the points
// p of this rounded box loses no light if it allows for |n| times `tolerance` more, and it does so whatever n is:
// errors in the normals of the box's faces make tests looser, not wrong. The tolerance is a bound on the distance of
// any point of the exact box, the convex hull of its exact corners, from the rounded one, and 16u S more, where u =
// 2^-24 and S is the sum of the absolute values of all coordinates of the centre and the half axes: computing m in
// float takes at most 11u S.
#pragma once

#include <lightbin/detail/project/view_spot.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// A Box in view space, after the camera's signs: tile indices grow with x and y, and z is the view depth. Its radius
/// is +inf where its ball, the sphere that cuts it, holds all of the box.
struct ViewBox : Box {
    float nearest, farthest;  ///< view depths between which the part of the box in the ball lies
    float tolerance;      ///< how far the exact box can reach outside of this one; +inf where the box has no bounds
    CellPlane around[6];  ///< with a depth test, a half space for each face of the box, see store_box_planes()
};

}}}  // namespace lightbin::detail
