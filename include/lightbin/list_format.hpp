// SPDX-License-Identifier: MIT
// The forms that lists have. What a Binner or encode() writes and what a shader reads must have the same.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/light_grid.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How the lights of a tile are written down.
enum class ListEncoding : std::uint8_t {
    offset_count,  ///< grid.ranges(), and the ids of all tiles one after the other (Tiled Shading, Figure 1)
    /// `capacity` ids a tile; a shorter list ends with the sentinel, the largest value of the id's width.
    /// Needs no table of tiles (Light Indexed Deferred Rendering).
    sentinel,
    bitmask,  ///< (max_lights + 31) / 32 words of 32 bits a tile: bit b of word w is light 32 w + b
};

constexpr const char* to_string(ListEncoding encoding) {
    return detail::name_at(encoding, {"offset_count", "sentinel", "bitmask"});
}

/// A form of the lists.
struct ListFormat {
    ListEncoding encoding = ListEncoding::offset_count;
    IdWidth ids = IdWidth::u32;    ///< offset_count, sentinel
    std::uint32_t capacity = 0;    ///< sentinel: lights a tile can hold, 1 or more
    std::uint32_t max_lights = 0;  ///< ids are below it; bitmask: needed, others: 0 is as many as ids number
};

}}  // namespace lightbin
