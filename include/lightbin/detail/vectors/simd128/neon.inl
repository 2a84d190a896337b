// SPDX-License-Identifier: MIT
// The operations of the tier of 128-bit vectors in NEON. Included by simd128.hpp, in its namespace.

using Floats = float32x4_t;
using FloatRegister = Floats;

#include <lightbin/detail/vectors/native_vector.inl>

inline Floats broadcast(float each) {
    return vdupq_n_f32(each);
}
inline Floats sqrt(Floats a) {
    return vsqrtq_f32(a);
}
inline unsigned movemask(decltype(Floats{} < Floats{}) mask) {
    static constexpr std::uint32_t each[] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(reinterpret_cast<uint32x4_t>(mask), vld1q_u32(each)));
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
inline void store_tiles(std::uint32_t* tiles, Floats values) {
    vst1q_u32(tiles, vcvtq_u32_f32(values));
}

struct Bytes {
    uint8x16_t v;
};

inline Bytes load_half(const void* from) {
    return {vcombine_u8(vld1_u8(static_cast<const std::uint8_t*>(from)), vdup_n_u8(0))};
}
inline void store_half(void* to, Bytes a) {
    vst1_u8(static_cast<std::uint8_t*>(to), vget_low_u8(a.v));
}
inline Bytes high_half(Bytes a) {
    return {vextq_u8(a.v, a.v, 8)};
}
inline Bytes broadcast_byte(unsigned byte) {
    return {vdupq_n_u8(static_cast<std::uint8_t>(byte))};
}
inline Bytes operator&(Bytes a, Bytes b) {
    return {vandq_u8(a.v, b.v)};
}
inline Bytes minimum(Bytes a, Bytes b) {
    return {vminq_u8(a.v, b.v)};
}
inline Bytes subtract(Bytes a, Bytes b) {
    return {vqsubq_u8(a.v, b.v)};
}
inline Bytes shuffle(Bytes table, Bytes indices) {
    return {vqtbl1q_u8(table.v, indices.v)};
}
inline Bytes all_if_not_zero(Bytes a) {
    return {vtstq_u8(a.v, a.v)};
}
/// Returns the bytes 1, 2 ... 128 twice. Each half, and-ed with 8 mask bytes and then summed, is a mask of 8 bits.
inline uint8x16_t bit_values() {
    return vreinterpretq_u8_u64(vdupq_n_u64(0x8040201008040201));
}
inline unsigned movemask(Bytes a) {
    uint8x16_t sums = vandq_u8(a.v, bit_values());
    for (int i = 0; i < 3; ++i)
        sums = vpaddq_u8(sums, sums);
    return vgetq_lane_u16(vreinterpretq_u16_u8(sums), 0);
}
inline Bytes relative_words(Bytes words, unsigned more, unsigned begin) {
    return {vreinterpretq_u8_u16(
        vqsubq_u16(vaddq_u16(vreinterpretq_u16_u8(words.v), vdupq_n_u16(static_cast<std::uint16_t>(more))),
                   vdupq_n_u16(static_cast<std::uint16_t>(begin))))};
}
inline Bytes narrow(Bytes low, Bytes high) {
    return {vcombine_u8(vqmovn_u16(vreinterpretq_u16_u8(low.v)), vqmovn_u16(vreinterpretq_u16_u8(high.v)))};
}
inline Bytes narrow_ids(Bytes ids) {
    return {vcombine_u8(vreinterpret_u8_u16(vmovn_u32(vreinterpretq_u32_u8(ids.v))), vdup_n_u8(0))};
}
inline void split_bits(const std::uint8_t* bytes, std::uint64_t* words) {
    for (unsigned bit = 0; bit < 8; ++bit) {
        uint8x16_t sums[4];
        for (unsigned i = 0; i < 4; ++i)
            sums[i] = vandq_u8(vtstq_u8(vld1q_u8(bytes + 16 * i), broadcast_byte(1u << bit).v), bit_values());
        sums[0] = vpaddq_u8(vpaddq_u8(sums[0], sums[1]), vpaddq_u8(sums[2], sums[3]));
        words[bit] = vgetq_lane_u64(vreinterpretq_u64_u8(vpaddq_u8(sums[0], sums[0])), 0);
    }
}
