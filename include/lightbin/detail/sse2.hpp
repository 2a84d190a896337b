// SPDX-License-Identifier: MIT
// The SSE2 tier's vectors: what every x86-64 machine has. Four lights at a time.
#pragma once

#include <lightbin/detail/platform.hpp>

#if defined(LIGHTBIN_X86)

#include <lightbin/detail/sphere_bounds.hpp>

#include <bit>
#include <emmintrin.h>

#define LIGHTBIN_TARGET

namespace lightbin::detail {
inline namespace LIGHTBIN_FLAVOUR {
namespace sse2 {

using Floats = __m128;
using Mask = __m128;
inline constexpr std::uint32_t lanes = 4;

inline Floats all(float value) {
    return _mm_set1_ps(value);
}
inline Floats add(Floats a, Floats b) {
    return _mm_add_ps(a, b);
}
inline Floats sub(Floats a, Floats b) {
    return _mm_sub_ps(a, b);
}
inline Floats mul(Floats a, Floats b) {
    Floats product = _mm_mul_ps(a, b);
    __asm__("" : "+x"(product));  // see rounded()
    return product;
}
inline Floats div(Floats a, Floats b) {
    return _mm_div_ps(a, b);
}
inline Floats sqrt(Floats a) {
    return _mm_sqrt_ps(a);
}
inline Floats lesser(Floats a, Floats b) {
    return _mm_min_ps(a, b);
}
inline Floats greater(Floats a, Floats b) {
    return _mm_max_ps(a, b);
}
inline Floats abs(Floats a) {
    return _mm_andnot_ps(all(-0.0f), a);
}
inline Floats negate(Floats a) {
    return _mm_xor_ps(all(-0.0f), a);
}
inline Mask less(Floats a, Floats b) {
    return _mm_cmplt_ps(a, b);
}
inline Mask less_equal(Floats a, Floats b) {
    return _mm_cmple_ps(a, b);
}
inline Mask both(Mask a, Mask b) {
    return _mm_and_ps(a, b);
}
inline Mask either(Mask a, Mask b) {
    return _mm_or_ps(a, b);
}
inline Mask both_not(Mask a, Mask b) {
    return _mm_andnot_ps(b, a);
}
inline Floats select(Mask mask, Floats a, Floats b) {
    return _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b));
}
inline unsigned bits(Mask mask) {
    return static_cast<unsigned>(_mm_movemask_ps(mask));
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

#include <lightbin/detail/project_simd.inl>

}  // namespace sse2
}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail

#undef LIGHTBIN_TARGET
#endif
