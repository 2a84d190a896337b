// SPDX-License-Identifier: MIT
// Vectors of boxes in view space: their sizes, the normals of their faces, and how far they reach in a direction.
// Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/kinds/spots.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A vector of boxes in view space, after the camera's signs. See Box. Reals are Floats, or double in
/// boxes_in_double.hpp.
template <class Reals> struct BoxLanes {
    Reals centre[3], half_axes[3][3], taper;
    /// A bound on how far a corner, computed from these numbers with rounding, is from the exact one, in the sum of
    /// the differences of the three coordinates.
    Reals error;
};

/// Returns the greatest n.p of all points p of boxes, relative to the boxes' centres.
inline Floats reach_from_centre(const BoxLanes<Floats>& box, const Floats (&n)[3]) {
    const Floats along = dot(n, box.half_axes[2]),
                 across = abs(dot(n, box.half_axes[0])) + abs(dot(n, box.half_axes[1]));
    return maximum(across + along, mul(across, box.taper) - along);
}

/// Returns the sum of the absolute values of the half axes' coordinates.
template <class Reals> Reals axes_size(const BoxLanes<Reals>& box) {
    Reals size = Reals{};
    LIGHTBIN_UNROLL for (const Reals(&h)[3] : box.half_axes)
        size = size + (abs(h[0]) + abs(h[1]) + abs(h[2]));
    return size;
}

/// Returns the sum of the absolute values of the centres' and the half axes' coordinates. For each point of a box the
/// sum of the absolute values of its coordinates is at most this.
template <class Reals> Reals size_of(const BoxLanes<Reals>& box) {
    return axes_size(box) + (abs(box.centre[0]) + abs(box.centre[1]) + abs(box.centre[2]));
}

/// Finds normals of the six faces of boxes, which point outward and have any length: faces 2 i and 2 i + 1 are those
/// that half axis i points to and away from. The normals of faces without an area are 0.
///
/// The half axes are first divided by axes_size(), so that products of six of their coordinates neither overflow nor
/// underflow; where that size is too small to divide by, they count as 0. Let h_0, h_1 and h_2 be the half axes, t the
/// taper, and g_i = h_j x h_k for (i, j, k) = (0, 1, 2) and its cyclic permutations. A side of half axis i = 0 or 1
/// contains the other of these two half axes and the directions h_2 +- (1 - t) / 2 h_i, to which +-g_i - (1 - t) / 2
/// g_2 is perpendicular. The product h_i.g_i, which is the same for all i, is negative where the half axes are
/// left-handed, and the normals are then negated. A half axis of zero is replaced by g_i, so that the sides of a flat
/// box have normals in its plane.
inline void find_normals(const BoxLanes<Floats>& box, Floats (&normals)[6][3]) {
    Floats axes[3][3], h[3][3], g[3][3];
    const Floats size = axes_size(box), per_size = select(less(broadcast(0x1p-120f), size), 1.0f / size, Floats{});
    for (unsigned axis = 0; axis < 3; ++axis)
        for (unsigned i = 0; i < 3; ++i)
            axes[axis][i] = mul(box.half_axes[axis][i], per_size);
    for (unsigned i = 0; i < 3; ++i) {
        const auto flat = less_equal(manhattan_length(axes[i]), Floats{});
        for (unsigned k = 0; k < 3; ++k)
            h[i][k] = axes[i][k];
        if (movemask(flat) == 0) continue;
        cross(axes[(i + 1) % 3], axes[(i + 2) % 3], g[i]);
        for (unsigned k = 0; k < 3; ++k)
            h[i][k] = select(flat, g[i][k], axes[i][k]);
    }
    for (unsigned i = 0; i < 3; ++i)
        cross(h[(i + 1) % 3], h[(i + 2) % 3], g[i]);
    const auto left_handed = less(dot(h[2], g[2]), Floats{});
    const Floats narrowing = mul(1.0f - box.taper, broadcast(0.5f));
    for (unsigned i = 0; i < 3; ++i) {
        const Floats tilt = select(left_handed, -mul(narrowing, g[2][i]), mul(narrowing, g[2][i]));
        for (unsigned axis = 0; axis < 3; ++axis) {
            const Floats out = select(left_handed, -g[axis][i], g[axis][i]);
            normals[2 * axis][i] = axis == 2 ? out : out - tilt;
            normals[2 * axis + 1][i] = axis == 2 ? -out : -out - tilt;
        }
    }
}

}}}}  // namespace lightbin::detail
