// SPDX-License-Identifier: MIT
// What compilers and processors differ in. Define LIGHTBIN_NO_SIMD to have the scalar kernels alone. So has the memory
// sanitizer, which does not know what most vector instructions leave unused.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstring>

#if defined(__has_feature)
#if __has_feature(memory_sanitizer)
#define LIGHTBIN_MEMORY_SANITIZER 1
#endif
#endif

#if defined(LIGHTBIN_NO_SIMD) || defined(LIGHTBIN_MEMORY_SANITIZER)
#elif defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC))
#define LIGHTBIN_X86 1
#define LIGHTBIN_SIMD128 1
#elif defined(__wasm_simd128__)
#define LIGHTBIN_SIMD128 1
#elif defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_NEON 1
#define LIGHTBIN_SIMD128 1
#endif

// Between LIGHTBIN_TARGET_BEGIN("avx2,bmi") and LIGHTBIN_TARGET_END functions, templates and lambdas may use these instruction
// sets beyond those of the compiler's flags. Microsoft's compiler lets every function use all of them.
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

// Makes the compiler forget how a number or vector came about. See rounded(). Microsoft's fuses
// nothing unless told to, and WebAssembly cannot. On processors without a tier of their own by way of memory, which all
// compilers understand.
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

/// A product that is rounded before it is added to anything: keeps compilers from fusing the two, which would
/// make the result depend on the instruction set.
template <class Real> inline Real rounded(Real product) {
    LIGHTBIN_FORGET(product);
    return product;
}

/// As std::bit_cast, which not every library of C++20 has.
template <class To, class From> To bit_cast(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

}}}  // namespace lightbin::detail
