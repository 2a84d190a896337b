// SPDX-License-Identifier: MIT
// Names everything in the library after the instructions that the compiler may use anywhere. Two translation units
// with different flags then share no function and no type: of one that both have the linker would keep either copy,
// and its instructions might not exist on the machine. Who hands a lightbin type from one such unit to another is told
// by the linker.
//
// What a compiler takes for granted is a rung of a ladder, each with all below it, and some single extensions.
//
// All other headers read this one before anything else, so it also refuses what is not C++20. After #error gcc and clang
// would go on to hundreds of errors; a file that does not exist ends every compiler, by one error that shows its name.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include "lightbin wants C++20, which the flag -std=c++20 gives (Microsoft's: /std:c++20)"
#endif

#if defined(__AVX512F__)
#define LIGHTBIN_FLAVOUR_RUNG _avx512
#elif defined(__AVX2__)
#define LIGHTBIN_FLAVOUR_RUNG _avx2
#elif defined(__AVX__)
#define LIGHTBIN_FLAVOUR_RUNG _avx
#elif defined(__SSE4_2__)
#define LIGHTBIN_FLAVOUR_RUNG _sse42
#elif defined(__SSE4_1__)
#define LIGHTBIN_FLAVOUR_RUNG _sse41
#elif defined(__SSSE3__)
#define LIGHTBIN_FLAVOUR_RUNG _ssse3
#elif defined(__SSE3__)
#define LIGHTBIN_FLAVOUR_RUNG _sse3
#elif defined(__ARM_FEATURE_SVE2)
#define LIGHTBIN_FLAVOUR_RUNG _sve2
#elif defined(__ARM_FEATURE_SVE)
#define LIGHTBIN_FLAVOUR_RUNG _sve
#elif defined(__wasm_simd128__)
#define LIGHTBIN_FLAVOUR_RUNG _simd128
#else
#define LIGHTBIN_FLAVOUR_RUNG _baseline
#endif

#if defined(__AVX512VBMI2__)
#define LIGHTBIN_FLAVOUR_AVX512 _vbmi2
#elif defined(__AVX512BW__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define LIGHTBIN_FLAVOUR_AVX512 _bw
#else
#define LIGHTBIN_FLAVOUR_AVX512
#endif

#if defined(__FMA__) || defined(__FMA4__)
#define LIGHTBIN_FLAVOUR_FMA _fma
#else
#define LIGHTBIN_FLAVOUR_FMA
#endif
#if defined(__BMI2__)
#define LIGHTBIN_FLAVOUR_BMI _bmi2
#elif defined(__BMI__)
#define LIGHTBIN_FLAVOUR_BMI _bmi
#else
#define LIGHTBIN_FLAVOUR_BMI
#endif
#if defined(__LZCNT__)
#define LIGHTBIN_FLAVOUR_LZCNT _lzcnt
#else
#define LIGHTBIN_FLAVOUR_LZCNT
#endif
#if defined(__POPCNT__)
#define LIGHTBIN_FLAVOUR_POPCNT _popcnt
#else
#define LIGHTBIN_FLAVOUR_POPCNT
#endif
// Other kernels are picked.
#if defined(LIGHTBIN_NO_SIMD)
#define LIGHTBIN_FLAVOUR_SIMD _no_simd
#else
#define LIGHTBIN_FLAVOUR_SIMD
#endif

#define LIGHTBIN_PASTE_EXPANDED(a, b, c, d, e, f, g) built_for##a##b##c##d##e##f##g
#define LIGHTBIN_PASTE(...) LIGHTBIN_PASTE_EXPANDED(__VA_ARGS__)
#define LIGHTBIN_FLAVOUR                                                                                     \
    LIGHTBIN_PASTE(LIGHTBIN_FLAVOUR_RUNG, LIGHTBIN_FLAVOUR_AVX512, LIGHTBIN_FLAVOUR_FMA, LIGHTBIN_FLAVOUR_BMI,   \
                   LIGHTBIN_FLAVOUR_LZCNT, LIGHTBIN_FLAVOUR_POPCNT, LIGHTBIN_FLAVOUR_SIMD)
