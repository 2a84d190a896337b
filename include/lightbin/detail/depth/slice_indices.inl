// SPDX-License-Identifier: MIT
// Finds the view depths of lights and, to find the depth slices that they meet, the entries (buckets) of a SliceTable's
// lookup table for these depths. A vector of lights at a time. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/vectors/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Returns in which buckets, a lookup table's depth intervals, a vector of depths lies, before truncation to integers.
/// It computes what DepthBuckets::index_of() does, in the same operations.
inline Floats bucket_of(const DepthBuckets& buckets, Floats depth) {
    depth = depth + broadcast(0.0f);  // makes -0 to 0
    const Floats coordinate = buckets.by_bits ? ascending_bits(depth) : depth;
    const Floats bucket = mul(coordinate - broadcast(buckets.begin), broadcast(buckets.scale));
    return minimum(maximum(bucket, broadcast(0.0f)), broadcast(buckets.last));
}

/// Finds the least and the greatest view depth of each of `count` lights, and in which buckets, a lookup table's depth
/// intervals, these depths lie. Whole vectors of ids are read, so elements after the last id must exist and be the ids
/// of lights of the same kind. The lights of one call are of one kind, the first one's if `kind` is `mixed`. Rounding
/// is monotone, so a light whose exact depths meet an interval between two floats meets it with its rounded ones.
template <LightKind kind>
inline void find_depth_buckets(const DepthBuckets& buckets, float z_sign, const FootprintArrays& lights,
                               const std::uint32_t* ids, std::uint32_t count, LightDepths& out) {
    if constexpr (kind == LightKind::mixed) {
        const LightKind first = lights.view_lights.kind_of(*ids);
        const auto find = first == LightKind::sphere ? find_depth_buckets<LightKind::sphere>
                          : first == LightKind::spot ? find_depth_buckets<LightKind::spot>
                                                     : find_depth_buckets<LightKind::box>;
        return find(buckets, z_sign, lights, ids, count, out);
    }
    for (std::uint32_t i = 0; i < count; i += lanes) {
        Floats nearest, farthest;
        if constexpr (kind == LightKind::spot || kind == LightKind::box) {
            for (std::uint32_t lane = i; lane < i + lanes; ++lane) {
                const auto& light = lights.view_lights.shape<kind>(ids[lane]);
                out.nearest[lane] = light.nearest;
                out.farthest[lane] = light.farthest;
            }
            nearest = load_floats(out.nearest + i);
            farthest = load_floats(out.farthest + i);
        } else {
            Sphere listed[lanes];
            LIGHTBIN_UNROLL for (std::uint32_t lane = 0; lane < lanes; ++lane)
                listed[lane] = load_sphere(lights.view_lights.spheres + ids[i + lane]);
            Floats x, y, z, radius;
            load_spheres(listed, x, y, z, radius);
            z = z * broadcast(z_sign);
            nearest = z - radius;
            farthest = z + radius;
        }
        store_floats(out.nearest + i, nearest);
        store_floats(out.farthest + i, farthest);
        store_tiles(out.first_bucket + i, bucket_of(buckets, nearest));
        store_tiles(out.last_bucket + i, bucket_of(buckets, farthest));
    }
}

}}}}  // namespace lightbin::detail
