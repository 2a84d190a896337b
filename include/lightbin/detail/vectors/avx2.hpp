// SPDX-License-Identifier: MIT
// The vector class of AVX2, which most desktop machines and consoles have: vectors of 256 bits hold eight lights.
#pragma once

#include <lightbin/detail/base/bits.hpp>
#include <lightbin/sphere.hpp>

#if defined(LIGHTBIN_X86)

#include <immintrin.h>

// The region of the tier, which shape_kernels.hpp enters once more.
#define LIGHTBIN_AVX2_BEGIN LIGHTBIN_TARGET_BEGIN("avx2,bmi,popcnt")
#define LIGHTBIN_AVX2_END LIGHTBIN_TARGET_END
LIGHTBIN_AVX2_BEGIN

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace avx2 {

using FloatRegister = __m256;
using IntRegister = __m256i;
inline constexpr std::uint32_t lanes = 8;

inline __m256 load_each_fourth(const Sphere* from) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&from->x)), _mm_loadu_ps(&from[4].x), 1);
}
inline void store_each_fourth(Sphere* to, __m256 pair) {
    _mm_storeu_ps(&to->x, _mm256_castps256_ps128(pair));
    _mm_storeu_ps(&to[4].x, _mm256_extractf128_ps(pair, 1));
}

#define LIGHTBIN_LESS(a, b) LIGHTBIN_OP(cmp)(a, b, _CMP_LT_OQ)
#define LIGHTBIN_LESS_EQUAL(a, b) LIGHTBIN_OP(cmp)(a, b, _CMP_LE_OQ)
#define LIGHTBIN_SELECT(mask, a, b) LIGHTBIN_OP(blendv)(b, a, mask)
#define LIGHTBIN_OP(name) _mm256_##name##_ps
#define LIGHTBIN_INT(name) _mm256_##name
#define LIGHTBIN_BITS(name) _mm256_##name##_si256
#include <lightbin/detail/vectors/x86_vector.inl>

/// Appends to `out` the ids, of eight, whose bit in `mask` is set. Returns the end; may write 8 elements past it.
template <class Id> LIGHTBIN_INLINE Id* append_8(Id* out, const std::uint32_t* ids, unsigned mask) {
    const __m256i chosen = _mm256_permutevar8x32_epi32(
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(ids)),
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(set_bits.of + mask))));
    if constexpr (sizeof(Id) == 4)
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), chosen);
    else
        _mm_storeu_si128(reinterpret_cast<__m128i*>(out),
                         _mm_packus_epi32(_mm256_castsi256_si128(chosen), _mm256_extracti128_si256(chosen, 1)));
    return out + std::popcount(mask);
}
template <class Id> LIGHTBIN_INLINE Id* append_16(Id* out, const std::uint32_t* ids, unsigned mask) {
    return append_8(append_8(out, ids, mask & 0xff), ids + 8, mask >> 8);
}

using ByteMask = std::uint32_t;
inline constexpr std::uint32_t byte_lanes = 32;

inline Bytes load_bytes(const std::uint8_t* from) {
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))};
}
inline void store_bytes(std::uint8_t* to, Bytes bytes) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), bytes.v);
}
inline Bytes shuffle(const std::uint8_t (&table)[16], Bytes indices) {
    const __m128i once = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    return {_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(once), indices.v)};
}
inline Bytes keep_where(Bytes bytes, Bytes condition) {
    return {_mm256_andnot_si256(_mm256_cmpeq_epi8(condition.v, _mm256_setzero_si256()), bytes.v)};
}
inline ByteMask not_zero(Bytes bytes) {
    return ~static_cast<ByteMask>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(bytes.v, _mm256_setzero_si256())));
}
inline Bytes coordinates(const std::uint16_t* from, unsigned more, unsigned begin) {
    const __m256i add = _mm256_set1_epi16(static_cast<short>(more)),
                  start = _mm256_set1_epi16(static_cast<short>(begin)),
                  max = _mm256_set1_epi16(255);  // packing takes words as signed, and there are some from 0x8000 on
    const __m256i* const halves = reinterpret_cast<const __m256i*>(from);
    const __m256i low = _mm256_subs_epu16(_mm256_add_epi16(_mm256_loadu_si256(halves), add), start),
                  high = _mm256_subs_epu16(_mm256_add_epi16(_mm256_loadu_si256(halves + 1), add), start);
    return {
        _mm256_permute4x64_epi64(_mm256_packus_epi16(_mm256_min_epu16(low, max), _mm256_min_epu16(high, max)), 0xd8)};
}
inline void compress_store(ByteMask chosen, Bytes from, std::uint8_t* to) {
    const __m128i halves[] = {_mm256_castsi256_si128(from.v), _mm256_extracti128_si256(from.v, 1)};
    for (unsigned i = 0; i < 4; ++i, chosen >>= 8) {
        __m128i indices = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(set_bits.of + (chosen & 0xff)));
        if (i % 2 == 1) indices = _mm_add_epi8(indices, _mm_set1_epi8(8));
        _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_shuffle_epi8(halves[i / 2], indices));
        to += std::popcount(chosen & 0xff);
    }
}

}}}}  // namespace lightbin::detail

LIGHTBIN_AVX2_END

#endif
