// SPDX-License-Identifier: MIT
// Ways to do, without special instructions, what a tier must define and some tiers do faster: a tier names those it
// takes.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace portable {

/// For each of 8 bits, which of 64 bytes have it: words[bit], one bit a byte.
inline void split_bits(const std::uint8_t* bytes, std::uint64_t* words) {
    for (unsigned i = 0; i < 64; i += 8) {
        const std::uint64_t eight = transpose_bits(load_8_bytes(bytes + i));
        for (unsigned bit = 0; bit < 8; ++bit)
            words[bit] = (i == 0 ? 0 : words[bit]) | (eight >> 8 * bit & 0xff) << i;
    }
}

/// Transposes the words of 8 lights, a bit per tile, to a byte per tile, a bit a light.
inline void transpose_words(const std::uint64_t* words, std::uint64_t* tiles) {
    for (unsigned row = 0; row < 8; ++row) {
        std::uint64_t of_row = 0;
        for (unsigned light = 0; light < 8; ++light)
            of_row |= (words[light] >> 8 * row & 0xff) << 8 * light;
        tiles[row] = transpose_bits(of_row);
    }
}

/// The form in which append() takes ids, one after another: as they are.
template <class Id> using Packed = std::uint32_t;
inline constexpr bool packs_ids = false;

/// Writes those of 8 ids whose bit is set, in order, then elements that mean nothing: every id is written, and
/// the place moves on for those chosen. Returns how many.
template <class Id> std::uint32_t append(Id* out, const std::uint32_t* ids, unsigned mask) {
    std::uint32_t count = 0;
    for (unsigned i = 0; i < 8; ++i, mask >>= 1) {
        out[count] = static_cast<Id>(ids[i]);
        count += mask & 1;
    }
    return count;
}

}}}}  // namespace lightbin::detail
