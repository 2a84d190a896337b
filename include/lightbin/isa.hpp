// SPDX-License-Identifier: MIT
// Instruction sets: which of them the compiler made kernels for, and which this machine runs.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/base/platform.hpp>

#include <cstdint>
#include <initializer_list>

#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Instruction sets with kernels of their own. All give the same bytes.
enum class Isa : std::uint8_t {
    scalar,
    sse2,  ///< also WebAssembly's simd128, by emscripten's -msimd128 -msse2
    avx2,
    avx512,  ///< with VBMI2, BITALG and VPOPCNTDQ: Ice Lake, Zen 4 and later
    neon,    ///< 64-bit ARM
};

constexpr const char* to_string(Isa isa) {
    return detail::name_at(isa, {"scalar", "sse2", "avx2", "avx512", "neon"});
}

/// The widest instruction set that this compiler makes kernels for.
#if defined(LIGHTBIN_X86) && defined(__MINGW32__) && !defined(__clang__)
inline constexpr Isa compiled_isa = Isa::sse2;  // wider vectors are misaligned on the stack: GCC bug 54412
#elif defined(LIGHTBIN_SSE2) && !defined(LIGHTBIN_X86)
inline constexpr Isa compiled_isa = Isa::sse2;
#elif defined(LIGHTBIN_X86)
inline constexpr Isa compiled_isa = Isa::avx512;
#elif defined(LIGHTBIN_NEON)
inline constexpr Isa compiled_isa = Isa::neon;
#else
inline constexpr Isa compiled_isa = Isa::scalar;
#endif

#if defined(LIGHTBIN_X86)
namespace detail {

/// Whether the processor and the system have what the avx2 kernels use; the avx512 kernels.
struct WideVectors {
    bool avx2, avx512;
};

inline WideVectors wide_vectors() {
#if defined(_MSC_VER)
    // Intel's manual, volume 2, CPUID: leaf 1, ECX; leaf 7, EBX and ECX. XGETBV: what the system saves of registers.
    int first[4], seventh[4];
    __cpuid(first, 0);
    if (first[0] < 7) return {};
    __cpuid(first, 1);
    __cpuidex(seventh, 7, 0);
    const auto has = [](int register_value, std::initializer_list<unsigned> bits) {
        for (const unsigned bit : bits)
            if ((static_cast<unsigned>(register_value) >> bit & 1) == 0) return false;
        return true;
    };
    if (!has(first[2], {23, 27, 28})) return {};  // POPCNT, OSXSAVE, AVX
    const unsigned long long saved = _xgetbv(0);
    const bool avx2 = (saved & 0x06) == 0x06 && has(seventh[1], {3, 5});  // BMI1, AVX2
    return {avx2, avx2 && (saved & 0xe6) == 0xe6 &&
                      has(seventh[1], {8, 16, 17, 30, 31}) &&  // BMI2, F, DQ, BW, VL
                      has(seventh[2], {1, 6, 12, 14})};        // VBMI, VBMI2, BITALG, VPOPCNTDQ
#else
    // The compiler's own, which asks the processor once a program: in a virtual machine asking takes 10 us and more.
    const bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("popcnt");
    return {avx2, avx2 && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vbmi") &&
                      __builtin_cpu_supports("avx512vbmi2") && __builtin_cpu_supports("avx512bitalg") &&
                      __builtin_cpu_supports("avx512vpopcntdq")};
#endif
}

}  // namespace detail
#endif

/// Returns the widest instruction set, `cap` or below, that was compiled in and that this machine runs: what a Binner
/// with Options::isa = cap uses. On ARM all but scalar mean neon; elsewhere neon means scalar.
inline Isa machine_isa(Isa cap = compiled_isa) {
#if defined(LIGHTBIN_NEON)
    return cap == Isa::scalar ? Isa::scalar : Isa::neon;
#elif defined(LIGHTBIN_SSE2)
    if (cap == Isa::neon) return Isa::scalar;
    if (cap > compiled_isa) cap = compiled_isa;
#if defined(LIGHTBIN_X86)
    if (cap >= Isa::avx2) {
        const detail::WideVectors has = detail::wide_vectors();
        if (cap >= Isa::avx512 && has.avx512) return Isa::avx512;
        if (has.avx2) return Isa::avx2;
    }
#endif
    return cap >= Isa::sse2 ? Isa::sse2 : Isa::scalar;
#else
    static_cast<void>(cap);
    return Isa::scalar;
#endif
}

}}  // namespace lightbin
