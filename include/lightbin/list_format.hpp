// SPDX-License-Identifier: MIT
// The format of light lists. A shader that reads lists must be made for the format that a Binner or encode() wrote.
#pragma once

#include <lightbin/light_grid.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How the list of a tile is stored.
enum class ListEncoding : std::uint8_t {
    offset_count,  ///< a LightGrid's lists: {offset, count} per tile, and one list of ids (Tiled Shading, Figure 1)
    /// Memory for `capacity` ids per tile, so that no offsets are needed (Light Indexed Deferred Rendering). A shorter
    /// list ends with a sentinel, the largest value of the id's width.
    sentinel,
    bitmask,  ///< (max_lights + 31) / 32 words of 32 bits per tile: bit b of word w is set for light 32 w + b
};

constexpr const char* to_string(ListEncoding encoding) {
    return detail::name_at(encoding, {"offset_count", "sentinel", "bitmask"});
}

/// The format of the lists: their encoding, and the numbers that fix its sizes.
struct ListFormat {
    ListEncoding encoding = ListEncoding::offset_count;
    IdWidth ids = IdWidth::u32;    ///< the width of an id in the encodings offset_count and sentinel
    std::uint32_t capacity = 0;    ///< with ListEncoding::sentinel: how many ids each tile has memory for, 1 or more
    /// Every id must be less. Required with ListEncoding::bitmask; else 0 allows all ids that IdWidth can hold.
    std::uint32_t max_lights = 0;
};

}}  // namespace lightbin
