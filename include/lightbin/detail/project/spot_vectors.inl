// SPDX-License-Identifier: MIT
// Spots as they are given to spots in view space, a vector of lights at a time, and what is kept of them for the later
// stages, ViewSpots; view_spot.hpp says how it rounds. Included once a tier, after move.inl.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/world_to_view.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A vector of spots, see ViewSpot.
struct SpotLanes {
    Floats x, y, z, radius, axis[3], cosine, sine, blur;
};

/// Makes whole spheres of those of a vector's spots that floats can't hold: their least spheres.
///
/// balls, cones  the spots as they were given, see LightSource
LIGHTBIN_NOINLINE inline void take_least_spheres(const WorldToView* to_view, unsigned which,
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
LIGHTBIN_INLINE void shape_spots(const Camera& camera, const MoveLanes& move,
                                                 const Sphere* balls, const Sphere* cones, SpotLanes& spots) {
    Floats axis[3], cosine;
    load_spheres(balls, spots.x, spots.y, spots.z, spots.radius);
    load_spheres(cones, axis[0], axis[1], axis[2], cosine);
    const Floats given_radius = spots.radius;
    const Floats away = abs(spots.x) + abs(spots.y) + abs(spots.z),
                 long_axis = abs(axis[0]) + abs(axis[1]) + abs(axis[2]);
    // What floats can make a ViewSpot of; others are binned as their least spheres.
    auto plain = both(less_equal(away, broadcast(float_safe_max)), less_equal(abs(cosine), broadcast(1.0f)));
    plain = both(plain,
                 both(less_equal(broadcast(float_safe_min), given_radius), less_equal(given_radius, broadcast(float_safe_max))));
    plain = both(plain, both(less_equal(broadcast(0x1p-20f), long_axis), less_equal(long_axis, broadcast(0x1p20f))));
    Floats blur = mul(spots.radius, broadcast(0x1p-18f));
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
        blur = mul(spots.radius, broadcast(0x1p-18f)) + (off + mul(spots.radius, move.bend));
        plain = both(plain, less_equal(move.bend, broadcast(1.0f)));
    }
    const auto whole = less_equal(cosine, broadcast(0.0f));
    const Floats zero = Floats{};
    const Floats per_length =
        1.0f / sqrt(mul(axis[0], axis[0]) + mul(axis[1], axis[1]) + mul(axis[2], axis[2]));
    for (unsigned row = 0; row < 3; ++row)
        spots.axis[row] = select(whole, zero, mul(axis[row], per_length));
    spots.cosine = select(whole, zero, cosine);
    spots.sine = select(whole, broadcast(1.0f), sqrt(mul(1.0f - cosine, 1.0f + cosine)));
    spots.blur = select(whole, zero, blur);
    if (const unsigned odd = ~movemask(plain) & static_cast<unsigned>(every_lane); odd != 0)
        take_least_spheres(move.to_view, odd, balls, cones, spots);
    const Floats signs[] = {broadcast(camera.x.sign), broadcast(camera.y.sign), broadcast(camera.z_sign)};
    spots.x = spots.x * signs[0];
    spots.y = spots.y * signs[1];
    spots.z = spots.z * signs[2];
    for (unsigned i = 0; i < 3; ++i)
        spots.axis[i] = spots.axis[i] * signs[i];
}

/// How far spots reach from their apex along an axis, on which the cone's axis has the coordinate `along`, beside it the
/// length `across`.
inline Floats spot_reach(const SpotLanes& spots, Floats along, Floats across) {
    const Floats rim =
        minimum(maximum(mul(spots.cosine, along) + mul(spots.sine, across), Floats{}), broadcast(1.0f));
    const Floats part = select(less_equal(spots.cosine, along), broadcast(1.0f), rim);
    return minimum(mul(spots.radius, part) + spots.blur, spots.radius);
}

/// Copies vec4s, one a spot, to a place in each.
inline void store_part(ViewSpot* to, std::size_t place, const Sphere (&vec4s)[lanes]) {
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
inline void store_planes(ViewSpot* to, const SpotLanes& spots) {
    const Floats apex[] = {spots.x, spots.y, spots.z}, (&axis)[3] = spots.axis;
    const auto backward = less(axis[2], Floats{});
    const Floats sign = select(backward, broadcast(-1.0f), broadcast(1.0f)), p = -1.0f / (sign + axis[2]);
    const Floats xp = mul(axis[0], p), q = mul(axis[1], xp);
    const Floats across[2][3] = {{1.0f + mul(mul(sign, axis[0]), xp), sign * q, -(sign * axis[0])},
                                 {q, sign + mul(axis[1], mul(axis[1], p)), -axis[1]}};
    const Floats slack =
        spots.blur + mul(abs(apex[0]) + abs(apex[1]) + abs(apex[2]) + spots.radius, broadcast(0x1p-18f));
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
            store_tiles(corners, select(less(n[i], Floats{}), broadcast(low + 64), broadcast(low)));
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                to[lane].corners[plane][i] = corners[lane];
        }
    }
}

/// Stores what else is known of a vector of spots.
inline void store_spots(ViewSpot* to, const SpotLanes& spots, Floats nearest,
                                        Floats farthest) {
    Sphere vec4s[lanes];
    store_spheres(vec4s, spots.x, spots.y, spots.z, spots.radius);
    store_part(to, offsetof(ViewSpot, ball), vec4s);
    store_spheres(vec4s, spots.axis[0], spots.axis[1], spots.axis[2], spots.cosine);
    store_part(to, offsetof(ViewSpot, axis_x), vec4s);
    store_spheres(vec4s, nearest, farthest, spots.sine, spots.blur);
    store_part(to, offsetof(ViewSpot, nearest), vec4s);
}

}}}}  // namespace lightbin::detail
