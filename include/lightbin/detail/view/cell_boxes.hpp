// SPDX-License-Identifier: MIT
// The view-space box around a tile's cell, which the depth test tests spheres against (Thomas, "Advancements
// in Tiled-Based Compute Rendering", GDC 2015; Stewart, "Compute-Based Tiled Culling", GPU Pro 6).
//
// A cell lies between two depths and, along each of x and y, between two planes, which pass through the eye
// (perspective) or are parallel to the viewing direction (orthographic). Between the depths z0 and z1, 0 < z0, the
// planes of slope s0 and s1 through the eye bound the coordinate by  min(s0 z0, s0 z1)  and  max(s1 z0, s1 z1).
//
// Rounding, u = 2^-24. Outward everywhere:
// - an edge's slope is computed in double: the offset may be off by 2^-51 of its parts, the quotient by a few
//   2^-53 of itself. It is moved outward by 2^-48 and 2^-21 of these, and rounding to float takes u.
// - slope * depth takes another u, so the product is still outward of the truth: 2^-21 = 8u. Underflow, or a
//   caller who flushes denormal numbers to zero, takes up to 2^-126; `flushed` is more.
// - the distance along an axis is within u of the truth, its square 3u, the sum of three squares 5u (sums of
//   terms of one sign). The squared radius loses 3u. 2^-20 = 16u makes up for the 8u, and 2^-125 for squares
//   that are flushed to zero. What overflows to infinity did so in both or in the sphere's favour, since all
//   roundings are monotone; infinity is not beyond infinity.
// - in a slice (SlabCells) the squared distances along z and y are subtracted from the squared radius, and the
//   rest is compared with that along x. Where a sphere meets a box, each difference loses at most u of the squared
//   radius, like a sum above. Two differences that are flushed to zero lose 2^-125. The 2^-125 that is added covers
//   these or a squared radius that is flushed, never both: with a flushed radius the rest is 2^-125 - 0 - 0, which is
//   not flushed.
#pragma once

#include <lightbin/options.hpp>
#include <lightbin/sphere.hpp>
#include <lightbin/view.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {
inline constexpr float flushed = 0x1p-120f;

/// Finds a tile's two edges along an image axis, `low` rounded down and `high` rounded up: slopes with a perspective
/// projection, view-space coordinates with an orthographic one. All of the tile's pixels lie between them.
inline void tile_edges(const ImageAxis& axis, int tile, float& low, float& high) {
    constexpr double most = static_cast<double>(FLT_MAX);
    const double error = 0x1p-48 * (abs_of(axis.offset) + axis.tiles + 1) + axis.split.overhang();
    const double end = min_of(tile + 1.0, static_cast<double>(axis.limit));
    double from = (tile - axis.offset - error) / axis.scale, to = (end - axis.offset + error) / axis.scale;
    from -= abs_of(from) * 0x1p-21 + 0x1p-100;
    to += abs_of(to) * 0x1p-21 + 0x1p-100;
    low = from < -most ? -infinity : static_cast<float>(min_of(from, most));
    high = to > most ? infinity : static_cast<float>(max_of(to, -most));
}

/// The boxes around all cells of a depth slice. They share their depths z0 to z1 and differ only by column and by row.
struct SlabBoxes {
    const float* ends[4] = {};  ///< four arrays: cell boxes' low and high x by tile column, low and high y by tile row
    float z0 = 0, z1 = 0;
};

/// Returns the squared radius of a sphere, enlarged by the margin that the head of this file derives.
inline float reach2_of(float radius) {
    return rounded(rounded(radius * radius) * (1 + 0x1p-20f)) + 0x1p-125f;
}

/// A sphere as the depth test reads it, in view space. The camera's signs are applied: tile indices grow with x and y,
/// and z is the view depth.
struct TestedLight {
    TestedLight() = default;
    TestedLight(const Camera& camera, const Sphere& light)
        : TestedLight({camera.x.sign * light.x, camera.y.sign * light.y, camera.z_sign * light.z, light.radius}) {}
    /// Takes a sphere with the camera's signs applied: tile indices grow with its x and y, and z is its view depth.
    explicit TestedLight(const Sphere& light)
        : x(light.x), y(light.y), z(light.z), nearest(z - light.radius), farthest(z + light.radius),
          reach2(reach2_of(light.radius)) {}

    float x, y, z;
    /// The sphere's view depths. Rounding is monotone: these meet all intervals of floats that the exact depths meet.
    float nearest, farthest;
    float reach2;             ///< the sphere's squared radius, enlarged by a margin for rounding: reach2_of()
};
}}}  // namespace lightbin::detail
