// SPDX-License-Identifier: MIT
// Spots as they are given to spots in view space, a vector of lights at a time; view_spot.hpp says how it rounds. Included
// once a tier, after move.inl.

/// A vector of spots, see ViewSpot.
struct SpotLanes {
    Floats x, y, z, radius, axis[3], cosine, sine, blur;
};

/// Makes whole spheres of those of a vector's spots that floats can't hold: their least spheres.
///
/// balls, cones  the spots as they were given, see LightSource
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

/// Moves spots to view space and finds what ViewSpot says of them, but for their depths.
LIGHTBIN_TARGET LIGHTBIN_INLINE void shape_spots(const Camera& camera, const MoveLanes& move,
                                                 const Sphere* balls, const Sphere* cones, SpotLanes& spots) {
    Floats axis[3], cosine;
    load_spheres(balls, spots.x, spots.y, spots.z, spots.radius);
    load_spheres(cones, axis[0], axis[1], axis[2], cosine);
    const Floats given_radius = spots.radius;
    const Floats away = abs(spots.x) + abs(spots.y) + abs(spots.z),
                 long_axis = abs(axis[0]) + abs(axis[1]) + abs(axis[2]);
    // What floats can make a ViewSpot of; others are binned as their least spheres.
    auto plain = both(less_equal(away, all(most_plain)), less_equal(abs(cosine), all(1.0f)));
    plain = both(plain, both(less_equal(all(least_plain), given_radius), less_equal(given_radius, all(most_plain))));
    plain = both(plain, both(less_equal(all(0x1p-20f), long_axis), less_equal(long_axis, all(0x1p20f))));
    Floats blur = mul(spots.radius, all(0x1p-18f));
    if (move.to_view != nullptr) {
        plain = both(plain, less_equal(abs(spots.x - move.origin[0]) + abs(spots.y - move.origin[1]) +
                                           abs(spots.z - move.origin[2]),
                                       move.most));
        const Floats given[] = {axis[0], axis[1], axis[2]};
        for (unsigned row = 0; row < 3; ++row)
            axis[row] = moved_direction(move, row, given[0], given[1], given[2]);
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
