// SPDX-License-Identifier: MIT
// Lights' depths and their places in a SliceTable, a vector at a time. Included once a tier, after its vectors.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// DepthBuckets::of() of each lane.
inline Floats slice_place(const DepthBuckets& to, Floats depth) {
    depth = depth + broadcast(0.0f);  // not -0
    const Floats place = mul((to.by_bits ? ascending_bits(depth) : depth) - broadcast(to.begin), broadcast(to.scale));
    return minimum(maximum(place, broadcast(0.0f)), broadcast(to.last));
}

/// Finds the depths of the lights that `lanes` ids number. Rounding is monotone: comparing them with floats loses no light.
template <bool spots>
inline void load_depths(const FootprintArrays& lights, float z_sign, const std::uint32_t* ids,
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
        load_listed_spheres(lights.spheres, ids, lanes, x, y, z, radius);
        z = z * broadcast(z_sign);
        nearest = z - radius;
        farthest = z + radius;
    }
}

/// Finds the depths of the `count` lights that `ids` number, and their places. There are ids to fill up a vector.
template <bool spots>
inline void find_depth_buckets(const DepthBuckets& to, float z_sign, const FootprintArrays& lights,
                                         const std::uint32_t* ids, std::uint32_t count, LightDepths& out) {
    for (std::uint32_t i = 0; i < count; i += lanes) {
        Floats nearest, farthest;
        load_depths<spots>(lights, z_sign, ids + i, nearest, farthest);
        store_floats(out.nearest + i, nearest);
        store_floats(out.farthest + i, farthest);
        store_tiles(out.first + i, slice_place(to, nearest));
        store_tiles(out.last + i, slice_place(to, farthest));
    }
}

}}}}  // namespace lightbin::detail
