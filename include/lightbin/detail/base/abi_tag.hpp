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
#include "lightbin wants C++20, which the flag -std=c++20 gives (Microsoft's: /std:c++20); no file is missing"
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
    LIGHTBIN_PASTE(LIGHTBIN_IF_VALUE(A, n##a, ), LIGHTBIN_IF_VALUE(B, n##b, ), LIGHTBIN_IF_VALUE(C, n##c, ), \
                   LIGHTBIN_IF_VALUE(D, n##d, ), LIGHTBIN_IF_VALUE(E, n##e, ), LIGHTBIN_IF_VALUE(F, n##f, ), \
                   LIGHTBIN_IF_VALUE(G, n##g, ), LIGHTBIN_IF_VALUE(H, n##h, ))

// By processor, and none of it where nothing is beyond the baseline: it is expanded wherever the namespace is named, and all
// of it would take 15 ms a file.
// clang-format off
#if defined(__arm__) || defined(__aarch64__)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE(LIGHTBIN_RUNG, \
    LIGHTBIN_LINE(1, __ARM_FEATURE_ATOMICS, __ARM_FEATURE_QRDMX, __ARM_FEATURE_COMPLEX, __ARM_FEATURE_DOTPROD, \
                     __ARM_FEATURE_MATMUL_INT8, __ARM_FEATURE_SHA3, __ARM_FEATURE_RCPC, __ARM_FEATURE_PAUTH), \
    LIGHTBIN_LINE(2, __ARM_FEATURE_MOPS, __ARM_FEATURE_CSSC, __ARM_FEATURE_FAMINMAX, __ARM_FEATURE_SVE2p1, \
                     __ARM_FEATURE_SVE_MATMUL_FP64, __ARM_FEATURE_FP16_SCALAR_ARITHMETIC, __ARM_FEATURE_PAUTH_LR, \
                     __ARM_FEATURE_SVE), , , , , )
#if defined(__arm__)
#define LIGHTBIN_RUNG LIGHTBIN_PASTE(arm, __ARM_ARCH, _, LIGHTBIN_LINE(0, __ARM_NEON, __ARM_FEATURE_FMA, __ARM_FEATURE_IDIV, \
    __ARM_FEATURE_DSP, __ARM_FEATURE_MVE, __ARM_FEATURE_NUMERIC_MAXMIN, __ARM_FPV5__, __SOFTFP__), , , , )
#elif defined(__ARM_FEATURE_SVE_BITS)
#define LIGHTBIN_RUNG LIGHTBIN_PASTE(LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, sve_), __ARM_FEATURE_SVE_BITS, _, , , , , )
#else
#define LIGHTBIN_RUNG LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, LIGHTBIN_IF(__ARM_FEATURE_SVE, sve_, baseline))
#endif
#elif defined(__wasm__)  // other kernels are picked
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_IF(__wasm_simd128__, simd128, baseline)
#elif defined(__s390__)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE(z, __ARCH__, LIGHTBIN_IF(__VX__, _vx, ), , , , , )
#elif defined(__powerpc__)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE(baseline, LIGHTBIN_LINE(1, __ALTIVEC__, __VSX__, _ARCH_PWR6, _ARCH_PWR7, \
    _ARCH_PWR8, _ARCH_PWR9, _ARCH_PWR10, _ARCH_PWR11), , , , , , )
#elif defined(__riscv)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE(baseline, LIGHTBIN_LINE(1, __riscv_v, __riscv_zba, __riscv_zbb, __riscv_zbs, \
    __riscv_zicond, __riscv_zfa, , ), , , , , , )
#elif defined(__SSE3__) || defined(__BMI__) || defined(__BMI2__) || defined(__LZCNT__) || defined(__POPCNT__) || \
    defined(__MOVBE__) || defined(__GFNI__) || defined(__TBM__) || defined(__CMPCCXADD__) || defined(__RAOINT__) || \
    defined(__EVEX512__) || defined(__APX_F__)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE( \
    LIGHTBIN_IF(__AVX512F__, avx512_, LIGHTBIN_IF(__AVX2__, avx2_, LIGHTBIN_IF(__AVX__, avx_, \
        LIGHTBIN_IF(__SSE4_2__, sse42_, LIGHTBIN_IF(__SSE4_1__, sse41_, LIGHTBIN_IF(__SSSE3__, ssse3_, \
            LIGHTBIN_IF(__SSE3__, sse3_, baseline))))))), \
    LIGHTBIN_LINE(1, __FMA__, __BMI__, __BMI2__, __LZCNT__, __POPCNT__, __MOVBE__, __GFNI__, __SSE4A__), \
    LIGHTBIN_LINE(2, __FMA4__, __XOP__, __TBM__, __AVXVNNI__, __AVXVNNIINT8__, __AVXVNNIINT16__, __AVXIFMA__, __APX_F__), \
    LIGHTBIN_LINES_OF_AVX512, LIGHTBIN_IF(__CMPCCXADD__, 0a, ), LIGHTBIN_IF(__RAOINT__, 0b, ), LIGHTBIN_IF(__EVEX512__, 0c, ), )
#if defined(__AVX512F__)
#define LIGHTBIN_LINES_OF_AVX512 LIGHTBIN_PASTE( \
    LIGHTBIN_LINE(3, __AVX512CD__, __AVX512BW__, __AVX512DQ__, __AVX512VL__, \
                     __AVX512IFMA__, __AVX512VBMI__, __AVX512VBMI2__, __AVX512VNNI__), \
    LIGHTBIN_LINE(4, __AVX512BITALG__, __AVX512VPOPCNTDQ__, __AVX512FP16__, __AVX10_1__, __AVX10_2__, , , ), \
    , , , , , )
#else
#define LIGHTBIN_LINES_OF_AVX512
#endif
#else
#define LIGHTBIN_INSTRUCTION_SET baseline
#endif
// clang-format on

#if defined(LIGHTBIN_NO_SIMD)  // other kernels are picked
#define LIGHTBIN_ABI_TAG LIGHTBIN_PASTE(built_for_, LIGHTBIN_INSTRUCTION_SET, _no_simd, , , , , )
#else
#define LIGHTBIN_ABI_TAG LIGHTBIN_PASTE(built_for_, LIGHTBIN_INSTRUCTION_SET, , , , , , )
#endif
