// SPDX-License-Identifier: MIT
// Stability: settled.
// Instruction sets: those that the compiler made kernels for, and the widest that this machine runs.
#pragma once

#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/base/platform.hpp>

#include <cstdint>

#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The instruction sets that have their own kernels. The kernels of all of them give the same bytes.
enum class Isa : std::uint8_t {
    scalar = 1,  ///< no vectors, one number at a time: runs on every machine
    simd128,  ///< vectors of 128 bits: SSE4.1 on x86-64, NEON on 64-bit ARM, simd128 of WebAssembly (-msimd128)
    avx2,
    avx512,  ///< vectors of 512 bits, AVX-512 with VBMI2: Ice Lake, Zen 4 and later
};

constexpr const char* to_string(Isa isa) {
    return detail::name_at(isa, {"?", "scalar", "simd128", "avx2", "avx512"});
}

/// The widest instruction set that this build contains kernels for.
#if defined(LIGHTBIN_X86) && defined(__MINGW32__) && !defined(__clang__)
inline constexpr Isa compiled_isa = Isa::simd128;  // wider vectors would be misaligned on the stack (GCC bug 54412)
#elif defined(LIGHTBIN_X86)
inline constexpr Isa compiled_isa = Isa::avx512;
#elif defined(LIGHTBIN_HAS_SIMD128)
inline constexpr Isa compiled_isa = Isa::simd128;
#else
inline constexpr Isa compiled_isa = Isa::scalar;
#endif

#if defined(LIGHTBIN_X86)
namespace detail {

/// The widest instruction set whose kernels the processor and the operating system support.
inline Isa processor_isa() {
#if defined(_MSC_VER)
    // Bits of CPUID leaf 1 (ECX) and leaf 7 (EBX, ECX) say what the processor supports; bits of XGETBV, which registers
    // the operating system saves. (Intel's manual, volume 2, CPUID.)
    int leaf_0[4], leaf_1[4], leaf_7[4] = {};
    __cpuid(leaf_0, 0);
    __cpuid(leaf_1, 1);
    if (leaf_0[0] >= 7) __cpuidex(leaf_7, 7, 0);
    const auto has = [](int register_value, std::initializer_list<unsigned> bits) {
        for (const unsigned bit : bits)
            if ((static_cast<unsigned>(register_value) >> bit & 1) == 0) return false;
        return true;
    };
    if (!has(leaf_1[2], {9, 19, 23})) return Isa::scalar;                               // SSSE3, SSE4.1, POPCNT
    const unsigned long long saved = has(leaf_1[2], {27, 28}) ? _xgetbv(0) : 0;         // OSXSAVE, AVX
    if ((saved & 0x06) != 0x06 || !has(leaf_7[1], {3, 5})) return Isa::simd128;         // BMI1, AVX2
    const bool avx512 = (saved & 0xe6) == 0xe6 && has(leaf_7[1], {8, 16, 17, 30, 31});  // BMI2, F, DQ, BW, VL
    return avx512 && has(leaf_7[2], {6}) ? Isa::avx512 : Isa::avx2;                     // VBMI2
#else
    // The compiler's builtins execute CPUID once per program. In a virtual machine, CPUID takes 10 us and more.
    if (!__builtin_cpu_supports("ssse3") || !__builtin_cpu_supports("sse4.1") || !__builtin_cpu_supports("popcnt"))
        return Isa::scalar;
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi")) return Isa::simd128;
    const bool avx512 = __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx512f") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vbmi2");
    return avx512 ? Isa::avx512 : Isa::avx2;
#endif
}

}  // namespace detail
#endif

/// Returns the widest instruction set, up to `cap`, of this build that this machine runs.
inline Isa machine_isa(Isa cap = compiled_isa) {
    if (cap > compiled_isa) cap = compiled_isa;
#if defined(LIGHTBIN_X86)
    if (cap == Isa::scalar) return cap;
    const Isa has = detail::processor_isa();
    return has < cap ? has : cap;
#else
    return cap;
#endif
}

}}  // namespace lightbin
