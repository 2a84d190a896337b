// SPDX-License-Identifier: MIT
// What the supertile kernels of all tiers share.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/detail/engine/scratch.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/options.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Lights have a word with a bit per tile in each supertile, rather than a byte of columns and one of rows.
template <Footprint footprint, DepthTest depth_test>
inline constexpr bool with_words = footprint != Footprint::rectangle || depth_test != DepthTest::none;

/// Kernels that read spots are other ones than those of spheres; what their footprints say needs none.
template <DepthTest depth_test> inline constexpr bool reads_spots = depth_test != DepthTest::none;

/// Depth tests that ask for the boxes around cells.
template <DepthTest depth_test>
inline constexpr bool with_boxes = depth_test == DepthTest::box || depth_test == DepthTest::split_box;

/// Planes of 64 floats that a depth test needs of a supertile, see arrange_cells().
template <DepthTest depth_test>
inline constexpr unsigned cell_planes = depth_test == DepthTest::split_box ? 12
                                        : depth_test == DepthTest::box     ? 6
                                                                           : 2;
inline constexpr unsigned next_box = 64 * cell_planes<DepthTest::box>;  ///< floats from a box to the next

/// The lists of a band, one a supertile, and the ids in them.
template <class ListId> struct BandLists {
    SupertileList* lists;  ///< null: no light meets the band
    ListId* ids;
    bool wide;  ///< some ids have more than 16 bits
};

/// The most places that a kernel's lists can take, which it counts in 32 bits: one for each light and supertile that
/// its rectangle meets, wherever the supertiles begin, and what fills up a list.
inline std::uint64_t list_places(const Camera& camera, const LitSlice& lit) {
    const std::uint64_t width = static_cast<std::uint64_t>(camera.x.tiles) / 8 + 3,
                        height = static_cast<std::uint64_t>(camera.y.tiles) / 8 + 3;
    std::uint64_t places = 64 * width * height;
    for (const FootprintRun& run : lit.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            places += (lit.lights.x1[i] / 8u - lit.lights.x0[i] / 8u + std::uint64_t{1}) *
                      ((lit.lights.y1[i] - lit.lights.y0[i] + 7u) / 8 + 1);
    return places;
}

/// Bits of the tiles first..last of an 8-tile span that begins at tile `begin`, for a light that meets it.
inline unsigned covered(unsigned first, unsigned last, unsigned begin) {
    const unsigned low = first > begin ? first - begin : 0, high = last - begin < 7 ? last - begin : 7;
    return ((2u << high) - 1) & (~0u << low);
}

/// 8 bytes as a word, the first of them its lowest, whatever the order of bytes in this machine's memory.
inline std::uint64_t load_8_bytes(const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(&word, bytes, 8);
    else
        for (unsigned i = 8; i > 0; --i)
            word = word << 8 | bytes[i - 1];
    return word;
}

/// Where in memory a word has its byte `i`, counted from the lowest.
constexpr std::ptrdiff_t byte_place(std::ptrdiff_t i) {
    return std::endian::native == std::endian::little ? i : 7 - i;
}

/// For each set bit of a byte a byte of ones.
inline std::uint64_t spread_rows(std::uint8_t rows) {
    const std::uint64_t one_each = rows * std::uint64_t{0x0101010101010101} & 0x8040201008040201;
    return ((one_each + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101) * 0xff;
}

/// 8x8 bits transposed: byte i bit j to byte j bit i (Warren, "Hacker's Delight", 7-3).
inline std::uint64_t transpose_bits(std::uint64_t x) {
    std::uint64_t t = (x ^ x >> 7) & 0x00aa00aa00aa00aa;
    x ^= t ^ t << 7;
    t = (x ^ x >> 14) & 0x0000cccc0000cccc;
    x ^= t ^ t << 14;
    t = (x ^ x >> 28) & 0x00000000f0f0f0f0;
    return x ^ t ^ t << 28;
}

}}}  // namespace lightbin::detail
