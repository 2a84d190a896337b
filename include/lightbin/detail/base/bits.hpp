// SPDX-License-Identifier: MIT
// Words as rows of bits or bytes: loads and stores, transposition, and the positions of the bits that are set.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <bit>
#include <cstdint>
#include <cstring>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns the word whose lowest byte is the first of 8 bytes in memory, whatever the byte order of the machine.
inline std::uint64_t load_8_bytes(const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(&word, bytes, 8);
    else
        for (unsigned i = 8; i > 0; --i)
            word = word << 8 | bytes[i - 1];
    return word;
}

/// Stores a word as 8 bytes with the lowest first, whatever the byte order of the machine.
inline void store_8_bytes(std::uint8_t* bytes, std::uint64_t word) {
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(bytes, &word, 8);
    else
        for (unsigned i = 0; i < 8; ++i, word >>= 8)
            bytes[i] = static_cast<std::uint8_t>(word);
}

/// Returns a word whose byte i is 0xff where bit i is set, and 0 elsewhere.
inline std::uint64_t spread_bits(std::uint8_t bits) {
    const std::uint64_t one_each = bits * std::uint64_t{0x0101010101010101} & 0x8040201008040201;
    return ((one_each + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101) * 0xff;
}

/// Transposes 8x8 bits: bit j of byte i becomes bit i of byte j (Warren, "Hacker's Delight", 7-3).
inline std::uint64_t transpose_bits(std::uint64_t x) {
    std::uint64_t t = (x ^ x >> 7) & 0x00aa00aa00aa00aa;
    x ^= t ^ t << 7;
    t = (x ^ x >> 14) & 0x0000cccc0000cccc;
    x ^= t ^ t << 14;
    t = (x ^ x >> 28) & 0x00000000f0f0f0f0;
    return x ^ t ^ t << 28;
}

/// For each value of a byte, the positions of its set bits in ascending order, one in each byte of a word. As indices
/// of a shuffle they compact eight elements: they move the elements whose bit is set to the front.
struct SetBits {
    std::uint64_t of[256];
};
inline constexpr SetBits set_bits = [] {
    SetBits table = {};
    for (unsigned byte = 1; byte < 256; ++byte)
        table.of[byte] = table.of[byte & (byte - 1)] << 8 | static_cast<unsigned>(std::countr_zero(byte));
    return table;
}();

}}}  // namespace lightbin::detail
