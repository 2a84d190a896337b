// SPDX-License-Identifier: MIT
// The places of lights' depths in a SliceTable, a vector at a time. Included once a tier, after its vectors.

/// SlicePlaces::of() of each lane.
LIGHTBIN_TARGET inline Floats slice_place(const SlicePlaces& to, Floats depth) {
    depth = depth + all(0.0f);  // not -0
    const Floats place = mul((to.by_bits ? ascending_bits(depth) : depth) - all(to.begin), all(to.scale));
    return lesser(greater(place, all(0.0f)), all(to.last));
}

/// Writes the places of the least and the greatest depth of `count` spheres. Whole vectors are read and written. Places
/// are less than 2^15.
LIGHTBIN_TARGET inline void slice_places(const SlicePlaces& to, float z_sign, const Sphere* spheres,
                                         std::uint32_t count, std::uint16_t* nearest, std::uint16_t* farthest) {
    for (std::uint32_t i = 0; i < count; i += lanes) {
        Floats x, y, z, radius;
        load_spheres(spheres + i, x, y, z, radius);
        z = z * all(z_sign);
        store_tiles(nearest + i, slice_place(to, z - radius));
        store_tiles(farthest + i, slice_place(to, z + radius));
    }
}
