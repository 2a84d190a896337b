// SPDX-License-Identifier: MIT
// Which instruction sets this compiler can make kernels for, and which of them this machine runs. Define
// LIGHTBIN_NO_SIMD to have the scalar kernels alone.
#pragma once

#include <lightbin/detail/flavour.hpp>

#include <cstdint>

#if !defined(LIGHTBIN_NO_SIMD) && defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_X86 1
#elif !defined(LIGHTBIN_NO_SIMD) && defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_NEON 1
#endif

#if defined(_MSC_VER) && !defined(__clang__)
#define LIGHTBIN_NOINLINE __declspec(noinline)
#else
#define LIGHTBIN_NOINLINE __attribute__((noinline))
#endif

// Makes the compiler forget how `product`, a number or a vector, came about. See rounded().
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_ROUND(product) __asm__("" : "+v"(product))
#elif defined(__aarch64__) && (defined(__GNUC__) || defined(__clang__))
#define LIGHTBIN_ROUND(product) __asm__("" : "+w"(product))
#else
#define LIGHTBIN_ROUND(product) static_cast<void>(product)
#endif

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Instruction sets with kernels of their own. All give the same bytes.
enum class Isa : std::uint8_t {
    scalar,
    sse2,
    avx2,
    avx512,  ///< with VBMI2, BITALG and VPOPCNTDQ: Ice Lake, Zen 4 and later
    neon,    ///< 64-bit ARM
};

namespace detail {

#if defined(LIGHTBIN_X86) && defined(__MINGW32__) && !defined(__clang__)
inline constexpr Isa compiled_isa = Isa::sse2;  // wider vectors are misaligned on the stack: GCC bug 54412
#elif defined(LIGHTBIN_X86)
inline constexpr Isa compiled_isa = Isa::avx512;
#elif defined(LIGHTBIN_NEON)
inline constexpr Isa compiled_isa = Isa::neon;
#else
inline constexpr Isa compiled_isa = Isa::scalar;
#endif

/// The widest instruction set, `cap` or below, that was compiled in and that this machine runs. On ARM all
/// but scalar mean neon; on x86 neon means scalar.
inline Isa machine_isa(Isa cap) {
#if defined(LIGHTBIN_NEON)
    return cap == Isa::scalar ? Isa::scalar : Isa::neon;
#elif defined(LIGHTBIN_X86)
    if (cap == Isa::neon) return Isa::scalar;
    if (cap >= Isa::avx512 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vbmi2") &&
        __builtin_cpu_supports("avx512bitalg") && __builtin_cpu_supports("avx512vpopcntdq"))
        return Isa::avx512;
    if (cap >= Isa::avx2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
        __builtin_cpu_supports("popcnt"))
        return Isa::avx2;
    return cap >= Isa::sse2 ? Isa::sse2 : Isa::scalar;
#else
    static_cast<void>(cap);
    return Isa::scalar;
#endif
}

/// A product that is rounded before it is added to anything: keeps compilers from fusing the two, which would
/// make the result depend on the instruction set.
template <class Real> inline Real rounded(Real product) {
    LIGHTBIN_ROUND(product);
    return product;
}

}  // namespace detail
}  // namespace lightbin
