// SPDX-License-Identifier: MIT
// The SSE2 tier's vectors: what every x86-64 machine has. Four lights at a time.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/tier.hpp>

#if defined(LIGHTBIN_X86)

#include <emmintrin.h>

#define LIGHTBIN_TARGET

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {
namespace sse2 {

using Floats = __m128;
using Doubles = __m128d;
inline constexpr std::uint32_t lanes = 4, double_lanes = 2;

inline Floats sqrt(Floats a) {
    return _mm_sqrt_ps(a);
}
inline Doubles sqrt(Doubles a) {
    return _mm_sqrt_pd(a);
}

#include <lightbin/detail/vectors.inl>

using Mask = decltype(less(Floats{}, Floats{}));
using DoubleMask = decltype(less(Doubles{}, Doubles{}));

inline unsigned bits(Mask mask) {
    return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<Floats>(mask)));
}
inline unsigned bits(DoubleMask mask) {
    return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<Doubles>(mask)));
}

/// Half 0 or 1 of the lanes.
inline Doubles widened(Floats a, unsigned half) {
    return _mm_cvtps_pd(half == 0 ? a : _mm_movehl_ps(a, a));
}

inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    const float* p = &spheres->x;
    x = _mm_loadu_ps(p);
    y = _mm_loadu_ps(p + 4);
    z = _mm_loadu_ps(p + 8);
    radius = _mm_loadu_ps(p + 12);
    _MM_TRANSPOSE4_PS(x, y, z, radius);
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

#include <lightbin/detail/depth_columns.inl>
#include <lightbin/detail/project.inl>
#include <lightbin/detail/silhouette.inl>

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

template <class Id, std::size_t... mask>
void pack_four(const std::uint32_t* ids, Packed<Id>* to, std::index_sequence<mask...>) {
    const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(ids));
    if constexpr (sizeof(Id) == 4) {
        __m128i* const choices = reinterpret_cast<__m128i*>(to);
        (_mm_storeu_si128(choices + mask, _mm_shuffle_epi32(four, chosen_first<mask>)), ...);
    } else {
        const __m128i low = _mm_srai_epi32(_mm_slli_epi32(four, 16), 16), narrow = _mm_packs_epi32(low, low);
        (_mm_storel_epi64(reinterpret_cast<__m128i*>(reinterpret_cast<Id*>(to) + 4 * mask),
                          _mm_shufflelo_epi16(narrow, chosen_first<mask>)),
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

#include <lightbin/detail/tile_masks.inl>

#include <lightbin/detail/scatter.inl>
#include <lightbin/detail/supertile.inl>
#include <lightbin/detail/survey.inl>

}  // namespace sse2
}  // namespace lightbin::detail

#include <lightbin/detail/warnings_on.inl>

#undef LIGHTBIN_TARGET
#endif
