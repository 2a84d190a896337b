// SPDX-License-Identifier: MIT
// A vector of lights against the boxes of a slice's cells, for step 2 of bin.inl (store_slab_words). The cells have the
// same depths, so squared distances are sums of one along x by column, one along y by row and one along z: few
// numbers, and one comparison a tile. Lights lie side by side, as step 3 takes them: words need not be transposed.
//
// A light is too far from a box if  less(reach2 - z2 - y2, x2),  see cell_boxes.hpp on rounding; NaN, where reach2 and
// a distance are infinite, is not. There is no test of depths, which are those of the slice and in view.

/// A vector of lights, see TestedLight.
struct SlabLights {
    Floats x, y;
    Floats reach2;  ///< less the squared distance from the slice
};

/// Those of a list, `count` or as many as a vector has, whose spheres are at these places.
LIGHTBIN_TARGET inline SlabLights load_slab_lights(const Camera& camera, const SlabBoxes& slab,
                                                   const Sphere* spheres, const ListId* places,
                                                   std::uint32_t count) {
    Floats x, y, z, radius;
    load_listed_spheres(spheres, places, count, x, y, z, radius);
    z = mul(z, all(camera.z_sign));
    const Floats apart = greater(greater(all(slab.z0) - z, z - all(slab.z1)), all(0.0f));
    const Floats reach2 = mul(mul(radius, radius), all(1 + 0x1p-20f)) + all(0x1p-125f);
    return {mul(x, all(camera.x.sign)), mul(y, all(camera.y.sign)), reach2 - mul(apart, apart)};
}

/// The squared distances of coordinates from an interval.
LIGHTBIN_TARGET inline Floats distance2(Floats c, float low, float high) {
    const Floats distance = greater(greater(all(low) - c, c - all(high)), all(0.0f));
    return mul(distance, distance);
}
