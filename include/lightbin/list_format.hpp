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
};

constexpr const char* to_string(ListEncoding encoding) {
    return detail::name_at(encoding, {"offset_count", "sentinel"});
}

/// The format of the lists: their encoding, and the numbers that fix its sizes.
struct ListFormat {
    ListEncoding encoding = ListEncoding::offset_count;
    IdWidth ids = IdWidth::u32;  ///< the width of an id
    std::uint32_t capacity = 0;  ///< with ListEncoding::sentinel: how many ids each tile has memory for, 1 or more
};

}}  // namespace lightbin
