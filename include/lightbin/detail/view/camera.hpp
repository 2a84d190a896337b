// SPDX-License-Identifier: MIT
// Camera: the constants of a View that the projection and the depth tests read.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

class View;

namespace detail {

/// How one image axis, x or y, maps view space to tiles. A point with the coordinate c, multiplied by `sign`, and the
/// view depth d is projected to  scale * (c / d) + offset  tiles with a perspective projection, and to
/// scale * c + offset  with an orthographic one.
struct ImageAxis {
    double scale = 0;  ///< tiles per unit of slope, which is c / d (orthographic: per unit of c); greater than 0
    double offset = 0;
    float sign = 1;    ///< 1, or -1 where tile indices grow as the view-space coordinate falls
    float margin = 0;  ///< an upper bound on the error, in tiles, of a coordinate in the viewport that float computes
    float limit = 0;   ///< the viewport's extent in tiles, fractional for a partial tile, rounded up to a float
    float last_tile_centre = 0;  ///< coordinates in tiles are clamped to it, then truncated to tile indices
    /// Unit normal (normal, normal_z) of a plane through the eye that has the whole viewport on its inner side. So has
    /// its mirror image: a point with the coordinate c and the view depth d is out of view if
    /// normal * |c| + normal_z * d > 0. Both are 0 with an orthographic projection, which has no such plane.
    float normal = 0, normal_z = 0;
    int tiles = 0;
};

/// The constants of a View that projection and depth tests read.
struct Camera {
    ImageAxis x, y;
    float z_sign = 1;      ///< view depth = z_sign * z, so that it grows away from the eye
    float near_depth = 0;  ///< view depth of the near plane, rounded down
    float far_depth = 0;   ///< view depth of the far plane, rounded up; +inf where there is none
    float min_float_depth = 0;  ///< spheres that lie entirely beyond this view depth can be projected in float
    bool orthographic = false;
};

const Camera& camera_of(const View& view);

struct Projection;
const Projection& projection_of(const View& view);

}  // namespace detail
}}  // namespace lightbin
