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

/// Writes the places of the least and the greatest depth of the `count` spheres that `ids` number. Whole vectors are
/// written. Places are less than 2^15.
LIGHTBIN_TARGET inline void slice_places(const SlicePlaces& to, float z_sign, const Sphere* spheres,
                                         const std::uint32_t* ids, std::uint32_t count, std::uint16_t* nearest,
                                         std::uint16_t* farthest) {
    for (std::uint32_t i = 0; i < count; i += lanes, ids += lanes) {
        std::uint32_t filled_up[lanes];
        const bool whole = count - i >= lanes;
        if (!whole)
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                filled_up[lane] = ids[(std::min)(lane, count - i - 1)];
        Floats x, y, z, radius;
        load_spheres_at(spheres, whole ? ids : filled_up, x, y, z, radius);
        z = z * all(z_sign);
        store_tiles(nearest + i, slice_place(to, z - radius));
        store_tiles(farthest + i, slice_place(to, z + radius));
    }
}
