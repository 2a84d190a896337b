// SPDX-License-Identifier: MIT
// The transform of spots to view space, whose rounding view_spot.hpp derives. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/project/spheres_around_shapes.hpp>
#include <lightbin/detail/project/world_to_view.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The members of a vector of ViewSpots, one for each lane, and the sines of their half angles.
struct SpotLanes {
    Floats apex[3], radius, axis[3], cosine, sine, tolerance;
};

/// Returns |x| + |y| + |z| of vectors (x, y, z).
LIGHTBIN_INLINE Floats manhattan_length(const Floats (&v)[3]) {
    return abs(v[0]) + abs(v[1]) + abs(v[2]);
}

/// In each lane whose bit in `which` is set, stores as spots.apex and spots.radius the spot's bounding_sphere() in view
/// space, in place of the sphere that the cone cuts.
///
/// given  the spots as they were given
LIGHTBIN_NOINLINE inline void use_least_spheres(const WorldToView* to_view, unsigned which, const Spot* given,
                                                SpotLanes& spots) {
    Sphere moved[lanes];
    store_spheres(moved, spots.apex[0], spots.apex[1], spots.apex[2], spots.radius);
    for (; which != 0; which &= which - 1) {
        const unsigned lane = static_cast<unsigned>(std::countr_zero(which));
        const Sphere least = bounding_sphere(given[lane]);
        moved[lane] = to_view != nullptr ? (*to_view)(least) : least;
    }
    load_spheres(moved, spots.apex[0], spots.apex[1], spots.apex[2], spots.radius);
}

/// Transforms a vector of spots to view space, signed so that tile indices grow with x and y, and z is view depth.
///
/// given  the spots as they were given
LIGHTBIN_INLINE void load_spots(const Camera& camera, const TransformLanes& transform, const Spot* given,
                                SpotLanes& spots) {
    Floats apex[3], axis[3], cosine;
    load_vec4s(given, sizeof *given, apex[0], apex[1], apex[2], spots.radius);
    load_vec4s(&given->axis_x, sizeof *given, axis[0], axis[1], axis[2], cosine);
    const Floats given_radius = spots.radius, axis_size = manhattan_length(axis);
    // A mask of the spots with which float can compute without overflow and underflow.
    auto safe =
        both(less_equal(manhattan_length(apex), broadcast(float_safe_max)), less_equal(abs(cosine), broadcast(1.0f)));
    safe = both(safe, both(less_equal(broadcast(float_safe_min), given_radius),
                           less_equal(given_radius, broadcast(float_safe_max))));
    safe = both(safe, either(less_equal(cosine, broadcast(-1.0f)),  // a whole sphere: its axis is not read
                             both(less_equal(broadcast(0x1p-20f), axis_size),
                                  less_equal(axis_size, broadcast(0x1p20f)))));
    Floats tolerance = mul(spots.radius, broadcast(0x1p-18f));
    if (transform.to_view != nullptr) {
        const Floats from_origin[] = {apex[0] - transform.origin[0], apex[1] - transform.origin[1],
                                      apex[2] - transform.origin[2]};
        safe = both(safe, less_equal(manhattan_length(from_origin), transform.max_distance));
        const Floats given_axis[] = {axis[0], axis[1], axis[2]};
        for (unsigned row = 0; row < 3; ++row)
            axis[row] = transformed_row(transform, row, given_axis[0], given_axis[1], given_axis[2]);
        transform_spheres(transform, apex[0], apex[1], apex[2], spots.radius);
        // transform_spheres() stretched the radius and added its bound on the centre's error; this recovers the bound.
        const Floats centre_error = spots.radius - mul(given_radius, transform.stretch);
        tolerance = mul(spots.radius, broadcast(0x1p-18f)) + (centre_error + mul(spots.radius, transform.cone_error));
        safe = both(safe, less_equal(transform.cone_error, broadcast(1.0f)));
    }
    // Spots with a half angle beyond 138 degrees count as whole spheres. Spots that have sizes float can't compute
    // with, or a cone that the transform does not map to a cone, are replaced by the least spheres around them.
    const auto with_cone = and_not(safe, less_equal(cosine, broadcast(whole_ball_cosine)));
    const Floats per_length = 1.0f / sqrt(mul(axis[0], axis[0]) + mul(axis[1], axis[1]) + mul(axis[2], axis[2]));
    for (unsigned i = 0; i < 3; ++i) {
        spots.apex[i] = apex[i];
        spots.axis[i] = select(with_cone, mul(axis[i], per_length), Floats{});
    }
    spots.cosine = select(with_cone, cosine, Floats{});
    spots.sine = select(with_cone, sqrt(mul(1.0f - cosine, 1.0f + cosine)), broadcast(1.0f));
    spots.tolerance = select(with_cone, tolerance, Floats{});
    if (const unsigned fallback = ~movemask(safe) & static_cast<unsigned>(every_lane); fallback != 0)
        use_least_spheres(transform.to_view, fallback, given, spots);
    const Floats signs[] = {broadcast(camera.x.sign), broadcast(camera.y.sign), broadcast(camera.z_sign)};
    for (unsigned i = 0; i < 3; ++i) {
        spots.apex[i] = spots.apex[i] * signs[i];
        spots.axis[i] = spots.axis[i] * signs[i];
    }
}

/// Returns how far spots reach from their apexes in a direction: the radius where the direction is inside the cone,
/// else the distance to the rim, or 0 if the apex lies farther in that direction than the rim.
///
/// along, across  the lengths of the cone's unit axis along the direction and perpendicular to it
inline Floats spot_reach(const SpotLanes& spots, Floats along, Floats across) {
    const Floats rim = minimum(maximum(mul(spots.cosine, along) + mul(spots.sine, across), Floats{}), broadcast(1.0f));
    const Floats part = select(less_equal(spots.cosine, along), broadcast(1.0f), rim);
    return minimum(mul(spots.radius, part) + spots.tolerance, spots.radius);
}

/// Finds and stores the half spaces around the cones of a vector of spots. Let t be the half angle, and e and f two
/// unit vectors perpendicular to the axis a and to each other (Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017). The planes go through the apex, and their unit normals are  +-e cos t - a sin t  and
/// +-f cos t - a sin t.
///
/// From 90 degrees on there is one half space, stored four times: the side of the rim's plane that the cap is on, with
/// the normal -a. With the ball it is the spot's convex hull. The plane lies -r cos t behind the apex, where r is the
/// radius, as a point v off the apex has  -a.v <= -|v| cos t,  which is at most  -r cos t,  as cos t <= 0.
///
/// Rounding, with u = 2^-24, the ball's size S = |x| + |y| + |z| + r, a normal n and the apex P: n is within 16u of
/// the normal for the exact axis, and so n.p - n.P is at most `tolerance` for each point p of the spot. The products
/// and sums of n.P and of r cos t are off by less than 9u S in all. With the 4u S that cell_planes.hpp asks for this is
/// less than 2^-20 S = 16u S, which is added.
inline void store_planes(ViewSpot* to, const SpotLanes& spots) {
    const Floats apex[] = {spots.apex[0], spots.apex[1], spots.apex[2]}, (&axis)[3] = spots.axis;
    const auto backward = less(axis[2], Floats{});
    const Floats sign = select(backward, broadcast(-1.0f), broadcast(1.0f)), p = -1.0f / (sign + axis[2]);
    const Floats xp = mul(axis[0], p), q = mul(axis[1], xp);
    const Floats across[2][3] = {{1.0f + mul(mul(sign, axis[0]), xp), sign * q, -(sign * axis[0])},
                                 {q, sign + mul(axis[1], mul(axis[1], p)), -axis[1]}};
    const Floats slack = spots.tolerance + mul(manhattan_length(apex) + spots.radius, broadcast(0x1p-20f));
    const auto wide = less_equal(spots.cosine, Floats{});
    const Floats sine = select(wide, broadcast(1.0f), spots.sine), cosine = maximum(spots.cosine, Floats{});
    // Beyond 90 degrees the only plane is the rim's: its place on the axis, from the apex on. Planes of narrower
    // cones go through the apex: 0.
    const Floats rim = mul(spots.radius, minimum(spots.cosine, Floats{}));
    Floats back[3];
    for (unsigned i = 0; i < 3; ++i)
        back[i] = mul(axis[i], sine);
    for (unsigned plane = 0; plane < 4; ++plane) {
        Floats n[3], most = slack - rim;
        for (unsigned i = 0; i < 3; ++i) {
            const Floats aside = mul(across[plane / 2][i], cosine);
            n[i] = (plane % 2 == 0 ? aside : -aside) - back[i];
            most = most + mul(n[i], apex[i]);
        }
        store_vec4s(to->around + plane, sizeof *to, n[0], n[1], n[2], most);
    }
}

/// Stores a vector of spots, except the half spaces around them, which store_planes() stores.
inline void store_spots(ViewSpot* to, const SpotLanes& spots, Floats nearest, Floats farthest) {
    store_vec4s(&to->x, sizeof *to, spots.apex[0], spots.apex[1], spots.apex[2], spots.radius);
    store_vec4s(&to->axis_x, sizeof *to, spots.axis[0], spots.axis[1], spots.axis[2], spots.cosine);
    store_vec4s(&to->nearest, sizeof *to, nearest, farthest, spots.tolerance, spots.tolerance);
}

}}}}  // namespace lightbin::detail
