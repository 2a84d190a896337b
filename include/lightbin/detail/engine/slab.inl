// SPDX-License-Identifier: MIT
// A vector of lights against the boxes of a slice's cells, for step 2 of bin.inl (store_slab_words). The cells have the
// same depths, so squared distances are sums of one along x by column, one along y by row and one along z: few
// numbers, and one comparison a tile. Lights lie side by side, as step 3 takes them: words need not be transposed.
//
// A light is too far from a box if  less(reach2 - z2 - y2, x2),  see cell_boxes.hpp on rounding; NaN, where reach2 and
// a distance are infinite, is not. There is no test of depths, which are those of the slice and in view.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/engine/cells.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The distances of coordinates from intervals.
inline Floats distance(Floats c, Floats low, Floats high) {
    return maximum(maximum(low - c, c - high), broadcast(0.0f));
}
inline Floats distance2(Floats c, float low, float high) {
    const Floats d = distance(c, broadcast(low), broadcast(high));
    return mul(d, d);
}

/// As TestedLight::reach2.
inline Floats reach2_of(Floats radius) {
    return mul(mul(radius, radius), broadcast(1 + 0x1p-20f)) + broadcast(0x1p-125f);
}

/// A vector of lights, see TestedLight. Each of their tests says that a light misses the tiles of a row and a column
/// for which  left_by_row < by_column.
struct SlabSpheres {
    static constexpr unsigned tests = 1;

    Floats left_by_row(unsigned, float low, float high) const {
        return left - distance2(y, low, high);
    }
    Floats by_column(unsigned, float low, float high) const { return distance2(x, low, high); }

    Floats x, y;
    Floats left;  ///< of reach2, what the distance from the slice leaves
};

/// The same of spots: their balls' test, and one for each of the half spaces around a cone, see boxes_missed(), of
/// which a box's deepest corner is a sum of a term by column, one by row and one of the slice.
struct SlabSpots {
    static constexpr unsigned tests = 5;

    Floats left_by_row(unsigned test, float low, float high) const {
        return test == 4 ? ball.left_by_row(0, low, high) : left[test] - deepest(y[test], low, high);
    }
    Floats by_column(unsigned test, float low, float high) const {
        return test == 4 ? ball.by_column(0, low, high) : deepest(x[test], low, high);
    }
    static Floats deepest(Floats normal, float low, float high) {
        return mul(normal, select(less(normal, broadcast(0.0f)), broadcast(high), broadcast(low)));
    }

    SlabSpheres ball;
    Floats x[4], y[4];  ///< of the planes' normals
    Floats left[4];     ///< `most` less what the slice takes
};

/// Spheres in the coordinates of the boxes.
inline SlabSpheres slab_spheres(const SlabBoxes& slab, Floats x, Floats y, Floats z,
                                                Floats radius) {
    return {x, y, reach2_of(radius) - distance2(z, slab.z0, slab.z1)};
}

/// Those of a list, `count` or as many as a vector has, whose spheres are at these places.
inline SlabSpheres load_slab_lights(const Camera& camera, const SlabBoxes& slab,
                                                    const Sphere* spheres, const ListId* places,
                                                    std::uint32_t count) {
    Floats x, y, z, radius;
    load_listed_spheres(spheres, places, count, x, y, z, radius);
    return slab_spheres(slab, mul(x, broadcast(camera.x.sign)), mul(y, broadcast(camera.y.sign)), mul(z, broadcast(camera.z_sign)),
                        radius);
}

/// The same of spots.
inline SlabSpots load_slab_lights(const Camera&, const SlabBoxes& slab, const ViewSpot* spots,
                                                  const ListId* places, std::uint32_t count) {
    Sphere balls[lanes], planes[4][lanes];
    for (std::uint32_t i = 0; i < lanes; ++i) {
        const ViewSpot& spot = spots[places[min_of(i, count - 1)]];
        balls[i] = spot.ball;
        for (unsigned plane = 0; plane < 4; ++plane)
            std::memcpy(&planes[plane][i], &spot.planes[plane], sizeof(Sphere));
    }
    Floats x, y, z, radius;
    load_spheres(balls, x, y, z, radius);
    SlabSpots lights;
    lights.ball = slab_spheres(slab, x, y, z, radius);
    for (unsigned plane = 0; plane < 4; ++plane) {
        load_spheres(planes[plane], lights.x[plane], lights.y[plane], z, radius);
        lights.left[plane] = radius - SlabSpots::deepest(z, slab.z0, slab.z1);
    }
    return lights;
}

/// Where a job's lights are, by id.
template <bool spots, class Id> auto lights_of(const BinJob<Id>& job) {
    if constexpr (spots)
        return job.lights.spots;
    else
        return job.lights.spheres;
}

/// The boxes of a slice in the supertile from column 8 x and row `top` on, as many rows as there are.
struct SupertileBoxes {
    SlabBoxes slab;
    unsigned rows;
};
template <class Id>
SupertileBoxes boxes_at(const BinJob<Id>& job, const Scratch& scratch, unsigned x, unsigned top) {
    SlabBoxes slab = scratch.slab;
    for (unsigned side = 0; side < 4; ++side)
        slab.ends[side] += side < 2 ? 8 * x : top;
    return {slab, min_of(8u, static_cast<unsigned>(job.camera->y.tiles) - top)};
}

}}}}  // namespace lightbin::detail
