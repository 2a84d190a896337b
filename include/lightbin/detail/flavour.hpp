// SPDX-License-Identifier: MIT
// Names everything in the library after the instructions that the compiler may use anywhere. Two translation units
// with different flags then share no function and no type: of one that both have the linker would keep either copy,
// and its instructions might not exist on the machine. Who hands a lightbin type from one such unit to another is told
// by the linker.
//
// All other headers read this one before anything else, so it also refuses what is not C++20. After #error gcc and clang
// would go on to hundreds of errors; a file that does not exist ends every compiler, by one error that shows its name.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include "lightbin wants C++20, which the flag -std=c++20 gives (Microsoft's: /std:c++20)"
#endif

// The name says which rung of the ladder of vector instructions is taken for granted, with all rungs below it, and then
// each other extension that is, by the number of its line below and its letter there. The rule: every extension whose
// instructions a compiler may choose by itself for plain C++, of which it tells by a macro. So none of those that take an
// intrinsic, a checksum, a cipher or 16-bit floats, no hints (prefetches, marks of control flow), which other processors
// skip, and none of WebAssembly, whose engines refuse a module as a whole. tests/guest/flavours.sh has a list of these.

// NAME where MACRO is 1, or what versions RISC-V counts, NAME and a number where it is that, OTHER where it is not defined.
#define LIGHTBIN_IF(macro, name, other) LIGHTBIN_IF_VALUE(macro, name, other)
#define LIGHTBIN_IF_VALUE(value, name, other) LIGHTBIN_IF_FOUND(LIGHTBIN_FOUND_##value(name), other)
#define LIGHTBIN_IF_FOUND(found, other) LIGHTBIN_SECOND(found, other, )
#define LIGHTBIN_SECOND(first, second, ...) second
#define LIGHTBIN_FOUND_1(name) , name
#define LIGHTBIN_FOUND_2(name) , name##2
#define LIGHTBIN_FOUND_3(name) , name##3
#define LIGHTBIN_FOUND_1000000(name) , name

#define LIGHTBIN_PASTE(a, b, c, d, e, f, g, h) LIGHTBIN_PASTE_EXPANDED(a, b, c, d, e, f, g, h)
#define LIGHTBIN_PASTE_EXPANDED(a, b, c, d, e, f, g, h) a##b##c##d##e##f##g##h
#define LIGHTBIN_LINE(n, A, B, C, D, E, F, G, H)                                                             \
    LIGHTBIN_PASTE(LIGHTBIN_IF(A, n##a, ), LIGHTBIN_IF(B, n##b, ), LIGHTBIN_IF(C, n##c, ),                   \
                   LIGHTBIN_IF(D, n##d, ), LIGHTBIN_IF(E, n##e, ), LIGHTBIN_IF(F, n##f, ),                   \
                   LIGHTBIN_IF(G, n##g, ), LIGHTBIN_IF(H, n##h, ))

// clang-format off
#if defined(__s390__)
#define LIGHTBIN_RUNG LIGHTBIN_PASTE(z, __ARCH__, _, LIGHTBIN_IF(__VX__, vx, ), , , , )
#elif defined(__arm__)
#define LIGHTBIN_RUNG LIGHTBIN_PASTE(arm, __ARM_ARCH, _, LIGHTBIN_LINE(0, __ARM_NEON, __ARM_FEATURE_FMA, __ARM_FEATURE_IDIV, \
    __ARM_FEATURE_DSP, __ARM_FEATURE_MVE, __ARM_FEATURE_NUMERIC_MAXMIN, __ARM_FPV5__, __SOFTFP__), , , , )
#elif defined(__ARM_FEATURE_SVE_BITS)
#define LIGHTBIN_RUNG LIGHTBIN_PASTE(LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, sve_), __ARM_FEATURE_SVE_BITS, _, , , , , )
#elif defined(__wasm_simd128__)
#define LIGHTBIN_RUNG LIGHTBIN_IF(__SSE2__, sse2, simd128)  // other kernels are picked
#else
#define LIGHTBIN_RUNG LIGHTBIN_IF(__AVX512F__, avx512_, LIGHTBIN_IF(__AVX2__, avx2_, LIGHTBIN_IF(__AVX__, avx_, \
    LIGHTBIN_IF(__SSE4_2__, sse42_, LIGHTBIN_IF(__SSE4_1__, sse41_, LIGHTBIN_IF(__SSSE3__, ssse3_, \
    LIGHTBIN_IF(__SSE3__, sse3_, LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, LIGHTBIN_IF(__ARM_FEATURE_SVE, sve_, baseline)))))))))
#endif
// Other kernels are picked.
#if defined(LIGHTBIN_NO_SIMD)
#define LIGHTBIN_KERNELS _no_simd
#else
#define LIGHTBIN_KERNELS
#endif

#define LIGHTBIN_FLAVOUR LIGHTBIN_PASTE( \
    LIGHTBIN_PASTE(built_for_, LIGHTBIN_RUNG, LIGHTBIN_KERNELS, , , , , ), \
    LIGHTBIN_LINE(1, __FMA__, __BMI__, __BMI2__, __LZCNT__, __POPCNT__, __MOVBE__, __GFNI__, __SSE4A__), \
    LIGHTBIN_LINE(2, __FMA4__, __XOP__, __TBM__, __AVXVNNI__, __AVXVNNIINT8__, __AVXVNNIINT16__, __AVXIFMA__, __EVEX512__), \
    LIGHTBIN_LINE(3, __AVX512CD__, __AVX512BW__, __AVX512DQ__, __AVX512VL__, \
                     __AVX512IFMA__, __AVX512VBMI__, __AVX512VBMI2__, __AVX512VNNI__), \
    LIGHTBIN_LINE(4, __AVX512BITALG__, __AVX512VPOPCNTDQ__, __AVX512FP16__, \
                     __AVX10_1__, __AVX10_2__, __CMPCCXADD__, __RAOINT__, __APX_F__), \
    LIGHTBIN_LINE(5, __EGPR__, __PPX__, __PUSH2POP2__, __NDD__, __CCMP__, __NF__, __CF__, __ZU__), \
    LIGHTBIN_LINE(6, __ARM_FEATURE_ATOMICS, __ARM_FEATURE_QRDMX, __ARM_FEATURE_COMPLEX, __ARM_FEATURE_DOTPROD, \
                     __ARM_FEATURE_MATMUL_INT8, __ARM_FEATURE_SHA3, __ARM_FEATURE_RCPC, __ARM_FEATURE_PAUTH), \
    LIGHTBIN_PASTE( \
    LIGHTBIN_LINE(7, __ARM_FEATURE_MOPS, __ARM_FEATURE_CSSC, __ARM_FEATURE_FAMINMAX, __ARM_FEATURE_SVE2p1, \
                     __ARM_FEATURE_SVE_MATMUL_FP64, __ARM_FEATURE_FP16_SCALAR_ARITHMETIC, __ARM_FEATURE_PAUTH_LR, __ARM_FEATURE_SVE), \
    LIGHTBIN_LINE(8, __ALTIVEC__, __VSX__, _ARCH_PWR6, _ARCH_PWR7, _ARCH_PWR8, _ARCH_PWR9, _ARCH_PWR10, _ARCH_PWR11), \
    LIGHTBIN_LINE(9, __riscv_v, __riscv_zba, __riscv_zbb, __riscv_zbs, __riscv_zicond, __riscv_zfa, , ), , , , , ))
// clang-format on
