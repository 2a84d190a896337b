// SPDX-License-Identifier: MIT
// LIGHTBIN_ABI_TAG: the name of the library's inline namespace. It has the level of vector instructions that the
// compiler's flags allow everywhere, so that two translation units of different levels share no function and no type.
// Of a shared inline function the linker would keep either copy, whose instructions might not exist on the machine.
// Passing a lightbin type between such units is a linker error. Flags for single extensions, such as -mbmi without
// -mavx2, don't change the name: with these, all units are to be compiled alike.
//
// Each other header begins by including this one, itself or by another header. So this header also refuses compilers
// that are not set to C++20, by including a file that does not exist: that ends every compiler with one error that
// shows the file's name, while after an #error gcc and clang would go on to report hundreds of errors.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include "lightbin wants C++20, which the flag -std=c++20 gives (Microsoft's: /std:c++20); no file is missing"
#endif

// LIGHTBIN_LEVEL, a part of the namespace's name, for each processor family in turn.
#if defined(__AVX512VBMI2__)
#define LIGHTBIN_LEVEL avx512_vbmi2
#elif defined(__AVX512VL__)
#define LIGHTBIN_LEVEL avx512_vl
#elif defined(__AVX512F__)
#define LIGHTBIN_LEVEL avx512
#elif defined(__AVX2__) && defined(__FMA__)
#define LIGHTBIN_LEVEL avx2_fma
#elif defined(__AVX2__)
#define LIGHTBIN_LEVEL avx2
#elif defined(__AVX__) && (defined(__FMA__) || defined(__FMA4__))  // AMD's Piledriver and its like
#define LIGHTBIN_LEVEL avx_fma
#elif defined(__AVX__)
#define LIGHTBIN_LEVEL avx
#elif defined(__SSE4_2__)
#define LIGHTBIN_LEVEL sse42
#elif defined(__SSE4_1__)
#define LIGHTBIN_LEVEL sse41
#elif defined(__SSSE3__)
#define LIGHTBIN_LEVEL ssse3
#elif defined(__ARM_FEATURE_SVE2)
#define LIGHTBIN_LEVEL sve2
#elif defined(__ARM_FEATURE_SVE)
#define LIGHTBIN_LEVEL sve
#elif defined(__arm__) && defined(__ARM_NEON)
#define LIGHTBIN_LEVEL neon
#elif defined(__wasm_simd128__)
#define LIGHTBIN_LEVEL simd128
#elif defined(__riscv_v) || defined(__VSX__)
#define LIGHTBIN_LEVEL vectors
#elif defined(__VX__)  // IBM Z, whose levels are numbers
#define LIGHTBIN_LEVEL LIGHTBIN_PASTE(z, __ARCH__, , )
#else
#define LIGHTBIN_LEVEL baseline
#endif

#define LIGHTBIN_PASTE(a, b, c, d) LIGHTBIN_PASTE_EXPANDED(a, b, c, d)
#define LIGHTBIN_PASTE_EXPANDED(a, b, c, d) a##b##c##d

#if defined(LIGHTBIN_IMPLEMENTATION)  // the file that implements lightbin.h inlines less, and may lack kinds of lights
#define LIGHTBIN_FILE_TAG _in_c
#else
#define LIGHTBIN_FILE_TAG
#endif
#if defined(LIGHTBIN_NO_SIMD)  // chooses other kernels, so needs another name
#define LIGHTBIN_KERNELS_TAG _no_simd
#elif defined(LIGHTBIN_NO_SCALAR)
#define LIGHTBIN_KERNELS_TAG _no_scalar
#else
#define LIGHTBIN_KERNELS_TAG
#endif
#define LIGHTBIN_ABI_TAG LIGHTBIN_PASTE(built_for_, LIGHTBIN_LEVEL, LIGHTBIN_KERNELS_TAG, LIGHTBIN_FILE_TAG)
