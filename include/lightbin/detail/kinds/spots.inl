// SPDX-License-Identifier: MIT
// The transform of spots to view space, whose rounding view_spot.hpp derives, and their projection to tile rectangles,
// a vector of lights at a time. Included once per tier (instruction set).
//
// A spot is the sector that a cone cuts out of a ball. The point of a sector that is farthest in some direction is the
// apex, a point of the rim, the circle in which cone and ball meet, or a point of the cap, the ball's surface inside
// the rim; in the last case it is the ball's own farthest point. So a sector has the bounds of its ball where these
// touch the cap, and else those of the apex and the rim. That holds for half angles of 90 degrees and more, too: then
// the bounds are those of the spot's convex hull, the part of the ball on the cap's side of the rim's plane.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/project/spheres.inl>
#include <lightbin/detail/project/spheres_around_shapes.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The members of a vector of ViewSpots, one for each lane, and the sines of their half angles.
struct SpotLanes {
    Floats apex[3], radius, axis[3], cosine, sine, tolerance;
};

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
        transform_vectors(transform, axis);
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

/// Stores, in view space, the balls of a vector of spots and the least spheres around the spots. Let u = 2^-24 and S =
/// |x| + |y| + |z| + r: the centre of a least sphere is within 8u S of the exact one, and its radius is 16u S larger.
inline void store_both_spheres(const Camera& camera, const SpotLanes& spots, Sphere* balls, Sphere* least) {
    const auto narrow = less_equal(broadcast(0.5f), mul(spots.cosine, spots.cosine));
    const Floats half = mul(spots.radius, broadcast(0.5f)) / spots.cosine, along = mul(spots.radius, spots.cosine);
    const Floats size = manhattan_length(spots.apex) + spots.radius;
    const Floats radius =
        select(narrow, half, mul(spots.radius, spots.sine)) + (mul(size, broadcast(0x1p-20f)) + spots.tolerance);
    // From a half angle of 90 degrees on, the least sphere around a spot is its ball, the sphere that its cone cuts.
    const auto smaller = both(less(Floats{}, spots.cosine), less(radius, spots.radius));
    const Floats step = select(smaller, select(narrow, half, along), Floats{});
    const Floats x = broadcast(camera.x.sign), y = broadcast(camera.y.sign), z = broadcast(camera.z_sign);
    store_spheres(balls, spots.apex[0] * x, spots.apex[1] * y, spots.apex[2] * z, spots.radius);
    store_spheres(least, (spots.apex[0] + mul(step, spots.axis[0])) * x, (spots.apex[1] + mul(step, spots.axis[1])) * y,
                  (spots.apex[2] + mul(step, spots.axis[2])) * z, select(smaller, radius, spots.radius));
}

/// Numbers of a vector of spots by which narrow_slopes() bounds the slopes of their rims along either image axis.
struct RimLanes {
    Floats per_z;      ///< the reciprocal of the view depth of the cone's apex
    Floats axis_z;     ///< the depth coordinate of the cone's unit axis
    Floats cosine2;    ///< the square of the cosine of the cone's half angle, with the cosine's sign
    Floats along;      ///< the distance from the cone's apex to the centre of the rim, where cone and ball meet
    Floats rho, rho2;  ///< the radius of the rim, the circle in which the cone meets its sphere, and its square
    Floats rim_z;      ///< the view depth of the centre of the rim, where cone and ball meet
    Floats per_a;      ///< 1 / A, where the slopes s of planes that touch the rim solve  A s^2 - 2 B s + C = 0
    Floats error;      ///< a slope's error is at most this times (1 + |slope|)
};

/// Returns for which spots the plane  coordinate = slope * depth,  which touches the sphere that the cone cuts, touches
/// it in the cap: the part of the sphere inside the cone. Where that is in doubt it returns true, as `slope` bounds the
/// whole sphere. With the half angle t and the normal's length l, the plane touches in the cap if  across >= l cos t.
/// Both sides are squared with their signs kept. 2^-20 l^2 is more than the errors of both squares.
///
/// across  the scalar product of the cone's axis and the plane's normal, whose length l is sqrt(1 + slope^2)
LIGHTBIN_INLINE auto touches_cap(const RimLanes& rim, Floats slope, Floats across) {
    across = across + mul(1.0f + abs(slope), broadcast(0x1p-18f));
    return less_equal(mul(rim.cosine2 - 0x1p-20f, 1.0f + mul(slope, slope)), mul(across, abs(across)));
}

/// Narrows the slopes low..high along an image axis, which bound the balls, to bounds of the balls' sectors, the spots.
///
/// c            the apex's coordinate along the image axis
/// axis, other  the coordinates of the cone's axis along this and the other image axis
///
/// The plane  x = s z  touches the rim, with the centre (X, Z) in this image axis and depth, the radius R and the axis
/// (a, a_z), where  (X - s Z)^2 = R^2 (1 + s^2 - (a - s a_z)^2).  The roots are  s = (B -+ R sqrt(D)) / A  with
///     A = Z^2 - R^2 (1 - a_z^2),   B = X Z + R^2 a a_z,   D = (X^2 + Z^2 - R^2) other^2 + (X a + Z a_z)^2.
/// Rounding, with u = 2^-24 and the ball's S = |x| + |y| + |z| + r: D is within 2^-20 (X^2 + Z^2 + R^2) of the exact
/// value; this bound is added to it. Apex and rim are within 8u S of the exact ones, and all other errors move a
/// point's slope by less than 32u S (1 + |slope|) / z, where z is the point's depth.
LIGHTBIN_INLINE void narrow_slopes(const RimLanes& rim, Floats c, Floats axis, Floats other, Floats& low,
                                   Floats& high) {
    const Floats x = c + mul(rim.along, axis), b = mul(x, rim.rim_z) + mul(rim.rho2, mul(axis, rim.axis_z));
    const Floats squares = mul(x, x) + mul(rim.rim_z, rim.rim_z), q = mul(x, axis) + mul(rim.rim_z, rim.axis_z);
    const Floats d = mul(squares - rim.rho2, mul(other, other)) + mul(q, q);
    const Floats root = mul(rim.rho, sqrt(maximum(d, Floats{}) + mul(squares + rim.rho2, broadcast(0x1p-20f))));
    const Floats apex = mul(c, rim.per_z);
    const Floats least = minimum(mul(b - root, rim.per_a), apex), largest = maximum(mul(b + root, rim.per_a), apex);
    const Floats error = mul(rim.error, 1.0f + maximum(abs(least), abs(largest)));

    low = select(touches_cap(rim, low, mul(low, rim.axis_z) - axis), low, maximum(least - error, low));
    high = select(touches_cap(rim, high, axis - mul(high, rim.axis_z)), high, minimum(largest + error, high));
}

/// Projects in double a spot that float can't project, as project_in_double() does a sphere. The spot's tile rectangle
/// is the intersection of two rectangles: of `ball`, the sphere that its cone cuts, and of `least`, the
/// bounding_sphere() of the spot.
inline bool project_spot_in_double(const Camera& camera, const Sphere& ball, const Sphere& least, std::uint32_t i,
                                   ChunkRects& rects, ProjectCounts& counts) {
    ChunkRects second;
    ProjectCounts counted_before;  // the second projection counts the same bad input again
    if (!project_in_double(camera, ball, i, rects, counts) ||
        !project_in_double(camera, least, i, second, counted_before))
        return false;
    rects.x0[i] = max_of(rects.x0[i], second.x0[i]);
    rects.y0[i] = max_of(rects.y0[i], second.y0[i]);
    rects.x1[i] = min_of(rects.x1[i], second.x1[i]);
    rects.y1[i] = min_of(rects.y1[i], second.y1[i]);
    return rects.x0[i] <= rects.x1[i] && rects.y0[i] <= rects.y1[i];
}

/// Narrows `bounds` from the slopes of spots' balls, which lie beyond the near plane, to the slopes of the spots.
///
/// size      |x| + |y| + |z| + r of the ball
/// nearest   the spot's least view depth; at least 2^-16 of `size`
/// across_z  the length of the cone's unit axis perpendicular to the view direction
LIGHTBIN_INLINE void narrow_to_spots(const SpotLanes& spots, Floats size, Floats nearest, Floats across_z,
                                     ImageBounds<Floats>& bounds) {
    const Floats z = spots.apex[2];
    const Floats along = mul(spots.radius, spots.cosine), rho = mul(spots.radius, spots.sine);
    const Floats rim_z = z + mul(along, spots.axis[2]), depth = mul(rho, across_z);
    const RimLanes rim = {1.0f / z,
                          spots.axis[2],
                          mul(spots.cosine, abs(spots.cosine)),
                          along,
                          rho,
                          mul(rho, rho),
                          rim_z,
                          1.0f / mul(rim_z - depth, rim_z + depth),
                          (mul(size, broadcast(0x1p-18f)) + spots.tolerance) / nearest};
    narrow_slopes(rim, spots.apex[0], spots.axis[0], spots.axis[1], bounds.low[0], bounds.high[0]);
    narrow_slopes(rim, spots.apex[1], spots.axis[1], spots.axis[0], bounds.low[1], bounds.high[1]);
}

/// Appends the footprints of the spots first..first + count - 1 that are in view. Spots are projected in float where
/// nothing overflows, underflows or is NaN, the sphere that the cone cuts lies beyond the near plane, and the spot's
/// least view depth is at least 2^-16 of that sphere's |x| + |y| + |z| + r. All others are projected in double.
template <>
inline void project_lights<LightKind::spot>(const Camera& camera, const LightSource& source, std::uint32_t first,
                                            std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts) {
    ProjectedChunk chunk;
    Spot buffer[ChunkRects::size], padded[lanes];
    // The spots that are projected in double: in view space, the spheres that the cones cut, and the least spheres.
    Sphere balls[ChunkRects::size], least[ChunkRects::size];
    const TransformLanes transform(source.to_view);
    const ViewLanes view(camera);
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, ChunkRects::size);
        const Spot* const given = source.array != nullptr ? static_cast<const Spot*>(source.array) + first : buffer;
        if (source.copy != nullptr) source.copy(source.lights, first, here, buffer);
        chunk.visible = chunk.in_double = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            const std::uint32_t used = min_of(lanes, here - i);
            SpotLanes spots;
            load_spots(camera, transform, whole_vector(given + i, used, padded), spots);
            const Floats(&apex)[3] = spots.apex, (&axis)[3] = spots.axis;
            const Floats across_z = sqrt(mul(axis[0], axis[0]) + mul(axis[1], axis[1]));
            const Floats nearest = apex[2] - spot_reach(spots, -axis[2], across_z),
                         farthest = apex[2] + spot_reach(spots, axis[2], across_z);

            const Floats size = manhattan_length(apex) + spots.radius;
            const auto safe = safe_in_float(size, spots.radius);
            const auto culled =
                both(safe, out_of_view(view, apex[0], apex[1], apex[2], spots.radius, nearest, farthest, size));
            const unsigned valid = (1u << used) - 1;
            if ((~movemask(culled) & valid) == 0) continue;
            if (source.out_spots != nullptr) store_spots(source.out_spots + first + i, spots, nearest, farthest);
            if (source.with_planes) store_planes(source.out_spots + first + i, spots);
            auto in_float = and_not(safe, culled);
            ImageBounds<Floats> bounds;
            if (camera.orthographic) {
                for (unsigned x = 0; x < 2; ++x) {
                    const Floats across = sqrt(mul(axis[1 - x], axis[1 - x]) + mul(axis[2], axis[2]));
                    bounds.low[x] = apex[x] - spot_reach(spots, -axis[x], across);
                    bounds.high[x] = apex[x] + spot_reach(spots, axis[x], across);
                }
            } else {
                in_float = both(in_float, both(less(broadcast(camera.min_float_depth), apex[2] - spots.radius),
                                               less(size * 0x1p-16f, nearest)));
                bounds = sphere_bounds(camera, apex[0], apex[1], apex[2], spots.radius);
                narrow_to_spots(spots, size, nearest, across_z, bounds);
            }
            const unsigned fallback = ~movemask(either(in_float, culled)) & valid;
            if (fallback != 0) store_both_spheres(camera, spots, balls + i, least + i);
            put_vector(camera, bounds, in_float, fallback, valid, i, chunk);
        }
        for (std::uint64_t rest = chunk.in_double; rest != 0; rest &= rest - 1) {
            const std::uint32_t i = static_cast<std::uint32_t>(std::countr_zero(rest));
            const bool visible = project_spot_in_double(camera, balls[i], least[i], i, chunk.rects, counts);
            chunk.visible |= std::uint64_t{visible} << i;
        }
        append_chunk(chunk, source.first_id + first, here, out, counts);
    }
}

}}}}  // namespace lightbin::detail
