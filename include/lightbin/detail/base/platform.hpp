// SPDX-License-Identifier: MIT
// Differences between compilers and processors, as macros. LIGHTBIN_NO_SIMD, which users may define, leaves only the
// scalar kernels. So does the memory sanitizer, which would report the unused lanes of vectors as uninitialised.
//
// So do g++ and clang without optimisation, where a file that bins compiles in half the time that all kernels take, and
// few vectors are faster than none (bench/README.md, "Compile time"). Files compiled with and without optimisation may
// still share types and functions of the library: where the linker keeps the copy of with_tier() that has no kernels for
// an instruction set, that one takes the scalar kernels.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstring>

#if defined(__has_feature)
#if __has_feature(memory_sanitizer)
#define LIGHTBIN_MEMORY_SANITIZER 1
#endif
#endif

#if defined(LIGHTBIN_NO_SIMD) || defined(LIGHTBIN_MEMORY_SANITIZER) || (defined(__GNUC__) && !defined(__OPTIMIZE__))
#elif defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC))
#define LIGHTBIN_X86 1
#define LIGHTBIN_HAS_SIMD128 1
#elif defined(__wasm_simd128__)
#define LIGHTBIN_HAS_SIMD128 1
#elif defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_NEON 1
#define LIGHTBIN_HAS_SIMD128 1
#endif

// LIGHTBIN_NO_SCALAR, which users may define, leaves the scalar kernels out where the compiler may use vectors of 128
// bits in any function, so that the program runs on no machine without them: WebAssembly with -msimd128, 64-bit ARM,
// x86-64 with -march=x86-64-v2 and up. Only the reduction of depth keeps its scalar kernel, for rows of less than four
// samples.
#if defined(LIGHTBIN_NO_SCALAR) && defined(LIGHTBIN_HAS_SIMD128) && \
    (!defined(LIGHTBIN_X86) || (defined(__SSSE3__) && defined(__SSE4_1__) && defined(__POPCNT__)))
#define LIGHTBIN_VECTORS_ONLY 1
#endif

// Functions, templates and lambdas between LIGHTBIN_TARGET_BEGIN("avx2,bmi") and LIGHTBIN_TARGET_END may use the named
// instruction sets in addition to those that the compiler's flags allow. Microsoft's compiler allows every function to
// use all of them.
#if defined(_MSC_VER) && !defined(__clang__)
#define LIGHTBIN_NOINLINE __declspec(noinline)
#define LIGHTBIN_INLINE __forceinline
#define LIGHTBIN_TARGET_BEGIN(names)
#define LIGHTBIN_TARGET_END
#else
#define LIGHTBIN_NOINLINE __attribute__((noinline))
#define LIGHTBIN_INLINE __attribute__((always_inline)) inline
#define LIGHTBIN_PRAGMA(text) _Pragma(#text)
#if defined(__clang__)
#define LIGHTBIN_TARGET_BEGIN(names)                                                                         \
    LIGHTBIN_PRAGMA(clang attribute push(__attribute__((target(names))), apply_to = function))
#define LIGHTBIN_TARGET_END LIGHTBIN_PRAGMA(clang attribute pop)
#else
#define LIGHTBIN_TARGET_BEGIN(names) LIGHTBIN_PRAGMA(GCC push_options) LIGHTBIN_PRAGMA(GCC target(names))
#define LIGHTBIN_TARGET_END LIGHTBIN_PRAGMA(GCC pop_options)
#endif
#endif

// Unrolls the loop that follows, of at most 16 turns. GCC does so with -O3, but with -O2 it would keep the arrays of
// vectors that such loops run over in memory instead of registers. Other compilers unroll short loops with -O2.
#if defined(__GNUC__) && !defined(__clang__)
#define LIGHTBIN_UNROLL LIGHTBIN_PRAGMA(GCC unroll 16)
#else
#define LIGHTBIN_UNROLL
#endif

// LIGHTBIN_SMALL marks functions that run seldom: in the file that implements lightbin.h, which has the code for all
// options, they are compiled for size.
#if defined(LIGHTBIN_IMPLEMENTATION) && defined(__GNUC__)
#define LIGHTBIN_SMALL __attribute__((noinline, cold))
#else
#define LIGHTBIN_SMALL
#endif

// LIGHTBIN_FORGET(value) makes the compiler forget how a number or vector was computed, so that it cannot fuse the
// computation with a later one; see rounded(). Microsoft's compiler fuses only if told to, and WebAssembly has no fused
// instructions. Without vector kernels the value goes through memory ("+m"), a constraint of all processors.
#if defined(__x86_64__) || defined(__i386__)
#define LIGHTBIN_FORGET(value) __asm__("" : "+v"(value))
#elif defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_FORGET(value) __asm__("" : "+w"(value))
#elif defined(__GNUC__) && !defined(__wasm__)
#define LIGHTBIN_FORGET(value) __asm__("" : "+m"(value))
#else
#define LIGHTBIN_FORGET(value) static_cast<void>(value)
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns `product`, rounded to its type. Keeps the compiler from fusing a product and a later sum into one
/// instruction that rounds once, since the result would then depend on the instruction set.
template <class Real> inline Real rounded(Real product) {
    LIGHTBIN_FORGET(product);
    return product;
}

/// Returns the value of type To that has the bytes of `from`: std::bit_cast, which some C++20 standard libraries lack.
template <class To, class From> To bit_cast(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

}}}  // namespace lightbin::detail
