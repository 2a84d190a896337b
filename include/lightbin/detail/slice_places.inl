// SPDX-License-Identifier: MIT
// The places of lights' depths in a SliceTable, a vector at a time. Included once a tier, after its vectors.

/// SlicePlaces::of() of each lane.
LIGHTBIN_TARGET inline Floats slice_place(const SlicePlaces& to, Floats depth) {
    depth = depth + all(0.0f);  // not -0
    const Floats place = mul((to.by_bits ? ascending_bits(depth) : depth) - all(to.begin), all(to.scale));
    return lesser(greater(place, all(0.0f)), all(to.last));
}

#if !defined(LIGHTBIN_TIER_COMPRESSES)
/// As load_spheres(), of the spheres at `lanes` places.
LIGHTBIN_TARGET inline void load_spheres_at(const Sphere* spheres, const std::uint32_t* places, Floats& x, Floats& y,
                                            Floats& z, Floats& radius) {
    Sphere some[lanes];
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        some[lane] = load_sphere(spheres + places[lane]);
    load_spheres(some, x, y, z, radius);
}
#endif

/// Finds the depths of the lights that `lanes` ids number.
template <bool spots>
LIGHTBIN_TARGET inline void load_depths(const FootprintArrays& lights, float z_sign, const std::uint32_t* ids,
                                        Floats& nearest, Floats& farthest) {
    if constexpr (spots) {
        float ends[2][lanes];
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            ends[0][lane] = lights.spots[ids[lane]].nearest;
            ends[1][lane] = lights.spots[ids[lane]].farthest;
        }
        nearest = load_floats(ends[0]);
        farthest = load_floats(ends[1]);
    } else {
        Floats x, y, z, radius;
        load_spheres_at(lights.spheres, ids, x, y, z, radius);
        z = z * all(z_sign);
        nearest = z - radius;
        farthest = z + radius;
    }
}

/// Writes the places of the least and the greatest depth of the `count` lights that `ids` number. Whole vectors are
/// written. Places are less than 2^15.
template <bool spots>
LIGHTBIN_TARGET inline void slice_places(const SlicePlaces& to, float z_sign, const FootprintArrays& lights,
                                         const std::uint32_t* ids, std::uint32_t count, std::uint16_t* nearest,
                                         std::uint16_t* farthest) {
    for (std::uint32_t i = 0; i < count; i += lanes, ids += lanes) {
        std::uint32_t filled_up[lanes];
        const bool whole = count - i >= lanes;
        if (!whole)
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                filled_up[lane] = ids[min_of(lane, count - i - 1)];
        Floats least, most;
        load_depths<spots>(lights, z_sign, whole ? ids : filled_up, least, most);
        store_tiles(nearest + i, slice_place(to, least));
        store_tiles(farthest + i, slice_place(to, most));
    }
}
