// SPDX-License-Identifier: MIT
// The tier of 512-bit vectors, which hold sixteen lights: AVX-512 with the compress instructions of VBMI2, which
// Ice Lake, Zen 4 and later processors have.
#pragma once

#include <lightbin/detail/vectors/avx2.hpp>

#if defined(LIGHTBIN_X86)

#include <immintrin.h>

// The region of the tier, which is entered once more for its kernels. GCC 12's own AVX-512 header causes two warnings,
// by values that it leaves undefined on purpose.
#if defined(__GNUC__) && !defined(__clang__)
#define LIGHTBIN_AVX512_WARNINGS_OFF                                                                   \
    LIGHTBIN_PRAGMA(GCC diagnostic push) LIGHTBIN_PRAGMA(GCC diagnostic ignored "-Wuninitialized")     \
    LIGHTBIN_PRAGMA(GCC diagnostic ignored "-Wmaybe-uninitialized")
#define LIGHTBIN_AVX512_WARNINGS_ON LIGHTBIN_PRAGMA(GCC diagnostic pop)
#else
#define LIGHTBIN_AVX512_WARNINGS_OFF
#define LIGHTBIN_AVX512_WARNINGS_ON
#endif
#define LIGHTBIN_AVX512_BEGIN    \
    LIGHTBIN_AVX512_WARNINGS_OFF \
    LIGHTBIN_TARGET_BEGIN("avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi2,bmi,bmi2,popcnt")
#define LIGHTBIN_AVX512_END LIGHTBIN_TARGET_END LIGHTBIN_AVX512_WARNINGS_ON

LIGHTBIN_AVX512_BEGIN

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace avx512 {

using FloatRegister = __m512;
using IntRegister = __m512i;
inline constexpr std::uint32_t lanes = 16;

inline __m512 load_each_fourth(const Sphere* from) {
    const __m512 two = _mm512_insertf32x4(_mm512_castps128_ps512(_mm_loadu_ps(&from->x)), _mm_loadu_ps(&from[4].x), 1);
    return _mm512_insertf32x4(_mm512_insertf32x4(two, _mm_loadu_ps(&from[8].x), 2), _mm_loadu_ps(&from[12].x), 3);
}
inline void store_each_fourth(Sphere* to, __m512 quads) {
    _mm_storeu_ps(&to->x, _mm512_castps512_ps128(quads));
    _mm_storeu_ps(&to[4].x, _mm512_extractf32x4_ps(quads, 1));
    _mm_storeu_ps(&to[8].x, _mm512_extractf32x4_ps(quads, 2));
    _mm_storeu_ps(&to[12].x, _mm512_extractf32x4_ps(quads, 3));
}

#define LIGHTBIN_LESS(a, b) _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ)
#define LIGHTBIN_LESS_EQUAL(a, b) _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ)
#define LIGHTBIN_SELECT(mask, a, b) LIGHTBIN_OP(mask_mov)(b, mask, a)
#define LIGHTBIN_MASK __mmask16
#define LIGHTBIN_OP(name) _mm512_##name##_ps
#define LIGHTBIN_INT(name) _mm512_##name
#define LIGHTBIN_BITS(name) _mm512_##name##_si512
#include <lightbin/detail/vectors/x86_vector.inl>

inline unsigned movemask(unsigned mask) {
    return mask;
}

using avx2::append_8;  // which takes less time for few ids than a compress instruction does

/// Returns zeros in a register of their own, for the merging form of compress instructions. The zeroing form depends on
/// the old value of its destination register on Zen 5, so that each iteration of a loop would wait for the one before.
inline __m512i fresh_zeros() {
    __m512i zeros = _mm512_setzero_si512();
    LIGHTBIN_FORGET(zeros);  // else the compiler picks the zeroing form
    return zeros;
}

/// Appends to `out` the ids, of sixteen, whose bit in `mask` is set. Returns the end; may write 16 elements past it.
template <class Id> LIGHTBIN_INLINE Id* append_16(Id* out, const std::uint32_t* ids, unsigned mask) {
    const __m512i chosen =
        _mm512_mask_compress_epi32(fresh_zeros(), static_cast<__mmask16>(mask), _mm512_loadu_si512(ids));
    if constexpr (sizeof(Id) == 4)
        _mm512_storeu_si512(out, chosen);
    else
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm512_cvtepi32_epi16(chosen));
    return out + std::popcount(mask);
}

using ByteMask = std::uint64_t;
inline constexpr std::uint32_t byte_lanes = 64;

inline Bytes load_bytes(const std::uint8_t* from) {
    return {_mm512_loadu_si512(from)};
}
inline void store_bytes(std::uint8_t* to, Bytes bytes) {
    _mm512_storeu_si512(to, bytes.v);
}
inline Bytes shuffle(const std::uint8_t (&table)[16], Bytes indices) {
    const __m128i once = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    return {_mm512_shuffle_epi8(_mm512_broadcast_i32x4(once), indices.v)};
}
inline Bytes keep_where(Bytes bytes, Bytes condition) {
    return {_mm512_maskz_mov_epi8(_mm512_test_epi8_mask(condition.v, condition.v), bytes.v)};
}
inline ByteMask not_zero(Bytes bytes) {
    return _mm512_test_epi8_mask(bytes.v, bytes.v);
}
inline Bytes coordinates(const std::uint16_t* from, unsigned more, unsigned begin) {
    const __m512i add = _mm512_set1_epi16(static_cast<short>(more)),
                  start = _mm512_set1_epi16(static_cast<short>(begin));
    const __m512i low = _mm512_subs_epu16(_mm512_add_epi16(_mm512_loadu_si512(from), add), start),
                  high = _mm512_subs_epu16(_mm512_add_epi16(_mm512_loadu_si512(from + 32), add), start);
    return {_mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtusepi16_epi8(low)), _mm512_cvtusepi16_epi8(high), 1)};
}
inline void compress_store(ByteMask chosen, Bytes from, std::uint8_t* to) {
    _mm512_storeu_si512(to, _mm512_mask_compress_epi8(fresh_zeros(), chosen, from.v));
}

}}}}  // namespace lightbin::detail

LIGHTBIN_AVX512_END

#endif
