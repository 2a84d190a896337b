// SPDX-License-Identifier: MIT
// What compilers and processors differ in. Define LIGHTBIN_NO_SIMD to have the scalar kernels alone.
#pragma once

#include <lightbin/detail/flavour.hpp>

#if !defined(LIGHTBIN_NO_SIMD) && (defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC)))
#define LIGHTBIN_X86 1
#elif !defined(LIGHTBIN_NO_SIMD) && defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_NEON 1
#endif

// The instructions that a function may use beyond those of the compiler's flags. Microsoft's compiler asks for no leave.
#if defined(_MSC_VER) && !defined(__clang__)
#define LIGHTBIN_NOINLINE __declspec(noinline)
#define LIGHTBIN_INLINE __forceinline
#define LIGHTBIN_INSTRUCTIONS(names)
#else
#define LIGHTBIN_NOINLINE __attribute__((noinline))
#define LIGHTBIN_INLINE __attribute__((always_inline)) inline
#define LIGHTBIN_INSTRUCTIONS(names) __attribute__((target(names)))
#endif

// Makes the compiler forget how a number or vector came about, or an array in memory. See rounded(). Microsoft's fuses
// nothing unless told to.
#if defined(__x86_64__)
#define LIGHTBIN_FORGET(value) __asm__("" : "+v"(value))
#define LIGHTBIN_FORGET_ARRAY(array) __asm__("" : "+m"(array))
#elif defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_FORGET(value) __asm__("" : "+w"(value))
#define LIGHTBIN_FORGET_ARRAY(array) __asm__("" : "+m"(array))
#else
#define LIGHTBIN_FORGET(value) static_cast<void>(value)
#define LIGHTBIN_FORGET_ARRAY(array) static_cast<void>(array)
#endif

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// A product that is rounded before it is added to anything: keeps compilers from fusing the two, which would
/// make the result depend on the instruction set.
template <class Real> inline Real rounded(Real product) {
    LIGHTBIN_FORGET(product);
    return product;
}

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
