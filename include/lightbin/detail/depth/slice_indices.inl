// SPDX-License-Identifier: MIT
// The view depths of lights and their buckets in a SliceTable's lookup table, a vector of lights at a time. Included
// once per tier.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Returns the buckets of a vector of depths, by the arithmetic of DepthBuckets::index_of(), before truncation to
/// integers.
inline Floats bucket_of(const DepthBuckets& buckets, Floats depth) {
    depth = depth + broadcast(0.0f);  // makes -0 to 0
    const Floats coordinate = buckets.by_bits ? ascending_bits(depth) : depth;
    const Floats bucket = mul(coordinate - broadcast(buckets.begin), broadcast(buckets.scale));
    return minimum(maximum(bucket, broadcast(0.0f)), broadcast(buckets.last));
}

/// Finds the least and the greatest view depth of the lights with `lanes` ids. Rounding is monotone, so a light whose
/// exact depths meet an interval between two floats meets it with its rounded ones.
template <bool spots>
inline void load_depths(const FootprintArrays& lights, float z_sign, const std::uint32_t* ids, Floats& nearest,
                        Floats& farthest) {
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

/// Finds the view depths of the lights with `count` ids, and the buckets of these. Whole vectors of ids are read.
template <bool spots>
inline void find_depth_buckets(const DepthBuckets& buckets, float z_sign, const FootprintArrays& lights,
                               const std::uint32_t* ids, std::uint32_t count, LightDepths& out) {
    for (std::uint32_t i = 0; i < count; i += lanes) {
        Floats nearest, farthest;
        load_depths<spots>(lights, z_sign, ids + i, nearest, farthest);
        store_floats(out.nearest + i, nearest);
        store_floats(out.farthest + i, farthest);
        store_tiles(out.first_bucket + i, bucket_of(buckets, nearest));
        store_tiles(out.last_bucket + i, bucket_of(buckets, farthest));
    }
}

}}}}  // namespace lightbin::detail
