// SPDX-License-Identifier: MIT
// The places of depths in a SliceTable, a vector at a time. Included once a tier, after its vectors.

/// Writes what SlicePlaces::of() returns of `count` depths. Whole vectors are read and written. Places are less than 2^15.
LIGHTBIN_TARGET inline void slice_places(const SlicePlaces& to, const float* depths, std::uint32_t count,
                                         std::uint16_t* places) {
    const Floats begin = all(to.begin), scale = all(to.scale), last = all(to.last), zero = all(0.0f);
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const Floats depth = load_floats(depths + i) + zero;  // not -0
        const Floats place = mul((to.by_bits ? ascending_bits(depth) : depth) - begin, scale);
        store_tiles(places + i, lesser(greater(place, zero), last));
    }
}
