// SPDX-License-Identifier: MIT
// Step 1 of binning: lists the lights of each block of 8x8 tiles. This text is included once for each instruction set.
//
//   1. Each vector of lights is compared with each band of 8 tile rows. A saturating subtraction and two byte shuffles
//      make a byte for each light, with a bit for each of the band's rows that its rectangle covers. Lights with a
//      byte that is not 0 are appended to the band's list.
//   2. A band's list is compared with the 8 columns of each of its blocks in the same way.
//
// No branch depends on which tiles a light covers. Coordinates are bytes that count from the first band and from the
// first column of a panel of 248 tile columns; a wider grid has several panels.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/engine/costs.hpp>
#include <lightbin/detail/vectors/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

inline constexpr unsigned panel_blocks = 31;  // a panel is this many blocks wide: tile columns that bytes can count

/// The lights of several bands of 8 tile rows each, which together are the tile rows begin..end-1. There is a list for
/// each band and each panel of 248 tile columns: list number l = band * panels + panel has sizes[l] elements in each of
/// x0, x1, rows and ids, from element l * capacity on.
struct BandLists {
    unsigned begin = 0, end = 0;
    std::size_t panels = 0, count = 0, capacity = 0;
    std::uint8_t *x0 = nullptr, *x1 = nullptr;  ///< each light's columns x0..x1-1 in its panel of 248 tile columns
    std::uint8_t* rows = nullptr;               ///< per light, a bit for each of the band's 8 tile rows it covers
    std::uint32_t* ids = nullptr;
    std::uint32_t* sizes = nullptr;
};

/// Returns for each light, with tiles first..end-1 along an axis, a byte with a bit for each of 8 tiles from `begin`.
inline Bytes covered_bytes(Bytes first, Bytes end, unsigned begin) {
    static constexpr std::uint8_t from[16] = {255, 254, 252, 248, 240, 224, 192, 128};
    static constexpr std::uint8_t before[16] = {0, 1, 3, 7, 15, 31, 63, 127, 255};
    const Bytes start = broadcast_byte(begin), eight = broadcast_byte(8);
    return shuffle(from, minimum(subtract(first, start), eight)) &
           shuffle(before, minimum(subtract(end, start), eight));
}

/// Returns the mask of the first `count` bytes of a vector, or of all bytes if `count` is larger than a vector.
inline ByteMask first_bytes(std::size_t count) {
    const ByteMask all = static_cast<ByteMask>(~ByteMask{0});
    return count < byte_lanes ? static_cast<ByteMask>(~(all << count)) : all;
}

/// Appends up to a vector of the `count` lights from index i on to the lists of the bands (8 tile rows) that they meet.
inline void add_to_bands(const FootprintArrays& lights, const BandLists& bands, std::uint32_t i, std::size_t count) {
    const BandLists to = bands;  // a local copy, so that compilers need not reload it after each store of bytes
    const Bytes first_y = coordinates(lights.y0 + i, 0, to.begin), end_y = coordinates(lights.y1 + i, 1, to.begin);
    for (unsigned panel = 0; panel < to.panels; ++panel) {
        const unsigned begin = 8 * panel_blocks * panel;
        const Bytes first_x = coordinates(lights.x0 + i, 0, begin), end_x = coordinates(lights.x1 + i, 1, begin);
        ByteMask in_panel = first_bytes(count);
        if (to.panels > 1)
            in_panel = static_cast<ByteMask>(in_panel & not_zero(end_x) &
                                            not_zero(subtract(broadcast_byte(8 * panel_blocks), first_x)));
        unsigned top = 0;
        for (std::size_t list = panel; list < to.count; list += to.panels, top += 8) {
            const Bytes rows = covered_bytes(first_y, end_y, top);
            const ByteMask chosen = not_zero(rows) & in_panel;
            if (chosen == 0) continue;
            const std::size_t at = list * to.capacity + to.sizes[list];
            compress_store(chosen, first_x, to.x0 + at);
            compress_store(chosen, end_x, to.x1 + at);
            compress_store(chosen, rows, to.rows + at);
            compress_store(chosen, lights.ids + i, to.ids + at);
            to.sizes[list] += static_cast<std::uint32_t>(std::popcount(chosen));
        }
    }
}

/// Lists the lights of as many bands of 8 tile rows, from row `begin` on, as max_band_entries allows in one pass.
inline void list_bands(const BinJob& job, Scratch& scratch, unsigned begin, unsigned end, BandLists& to) {
    const std::size_t width = (static_cast<std::size_t>(job.camera->x.tiles) + 7) / 8;
    to.panels = (width + panel_blocks - 1) / panel_blocks;
    const std::uint64_t together = min_of<std::uint64_t>(
        max_of<std::uint64_t>(max_band_entries / (std::uint64_t{job.visible} * to.panels + 1), 1), panel_blocks);
    to.begin = begin;
    to.end = min_of(begin + 8 * static_cast<unsigned>(together), end);
    to.count = (to.end - to.begin + 7) / 8 * to.panels;
    to.capacity = job.visible + widest_vector;
    const std::uint64_t entries = std::uint64_t{to.capacity} * to.count;
    to.x0 = scratch.band_x0.reserve(entries);
    to.x1 = scratch.band_x1.reserve(entries);
    to.rows = scratch.band_rows.reserve(entries);
    to.ids = scratch.band_ids.reserve(entries);
    to.sizes = scratch.band_sizes.reserve(to.count);
    fill_items(to.sizes, to.count, 0);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; i += byte_lanes)
            add_to_bands(job.lights, to, i, run.end - i);
}

/// Makes the list of the block at tile column 8 * x of a band, out of the list of its panel, 248 columns of the band.
/// Stores lights from element `begin` of Scratch::list_ids, list_columns and list_rows on. Returns their number.
inline std::uint32_t list_block(Scratch& scratch, const BandLists& bands, std::size_t band, unsigned x,
                                std::uint32_t begin) {
    const std::size_t list = band * bands.panels + x / panel_blocks, size = bands.sizes[list];
    if (size == 0) return 0;
    const std::uint64_t capacity = begin + std::uint64_t{size} + 2 * widest_vector;
    std::uint8_t* const columns = scratch.list_columns.reserve(capacity, begin) + begin;
    std::uint8_t* const rows = scratch.list_rows.reserve(capacity, begin) + begin;
    std::uint32_t* const ids = scratch.list_ids.reserve(capacity, begin) + begin;
    const BandLists from = bands;  // a local copy, so that compilers need not reload it after each store
    const std::size_t first = list * from.capacity;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < size; i += byte_lanes) {
        const Bytes here = covered_bytes(load_bytes(from.x0 + first + i), load_bytes(from.x1 + first + i),
                                         8 * (x % panel_blocks));
        const ByteMask chosen = not_zero(here) & first_bytes(size - i);
        if (chosen == 0) continue;
        compress_store(chosen, here, columns + count);
        compress_store(chosen, load_bytes(from.rows + first + i), rows + count);
        compress_store(chosen, from.ids + first + i, ids + count);
        count += static_cast<std::uint32_t>(std::popcount(chosen));
    }
    return count;
}

/// Fills the table of Scratch::row_columns_of(), which has for each row of tiles a byte for each light, with a bit for
/// each tile that it is listed in. These are the tiles of its rectangle that `narrow` leaves.
///
/// narrow  a callable: narrow(columns, at) returns `columns`, the bytes of a vector of lights, without the tiles in
///         which these are not listed. With a row's number and a light's index, `at` is row * list.padded_count() +
///         index
template <class Narrow> void store_rectangles(Scratch& scratch, const BlockList& list, const Narrow& narrow) {
    const std::uint32_t padded = list.padded_count();
    std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* const rows = scratch.list_rows.data() + list.begin;
    std::uint8_t* to = scratch.reserve_row_columns(list);
    std::memset(columns + list.count, 0, widest_lanes);
    for (unsigned row = 0; row < 8; ++row, to += padded)
        for (std::uint32_t i = 0; i < padded; i += byte_lanes) {
            const Bytes in_row = load_bytes(rows + i) & broadcast_byte(1u << row);
            store_bytes(to + i, keep_where(narrow(load_bytes(columns + i), row * padded + i), in_row));
        }
}

}}}}  // namespace lightbin::detail
