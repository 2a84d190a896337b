// SPDX-License-Identifier: MIT
// What is kept of spots for the later stages, ViewSpots, of a vector of them. Included once a tier, after spot_lanes.inl.

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
