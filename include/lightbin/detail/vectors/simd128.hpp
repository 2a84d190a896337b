// SPDX-License-Identifier: MIT
// The tier of 128-bit vectors, which hold four lights: SSE4.1 (x86 processors since 2008), NEON (64-bit ARM) and
// WebAssembly's simd128. sse41.inl, neon.inl and wasm.inl have the operations that each spells in its own way.
#pragma once

#include <lightbin/detail/base/bits.hpp>
#include <lightbin/sphere.hpp>

#if defined(LIGHTBIN_HAS_SIMD128)

#if defined(LIGHTBIN_X86)
#include <smmintrin.h>
#define LIGHTBIN_SIMD128_BEGIN LIGHTBIN_TARGET_BEGIN("ssse3,sse4.1,popcnt")
#define LIGHTBIN_SIMD128_END LIGHTBIN_TARGET_END
#elif defined(LIGHTBIN_NEON)
#include <arm_neon.h>
#else
#include <wasm_simd128.h>
#endif
#if !defined(LIGHTBIN_SIMD128_BEGIN)  // no region is needed: the compiler's flags allow the instructions
#define LIGHTBIN_SIMD128_BEGIN
#define LIGHTBIN_SIMD128_END
#endif

LIGHTBIN_SIMD128_BEGIN

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace simd128 {

inline constexpr std::uint32_t lanes = 4, byte_lanes = 16;
using ByteMask = std::uint16_t;

#if defined(LIGHTBIN_X86)
#include <lightbin/detail/vectors/simd128/sse41.inl>
#elif defined(LIGHTBIN_NEON)
#include <lightbin/detail/vectors/simd128/neon.inl>
#else
#include <lightbin/detail/vectors/simd128/wasm.inl>
#endif

inline Bytes load_bytes(const void* from) {
    Bytes bytes;
    std::memcpy(&bytes.v, from, sizeof bytes.v);
    return bytes;
}
inline void store_bytes(void* to, Bytes bytes) {
    std::memcpy(to, &bytes.v, sizeof bytes.v);
}
inline Bytes shuffle(const std::uint8_t (&table)[16], Bytes indices) {
    return shuffle(load_bytes(table), indices);
}
inline Bytes keep_where(Bytes bytes, Bytes condition) {
    return bytes & all_if_not_zero(condition);
}
inline ByteMask not_zero(Bytes bytes) {
    return static_cast<ByteMask>(movemask(all_if_not_zero(bytes)));
}
inline Bytes coordinates(const std::uint16_t* from, unsigned more, unsigned begin) {
    return narrow(relative_words(load_bytes(from), more, begin), relative_words(load_bytes(from + 8), more, begin));
}
inline void compress_store(ByteMask chosen, Bytes from, std::uint8_t* to) {
    const unsigned low = chosen & 0xffu, high = chosen >> 8;
    store_half(to, shuffle(from, load_half(&set_bits.of[low])));
    store_half(to + std::popcount(low), shuffle(high_half(from), load_half(&set_bits.of[high])));
}

/// How many bits of four are set.
inline constexpr std::uint8_t set_of_4[] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

/// For each mask of four 32-bit elements, the positions of the bytes of the chosen elements: indices of a byte shuffle.
struct Compress4 {
    alignas(16) std::uint8_t of[16][16];
};
inline constexpr Compress4 compress_4 = [] {
    Compress4 table = {};
    for (unsigned mask = 0; mask < 16; ++mask)
        for (unsigned i = 0, to = 0; i < 4; ++i)
            for (unsigned byte = 0; (mask >> i & 1) != 0 && byte < 4; ++byte)
                table.of[mask][to++] = static_cast<std::uint8_t>(4 * i + byte);
    return table;
}();

/// Appends to `out` the ids, of four, whose bit in `mask` is set. Returns the end; may write 4 elements past it.
template <class Id> LIGHTBIN_INLINE Id* append_4(Id* out, const std::uint32_t* ids, unsigned mask) {
    const Bytes chosen = shuffle(load_bytes(ids), load_bytes(compress_4.of[mask]));
    if constexpr (sizeof(Id) == 4)
        store_bytes(out, chosen);
    else
        store_half(out, narrow_ids(chosen));
    return out + set_of_4[mask];
}
template <class Id> LIGHTBIN_INLINE Id* append_8(Id* out, const std::uint32_t* ids, unsigned mask) {
    return append_4(append_4(out, ids, mask & 15), ids + 4, mask >> 4);
}
template <class Id> LIGHTBIN_INLINE Id* append_16(Id* out, const std::uint32_t* ids, unsigned mask) {
    return append_8(append_8(out, ids, mask & 0xff), ids + 8, mask >> 8);
}

}}}}  // namespace lightbin::detail

LIGHTBIN_SIMD128_END

#endif
