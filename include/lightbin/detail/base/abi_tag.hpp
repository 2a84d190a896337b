// SPDX-License-Identifier: MIT
// LIGHTBIN_ABI_TAG: the name of the library's inline namespace. It encodes the instructions that the compiler's flags
// allow everywhere, so that two translation units compiled with different flags share no function and no type. Of a
// shared inline function the linker would keep either copy, whose instructions might not exist on the machine. Passing
// a lightbin type between such units is a linker error.
//
// Each other header begins by including this one, itself or by another header. So this header also refuses compilers
// that are not set to C++20, by including a file that does not exist: that ends every compiler with one error that
// shows the file's name, while after an #error gcc and clang would go on to report hundreds of errors.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include "lightbin wants C++20, which the flag -std=c++20 gives (Microsoft's: /std:c++20); no file is missing"
#endif

// LIGHTBIN_INSTRUCTION_SET, a part of the namespace's name, consists of the highest level of vector instructions that
// the compiler's flags allow, and of each other extension that they allow, written as the number of its LIGHTBIN_LINE
// below and its letter within that line: -march=haswell gives avx2_1a1b1c1d1e1f. It has every extension that a compiler
// may use of its own accord for plain C++ and announces by a macro. tests/guest/flavours.sh lists the ones left out:
// for intrinsics only, for checksums, ciphers and 16-bit floats, hints that older processors ignore (prefetches,
// control-flow marks), and those of WebAssembly, where an engine refuses a module as a whole.

// LIGHTBIN_IF(macro, name, other) expands to `name` if the macro is 1 (RISC-V: 1000000), to `name` and the digit if the
// macro is 2 or 3, and to `other` if the macro is not defined.
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

// LIGHTBIN_INSTRUCTION_SET, a part of the namespace's name, for each processor family in turn. It is just `baseline` if
// the flags allow no x86 extension, as pasting it together from the macros above takes 15 ms of compile time per file.
// clang-format off
#if defined(__arm__) || defined(__aarch64__)
#define LIGHTBIN_INSTRUCTION_SET LIGHTBIN_PASTE(LIGHTBIN_LEVEL, \
    LIGHTBIN_LINE(1, __ARM_FEATURE_ATOMICS, __ARM_FEATURE_QRDMX, __ARM_FEATURE_COMPLEX, __ARM_FEATURE_DOTPROD, \
                     __ARM_FEATURE_MATMUL_INT8, __ARM_FEATURE_SHA3, __ARM_FEATURE_RCPC, __ARM_FEATURE_PAUTH), \
    LIGHTBIN_LINE(2, __ARM_FEATURE_MOPS, __ARM_FEATURE_CSSC, __ARM_FEATURE_FAMINMAX, __ARM_FEATURE_SVE2p1, \
                     __ARM_FEATURE_SVE_MATMUL_FP64, __ARM_FEATURE_FP16_SCALAR_ARITHMETIC, __ARM_FEATURE_PAUTH_LR, \
                     __ARM_FEATURE_SVE), , , , , )
#if defined(__arm__)
#define LIGHTBIN_LEVEL LIGHTBIN_PASTE(arm, __ARM_ARCH, _, LIGHTBIN_LINE(0, __ARM_NEON, __ARM_FEATURE_FMA, __ARM_FEATURE_IDIV, \
    __ARM_FEATURE_DSP, __ARM_FEATURE_MVE, __ARM_FEATURE_NUMERIC_MAXMIN, __ARM_FPV5__, __SOFTFP__), , , , )
#elif defined(__ARM_FEATURE_SVE_BITS)
#define LIGHTBIN_LEVEL LIGHTBIN_PASTE(LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, sve_), __ARM_FEATURE_SVE_BITS, _, , , , , )
#else
#define LIGHTBIN_LEVEL LIGHTBIN_IF(__ARM_FEATURE_SVE2, sve2_, LIGHTBIN_IF(__ARM_FEATURE_SVE, sve_, baseline))
#endif
#elif defined(__wasm__)  // the kernels depend on this macro
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
    LIGHTBIN_LINE(3, __AVX512CD__, __AVX512BW__, __AVX512DQ__, __AVX512VL__, \
                     __AVX512IFMA__, __AVX512VBMI__, __AVX512VBMI2__, __AVX512VNNI__), \
    LIGHTBIN_LINE(4, __AVX512BITALG__, __AVX512VPOPCNTDQ__, __AVX512FP16__, __AVX10_1__, __AVX10_2__, \
                     __CMPCCXADD__, __RAOINT__, __EVEX512__), , , )
#else
#define LIGHTBIN_INSTRUCTION_SET baseline
#endif
// clang-format on

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
#define LIGHTBIN_ABI_TAG \
    LIGHTBIN_PASTE(built_for_, LIGHTBIN_INSTRUCTION_SET, LIGHTBIN_KERNELS_TAG, LIGHTBIN_FILE_TAG, , , , )
