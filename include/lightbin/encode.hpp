// SPDX-License-Identifier: MIT
// Stability: settled.
// Writes a light grid's lists in another format: narrower ids, or a sentinel at each list's end.
#pragma once

#include <lightbin/list_format.hpp>

#include <algorithm>
#include <cstring>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

template <class To, class Id>
void encode_ids(const LightGrid<Id>& grid, const ListFormat& format, std::byte* out) {
    const auto put = [&](std::size_t at, To id) { std::memcpy(out + at * sizeof(To), &id, sizeof(To)); };
    const bool sentinels = format.encoding == ListEncoding::sentinel;
    std::size_t at = 0;
    for (const ListRange range : grid.ranges()) {
        const std::uint32_t kept = sentinels ? (std::min)(range.count, format.capacity) : range.count;
        const std::size_t first = sentinels ? at : range.offset;
        for (std::uint32_t i = 0; i < kept; ++i)
            put(first + i, static_cast<To>(grid.ids()[range.offset + i]));
        if (sentinels && kept < format.capacity) put(first + kept, static_cast<To>(~To{0}));
        at += format.capacity;
    }
}

}  // namespace detail

/// What encode() left out of lists that are longer than the capacity of the sentinel format.
struct Encoded {
    std::uint64_t entries_cut = 0;
    std::uint32_t tiles_cut = 0;        ///< the number of tiles whose list was cut short at ListFormat::capacity
    std::uint32_t capacity_needed = 0;  ///< the length of the longest list: the least capacity that cuts none
};

/// Writes the lists of a grid to `out`, in this machine's byte order. `out` must hold encoded_bytes(format, tiles,
/// entries) or more; bytes beyond the ids keep their values. With offset_count, shaders read grid.ranges() beside
/// `out`.
///
/// Every list is complete, except that the sentinel format cuts a list longer than its capacity: the lowest `capacity`
/// ids stay, and the result counts the entries that were cut.
///
/// Errors, after which `out` is unchanged: the format lacks its capacity; an id of the grid is too large for the
/// format; `out` is too small.
template <class Id>
Result<Encoded> encode(const LightGrid<Id>& grid, const ListFormat& format, std::span<std::byte> out) {
    if (const auto error = detail::refuse(format)) return *error;
    const std::uint64_t bytes = encoded_bytes(format, grid.ranges().size(), grid.ids().size());
    if (out.size() < bytes) return Error{ErrorCode::list_buffer_too_small, bytes, out.size()};
    const std::uint64_t limit = countable_lights(format);

    Encoded encoded;
    std::uint64_t needed = 0;  // the greatest id + 1
    for (const ListRange range : grid.ranges()) {
        if (range.count > 0)  // ids ascend, so the last one is the greatest
            needed = (std::max)(needed, grid.ids()[range.offset + range.count - 1] + std::uint64_t{1});
        encoded.capacity_needed = (std::max)(encoded.capacity_needed, range.count);
        if (format.encoding != ListEncoding::sentinel || range.count <= format.capacity) continue;
        encoded.entries_cut += range.count - format.capacity;
        ++encoded.tiles_cut;
    }
    if (needed > limit) return Error{ErrorCode::ids_too_narrow, needed, limit};
    if (format.ids == IdWidth::u8)
        detail::encode_ids<std::uint8_t>(grid, format, out.data());
    else if (format.ids == IdWidth::u16)
        detail::encode_ids<std::uint16_t>(grid, format, out.data());
    else
        detail::encode_ids<std::uint32_t>(grid, format, out.data());
    return encoded;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
