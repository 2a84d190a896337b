// SPDX-License-Identifier: MIT
// The SSE2 tier's vectors: what every x86-64 machine has. Four lights at a time.
#pragma once

#include <lightbin/detail/platform.hpp>

#if defined(LIGHTBIN_X86)

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/detail/supertile.hpp>

#include <bit>
#include <cstring>
#include <emmintrin.h>

#define LIGHTBIN_TARGET

namespace lightbin::detail {
inline namespace LIGHTBIN_FLAVOUR {
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

#include <lightbin/detail/project.inl>

#include <lightbin/detail/silhouette.inl>

#include <lightbin/detail/depth_columns.inl>

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

#include <lightbin/detail/tile_masks.inl>

#include <lightbin/detail/supertile.inl>

}  // namespace sse2
}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail

#undef LIGHTBIN_TARGET
#endif
