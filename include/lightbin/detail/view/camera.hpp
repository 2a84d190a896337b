// SPDX-License-Identifier: MIT
// Camera: the constants of a View that the projection and the depth tests read.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

class View;

namespace detail {

/// How tiles divide one side of the viewport: `pixels` pixels are as long as `tiles` tiles. So tiles of t pixels are t
/// pixels to 1 tile, and N tiles along the side are all its pixels to N tiles. A pixel belongs to the tile that its
/// centre lies in, of two tiles that meet there to the second one: shader_snippet() computes the same.
struct TileSplit {
    int side = 0, pixels = 1, tiles = 1;

    /// The number of tiles, the last of which may be partly beyond the side's end.
    int count() const {
        return static_cast<int>((std::int64_t{side} * tiles + pixels - 1) / pixels);
    }
    int tile_of(int pixel) const {
        return static_cast<int>((2 * std::int64_t{pixel} + 1) * tiles / (2 * std::int64_t{pixels}));
    }
    /// Returns the first pixel of a tile, or of the tiles behind it if the tile has none: the first whose centre is not
    /// before the tile,  (2 pixel + 1) / 2 >= tile pixels / tiles.
    int first_pixel(int tile) const {
        const std::int64_t first = (2 * std::int64_t{tile} * pixels + tiles - 1) / (2 * std::int64_t{tiles});
        return static_cast<int>(min_of(first, std::int64_t{side}));
    }
    double pixels_of(double in_tiles) const { return in_tiles * pixels / tiles; }
    double tiles_of(double in_pixels) const { return in_pixels * tiles / pixels; }
    /// How far a tile's pixels may reach beyond its edges, in tiles: half a pixel where edges cut pixels, else 0.
    double overhang() const { return pixels % tiles == 0 ? 0 : tiles_of(0.5); }
};

/// How one image axis, x or y, maps view space to tiles. A point with the coordinate c, multiplied by `sign`, and the
/// view depth d is projected to  scale * (c / d) + offset  tiles with a perspective projection, and to
/// scale * c + offset  with an orthographic one.
struct ImageAxis {
    double scale = 0;  ///< tiles per unit of slope, which is c / d (orthographic: per unit of c); greater than 0
    double offset = 0;
    float sign = 1;    ///< 1, or -1 where tile indices grow as the view-space coordinate falls
    /// An upper bound on the error, in tiles, of a coordinate in the viewport that float computes, plus the overhang
    float margin = 0;
    float limit = 0;   ///< the viewport's extent in tiles, fractional for a partial tile, rounded up to a float
    float last_tile_centre = 0;  ///< coordinates in tiles are clamped to it, then truncated to tile indices
    /// Unit normal (normal, normal_z) of a plane through the eye that has the whole viewport on its inner side. So has
    /// its mirror image: a point with the coordinate c and the view depth d is out of view if
    /// normal * |c| + normal_z * d > 0. Both are 0 with an orthographic projection, which has no such plane.
    float normal = 0, normal_z = 0;
    int tiles = 0;
    TileSplit split;
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
