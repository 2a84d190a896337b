// SPDX-License-Identifier: MIT
// The C side's functions that work on finished grids: copies, unions, budgets, encodings, statistics.
#pragma once

#include <lightbin/detail/c/binners.hpp>

#include <lightbin/budget.hpp>
#include <lightbin/coverage.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/grid_union.hpp>

namespace lightbin {
namespace c {

/// Calls body() with the LightGrid that the caller's struct describes.
template <class Body>
lightbin_result with_grid(const lightbin_grid* given, const char* name, const Body& body) {
    lightbin_grid grid;
    const lightbin_result result = read(given, grid, name);
    if (result.error != LIGHTBIN_OK) return result;
    if (grid.ranges == nullptr && grid.range_count > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "grid.ranges");
    if (grid.ids == nullptr && grid.id_count > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "grid.ids");
    const std::span<const ListRange> ranges = {reinterpret_cast<const ListRange*>(grid.ranges),
                                               static_cast<std::size_t>(grid.range_count)};
    const LightRanks ranks = {
        {grid.order, static_cast<std::size_t>(grid.order_count)},
        {reinterpret_cast<const BinRange*>(grid.bins), static_cast<std::size_t>(grid.bin_count)}};
    const auto with = [&]<class Id>(const Id* ids) {
        return body(LightGrid<Id>(
            grid.tiles_x, grid.tiles_y, ranges, {ids, static_cast<std::size_t>(grid.id_count)},
            {grid.lights, grid.rejected, grid.culled, grid.first_spot, grid.first_box}, grid.slices, ranks));
    };
#if defined(LIGHTBIN_NO_U16)
    if (grid.id_bytes == 2) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_U16");
#else
    if (grid.id_bytes == 2) return with(static_cast<const std::uint16_t*>(grid.ids));
#endif
    if (grid.id_bytes == 4) return with(static_cast<const std::uint32_t*>(grid.ids));
    return refused(LIGHTBIN_NOT_A_VALUE, "grid.id_bytes", grid.id_bytes);
}

/// Calls body() with two LightGrids, whose ids must have the same width.
///
/// second_width  the name of the second one's member id_bytes, for an error
template <class Body>
lightbin_result with_grids(const lightbin_grid* first, const char* first_name, const lightbin_grid* second,
                           const char* second_name, const char* second_width, const Body& body) {
    return with_grid(first, first_name, [&]<class Id>(const LightGrid<Id>& one) {
        return with_grid(second, second_name, [&]<class OtherId>(const LightGrid<OtherId>& other) {
            if constexpr (std::is_same_v<Id, OtherId>)
                return body(one, other);
            else
                return refused(LIGHTBIN_NOT_A_VALUE, second_width, sizeof(OtherId));
        });
    });
}

/// Returns the ListFormat that the caller describes, or why it is refused.
inline lightbin_result read_format(const lightbin_format* given, ListFormat& format, const char* name) {
    lightbin_format known;
    const lightbin_result result = read(given, known, name);
    if (result.error != LIGHTBIN_OK) return result;
    if (known.encoding < 0 || known.encoding > LIGHTBIN_SENTINEL || known.ids < 0 || known.ids > LIGHTBIN_U16)
        return refused(LIGHTBIN_NOT_A_VALUE, name,
                       static_cast<std::uint64_t>(std::int64_t{
                           known.ids < 0 || known.ids > LIGHTBIN_U16 ? known.ids : known.encoding}));
    format = {static_cast<ListEncoding>(known.encoding),
              known.ids == LIGHTBIN_U32 ? IdWidth::u32 : static_cast<IdWidth>(known.ids), known.capacity};
    return result;
}

}  // namespace c
}  // namespace lightbin

/// A Budget for each width of ids.
struct lightbin_budget {
    lightbin::Budget<std::uint32_t> wide = {};
    lightbin::Budget<std::uint16_t> narrow = {};
};

/// A GridUnion for each width of ids.
struct lightbin_grid_union {
    lightbin::GridUnion<std::uint32_t> wide = {};
    lightbin::GridUnion<std::uint16_t> narrow = {};
};

namespace lightbin {
namespace c {

/// Returns the member of a handle for a width of ids.
template <class Id, class Handle> auto& of_width(Handle& handle) {
    if constexpr (sizeof(Id) == 2)
        return handle.narrow;
    else
        return handle.wide;
}

/// Copies a grid to the caller's memory, behind the grid `before` if that is not null.
template <class Id>
lightbin_result copy_grid(const LightGrid<Id>& from, const LightGrid<Id>* before, lightbin_range* ranges,
                          std::uint64_t range_capacity, void* ids, std::uint64_t id_capacity,
                          lightbin_grid* grid) {
    if (ranges == nullptr && !from.ranges().empty()) return refused(LIGHTBIN_NULL_ARGUMENT, "ranges");
    if (ids == nullptr && !from.ids().empty()) return refused(LIGHTBIN_NULL_ARGUMENT, "ids");
    const std::span<ListRange> all_ranges = {reinterpret_cast<ListRange*>(ranges),
                                             static_cast<std::size_t>(range_capacity)};
    const std::span<Id> all_ids = {static_cast<Id*>(ids), static_cast<std::size_t>(id_capacity)};
    const auto copied =
        before != nullptr ? from.copy_to(all_ranges, all_ids, *before) : from.copy_to(all_ranges, all_ids);
    if (!copied) return refused(copied.error());
    write_grid(*copied, grid);
    return succeeded();
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_copy_grid(lightbin_grid* grid, lightbin_range* ranges, std::uint64_t range_capacity,
                                   void* ids, std::uint64_t id_capacity) {
    using namespace lightbin::c;
    return with_grid(grid, "grid", [&]<class Id>(const lightbin::LightGrid<Id>& from) {
        return copy_grid<Id>(from, nullptr, ranges, range_capacity, ids, id_capacity, grid);
    });
}

lightbin_result lightbin_append_grid(lightbin_grid* grid, const lightbin_grid* before, lightbin_range* ranges,
                                     std::uint64_t range_capacity, void* ids, std::uint64_t id_capacity) {
    using namespace lightbin::c;
    return with_grids(
        grid, "grid", before, "before", "before.id_bytes",
        [&]<class Id>(const auto& from, const lightbin::LightGrid<Id>& first) {
            const bool same = static_cast<const void*>(first.ranges().data()) == ranges &&
                              (first.ids().empty() || first.ids().data() == ids);
            if (!same) return refused(LIGHTBIN_OTHER_MEMORY, "before");
            const lightbin::LightGrid<Id> in_memory(first.tiles_x(), first.tiles_y(), first.ranges(),
                                                    {static_cast<const Id*>(ids), first.ids().size()},
                                                    first.light_counts(), first.slices(), first.ranks());
            return copy_grid<Id>(from, &in_memory, ranges, range_capacity, ids, id_capacity, grid);
        });
}

lightbin_result lightbin_grid_union_create(lightbin_grid_union** grid_union) {
    using namespace lightbin::c;
    if (grid_union == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "grid_union");
    return make_handle(grid_union);
}

void lightbin_grid_union_destroy(lightbin_grid_union* grid_union) {
    delete grid_union;
}

lightbin_result lightbin_unite_grids(lightbin_grid_union* grid_union, const lightbin_grid* first,
                                     const lightbin_grid* second, lightbin_grid* grid) {
    using namespace lightbin::c;
    if (grid_union == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "grid_union");
    const lightbin_result result = check_size(grid, "grid");
    if (result.error != LIGHTBIN_OK) return result;
    return with_grids(first, "first", second, "second", "second.id_bytes",
                      [&]<class Id>(const lightbin::LightGrid<Id>& one, const auto& other) {
                          return guarded([&] {
                              const auto made = of_width<Id>(*grid_union).unite(one, other);
                              if (!made) return refused(made.error());
                              write_grid(*made, grid);
                              return succeeded();
                          });
                      });
}

#if !defined(LIGHTBIN_NO_BUDGETS)

lightbin_result lightbin_budget_create(lightbin_budget** budget) {
    using namespace lightbin::c;
    if (budget == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "budget");
    return make_handle(budget);
}

void lightbin_budget_destroy(lightbin_budget* budget) {
    delete budget;
}

lightbin_result lightbin_limit_grid(lightbin_budget* budget, const lightbin_grid* grid, const float* weights,
                                    std::size_t weight_count, std::uint32_t per_cell, std::uint32_t per_frame,
                                    lightbin_grid* limited, lightbin_cut* cut) {
    using namespace lightbin::c;
    if (budget == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "budget");
    if (weights == nullptr && weight_count > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "weights");
    const lightbin_result result =
        first_error(check_size(limited, "limited"), cut != nullptr ? check_size(cut, "cut") : succeeded());
    if (result.error != LIGHTBIN_OK) return result;
    return with_grid(grid, "grid", [&]<class Id>(const lightbin::LightGrid<Id>& whole) {
        return guarded([&] {
            const auto made =
                of_width<Id>(*budget).limit(whole, {weights, weight_count}, {per_cell, per_frame});
            if (!made) return refused(made.error());
            write_grid(made->grid, limited);
            if (cut != nullptr)
                write(lightbin_cut{0, made->entries_cut, made->cut_in_cell.data(), made->cut_in_cell.size()},
                      cut);
            return succeeded();
        });
    });
}

#endif

lightbin_result lightbin_count_entries(const lightbin_grid* grid, std::uint32_t* entries,
                                       std::size_t capacity, std::uint32_t* listed) {
    using namespace lightbin::c;
    if (listed == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "listed");
    if (entries == nullptr && capacity > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "entries");
    return with_grid(grid, "grid", [&](const auto& from) {
        const auto count = count_entries(from, std::span<std::uint32_t>(entries, capacity));
        if (!count) return refused(count.error());
        *listed = *count;
        return succeeded();
    });
}

lightbin_result lightbin_list_lengths(const lightbin_grid* grid, std::uint32_t* longest,
                                      std::uint64_t* histogram) {
    using namespace lightbin::c;
    if (longest == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "longest");
    if (histogram == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "histogram");
    return with_grid(grid, "grid", [&](const auto& from) {
        const lightbin::ListLengths lengths = list_lengths(from);
        *longest = lengths.longest;
        lightbin::detail::copy_items(lengths.histogram.data(), lengths.histogram.size(), histogram);
        return succeeded();
    });
}

lightbin_result lightbin_encoded_bytes(const lightbin_format* format, std::uint64_t tiles,
                                       std::uint64_t entries, std::uint64_t* bytes) {
    using namespace lightbin::c;
    if (bytes == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "bytes");
    lightbin::ListFormat known;
    const lightbin_result result = read_format(format, known, "format");
    if (result.error == LIGHTBIN_OK) *bytes = lightbin::encoded_bytes(known, tiles, entries);
    return result;
}

lightbin_result lightbin_encode(const lightbin_grid* grid, const lightbin_format* format, void* out,
                                std::uint64_t out_bytes, lightbin_encoded* encoded) {
    using namespace lightbin::c;
    lightbin::ListFormat known;
    const lightbin_result result =
        first_error(check_size(encoded, "encoded"), read_format(format, known, "format"));
    if (result.error != LIGHTBIN_OK) return result;
    return with_grid(grid, "grid", [&](const auto& from) {
        if (out == nullptr && out_bytes > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "out");
        const auto made = lightbin::encode(
            from, known,
            std::span<std::byte>(static_cast<std::byte*>(out), static_cast<std::size_t>(out_bytes)));
        if (!made) return refused(made.error());
        write(lightbin_encoded{0, made->tiles_cut, made->entries_cut, made->capacity_needed, 0}, encoded);
        return succeeded();
    });
}

}  // extern "C"
