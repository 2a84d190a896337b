// SPDX-License-Identifier: MIT
// The projection in double of the spheres for which float has no error bound, one at a time, by the scalar tier's
// functions. It is the same function for every tier: few lights of a scene cross the near plane or are tiny or huge.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor
#pragma once
#include <lightbin/detail/project/spheres.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Finds bounds on c / z over that part of a disc with the centre (c, z) and the radius r whose depth is at least
/// near_depth. A bound is infinite where double precision can't decide. For discs that meet the near plane:
/// z - r <= near_depth <= z + r. The arguments are floats that were converted to double: their products are exact, and
/// none overflows.
///
/// The part is convex, so the largest slope c / z is at the point where the tangent touches the circle, if that lies
/// beyond the near plane, and else at the corner where circle and near plane meet. The tangent's slope bounds the whole
/// disc, so it is a correct bound wherever there is a tangent; the corner's is taken only where it is certain to be the
/// largest. The smallest slope is the negative of the largest one of the mirrored disc with the centre (-c, z).
inline void clipped_slopes(double c, double z, double r, double near_depth, double& low, double& high) {
    using scalar::mul;
    constexpr double infinite = static_cast<double>(infinity);
    const double a = abs_of(c);
    // The squared half of the chord that the near plane cuts off.
    const double h2 = mul(r - (near_depth - z), r + (near_depth - z));
    const double h2_error = mul(r, r) * 0x1p-50;
    const double h = root_of(scalar::maximum(h2, 0.0) + h2_error);  // rounded up
    const double h_low = root_of(scalar::maximum(h2 - h2_error, 0.0));

    // The circle around (c, z) meets the near plane in the corner (c + h, near_depth). There it leads beyond the plane
    // in the direction (z - near_depth, h), in which the slope, coordinate / depth, grows as
    // (near_depth, -(c + h)) . (z - near_depth, h).  So the tangent of the largest slope touches beyond the near plane
    // if and only if  near_depth (z - near_depth) > h (c + h),  where the outer tangent has c = |c| = a and the inner
    // one c = -a.
    const double doubt = (mul(h, h) + mul(a, h) + mul(near_depth, abs_of(z) + near_depth)) * 0x1p-48;
    const double tangent_side = mul(near_depth, z - near_depth) + doubt, square = mul(h_low, h_low);
    const bool outer_cut = tangent_side < square + mul(a, h_low), inner_cut = tangent_side < square - mul(a, h);
    const double corner_error = (a + h) * 0x1p-48;

    // The squared length t2 of the tangent from eye to sphere is not positive if the eye is on the sphere or inside.
    const double squares = mul(a, a) + mul(z, z), t2 = squares - mul(r, r);
    const double error = (squares + mul(r, r)) * 0x1p-50 / t2 + 0x1p-48;  // relative error of a tangent's slope
    const bool has_tangent = 0 < t2 && error <= 0x1p-20;
    // Each sum has terms of one sign, so that none cancels. If the sphere reaches behind the eye, z <= r, the outer
    // tangent points backward and bounds nothing.
    const double az = mul(a, z), rt = mul(r, root_of(t2)), e = mul(z - r, z + r);
    double outer = infinite, inner = infinite;
    if (outer_cut) {
        outer = (h + a + corner_error) / near_depth;
    } else if (has_tangent && r < z) {
        outer = (az + rt) / e;
        outer = outer + mul(abs_of(outer), error);
    }
    if (inner_cut) {
        inner = (h - a + corner_error) / near_depth;
    } else if (has_tangent) {
        inner = z < 0 ? (rt - az) / e : mul(r - a, r + a) / (rt + az);
        inner = inner + mul(abs_of(inner), error);
    }
    low = c < 0 ? -outer : -inner;
    high = c < 0 ? inner : outer;
}

/// Finds bounds along the image axes of the part of a sphere beyond the near plane.
///
/// sphere  the centre (x, y, z), signed so that tile indices grow with x and y, and z is the view depth, and the
///         radius: floats that were converted to double
inline void bounds_in_double(const Camera& camera, const double (&sphere)[4], double (&low)[2], double (&high)[2]) {
    // A radius of 0 is enlarged to much less than any float's rounding error, so that no square root is taken of 0.
    const double z = sphere[2], radius = sphere[3], r = max_of(radius, 0x1p-400);
    const double near_depth = static_cast<double>(camera.near_depth), e = scalar::mul(z - radius, z + radius);
    for (unsigned axis = 0; axis < 2; ++axis) {
        low[axis] = sphere[axis] - r;
        high[axis] = sphere[axis] + r;
        if (camera.orthographic) continue;
        if (near_depth < z - radius)
            scalar::tangent_slopes(sphere[axis], z, r, e, 1 / e, low[axis], high[axis]);
        else
            clipped_slopes(sphere[axis], z, r, near_depth, low[axis], high[axis]);
    }
}

inline bool project_in_double(const Camera& camera, const Sphere& sphere, std::uint32_t i, ChunkRects& rects,
                              ProjectCounts& counts) {
    const double in_view[] = {static_cast<double>(sphere.x) * static_cast<double>(camera.x.sign),
                              static_cast<double>(sphere.y) * static_cast<double>(camera.y.sign),
                              static_cast<double>(sphere.z) * static_cast<double>(camera.z_sign),
                              static_cast<double>(sphere.radius)};
    const double z = in_view[2], radius = in_view[3];
    const bool good = is_finite(in_view[0]) && is_finite(in_view[1]) && is_finite(z) && 0 <= radius;
    counts.rejected += !good && !is_off(radius);
    if (!good || z + radius < static_cast<double>(camera.near_depth) ||
        static_cast<double>(camera.far_depth) < z - radius)
        return false;
    scalar::ImageBounds<double> bounds;
    bounds_in_double(camera, in_view, bounds.low, bounds.high);
    return scalar::tile_rects<double>(camera, bounds, true, rects, i);
}

}}}  // namespace lightbin::detail
