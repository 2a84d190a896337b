// SPDX-License-Identifier: MIT
// The operations of the tier of 128-bit vectors in SSE4.1. Included by simd128.hpp, in its namespace.

using FloatRegister = __m128;
using IntRegister = __m128i;

inline __m128 load_each_fourth(const Sphere* from) {
    return _mm_loadu_ps(&from->x);
}
inline void store_each_fourth(Sphere* to, __m128 sphere) {
    _mm_storeu_ps(&to->x, sphere);
}

#define LIGHTBIN_LESS(a, b) LIGHTBIN_OP(cmplt)(a, b)
#define LIGHTBIN_LESS_EQUAL(a, b) LIGHTBIN_OP(cmple)(a, b)
#define LIGHTBIN_SELECT(mask, a, b) LIGHTBIN_OP(blendv)(b, a, mask)
#define LIGHTBIN_OP(name) _mm_##name##_ps
#define LIGHTBIN_INT(name) _mm_##name
#define LIGHTBIN_BITS(name) _mm_##name##_si128
#include <lightbin/detail/vectors/x86_vector.inl>

inline Bytes load_half(const void* from) {
    return {_mm_loadl_epi64(static_cast<const __m128i*>(from))};
}
inline void store_half(void* to, Bytes a) {
    _mm_storel_epi64(static_cast<__m128i*>(to), a.v);
}
inline Bytes high_half(Bytes a) {
    return {_mm_unpackhi_epi64(a.v, a.v)};
}
inline Bytes shuffle(Bytes table, Bytes indices) {
    return {_mm_shuffle_epi8(table.v, indices.v)};
}
inline Bytes all_if_not_zero(Bytes a) {
    return {_mm_cmpgt_epi8(_mm_cmpeq_epi8(a.v, _mm_setzero_si128()), _mm_set1_epi8(-1))};
}
inline unsigned movemask(Bytes a) {
    return static_cast<unsigned>(_mm_movemask_epi8(a.v));
}
inline Bytes relative_words(Bytes words, unsigned more, unsigned begin) {
    return {_mm_subs_epu16(_mm_add_epi16(words.v, _mm_set1_epi16(static_cast<short>(more))),
                          _mm_set1_epi16(static_cast<short>(begin)))};
}
inline Bytes narrow(Bytes low, Bytes high) {
    const __m128i max = _mm_set1_epi16(255);  // packing takes words as signed, and there are some from 0x8000 on
    return {_mm_packus_epi16(_mm_min_epu16(low.v, max), _mm_min_epu16(high.v, max))};
}
inline Bytes narrow_ids(Bytes ids) {
    return {_mm_packus_epi32(ids.v, ids.v)};
}
