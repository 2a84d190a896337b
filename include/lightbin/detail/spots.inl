// SPDX-License-Identifier: MIT
// Spots to tile rectangles, a vector of lights at a time. Included once a tier, after project.inl, whose parts it takes.
//
// A spot is the sector of a ball that a cone holds. Of all points of a sector, the one that is farthest in some direction
// is the apex, on the rim where cone and ball meet, or on the cap within the rim; on the cap it is the ball's own. So its
// bounds are those of its ball where that is touched within the cone, else of the apex and the rim, a circle.

/// A vector of spots, see ViewSpot.
struct SpotLanes {
    Floats x, y, z, radius, axis[3], cosine, sine, blur;
};

/// Makes whole spheres of those of a vector's spots that floats can't hold: their least spheres.
///
/// balls, cones  the spots as they were given, see SpotSource
LIGHTBIN_TARGET LIGHTBIN_NOINLINE inline void take_least_spheres(const WorldToView* to_view, unsigned which,
                                                                 const Sphere* balls, const Sphere* cones,
                                                                 SpotLanes& spots) {
    Sphere ball[lanes], cone[lanes], rest[lanes];
    store_spheres(ball, spots.x, spots.y, spots.z, spots.radius);
    store_spheres(cone, spots.axis[0], spots.axis[1], spots.axis[2], spots.cosine);
    store_spheres(rest, spots.sine, spots.blur, spots.blur, spots.blur);
    for (; which != 0; which &= which - 1) {
        const unsigned lane = static_cast<unsigned>(std::countr_zero(which));
        const Sphere given = load_sphere(balls + lane), axis = load_sphere(cones + lane);
        const Sphere sphere =
            least_sphere(Spot{given.x, given.y, given.z, given.radius, axis.x, axis.y, axis.z, axis.radius});
        ball[lane] = to_view != nullptr ? (*to_view)(sphere) : sphere;
        cone[lane] = {0, 0, 0, 0};
        rest[lane] = {1, 0, 0, 0};
    }
    Floats unused[2];
    load_spheres(ball, spots.x, spots.y, spots.z, spots.radius);
    load_spheres(cone, spots.axis[0], spots.axis[1], spots.axis[2], spots.cosine);
    load_spheres(rest, spots.sine, spots.blur, unused[0], unused[1]);
}

/// Stores the balls and the least spheres, see least_sphere(), as the caller has view space. The least spheres' centres are
/// within 8u of the sizes that they are made of.
LIGHTBIN_TARGET inline void store_both_spheres(const Camera& camera, const SpotLanes& spots, Sphere* balls,
                                               Sphere* least) {
    const auto narrow = less_equal(all(0.5f), mul(spots.cosine, spots.cosine));
    const Floats half = mul(spots.radius, all(0.5f)) / spots.cosine, along = mul(spots.radius, spots.cosine);
    const Floats size = abs(spots.x) + abs(spots.y) + abs(spots.z) + spots.radius;
    const Floats radius =
        select(narrow, half, mul(spots.radius, spots.sine)) + (mul(size, all(0x1p-20f)) + spots.blur);
    const auto smaller = less(radius, spots.radius);
    const Floats step = select(smaller, select(narrow, half, along), Floats{});
    const Floats x = all(camera.x.sign), y = all(camera.y.sign), z = all(camera.z_sign);
    store_spheres(balls, spots.x * x, spots.y * y, spots.z * z, spots.radius);
    store_spheres(least, (spots.x + mul(step, spots.axis[0])) * x, (spots.y + mul(step, spots.axis[1])) * y,
                  (spots.z + mul(step, spots.axis[2])) * z, select(smaller, radius, spots.radius));
}

/// Moves spots to view space and finds what ViewSpot says of them, but for their depths.
LIGHTBIN_TARGET LIGHTBIN_INLINE void shape_spots(const Camera& camera, const MoveLanes& move,
                                                 const Sphere* balls, const Sphere* cones, SpotLanes& spots) {
    Floats axis[3], cosine;
    load_spheres(balls, spots.x, spots.y, spots.z, spots.radius);
    load_spheres(cones, axis[0], axis[1], axis[2], cosine);
    const Floats given_radius = spots.radius;
    const Floats away = abs(spots.x) + abs(spots.y) + abs(spots.z),
                 long_axis = abs(axis[0]) + abs(axis[1]) + abs(axis[2]);
    auto plain = both(less_equal(away, all(PlainSpots::most_size)), less_equal(abs(cosine), all(1.0f)));
    plain = both(plain, both(less_equal(all(PlainSpots::least_size), given_radius),
                             less_equal(given_radius, all(PlainSpots::most_size))));
    plain = both(plain, both(less_equal(all(PlainSpots::least_axis), long_axis),
                             less_equal(long_axis, all(PlainSpots::most_axis))));
    Floats blur = mul(spots.radius, all(0x1p-18f));
    if (move.to_view != nullptr) {
        plain = both(plain, less_equal(abs(spots.x - move.origin[0]) + abs(spots.y - move.origin[1]) +
                                           abs(spots.z - move.origin[2]),
                                       move.most));
        const Floats given[] = {axis[0], axis[1], axis[2]};
        for (unsigned row = 0; row < 3; ++row)
            axis[row] = mul(given[0], move.columns[0][row]) + mul(given[1], move.columns[1][row]) +
                        mul(given[2], move.columns[2][row]);
        move_spheres(move, spots.x, spots.y, spots.z, spots.radius);
        // By how far the centre may be off its radius was made longer.
        const Floats off = spots.radius - mul(given_radius, move.stretch);
        blur = mul(spots.radius, all(0x1p-18f)) + (off + mul(spots.radius, move.bend));
        plain = both(plain, less_equal(move.bend, all(1.0f)));
    }
    const auto whole = less_equal(cosine, all(0.0f));
    const Floats zero = Floats{};
    const Floats per_length =
        1.0f / sqrt(mul(axis[0], axis[0]) + mul(axis[1], axis[1]) + mul(axis[2], axis[2]));
    for (unsigned row = 0; row < 3; ++row)
        spots.axis[row] = select(whole, zero, mul(axis[row], per_length));
    spots.cosine = select(whole, zero, cosine);
    spots.sine = select(whole, all(1.0f), sqrt(mul(1.0f - cosine, 1.0f + cosine)));
    spots.blur = select(whole, zero, blur);
    if (const unsigned odd = ~bits(plain) & static_cast<unsigned>(every_lane); odd != 0)
        take_least_spheres(move.to_view, odd, balls, cones, spots);
    const Floats signs[] = {all(camera.x.sign), all(camera.y.sign), all(camera.z_sign)};
    spots.x = spots.x * signs[0];
    spots.y = spots.y * signs[1];
    spots.z = spots.z * signs[2];
    for (unsigned i = 0; i < 3; ++i)
        spots.axis[i] = spots.axis[i] * signs[i];
}

/// How far spots reach from their apex along an axis, on which the cone's axis has the coordinate `along`, beside it the
/// length `across`.
LIGHTBIN_TARGET inline Floats spot_reach(const SpotLanes& spots, Floats along, Floats across) {
    const Floats rim =
        lesser(greater(mul(spots.cosine, along) + mul(spots.sine, across), Floats{}), all(1.0f));
    const Floats part = select(less_equal(spots.cosine, along), all(1.0f), rim);
    return lesser(mul(spots.radius, part) + spots.blur, spots.radius);
}

/// What the slopes of both image axes need of spots.
struct RimLanes {
    Floats per_z;  ///< of the apex
    Floats axis_z, cosine2;
    Floats along, rho, rho2;  ///< from the apex to the rim's centre, the rim's radius and its square
    Floats rim_z, per_a;
    Floats error;  ///< of slopes, by 1 + |slope|
};

/// Narrows the slopes low..high of the balls along an image axis to those of their sectors. `c` is the apex's coordinate,
/// `axis` and `other` those of the cone's axis along this and the other image axis.
///
/// The plane  x = s z  touches the rim, with centre (X, Z), radius R and axis (a, a_z), where
///     (X - s Z)^2 = R^2 (1 + s^2 - (a - s a_z)^2),
/// whose roots are  (B -+ R sqrt(D)) / A  with  A = Z^2 - R^2 (1 - a_z^2),  B = X Z + R^2 a a_z,
/// D = (X^2 + Z^2 - R^2) other^2 + (X a + Z a_z)^2. With u = 2^-24 and S = |x| + |y| + |z| + r, of the ball, D is within
/// 2^-20 of X^2 + Z^2 + R^2, which is added to it; all else, the apex and the rim being within 8u S, moves a slope by less
/// than 32u S (1 + the larger slope) / z of the point.
LIGHTBIN_TARGET LIGHTBIN_INLINE void narrow_slopes(const RimLanes& rim, Floats c, Floats axis, Floats other,
                                                   Floats& low, Floats& high) {
    const Floats zero = Floats{}, one = all(1.0f);
    const Floats x = c + mul(rim.along, axis), b = mul(x, rim.rim_z) + mul(rim.rho2, mul(axis, rim.axis_z));
    const Floats squares = mul(x, x) + mul(rim.rim_z, rim.rim_z),
                 q = mul(x, axis) + mul(rim.rim_z, rim.axis_z);
    const Floats d = mul(squares - rim.rho2, mul(other, other)) + mul(q, q);
    const Floats root = mul(rim.rho, sqrt(greater(d, zero) + mul(squares + rim.rho2, all(0x1p-20f))));
    const Floats tip = mul(c, rim.per_z);
    const Floats least = lesser(mul(b - root, rim.per_a), tip), most = greater(mul(b + root, rim.per_a), tip);
    const Floats error = mul(rim.error, one + greater(abs(least), abs(most)));

    // Does the plane touch the ball within the cone? If in doubt, yes: the ball's slopes are right for all of it.
    const Floats low_across = mul(low, rim.axis_z) - axis + mul(one + abs(low), all(0x1p-18f)),
                 high_across = axis - mul(high, rim.axis_z) + mul(one + abs(high), all(0x1p-18f));
    const auto low_on_cap =
        both(less_equal(zero, low_across), less_equal(mul(rim.cosine2, one + mul(low, low)),
                                                      mul(mul(low_across, low_across), all(1 + 0x1p-18f))));
    const auto high_on_cap = both(less_equal(zero, high_across),
                                  less_equal(mul(rim.cosine2, one + mul(high, high)),
                                             mul(mul(high_across, high_across), all(1 + 0x1p-18f))));
    low = select(low_on_cap, low, greater(least - error, low));
    high = select(high_on_cap, high, lesser(most + error, high));
}

/// Copies vec4s, one a spot, to a place in each.
LIGHTBIN_TARGET inline void store_part(ViewSpot* to, std::size_t place, const Sphere (&vec4s)[lanes]) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        std::memcpy(reinterpret_cast<char*>(to + lane) + place, vec4s + lane, sizeof(Sphere));
}

/// Finds and stores the half spaces around a vector of cones: with e and f two unit vectors across the axis a and each
/// other (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017), the planes' normals are
/// +-e cos t - a sin t  and  +-f cos t - a sin t,  of unit length.
///
/// With u = 2^-24, S = |x| + |y| + |z| + r, of the ball, n a normal and P the apex, n.p - n.P is at most `blur` for a point
/// p of the spot, n being within 16u of its like for the axis as it is. A box that meets the spot there has a corner with
/// n_i c_i <= n_i p_i, whose sum rounding makes larger by 5u of the products' sizes: of the positive ones, which are
/// not more than 2 S, and of the negative ones; should those be more than twice all others, the sum is negative.
LIGHTBIN_TARGET inline void store_planes(ViewSpot* to, const SpotLanes& spots) {
    const Floats apex[] = {spots.x, spots.y, spots.z}, (&axis)[3] = spots.axis;
    const auto backward = less(axis[2], Floats{});
    const Floats sign = select(backward, all(-1.0f), all(1.0f)), p = -1.0f / (sign + axis[2]);
    const Floats xp = mul(axis[0], p), q = mul(axis[1], xp);
    const Floats across[2][3] = {{1.0f + mul(mul(sign, axis[0]), xp), sign * q, -(sign * axis[0])},
                                 {q, sign + mul(axis[1], mul(axis[1], p)), -axis[1]}};
    const Floats slack =
        spots.blur + mul(abs(apex[0]) + abs(apex[1]) + abs(apex[2]) + spots.radius, all(0x1p-18f));
    Floats back[3];
    for (unsigned i = 0; i < 3; ++i)
        back[i] = mul(axis[i], spots.sine);
    for (unsigned plane = 0; plane < 4; ++plane) {
        Floats n[3], at_apex = slack;
        for (unsigned i = 0; i < 3; ++i) {
            const Floats aside = mul(across[plane / 2][i], spots.cosine);
            n[i] = (plane % 2 == 0 ? aside : -aside) - back[i];
            at_apex = at_apex + mul(n[i], apex[i]);
        }
        Sphere vec4s[lanes];
        store_spheres(vec4s, n[0], n[1], n[2], at_apex);
        store_part(to, offsetof(ViewSpot, planes) + plane * sizeof(SpotPlane), vec4s);
        for (unsigned i = 0; i < 3; ++i) {
            const float low = static_cast<float>(i == 2 ? 0 : 128 + 128 * i);  // where its low ends are
            std::uint16_t corners[lanes];
            store_tiles(corners, select(less(n[i], Floats{}), all(low + 64), all(low)));
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                to[lane].corners[plane][i] = corners[lane];
        }
    }
}

/// Stores what else is known of a vector of spots.
LIGHTBIN_TARGET inline void store_spots(ViewSpot* to, const SpotLanes& spots, Floats nearest,
                                        Floats farthest) {
    Sphere vec4s[lanes];
    store_spheres(vec4s, spots.x, spots.y, spots.z, spots.radius);
    store_part(to, offsetof(ViewSpot, ball), vec4s);
    store_spheres(vec4s, spots.axis[0], spots.axis[1], spots.axis[2], spots.cosine);
    store_part(to, offsetof(ViewSpot, axis_x), vec4s);
    store_spheres(vec4s, nearest, farthest, spots.sine, spots.blur);
    store_part(to, offsetof(ViewSpot, nearest), vec4s);
}

/// Of some of a chunk's lights: the tiles of both the ball and the least sphere of each, by project_carefully().
LIGHTBIN_TARGET inline void project_both_carefully(const Camera& camera, const Sphere* balls,
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
        rects.x0[place] = (std::max)(rects.x0[place], second.x0[place]);
        rects.y0[place] = (std::max)(rects.y0[place], second.y0[place]);
        rects.x1[place] = (std::min)(rects.x1[place], second.x1[place]);
        rects.y1[place] = (std::min)(rects.y1[place], second.y1[place]);
        const bool any = (also[place / lanes] >> place % lanes & 1) != 0 &&
                         rects.x0[place] <= rects.x1[place] && rects.y0[place] <= rects.y1[place];
        if (!any) visible[place / lanes] &= ~(1u << place % lanes);
    }
}

/// What spots cover along the image axes: slopes or, orthographic, coordinates.
struct ImageBounds {
    Floats left, right, bottom, top;
};

LIGHTBIN_TARGET LIGHTBIN_INLINE void find_coordinates(const SpotLanes& spots, ImageBounds& bounds) {
    const Floats x2 = mul(spots.axis[0], spots.axis[0]), y2 = mul(spots.axis[1], spots.axis[1]),
                 z2 = mul(spots.axis[2], spots.axis[2]), across_x = sqrt(y2 + z2), across_y = sqrt(x2 + z2);
    bounds = {spots.x - spot_reach(spots, -spots.axis[0], across_x),
              spots.x + spot_reach(spots, spots.axis[0], across_x),
              spots.y - spot_reach(spots, -spots.axis[1], across_y),
              spots.y + spot_reach(spots, spots.axis[1], across_y)};
}

/// Of spots whose balls lie beyond the near plane; `size` is |x| + |y| + |z| + r of the ball, `nearest` 2^-16 of it at least.
LIGHTBIN_TARGET LIGHTBIN_INLINE void find_slopes(const SpotLanes& spots, Floats size, Floats nearest,
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
                          (mul(size, all(0x1p-18f)) + spots.blur) / nearest};
    narrow_slopes(rim, spots.x, spots.axis[0], spots.axis[1], bounds.left, bounds.right);
    narrow_slopes(rim, spots.y, spots.axis[1], spots.axis[0], bounds.bottom, bounds.top);
}

/// Appends the footprints of those of the spots first..first + count - 1 that are in view, as project() does.
LIGHTBIN_TARGET inline void project_spots(const Camera& camera, const SpotSource& source, std::uint32_t first,
                                          std::uint32_t count, const FootprintArrays& out,
                                          ProjectCounts& counts) {
    ChunkRects rects;
    unsigned visible[ChunkRects::size / lanes];
    std::uint8_t careful[ChunkRects::size];
    Sphere balls[ChunkRects::size],
        cones[ChunkRects::size];  // as given, then of careful ones balls and least spheres
    const MoveLanes move(source.to_view);
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = count < ChunkRects::size ? count : ChunkRects::size;
        source.copy(source.lights, first, here, balls, cones);
        for (std::uint32_t i = here; i % lanes != 0; ++i) {
            balls[i] = balls[0];
            cones[i] = cones[0];
        }
        std::uint32_t careful_count = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            SpotLanes spots;
            shape_spots(camera, move, balls + i, cones + i, spots);
            const Floats r = spots.radius, across_z = sqrt(mul(spots.axis[0], spots.axis[0]) +
                                                           mul(spots.axis[1], spots.axis[1]));
            const Floats nearest = spots.z - spot_reach(spots, -spots.axis[2], across_z),
                         farthest = spots.z + spot_reach(spots, spots.axis[2], across_z);

            // As project() does, which says why.
            const Floats a = abs(spots.x), b = abs(spots.y), size = a + b + abs(spots.z) + r;
            const Floats aside = greater(mul(a, all(camera.x.side)) + mul(spots.z, all(camera.x.side_z)),
                                         mul(b, all(camera.y.side)) + mul(spots.z, all(camera.y.side_z)));
            const auto usable = both(less_equal(size, all(0x1p40f)), less_equal(all(0x1p-40f), r));
            const auto beyond =
                either(less(farthest, all(camera.near_depth)), less(all(camera.far_depth), nearest));
            const auto culled = both(usable, either(beyond, less(size * 0x1p-21f, aside - r)));
            const unsigned used = here - i < lanes ? here - i : lanes,
                           valid = used < 32 ? (1u << used) - 1 : ~0u;
            unsigned& in_view = visible[i / lanes] = 0;
            if ((~bits(culled) & valid) == 0) continue;
            if (source.kept != nullptr) store_spots(source.kept + first + i, spots, nearest, farthest);
            if (source.with_planes) store_planes(source.kept + first + i, spots);
            auto plain = and_not(usable, culled);
            ImageBounds bounds;
            if (camera.orthographic) {
                find_coordinates(spots, bounds);
            } else {
                plain = both(plain,
                             both(less(all(camera.near_fast), spots.z - r), less(size * 0x1p-16f, nearest)));
                find_slopes(spots, size, nearest, across_z, bounds);
            }
            unsigned rest = ~bits(either(plain, culled)) & valid;
            if (rest != 0) store_both_spheres(camera, spots, balls + i, cones + i);
            for (; rest != 0; rest &= rest - 1)
                careful[careful_count++] =
                    static_cast<std::uint8_t>(i + static_cast<unsigned>(std::countr_zero(rest)));
            plain = tile_span(camera.x, camera.x.scale_f, camera.x.offset_f, bounds.left, bounds.right, plain,
                              rects.x0 + i, rects.x1 + i);
            plain = tile_span(camera.y, camera.y.scale_f, camera.y.offset_f, bounds.bottom, bounds.top, plain,
                              rects.y0 + i, rects.y1 + i);
            in_view = bits(plain) & valid;
        }
        for (std::uint32_t i = 0; i < careful_count; i += lanes)
            project_both_carefully(camera, balls, cones, careful + i,
                                   careful_count - i < lanes ? careful_count - i : lanes, rects, visible,
                                   counts);
        for (std::uint32_t i = 0; i < here; i += lanes)
            if (visible[i / lanes] != 0) append_visible(out, counts, first, visible[i / lanes], rects, i);
    }
}
