// SPDX-License-Identifier: MIT
// The C functions that encode the lists of finished grids in smaller formats.
#pragma once

#include <lightbin/detail/c/binners.hpp>

#include <lightbin/encode.hpp>

namespace lightbin {
namespace c {

/// Calls body() with the LightGrid that the caller's struct describes.
template <class Body> lightbin_result with_grid(const lightbin_grid* given, const Body& body) {
    lightbin_grid grid;
    lightbin_result result = read(given, grid, "grid");
    if (result.error == LIGHTBIN_OK)
        result = first_error(check_array(grid.ranges, grid.range_count, "grid.ranges"),
                             check_array(grid.ids, grid.id_count, "grid.ids"));
    if (result.error != LIGHTBIN_OK) return result;
    const auto with = [&]<class Id>(const Id* ids) {
        const auto size = [](std::uint64_t count) { return static_cast<std::size_t>(count); };
        return body(LightGrid<Id>(
            grid.tiles_x, grid.tiles_y, {same_layout<ListRange>(grid.ranges), size(grid.range_count)},
            {ids, size(grid.id_count)}, {grid.lights, grid.rejected, grid.culled, grid.first_spot, grid.first_box},
            grid.slices,
            {{grid.order, size(grid.order_count)}, {same_layout<BinRange>(grid.bins), size(grid.bin_count)}}));
    };
#if defined(LIGHTBIN_NO_U16)
    if (grid.id_bytes == 2) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_U16");
#else
    if (grid.id_bytes == 2) return with(static_cast<const std::uint16_t*>(grid.ids));
#endif
    if (grid.id_bytes == 4) return with(static_cast<const std::uint32_t*>(grid.ids));
    return refused(LIGHTBIN_NOT_A_VALUE, "grid.id_bytes", grid.id_bytes);
}

/// Reads the ListFormat that the caller describes, or returns why it is refused.
inline lightbin_result read_format(const lightbin_format* from, ListFormat& known, const char* name) {
    lightbin_format given;
    const lightbin_result result = read(from, given, name);
    if (result.error != LIGHTBIN_OK) return result;
    return first_error(read_member(given.ids, known.ids, name), read_member(given.encoding, known.encoding, name),
                       read_member(given.capacity, known.capacity, name));
}
inline lightbin_result read_member(const lightbin_format* given, ListFormat& known, const char* name) {
    return given != nullptr ? read_format(given, known, name) : succeeded();
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_encode(const lightbin_grid* grid, const lightbin_format* format, void* out,
                                std::uint64_t out_bytes, lightbin_encoded* encoded) {
    using namespace lightbin::c;
    lightbin::ListFormat known;
    const lightbin_result checked =
        first_error(check_size(encoded, "encoded"), read_format(format, known, "format"));
    return call_if(checked, [&] {
        return with_grid(grid, [&](const auto& from) {
            const std::uint64_t bytes = lightbin::encoded_bytes(known, from.ranges().size(), from.ids().size());
            if (out == nullptr && bytes > 0) return write({0, 0, 0, bytes, 0, 0}, encoded);
            const auto made = lightbin::encode(
                from, known, std::span(static_cast<std::byte*>(out), static_cast<std::size_t>(out_bytes)));
            if (!made) return refused(made.error());
            return write({0, made->tiles_cut, made->entries_cut, bytes, made->capacity_needed, 0}, encoded);
        });
    });
}

}  // extern "C"
