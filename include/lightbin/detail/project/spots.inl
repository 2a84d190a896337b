// SPDX-License-Identifier: MIT
// Spots to tile rectangles, a vector of lights at a time. Included once a tier, after project.inl, whose parts it takes, and
// spot_lanes.inl.
//
// A spot is the sector of a ball that a cone holds. Of all points of a sector, the one that is farthest in some direction
// is the apex, on the rim where cone and ball meet, or on the cap within the rim; on the cap it is the ball's own. So its
// bounds are those of its ball where that is touched within the cone, else of the apex and the rim, a circle.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/spheres.inl>
#include <lightbin/detail/project/spot_vectors.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Stores the balls and the least spheres, see least_sphere(), as the caller has view space. The least spheres' centres are
/// within 8u of the sizes that they are made of.
inline void store_both_spheres(const Camera& camera, const SpotLanes& spots, Sphere* balls,
                                               Sphere* least) {
    const auto narrow = less_equal(broadcast(0.5f), mul(spots.cosine, spots.cosine));
    const Floats half = mul(spots.radius, broadcast(0.5f)) / spots.cosine, along = mul(spots.radius, spots.cosine);
    const Floats size = abs(spots.x) + abs(spots.y) + abs(spots.z) + spots.radius;
    const Floats radius =
        select(narrow, half, mul(spots.radius, spots.sine)) + (mul(size, broadcast(0x1p-20f)) + spots.blur);
    const auto smaller = less(radius, spots.radius);
    const Floats step = select(smaller, select(narrow, half, along), Floats{});
    const Floats x = broadcast(camera.x.sign), y = broadcast(camera.y.sign), z = broadcast(camera.z_sign);
    store_spheres(balls, spots.x * x, spots.y * y, spots.z * z, spots.radius);
    store_spheres(least, (spots.x + mul(step, spots.axis[0])) * x, (spots.y + mul(step, spots.axis[1])) * y,
                  (spots.z + mul(step, spots.axis[2])) * z, select(smaller, radius, spots.radius));
}

/// What the slopes of both image axes need of spots.
struct RimLanes {
    Floats per_z;  ///< of the apex
    Floats axis_z, cosine2;
    Floats along, rho, rho2;  ///< from the apex to the rim's centre, the rim's radius and its square
    Floats rim_z, per_a;
    Floats error;  ///< of slopes, by 1 + |slope|
};

/// Does a plane of some slope touch the ball within the cone? If in doubt, yes: the ball's slopes are right for all of it.
///
/// across  the plane's normal, of length sqrt(1 + slope^2), times the cone's axis
LIGHTBIN_INLINE auto touches_cap(const RimLanes& rim, Floats slope, Floats across) {
    across = across + mul(1.0f + abs(slope), broadcast(0x1p-18f));
    return both(less_equal(Floats{}, across), less_equal(mul(rim.cosine2, 1.0f + mul(slope, slope)),
                                                         mul(mul(across, across), broadcast(1 + 0x1p-18f))));
}

/// Narrows the slopes low..high of the balls along an image axis to those of their sectors. `c` is the apex's coordinate,
/// `axis` and `other` those of the cone's axis along this and the other image axis.
///
/// The plane  x = s z  touches the rim, with centre (X, Z), radius R and axis (a, a_z), where
///     (X - s Z)^2 = R^2 (1 + s^2 - (a - s a_z)^2),
/// whose roots are  (B -+ R sqrt(D)) / A  with  A = Z^2 - R^2 (1 - a_z^2),  B = X Z + R^2 a a_z,
/// D = (X^2 + Z^2 - R^2) other^2 + (X a + Z a_z)^2. With u = 2^-24 and S = |x| + |y| + |z| + r, of the ball, D is within
/// 2^-20 of X^2 + Z^2 + R^2, which is added to it; all else, the apex and the rim being within 8u S, moves a slope by less
/// than 32u S (1 + the larger slope) / z of the point.
LIGHTBIN_INLINE void narrow_slopes(const RimLanes& rim, Floats c, Floats axis, Floats other,
                                                   Floats& low, Floats& high) {
    const Floats x = c + mul(rim.along, axis), b = mul(x, rim.rim_z) + mul(rim.rho2, mul(axis, rim.axis_z));
    const Floats squares = mul(x, x) + mul(rim.rim_z, rim.rim_z),
                 q = mul(x, axis) + mul(rim.rim_z, rim.axis_z);
    const Floats d = mul(squares - rim.rho2, mul(other, other)) + mul(q, q);
    const Floats root = mul(rim.rho, sqrt(maximum(d, Floats{}) + mul(squares + rim.rho2, broadcast(0x1p-20f))));
    const Floats tip = mul(c, rim.per_z);
    const Floats least = minimum(mul(b - root, rim.per_a), tip), most = maximum(mul(b + root, rim.per_a), tip);
    const Floats error = mul(rim.error, 1.0f + maximum(abs(least), abs(most)));

    low = select(touches_cap(rim, low, mul(low, rim.axis_z) - axis), low, maximum(least - error, low));
    high = select(touches_cap(rim, high, axis - mul(high, rim.axis_z)), high, minimum(most + error, high));
}

/// Of some of a chunk's lights: the tiles of both the ball and the least sphere of each, by project_carefully().
inline void project_both_carefully(const Camera& camera, const Sphere* balls,
                                                   const Sphere* least, const std::uint8_t* places,
                                                   std::uint32_t count, ChunkRects& rects, unsigned* visible,
                                                   ProjectCounts& counts) {
    ChunkRects second;
    ProjectCounts counted_before;
    unsigned also[ChunkRects::size / lanes] = {};
    project_carefully(camera, balls, places, count, rects, visible, counts);
    project_carefully(camera, least, places, count, second, also, counted_before);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t place = places[i];
        rects.x0[place] = max_of(rects.x0[place], second.x0[place]);
        rects.y0[place] = max_of(rects.y0[place], second.y0[place]);
        rects.x1[place] = min_of(rects.x1[place], second.x1[place]);
        rects.y1[place] = min_of(rects.y1[place], second.y1[place]);
        const bool any = (also[place / lanes] >> place % lanes & 1) != 0 &&
                         rects.x0[place] <= rects.x1[place] && rects.y0[place] <= rects.y1[place];
        if (!any) visible[place / lanes] &= ~(1u << place % lanes);
    }
}

/// What spots cover along the image axes: slopes or, orthographic, coordinates.
struct ImageBounds {
    Floats left, right, bottom, top;
};

LIGHTBIN_INLINE void find_coordinates(const SpotLanes& spots, ImageBounds& bounds) {
    const Floats x2 = mul(spots.axis[0], spots.axis[0]), y2 = mul(spots.axis[1], spots.axis[1]),
                 z2 = mul(spots.axis[2], spots.axis[2]), across_x = sqrt(y2 + z2), across_y = sqrt(x2 + z2);
    bounds = {spots.x - spot_reach(spots, -spots.axis[0], across_x),
              spots.x + spot_reach(spots, spots.axis[0], across_x),
              spots.y - spot_reach(spots, -spots.axis[1], across_y),
              spots.y + spot_reach(spots, spots.axis[1], across_y)};
}

/// Of spots whose balls lie beyond the near plane; `size` is |x| + |y| + |z| + r of the ball, `nearest` 2^-16 of it at least.
LIGHTBIN_INLINE void find_slopes(const SpotLanes& spots, Floats size, Floats nearest,
                                                 Floats across_z, ImageBounds& bounds) {
    const Floats e = mul(spots.z - spots.radius, spots.z + spots.radius), per_e = 1.0f / e;
    tangent_slopes(spots.x, spots.z, spots.radius, e, per_e, bounds.left, bounds.right);
    tangent_slopes(spots.y, spots.z, spots.radius, e, per_e, bounds.bottom, bounds.top);
    const Floats along = mul(spots.radius, spots.cosine), rho = mul(spots.radius, spots.sine);
    const Floats rim_z = spots.z + mul(along, spots.axis[2]), depth = mul(rho, across_z);
    const RimLanes rim = {1.0f / spots.z,
                          spots.axis[2],
                          mul(spots.cosine, spots.cosine),
                          along,
                          rho,
                          mul(rho, rho),
                          rim_z,
                          1.0f / mul(rim_z - depth, rim_z + depth),
                          (mul(size, broadcast(0x1p-18f)) + spots.blur) / nearest};
    narrow_slopes(rim, spots.x, spots.axis[0], spots.axis[1], bounds.left, bounds.right);
    narrow_slopes(rim, spots.y, spots.axis[1], spots.axis[0], bounds.bottom, bounds.top);
}

/// Appends the footprints of those of the spots first..first + count - 1 that are in view, as project() does.
inline void project_spots(const Camera& camera, const LightSource& source, std::uint32_t first,
                                          std::uint32_t count, const FootprintArrays& out,
                                          ProjectCounts& counts) {
    ChunkRects rects;
    unsigned visible[ChunkRects::size / lanes];
    std::uint8_t careful[ChunkRects::size];
    Sphere balls[ChunkRects::size],
        cones[ChunkRects::size];  // as given, then of careful ones balls and least spheres
    const MoveLanes move(source.to_view);
    const ViewLanes view(camera);
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, ChunkRects::size);
        source.copy(source.lights, first, here, balls, cones);
        for (std::uint32_t i = here; i % lanes != 0; ++i) {
            balls[i] = balls[0];
            cones[i] = cones[0];
        }
        std::uint32_t careful_count = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            SpotLanes spots;
            shape_spots(camera, move, balls + i, cones + i, spots);
            const Floats across_z =
                sqrt(mul(spots.axis[0], spots.axis[0]) + mul(spots.axis[1], spots.axis[1]));
            const Floats nearest = spots.z - spot_reach(spots, -spots.axis[2], across_z),
                         farthest = spots.z + spot_reach(spots, spots.axis[2], across_z);

            const Floats size = abs(spots.x) + abs(spots.y) + abs(spots.z) + spots.radius;
            const auto usable =
                both(less_equal(size, broadcast(float_safe_max)), less_equal(broadcast(float_safe_min), spots.radius));
            const auto culled = both(usable, out_of_view(view, spots.x, spots.y, spots.z, spots.radius,
                                                         nearest, farthest, size));
            const unsigned used = min_of(lanes, here - i), valid = used < 32 ? (1u << used) - 1 : ~0u;
            unsigned& in_view = visible[i / lanes] = 0;
            if ((~movemask(culled) & valid) == 0) continue;
            if (source.kept_spots != nullptr) store_spots(source.kept_spots + first + i, spots, nearest, farthest);
            if (source.with_planes) store_planes(source.kept_spots + first + i, spots);
            auto plain = and_not(usable, culled);
            ImageBounds bounds;
            if (camera.orthographic) {
                find_coordinates(spots, bounds);
            } else {
                plain = both(plain, both(less(broadcast(camera.min_float_depth), spots.z - spots.radius),
                                         less(size * 0x1p-16f, nearest)));
                find_slopes(spots, size, nearest, across_z, bounds);
            }
            unsigned rest = ~movemask(either(plain, culled)) & valid;
            if (rest != 0) store_both_spheres(camera, spots, balls + i, cones + i);
            for (; rest != 0; rest &= rest - 1)
                careful[careful_count++] =
                    static_cast<std::uint8_t>(i + static_cast<unsigned>(std::countr_zero(rest)));
            plain = tile_span<float>(camera.x, bounds.left, bounds.right, plain, rects.x0 + i, rects.x1 + i);
            plain = tile_span<float>(camera.y, bounds.bottom, bounds.top, plain, rects.y0 + i, rects.y1 + i);
            in_view = movemask(plain) & valid;
        }
        project_both_carefully(camera, balls, cones, careful, careful_count, rects, visible, counts);
        for (std::uint32_t i = 0; i < here; i += lanes)
            if (visible[i / lanes] != 0) append_visible(out, counts, first, visible[i / lanes], rects, i);
    }
}

}}}}  // namespace lightbin::detail
