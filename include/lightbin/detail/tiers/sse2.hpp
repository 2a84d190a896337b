// SPDX-License-Identifier: MIT
// The SSE2 tier's vectors: what every x86-64 machine has. Four lights at a time.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/tiers/tier.hpp>

#if defined(LIGHTBIN_SSE2)

#include <emmintrin.h>
#if defined(__wasm__)
#include <wasm_simd128.h>
#endif

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace sse2 {

#if defined(__wasm__)
// Of these, emscripten makes four instructions or a loop of calls. WebAssembly's own do the same of numbers that an int
// holds, and of NaN; here they hide emscripten's.
inline __m128 _mm_min_ps(__m128 a, __m128 b) {
    return wasm_f32x4_pmin(b, a);
}
inline __m128 _mm_max_ps(__m128 a, __m128 b) {
    return wasm_f32x4_pmax(b, a);
}
inline __m128d _mm_min_pd(__m128d a, __m128d b) {
    return wasm_f64x2_pmin(b, a);
}
inline __m128d _mm_max_pd(__m128d a, __m128d b) {
    return wasm_f64x2_pmax(b, a);
}
inline __m128i _mm_cvttps_epi32(__m128 values) {
    return wasm_i32x4_trunc_sat_f32x4(values);
}
inline __m128i _mm_cvttpd_epi32(__m128d values) {
    return wasm_i32x4_trunc_sat_f64x2_zero(values);
}
#endif

using FloatRegister = __m128;
using DoubleRegister = __m128d;
using ListId = std::uint32_t;
inline constexpr std::uint32_t lanes = 4, double_lanes = 2;

#define LIGHTBIN_LESS(a, b) LIGHTBIN_OP(cmplt)(a, b)
#define LIGHTBIN_LESS_EQUAL(a, b) LIGHTBIN_OP(cmple)(a, b)
#define LIGHTBIN_SELECT(mask, a, b) LIGHTBIN_OP(or)(LIGHTBIN_OP(and)(mask, a), LIGHTBIN_OP(andnot)(mask, b))

#define LIGHTBIN_VECTOR Floats
#define LIGHTBIN_ELEMENT float
#define LIGHTBIN_REGISTER __m128
#define LIGHTBIN_OP(name) _mm_##name##_ps
#include <lightbin/detail/tiers/x86_vector.inl>

#define LIGHTBIN_VECTOR Doubles
#define LIGHTBIN_ELEMENT double
#define LIGHTBIN_REGISTER __m128d
#define LIGHTBIN_OP(name) _mm_##name##_pd
#include <lightbin/detail/tiers/x86_vector.inl>

/// Counts of a column's tiles, and tiles: for scatter.inl.
struct Rows {
    __m128i v;
};
using Tiles = __m128i;
inline Rows operator+(Rows a, Rows b) {
    return {_mm_add_epi32(a.v, b.v)};
}
inline Rows operator-(Rows a, Rows b) {
    return {_mm_sub_epi32(a.v, b.v)};
}
inline Rows all_rows(std::uint32_t count) {
    return {_mm_set1_epi32(static_cast<int>(count))};
}
inline Rows last_row(Rows rows) {
    return {_mm_shuffle_epi32(rows.v, 0xff)};
}
inline Tiles low_pairs(Rows ends, Rows counts) {
    return _mm_unpacklo_epi32(ends.v, counts.v);
}
inline Tiles high_pairs(Rows ends, Rows counts) {
    return _mm_unpackhi_epi32(ends.v, counts.v);
}
inline void transpose(Tiles* columns) {
    const Tiles low = _mm_unpacklo_epi64(columns[0], columns[1]);
    columns[1] = _mm_unpackhi_epi64(columns[0], columns[1]);
    columns[0] = low;
}

/// Half 0 or 1 of the lanes.
inline Doubles widened(Floats a, unsigned half) {
    return _mm_cvtps_pd(half == 0 ? a.v : _mm_movehl_ps(a, a));
}

inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    const float* p = &spheres->x;
    x = _mm_loadu_ps(p);
    y = _mm_loadu_ps(p + 4);
    z = _mm_loadu_ps(p + 8);
    radius = _mm_loadu_ps(p + 12);
    _MM_TRANSPOSE4_PS(x.v, y.v, z.v, radius.v);
}
inline void store_spheres(Sphere* spheres, Floats x, Floats y, Floats z, Floats radius) {
    _MM_TRANSPOSE4_PS(x.v, y.v, z.v, radius.v);
    float* p = &spheres->x;
    _mm_storeu_ps(p, x);
    _mm_storeu_ps(p + 4, y);
    _mm_storeu_ps(p + 8, z);
    _mm_storeu_ps(p + 12, radius);
}

inline Floats ascending_bits(Floats values) {
    const __m128i bits = _mm_castps_si128(values);
    return _mm_cvtepi32_ps(_mm_xor_si128(bits, _mm_srli_epi32(_mm_srai_epi32(bits, 31), 1)));
}
inline void store_tiles(std::uint16_t* tiles, Floats values) {
    const __m128i whole = _mm_cvttps_epi32(values);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(tiles), _mm_packs_epi32(whole, whole));
}
inline void store_tiles(std::uint16_t* tiles, Doubles values) {
    const __m128i whole = _mm_cvttpd_epi32(values);
    const int both_tiles = _mm_cvtsi128_si32(_mm_packs_epi32(whole, whole));
    std::memcpy(tiles, &both_tiles, sizeof both_tiles);
}
/// Of two lights' or rows' tiles each.
inline void store_spans(RowSpan* spans, Doubles first, Doubles last) {
    const __m128i pairs = _mm_or_si128(_mm_cvttpd_epi32(first), _mm_slli_epi32(_mm_cvttpd_epi32(last), 16));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(spans), pairs);
}

/// As the AVX2 tier's, which see.
inline void split_bits(const std::uint8_t* bytes, std::uint64_t* words) {
    __m128i quarter[4];
    for (int i = 0; i < 4; ++i)
        quarter[i] = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + 16 * i));
    for (int bit = 7; bit >= 0; --bit) {
        words[bit] = 0;
        for (int i = 0; i < 4; ++i) {
            words[bit] |= std::uint64_t{static_cast<unsigned>(_mm_movemask_epi8(quarter[i]))} << 16 * i;
            quarter[i] = _mm_add_epi8(quarter[i], quarter[i]);
        }
    }
}

/// No instruction here compresses or permutes by a variable. So all 16 choices of 4 ids are made beforehand,
/// once a supertile, and used for each of its tiles: a light's share of them is 16 ids.
template <class Id> struct Packed { Id ids[16]; };
inline constexpr bool packs_ids = true;

/// The immediate of a shuffle of four that puts those whose bit is set first.
template <std::size_t mask>
inline constexpr int chosen_first = [] {
    int order = 0, place = 0;
    for (int i = 0; i < 4; ++i)
        if (mask >> i & 1) order |= i << 2 * place++;
    return order;
}();

// As functions: emscripten has macros for them, in which no pack is expanded.
template <int order> __m128i in_order(__m128i four) {
    return _mm_shuffle_epi32(four, order);
}
template <int order> __m128i low_in_order(__m128i words) {
    return _mm_shufflelo_epi16(words, order);
}

template <class Id, std::size_t... mask>
void pack_four(const std::uint32_t* ids, Packed<Id>* to, std::index_sequence<mask...>) {
    const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(ids));
    if constexpr (sizeof(Id) == 4) {
        __m128i* const choices = reinterpret_cast<__m128i*>(to);
        (_mm_storeu_si128(choices + mask, in_order<chosen_first<mask>>(four)), ...);
    } else {
        const __m128i low = _mm_srai_epi32(_mm_slli_epi32(four, 16), 16), narrow = _mm_packs_epi32(low, low);
        (_mm_storel_epi64(reinterpret_cast<__m128i*>(reinterpret_cast<Id*>(to) + 4 * mask),
                          low_in_order<chosen_first<mask>>(narrow)),
         ...);
    }
}

template <class Id> void pack(const std::uint32_t* ids, std::uint32_t count, Packed<Id>* to) {
    for (std::uint32_t i = 0; i < count; i += 4)
        pack_four(ids + i, to + i, std::make_index_sequence<16>());
}

/// Writes those of 8 ids whose bit is set, in order, then up to 4 elements that mean nothing. Returns how many.
template <class Id> std::uint32_t append(Id* out, const Packed<Id>* ids, unsigned mask) {
    constexpr std::uint8_t set[] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    const unsigned low = mask & 15, high = mask >> 4;
    const Id* const choices = reinterpret_cast<const Id*>(ids);  // of four lights: 16 choices of 4 ids
    std::memcpy(out, choices + 4 * low, 4 * sizeof(Id));
    std::memcpy(out + set[low], choices + 64 + 4 * high, 4 * sizeof(Id));
    return set[low] + std::uint32_t{set[high]};
}

#include <lightbin/detail/tiers/transpose_x86.inl>

}}}}  // namespace lightbin::detail

#define LIGHTBIN_TIER sse2
#define LIGHTBIN_TIER_HAS_ROWS
#include <lightbin/detail/tiers/kernels.inl>


#include <lightbin/detail/base/warnings_on.inl>
#endif
