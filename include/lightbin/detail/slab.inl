// SPDX-License-Identifier: MIT
// A vector of lights against the boxes of a slice's cells, for step 2 of bin.inl (store_slab_words). The cells have the
// same depths, so squared distances are sums of one along x by column, one along y by row and one along z: few
// numbers, and one comparison a tile. Lights lie side by side, as step 3 takes them: words need not be transposed.
//
// A light is too far from a box if  less(reach2 - z2 - y2, x2),  see cell_boxes.hpp on rounding; NaN, where reach2 and
// a distance are infinite, is not. There is no test of depths, which are those of the slice and in view.
//
// Of spheres alone: spots have five tests in place of one, and mostly take less where the tiles outside of their rectangles
// are not tested, as words.inl does it.

/// The distances of coordinates from intervals.
LIGHTBIN_TARGET inline Floats distance(Floats c, Floats low, Floats high) {
    return greater(greater(low - c, c - high), all(0.0f));
}
LIGHTBIN_TARGET inline Floats distance2(Floats c, float low, float high) {
    const Floats d = distance(c, all(low), all(high));
    return mul(d, d);
}

/// As TestedLight::reach2.
LIGHTBIN_TARGET inline Floats reach2_of(Floats radius) {
    return mul(mul(radius, radius), all(1 + 0x1p-20f)) + all(0x1p-125f);
}

/// A vector of lights, see TestedLight. `left` is of reach2 what the distance from the slice leaves.
struct SlabLights {
    Floats x, y, left;
};

/// Those of a list, `count` or as many as a vector has, whose spheres are at these places.
LIGHTBIN_TARGET inline SlabLights load_slab_lights(const Camera& camera, const SlabBoxes& slab,
                                                   const Sphere* spheres, const ListId* places,
                                                   std::uint32_t count) {
    Floats x, y, z, radius;
    load_listed_spheres(spheres, places, count, x, y, z, radius);
    return {mul(x, all(camera.x.sign)), mul(y, all(camera.y.sign)),
            reach2_of(radius) - distance2(mul(z, all(camera.z_sign)), slab.z0, slab.z1)};
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
