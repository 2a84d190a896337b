// SPDX-License-Identifier: MIT
// Stability: settled.
// The format of light lists. A shader that reads lists must be made for the format that a Binner or encode() wrote.
#pragma once

#include <lightbin/detail/base/checked_sizes.hpp>
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

/// Returns how many lights a format can number. A sentinel takes one of the ids.
inline std::uint64_t countable_lights(const ListFormat& format) {
    const std::uint64_t values = std::uint64_t{1} << (8 * static_cast<unsigned>(format.ids));
    return format.encoding == ListEncoding::sentinel ? values - 1 : values;
}

/// Returns how many bytes, a multiple of 4, encode() needs for `tiles` tiles and `entries` ids; 2^64 - 4 for any more.
inline std::uint64_t encoded_bytes(const ListFormat& format, std::uint64_t tiles, std::uint64_t entries) {
    const std::uint64_t elements = format.encoding == ListEncoding::offset_count
                                       ? entries
                                       : detail::product_of_sizes(tiles, format.capacity);
    const std::uint64_t width = static_cast<std::uint64_t>(format.ids);
    constexpr std::uint64_t limit = ~std::uint64_t{3};
    return elements > limit / width ? limit : (elements * width + 3) / 4 * 4;
}

namespace detail {

/// Returns the error of a format that is inconsistent, and so refused by encode() and shader_snippet().
inline std::optional<Error> refuse(const ListFormat& format) {
    if (format.encoding == ListEncoding::sentinel && format.capacity == 0)
        return Error{ErrorCode::capacity_unknown};
    return std::nullopt;
}

}  // namespace detail

}}  // namespace lightbin
