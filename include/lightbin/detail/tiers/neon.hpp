// SPDX-License-Identifier: MIT
// The NEON tier's vectors: phones and Apple's machines, every 64-bit ARM. Four lights at a time.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/tiers/tier.hpp>

#if defined(LIGHTBIN_NEON)

#include <arm_neon.h>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace neon {

using Floats = float32x4_t;
using Doubles = float64x2_t;
using FloatRegister = Floats;
using DoubleRegister = Doubles;
using ListId = std::uint32_t;
inline constexpr std::uint32_t lanes = 4, double_lanes = 2;

#include <lightbin/detail/tiers/numbers.inl>

inline Floats broadcast(float each) {
    return vdupq_n_f32(each);
}
inline Doubles broadcast(double each) {
    return vdupq_n_f64(each);
}
inline Floats sqrt(Floats a) {
    return vsqrtq_f32(a);
}
inline Doubles sqrt(Doubles a) {
    return vsqrtq_f64(a);
}
inline unsigned movemask(decltype(Floats{} < Floats{}) mask) {
    static constexpr std::uint32_t each[] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(reinterpret_cast<uint32x4_t>(mask), vld1q_u32(each)));
}
inline unsigned movemask(decltype(Doubles{} < Doubles{}) mask) {
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2));
}

/// Counts of a column's tiles, and tiles: for scatter.inl.
struct Rows {
    uint32x4_t v;
};
using Tiles = uint64x2_t;
inline Rows operator+(Rows a, Rows b) {
    return {a.v + b.v};
}
inline Rows operator-(Rows a, Rows b) {
    return {a.v - b.v};
}
inline Rows all_rows(std::uint32_t count) {
    return {vdupq_n_u32(count)};
}
inline Rows last_row(Rows rows) {
    return {vdupq_laneq_u32(rows.v, 3)};
}
inline Tiles low_pairs(Rows ends, Rows counts) {
    return vreinterpretq_u64_u32(vzip1q_u32(ends.v, counts.v));
}
inline Tiles high_pairs(Rows ends, Rows counts) {
    return vreinterpretq_u64_u32(vzip2q_u32(ends.v, counts.v));
}
inline void transpose(Tiles* columns) {
    const Tiles low = vzip1q_u64(columns[0], columns[1]);
    columns[1] = vzip2q_u64(columns[0], columns[1]);
    columns[0] = low;
}

/// Half 0 or 1 of the lanes.
inline Doubles widened(Floats a, unsigned half) {
    return half == 0 ? vcvt_f64_f32(vget_low_f32(a)) : vcvt_high_f64_f32(a);
}

inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    const float32x4x4_t columns = vld4q_f32(&spheres->x);
    x = columns.val[0];
    y = columns.val[1];
    z = columns.val[2];
    radius = columns.val[3];
}
inline void store_spheres(Sphere* spheres, Floats x, Floats y, Floats z, Floats radius) {
    const float32x4x4_t columns = {{x, y, z, radius}};  // by name: for clang vst4q_f32 is a macro
    vst4q_f32(&spheres->x, columns);
}

inline Floats ascending_bits(Floats values) {
    const int32x4_t bits = vreinterpretq_s32_f32(values);
    const uint32x4_t but_sign = vshrq_n_u32(vreinterpretq_u32_s32(vshrq_n_s32(bits, 31)), 1);
    return vcvtq_f32_s32(veorq_s32(bits, vreinterpretq_s32_u32(but_sign)));
}
inline void store_tiles(std::uint16_t* tiles, Floats values) {
    vst1_u16(tiles, vmovn_u32(vcvtq_u32_f32(values)));
}
inline void store_tiles(std::uint16_t* tiles, Doubles values) {
    tiles[0] = static_cast<std::uint16_t>(vgetq_lane_f64(values, 0));
    tiles[1] = static_cast<std::uint16_t>(vgetq_lane_f64(values, 1));
}
inline void store_spans(RowSpan* spans, Doubles first, Doubles last) {
    const uint64x2_t pairs = vorrq_u64(vcvtq_u64_f64(first), vshlq_n_u64(vcvtq_u64_f64(last), 16));
    const uint32x2_t narrow = vmovn_u64(pairs);
    std::memcpy(spans, &narrow, sizeof narrow);
}

using portable::append;
using portable::Packed;
using portable::packs_ids;
using portable::split_bits;
using portable::transpose_words;

}}}}  // namespace lightbin::detail

#define LIGHTBIN_TIER neon
#define LIGHTBIN_TIER_HAS_ROWS
#include <lightbin/detail/tiers/kernels.inl>


#endif
