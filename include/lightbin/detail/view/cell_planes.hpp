// SPDX-License-Identifier: MIT
// Half spaces around a light, and how a depth test finds that a tile's cell lies outside of one of them.
//
// A half space holds the points p with  n.p <= most,  where n is a vector of any length. A cell is part of the view
// frustum: its points are (s z, t z, z)  with a perspective projection and  (s, t, z)  with an orthographic one, where
// s and t lie between the edges of the tile, see tile_edges(), and the view depth z lies between z0 and z1. The cell
// lies outside of the half space if its point with the least n.p does:
//     perspective:     (n_x s + n_y t + n_z) z > most,     orthographic:  n_x s + n_y t + n_z z > most.
// Each of s and t is the low edge where n_x or n_y is positive, the high edge where it is negative. With an
// orthographic projection z is z0 where n_z is positive, z1 where it is negative. With a perspective projection z is
// z0 where `most` is positive, z1 where it is negative: if the inequality holds for this z, it holds for all depths of
// the cell. Where the number that decides is 0, both choices are right. Unlike a test of the box around the cell, this
// test is exact for one half space.
//
// Rounding, with u = 2^-24: let S be |P_x| + |P_y| + |P_z| + r of a light in a ball around P with the radius r, and of
// a box the sum of the absolute values of all coordinates of its centre and half axes. Let n have the length 1: with
// other lengths, all numbers below but for those of underflow grow with the length. A cell that holds a point p of the
// light is not rejected if  n.p <= most - 4u S.  Rounding is monotone: an expression of floats is at most what the same
// expression, rounded likewise, gives for larger operands.
// - Edges are rounded outward by more than the rounding error of a product, so each rounded product of an edge is at
//   most that of p, but for underflow of 2^-126. The rounded sum of both exceeds the sum of p's by at most u |p|,
//   divided by z if perspective.
// - perspective: the next sum adds u |p| / z, so the factor of z is at most  (n.p + 2.1u |p|) / z_p,  where z_p is the
//   depth of p. |p| is at most S, so the factor times z_p is at most `most`. Then so is the factor times z: if `most`
//   is positive, z is at most z_p, else the factor is negative and z is at least z_p. Rounding this product can't raise
//   it above `most`, which is a float.
// - orthographic: the rounded n_z z is at most n_z p_z + u |p|, and the last sum adds u |p|.
// What is left of 4u S exceeds the underflow, as S is at least 2^-62: a spot whose half spaces are tested has a radius
// of at least 2^-40, before a transform that shrinks it to no less than 2^-21 of that. Boxes may be smaller, and the
// sums of their normals' absolute values are from 2^-50 on, so 2^-100 is added to their `most`. With an orthographic
// projection this exceeds the underflow. With a perspective one, the underflow is at most 2^-124 z_p, where S is at
// least z_p, and what is left of 4u S |n| is at least 2^-74 z_p; and if `most` is negative, the last product is below
// -2^-101, so that it does not underflow.
//
// An edge or a depth may be infinite: products of 0 and infinity, and sums of opposite infinities, are NaN, which
// rejects no cell.
#pragma once

#include <lightbin/detail/view/cell_boxes.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The edges of a block's 64 tiles, by tile_edges(): first all low edges, then all high ones.
struct TileEdges {
    /// The elements where the high edges begin. A vector of sixteen floats is two rows of 8 tiles: so x has its 8
    /// columns twice, and y has 16 elements more than 64, as the vector stored for the last row ends there.
    static constexpr unsigned high_x = 16, high_y = 64 + 16;

    float x[2 * high_x];  ///< the low edges of 8 tile columns from element 0 on, their high edges from high_x on
    float y[2 * high_y];  ///< the low edges of 64 tiles, row by row, from element 0 on, their high edges from high_y on
};

/// A half space of the points p with  x p_x + y p_y + z p_z <= most.
struct CellPlane {
    float x, y, z, most;
};

/// Returns `offset` if a number has its sign bit set, else 0. It selects low or high edges, or near or far depths,
/// without a branch, as the sign of a plane's normal can't be predicted.
inline std::int32_t offset_if_negative(float number, std::int32_t offset) {
    return bit_cast<std::int32_t>(number) >> 31 & offset;
}
}}}  // namespace lightbin::detail
