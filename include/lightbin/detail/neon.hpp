// SPDX-License-Identifier: MIT
// The NEON tier's vectors: phones and Apple's machines, every 64-bit ARM. Four lights at a time.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/tier.hpp>

#if defined(LIGHTBIN_NEON)

#include <arm_neon.h>

#define LIGHTBIN_TARGET

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {
namespace neon {

// Not float32x4_t: clang gives that type no ?: operator.
using Floats = float __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(16)));
inline constexpr std::uint32_t lanes = 4, double_lanes = 2;

inline Floats sqrt(Floats a) {
    return (Floats)vsqrtq_f32((float32x4_t)a);
}
inline Doubles sqrt(Doubles a) {
    return (Doubles)vsqrtq_f64((float64x2_t)a);
}

#include <lightbin/detail/vectors.inl>

using Mask = decltype(less(Floats{}, Floats{}));
using DoubleMask = decltype(less(Doubles{}, Doubles{}));

inline unsigned bits(Mask mask) {
    return vaddvq_u32((uint32x4_t)(mask & Mask{1, 2, 4, 8}));
}
inline unsigned bits(DoubleMask mask) {
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2));
}

/// Half 0 or 1 of the lanes.
inline Doubles widened(Floats a, unsigned half) {
    const float32x4_t floats = (float32x4_t)a;
    return (Doubles)(half == 0 ? vcvt_f64_f32(vget_low_f32(floats)) : vcvt_high_f64_f32(floats));
}

inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    const float32x4x4_t columns = vld4q_f32(&spheres->x);
    x = (Floats)columns.val[0];
    y = (Floats)columns.val[1];
    z = (Floats)columns.val[2];
    radius = (Floats)columns.val[3];
}

inline void store_tiles(std::uint16_t* tiles, Floats values) {
    vst1_u16(tiles, vmovn_u32(vcvtq_u32_f32((float32x4_t)values)));
}
inline void store_tiles(std::uint16_t* tiles, Doubles values) {
    tiles[0] = static_cast<std::uint16_t>(values[0]);
    tiles[1] = static_cast<std::uint16_t>(values[1]);
}
inline void store_spans(RowSpan* spans, Doubles first, Doubles last) {
    for (unsigned i = 0; i < double_lanes; ++i)
        spans[i] = {static_cast<std::uint16_t>(first[i]), static_cast<std::uint16_t>(last[i])};
}

#include <lightbin/detail/depth_columns.inl>
#include <lightbin/detail/project.inl>
#include <lightbin/detail/silhouette.inl>
#include <lightbin/detail/tile_masks.inl>

#include <lightbin/detail/scatter.inl>
#include <lightbin/detail/supertile.inl>

}  // namespace neon
}  // namespace lightbin::detail

#undef LIGHTBIN_TARGET
#endif
