// SPDX-License-Identifier: MIT
// The operations of the tier of 128-bit vectors in SSE4.1. Included by simd128.hpp, in its namespace.

using FloatRegister = __m128;

#define LIGHTBIN_LESS(a, b) LIGHTBIN_OP(cmplt)(a, b)
#define LIGHTBIN_LESS_EQUAL(a, b) LIGHTBIN_OP(cmple)(a, b)
#define LIGHTBIN_SELECT(mask, a, b) LIGHTBIN_OP(blendv)(b, a, mask)
#define LIGHTBIN_OP(name) _mm_##name##_ps
#include <lightbin/detail/vectors/x86_vector.inl>

inline void load_vec4s(const void* from, std::size_t stride, Floats& x, Floats& y, Floats& z, Floats& w) {
    const char* const bytes = static_cast<const char*>(from);
    x = _mm_loadu_ps(reinterpret_cast<const float*>(bytes));
    y = _mm_loadu_ps(reinterpret_cast<const float*>(bytes + stride));
    z = _mm_loadu_ps(reinterpret_cast<const float*>(bytes + 2 * stride));
    w = _mm_loadu_ps(reinterpret_cast<const float*>(bytes + 3 * stride));
    _MM_TRANSPOSE4_PS(x.v, y.v, z.v, w.v);
}
inline void store_vec4s(void* to, std::size_t stride, Floats x, Floats y, Floats z, Floats w) {
    char* const bytes = static_cast<char*>(to);
    _MM_TRANSPOSE4_PS(x.v, y.v, z.v, w.v);
    _mm_storeu_ps(reinterpret_cast<float*>(bytes), x);
    _mm_storeu_ps(reinterpret_cast<float*>(bytes + stride), y);
    _mm_storeu_ps(reinterpret_cast<float*>(bytes + 2 * stride), z);
    _mm_storeu_ps(reinterpret_cast<float*>(bytes + 3 * stride), w);
}
inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    load_vec4s(spheres, sizeof *spheres, x, y, z, radius);
}
inline void store_spheres(Sphere* spheres, Floats x, Floats y, Floats z, Floats radius) {
    store_vec4s(spheres, sizeof *spheres, x, y, z, radius);
}
inline Floats ascending_bits(Floats values) {
    const __m128i bits = _mm_castps_si128(values);
    return _mm_cvtepi32_ps(_mm_xor_si128(bits, _mm_srli_epi32(_mm_srai_epi32(bits, 31), 1)));
}
inline void store_tiles(std::uint32_t* tiles, Floats values) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(tiles), _mm_cvttps_epi32(values));
}
using ByteRegister = __m128i;

inline __m128i load_register(const void* from) {
    return _mm_loadu_si128(static_cast<const __m128i*>(from));
}
inline void store_register(void* to, __m128i a) {
    _mm_storeu_si128(static_cast<__m128i*>(to), a);
}
inline __m128i load_half(const void* from) {
    return _mm_loadl_epi64(static_cast<const __m128i*>(from));
}
inline void store_half(void* to, __m128i a) {
    _mm_storel_epi64(static_cast<__m128i*>(to), a);
}
inline __m128i high_half(__m128i a) {
    return _mm_unpackhi_epi64(a, a);
}
inline __m128i broadcast_register(unsigned byte) {
    return _mm_set1_epi8(static_cast<char>(byte));
}
inline __m128i and_registers(__m128i a, __m128i b) {
    return _mm_and_si128(a, b);
}
inline __m128i min_of_bytes(__m128i a, __m128i b) {
    return _mm_min_epu8(a, b);
}
inline __m128i subtract_bytes(__m128i a, __m128i b) {
    return _mm_subs_epu8(a, b);
}
inline __m128i shuffle_bytes(__m128i table, __m128i indices) {
    return _mm_shuffle_epi8(table, indices);
}
inline __m128i bytes_not_zero(__m128i a) {
    return _mm_cmpgt_epi8(_mm_cmpeq_epi8(a, _mm_setzero_si128()), _mm_set1_epi8(-1));
}
inline unsigned movemask_of_bytes(__m128i a) {
    return static_cast<unsigned>(_mm_movemask_epi8(a));
}
inline __m128i relative_words(__m128i words, unsigned more, unsigned begin) {
    return _mm_subs_epu16(_mm_add_epi16(words, _mm_set1_epi16(static_cast<short>(more))),
                          _mm_set1_epi16(static_cast<short>(begin)));
}
inline __m128i narrow(__m128i low, __m128i high) {
    const __m128i max = _mm_set1_epi16(255);  // packing takes words as signed, and there are some from 0x8000 on
    return _mm_packus_epi16(_mm_min_epu16(low, max), _mm_min_epu16(high, max));
}
inline __m128i narrow_ids(__m128i ids) {
    return _mm_packus_epi32(ids, ids);
}
inline void split_bits(const std::uint8_t* bytes, std::uint64_t* words) {
    __m128i quarter[4];
    for (int i = 0; i < 4; ++i)
        quarter[i] = load_register(bytes + 16 * i);
    for (int bit = 7; bit >= 0; --bit) {
        words[bit] = 0;
        for (int i = 0; i < 4; ++i) {
            words[bit] |= std::uint64_t{movemask_of_bytes(quarter[i])} << 16 * i;
            quarter[i] = _mm_add_epi8(quarter[i], quarter[i]);
        }
    }
}
