// SPDX-License-Identifier: MIT
// The operations of the tier of 128-bit vectors in WebAssembly's simd128. Included by simd128.hpp, in its namespace.

typedef float Floats __attribute__((vector_size(16)));
using FloatRegister = Floats;

#include <lightbin/detail/vectors/native_vector.inl>

inline Floats broadcast(float each) {
    return reinterpret_cast<Floats>(wasm_f32x4_splat(each));
}
inline Floats sqrt(Floats a) {
    return reinterpret_cast<Floats>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(a)));
}
// WebAssembly's pmin and pmax are select(less(a, b), a, b) and the like in one instruction, also for NaN.
inline Floats minimum(Floats a, Floats b) {
    return reinterpret_cast<Floats>(wasm_f32x4_pmin(reinterpret_cast<v128_t>(b), reinterpret_cast<v128_t>(a)));
}
inline Floats maximum(Floats a, Floats b) {
    return reinterpret_cast<Floats>(wasm_f32x4_pmax(reinterpret_cast<v128_t>(b), reinterpret_cast<v128_t>(a)));
}
inline unsigned movemask(decltype(Floats{} < Floats{}) mask) {
    return wasm_i32x4_bitmask(reinterpret_cast<v128_t>(mask));
}

/// Transposes 4x4 floats.
inline void transpose(v128_t& a, v128_t& b, v128_t& c, v128_t& d) {
    const v128_t low = wasm_i32x4_shuffle(a, b, 0, 4, 1, 5), high = wasm_i32x4_shuffle(a, b, 2, 6, 3, 7),
                 low_after = wasm_i32x4_shuffle(c, d, 0, 4, 1, 5), high_after = wasm_i32x4_shuffle(c, d, 2, 6, 3, 7);
    a = wasm_i64x2_shuffle(low, low_after, 0, 2);
    b = wasm_i64x2_shuffle(low, low_after, 1, 3);
    c = wasm_i64x2_shuffle(high, high_after, 0, 2);
    d = wasm_i64x2_shuffle(high, high_after, 1, 3);
}
inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    v128_t rows[4];
    for (int i = 0; i < 4; ++i)
        rows[i] = wasm_v128_load(spheres + i);
    transpose(rows[0], rows[1], rows[2], rows[3]);
    x = reinterpret_cast<Floats>(rows[0]);
    y = reinterpret_cast<Floats>(rows[1]);
    z = reinterpret_cast<Floats>(rows[2]);
    radius = reinterpret_cast<Floats>(rows[3]);
}
inline void store_spheres(Sphere* spheres, Floats x, Floats y, Floats z, Floats radius) {
    v128_t rows[] = {reinterpret_cast<v128_t>(x), reinterpret_cast<v128_t>(y), reinterpret_cast<v128_t>(z),
                     reinterpret_cast<v128_t>(radius)};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (int i = 0; i < 4; ++i)
        wasm_v128_store(spheres + i, rows[i]);
}
inline Floats ascending_bits(Floats values) {
    const v128_t bits = reinterpret_cast<v128_t>(values);
    return reinterpret_cast<Floats>(
        wasm_f32x4_convert_i32x4(wasm_v128_xor(bits, wasm_u32x4_shr(wasm_i32x4_shr(bits, 31), 1))));
}
inline void store_tiles(std::uint32_t* tiles, Floats values) {
    wasm_v128_store(tiles, wasm_i32x4_trunc_sat_f32x4(reinterpret_cast<v128_t>(values)));
}

struct Bytes {
    v128_t v;
};

inline Bytes load_half(const void* from) {
    return {wasm_v128_load64_zero(from)};
}
inline void store_half(void* to, Bytes a) {
    wasm_v128_store64_lane(to, a.v, 0);
}
inline Bytes high_half(Bytes a) {
    return {wasm_i64x2_shuffle(a.v, a.v, 1, 1)};
}
inline Bytes broadcast_byte(unsigned byte) {
    return {wasm_i8x16_splat(static_cast<std::int8_t>(byte))};
}
inline Bytes operator&(Bytes a, Bytes b) {
    return {wasm_v128_and(a.v, b.v)};
}
inline Bytes minimum(Bytes a, Bytes b) {
    return {wasm_u8x16_min(a.v, b.v)};
}
inline Bytes subtract(Bytes a, Bytes b) {
    return {wasm_u8x16_sub_sat(a.v, b.v)};
}
inline Bytes shuffle(Bytes table, Bytes indices) {
    return {wasm_i8x16_swizzle(table.v, indices.v)};
}
inline Bytes all_if_not_zero(Bytes a) {
    return {wasm_i8x16_ne(a.v, wasm_i8x16_splat(0))};
}
inline unsigned movemask(Bytes a) {
    return wasm_i8x16_bitmask(a.v);
}
inline Bytes relative_words(Bytes words, unsigned more, unsigned begin) {
    return {wasm_u16x8_sub_sat(wasm_i16x8_add(words.v, wasm_i16x8_splat(static_cast<std::int16_t>(more))),
                              wasm_i16x8_splat(static_cast<std::int16_t>(begin)))};
}
inline Bytes narrow(Bytes low, Bytes high) {
    const v128_t max = wasm_i16x8_splat(255);  // narrowing takes words as signed, and there are some from 0x8000 on
    return {wasm_u8x16_narrow_i16x8(wasm_u16x8_min(low.v, max), wasm_u16x8_min(high.v, max))};
}
inline Bytes narrow_ids(Bytes ids) {
    return {wasm_u16x8_narrow_i32x4(ids.v, ids.v)};
}
