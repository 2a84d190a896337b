// SPDX-License-Identifier: MIT
// What the stages read of a View.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

class View;

namespace detail {

/// One image axis of a camera, oriented so that the tile index grows with the coordinate. A point with
/// coordinate c (after the sign) and view depth d lands at  scale * (c / d) + offset  tiles (perspective)  or
/// scale * c + offset (orthographic). Off-centre, jittered, reversed, flipped cameras differ in these numbers
/// only.
struct ImageAxis {
    double scale = 0;  ///< > 0
    double offset = 0;
    float sign = 1;    ///< of the view-space coordinate
    float margin = 0;  ///< bound on the error of a float tile coordinate inside the viewport, in tiles
    float limit = 0;   ///< the viewport's far edge in tiles, rounded up
    float inside = 0;  ///< a coordinate in the last tile
    /// A plane through the eye with the whole viewport on one side, and so its mirror image: points at depth
    /// d with  side * |c| + side_z * d > 0  are out of view. Of unit length; 0 if there is no such plane.
    float side = 0, side_z = 0;
    int tiles = 0;
};

/// Everything the projection stage needs to know of a view.
struct Camera {
    ImageAxis x, y;
    float z_sign = 1;      ///< view depth = z_sign * z
    float near_depth = 0;  ///< rounded down
    float far_depth = 0;   ///< rounded up, may be +inf
    float min_float_depth = 0;   ///< spheres beyond it are projected in float: near_depth, but at least float_safe_min
    bool orthographic = false;
};

/// The constants of a view. Defined in view.hpp.
const Camera& camera_of(const View& view);

}  // namespace detail
}}  // namespace lightbin
