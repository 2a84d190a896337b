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

using FloatRegister = float32x4_t;
using DoubleRegister = float64x2_t;
using ListId = std::uint32_t;
inline constexpr std::uint32_t lanes = 4, double_lanes = 2;

inline float32x4_t all_lanes(float each) {
    return vdupq_n_f32(each);
}
inline float32x4_t negated(float32x4_t a) {
    return vnegq_f32(a);
}

#define LIGHTBIN_VECTOR Floats
#define LIGHTBIN_ELEMENT float
#define LIGHTBIN_REGISTER float32x4_t
#define LIGHTBIN_OP(name) v##name##q_f32
#include <lightbin/detail/vector.inl>

/// All ones or all zeros a lane.
struct Mask {
    uint32x4_t v;
};
inline Mask less(Floats a, Floats b) {
    return {vcltq_f32(a, b)};
}
inline Mask less_equal(Floats a, Floats b) {
    return {vcleq_f32(a, b)};
}
inline Mask both(Mask a, Mask b) {
    return {vandq_u32(a.v, b.v)};
}
inline Mask either(Mask a, Mask b) {
    return {vorrq_u32(a.v, b.v)};
}
inline Mask and_not(Mask a, Mask b) {
    return {vbicq_u32(a.v, b.v)};
}
inline Floats select(Mask mask, Floats a, Floats b) {
    return vbslq_f32(mask.v, a, b);
}
// With NaN in `a`, b: the instructions for it give NaN.
inline Floats lesser(Floats a, Floats b) {
    return select(less(a, b), a, b);
}
inline Floats greater(Floats a, Floats b) {
    return select(less(b, a), a, b);
}
inline float64x2_t all_lanes(double each) {
    return vdupq_n_f64(each);
}
inline float64x2_t negated(float64x2_t a) {
    return vnegq_f64(a);
}

#define LIGHTBIN_VECTOR Doubles
#define LIGHTBIN_ELEMENT double
#define LIGHTBIN_REGISTER float64x2_t
#define LIGHTBIN_OP(name) v##name##q_f64
#include <lightbin/detail/vector.inl>

/// All ones or all zeros a lane.
struct DoubleMask {
    uint64x2_t v;
};
inline DoubleMask less(Doubles a, Doubles b) {
    return {vcltq_f64(a, b)};
}
inline DoubleMask less_equal(Doubles a, Doubles b) {
    return {vcleq_f64(a, b)};
}
inline DoubleMask both(DoubleMask a, DoubleMask b) {
    return {vandq_u64(a.v, b.v)};
}
inline DoubleMask either(DoubleMask a, DoubleMask b) {
    return {vorrq_u64(a.v, b.v)};
}
inline DoubleMask and_not(DoubleMask a, DoubleMask b) {
    return {vbicq_u64(a.v, b.v)};
}
inline Doubles select(DoubleMask mask, Doubles a, Doubles b) {
    return vbslq_f64(mask.v, a, b);
}
// With NaN in `a`, b: the instructions for it give NaN.
inline Doubles lesser(Doubles a, Doubles b) {
    return select(less(a, b), a, b);
}
inline Doubles greater(Doubles a, Doubles b) {
    return select(less(b, a), a, b);
}
inline unsigned bits(Mask mask) {
    static constexpr std::uint32_t each[] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(mask.v, vld1q_u32(each)));
}
inline unsigned bits(DoubleMask mask) {
    return static_cast<unsigned>((vgetq_lane_u64(mask.v, 0) & 1) | (vgetq_lane_u64(mask.v, 1) & 2));
}

/// Counts of a column's tiles, and tiles: for scatter.inl.
struct Rows {
    uint32x4_t v;
};
using Tiles = uint64x2_t;
inline Rows operator+(Rows a, Rows b) {
    return {vaddq_u32(a.v, b.v)};
}
inline Rows operator-(Rows a, Rows b) {
    return {vsubq_u32(a.v, b.v)};
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
    vst4q_f32(&spheres->x, {{x.v, y.v, z.v, radius.v}});
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

inline void append_visible(const FootprintArrays& out, ProjectCounts& counts, std::uint32_t first_id,
                           unsigned visible, const ChunkRects& rects, std::uint32_t first) {
    portable::append_visible<lanes>(out, counts, first_id, visible, rects, first);
}
using portable::append;
using portable::Packed;
using portable::packs_ids;
using portable::split_bits;
using portable::transpose_words;

#define LIGHTBIN_TIER_HAS_ROWS
#include <lightbin/detail/kernels.inl>

}  // namespace neon
}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail

#endif
