// SPDX-License-Identifier: MIT
// Step 1 of bin.inl, for tiers with vectors of bytes: each list picks its lights out of many, a vector of them at a
// time and without a branch on what a light covers. Included once such a tier, see kernels.inl for what it defines.
//
//   1. A vector of lights' rows against each band of 8 tile rows: a saturating subtraction and two byte shuffles
//      give each light's byte of covered rows, zero if it misses the band. Those that do not are appended to the
//      band's list.
//   2. The same with the band's list and each supertile's 8 columns: the supertile's list.
//
// Coordinates are bytes here. So bands are listed by panels of 248 tiles a side, coordinates counted from the panel.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

inline constexpr unsigned panel_side = 31;  // in supertiles

/// The lights of some bands, from tile row `begin` to end-1, in `count` lists for each block of ids: one for each
/// band and panel, number band * panels + panel. Of each light the columns that it covers, x0..x1-1, its byte of
/// rows, and its id or, for words, its visible index.
struct ListedBands {
    unsigned begin = 0, end = 0;
    std::size_t panels = 0, count = 0, block_count = 0;
    const IdBlock* blocks = nullptr;
    std::uint8_t *x0 = nullptr, *x1 = nullptr, *rows = nullptr;
    ListId* ids = nullptr;
    std::uint32_t* size = nullptr;

    /// Where a list begins.
    std::size_t place(std::size_t block, std::size_t list) const {
        return blocks[block].before * count + list * blocks[block].capacity;
    }
};

/// Of each light first..end-1, which of the 8 tiles from `begin` on it covers, a bit per tile.
inline Bytes covered_bytes(Bytes first, Bytes end, unsigned begin) {
    static constexpr std::uint8_t from[16] = {255, 254, 252, 248, 240, 224, 192, 128};
    static constexpr std::uint8_t before[16] = {0, 1, 3, 7, 15, 31, 63, 127, 255};
    const Bytes start = all_bytes(begin), eight = all_bytes(8);
    return shuffle(from, minimum(subtract(first, start), eight)) &
           shuffle(before, minimum(subtract(end, start), eight));
}

/// The first `count` bytes of a vector, or all.
inline ByteMask first_bytes(std::size_t count) {
    const ByteMask all = ~ByteMask{0};
    return count < byte_lanes ? static_cast<ByteMask>(~(all << count)) : all;
}

/// Fills scratch.blocks, apart from `before` and `capacity`; returns how many there are. Whole ids are one block.
template <class Id> std::size_t find_blocks(const BinJob<Id>& job, Scratch& scratch) {
    if (sizeof(ListId) == 4 || job.runs.count == 0) {
        *scratch.blocks.reserve(1) = {0, job.runs.count == 0 ? 0 : job.runs[job.runs.count - 1].end, 0, 0, 0};
        return 1;
    }
    const std::uint32_t* ids = job.lights.ids;
    std::size_t count = 0;
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin, end; i < run.end; i = end) {
            const std::uint32_t upper = ids[i] & 0xffff0000, last = upper | 0xffff;
            end = run.end;
            if (ids[end - 1] > last)
                end = static_cast<std::uint32_t>(
                    first_not(ids + i, ids + end, [=](std::uint32_t id) { return id <= last; }) - ids);
            IdBlock* const blocks = scratch.blocks.reserve(count + 1, count);
            if (count > 0 && blocks[count - 1].upper == upper && end - blocks[count - 1].begin <= 0x10000)
                blocks[count - 1].end = end;
            else
                blocks[count++] = {i, end, upper, 0, 0};
        }
    return count;
}

/// Fills scratch.blocks; returns how many there are.
template <class Id> std::size_t make_blocks(const BinJob<Id>& job, Scratch& scratch) {
    const std::size_t count = find_blocks(job, scratch);
    std::size_t before = 0;
    for (IdBlock *block = scratch.blocks.data(), *const end = block + count; block < end; ++block) {
        block->before = before;
        block->capacity =
            std::size_t{min_of(block->end - block->begin, job.visible)} + 64;  // of whole vectors
        before += block->capacity;
    }
    return count;
}

/// Appends a vector of lights of a block, `count` or as many as it has, from visible index i on, to the lists of the
/// bands and panels that they meet.
template <bool with_words>
inline void add_to_bands(const FootprintArrays& lights, const ListedBands& listed,
                                         std::size_t block, std::uint32_t i, std::size_t count) {
    const ListedBands to = listed;  // a copy, that no store can change
    const Bytes first_y = coordinates(lights.y0 + i, 0, to.begin),
                end_y = coordinates(lights.y1 + i, 1, to.begin);
    const ByteIds ids = with_words ? count_ids(i - to.blocks[block].begin) : load_ids(lights.ids + i);
    std::uint32_t* const sizes = to.size + block * to.count;
    const std::size_t first = to.place(block, 0), capacity = to.blocks[block].capacity;
    for (unsigned panel = 0; panel < to.panels; ++panel) {
        const unsigned begin = 8 * panel_side * panel;
        const Bytes first_x = coordinates(lights.x0 + i, 0, begin),
                    end_x = coordinates(lights.x1 + i, 1, begin);
        ByteMask in_panel = first_bytes(count);
        if (to.panels > 1)
            in_panel &= not_zero(end_x) & not_zero(subtract(all_bytes(8 * panel_side), first_x));
        unsigned top = 0;
        for (std::size_t list = panel; list < to.count; list += to.panels, top += 8) {
            const Bytes rows = covered_bytes(first_y, end_y, top);
            const ByteMask chosen = not_zero(rows) & in_panel;
            if (chosen == 0) continue;
            const std::size_t at = first + list * capacity + sizes[list];
            append_chosen(chosen, first_x, to.x0 + at);
            append_chosen(chosen, end_x, to.x1 + at);
            append_chosen(chosen, rows, to.rows + at);
            append_chosen(chosen, ids, to.ids + at);
            sizes[list] += static_cast<std::uint32_t>(std::popcount(chosen));
        }
    }
}

/// Lists as many bands from tile row `begin` on as one pass over the lights takes.
template <bool with_words, class Id>
void list_bands(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                                unsigned width, ListedBands& to) {
    if (to.blocks == nullptr) {
        to.block_count = make_blocks(job, scratch);
        to.blocks = scratch.blocks.data();
    }
    to.panels = (width + panel_side - 1) / panel_side;
    const std::uint64_t together = min_of<std::uint64_t>(
        max_of<std::uint64_t>(most_band_places / (std::uint64_t{job.visible} * to.panels + 1), 1), panel_side);
    to.begin = begin;
    to.end = min_of(begin + 8 * static_cast<unsigned>(together), end);
    to.count = (to.end - to.begin + 7) / 8 * to.panels;
    const std::uint64_t capacity = to.block_count > 0 ? to.place(to.block_count - 1, to.count) : 0;
    to.x0 = scratch.band_x0.reserve(capacity);
    to.x1 = scratch.band_x1.reserve(capacity);
    to.rows = scratch.band_rows.reserve(capacity);
    to.ids = scratch.band_ids.template reserve<ListId>(capacity);
    to.size = scratch.band_size.reserve(to.block_count * to.count);
    fill_items(to.size, to.block_count * to.count, 0);
    for (std::size_t block = 0; block < to.block_count; ++block)
        for (const FootprintRun& run : job.runs) {
            const std::uint32_t last = min_of(run.end, to.blocks[block].end);
            for (std::uint32_t i = max_of(run.begin, to.blocks[block].begin); i < last; i += byte_lanes)
                add_to_bands<with_words>(job.lights, to, block, i, last - i);
        }
}

/// Picks the lights of a supertile out of `size` lights of a list, from a place on, its columns beginning at
/// `begin` in the panel. Returns how many.
inline std::uint32_t pick_lights(const ListedBands& listed, std::size_t at, std::size_t size,
                                                 unsigned begin, std::uint8_t* columns, std::uint8_t* rows,
                                                 ListId* ids) {
    const ListedBands bands = listed;  // a copy, that no store can change
    std::uint32_t count = 0;
    for (const std::size_t end = at + size; at < end; at += byte_lanes) {
        const Bytes here = covered_bytes(load_bytes(bands.x0 + at), load_bytes(bands.x1 + at), begin);
        const ByteMask chosen = not_zero(here) & first_bytes(end - at);
        if (chosen == 0) continue;
        append_chosen(chosen, here, columns + count);
        append_chosen(chosen, load_bytes(bands.rows + at), rows + count);
        append_chosen(chosen, load_ids(bands.ids + at), ids + count);
        count += static_cast<std::uint32_t>(std::popcount(chosen));
    }
    return count;
}

/// Lets a block's part of a list begin at place `from`, a multiple of 64, where the list ended at `end`: between them
/// are lights that cover nothing. Notes the block of the places from there to `last`.
inline void begin_block(Scratch& scratch, std::uint32_t end, std::uint32_t from, std::uint32_t last,
                        std::size_t block) {
    if (from > end) {
        std::memset(scratch.list_columns.data() + end, 0, from - end);
        std::memset(scratch.list_ids.template reserve<ListId>(end) + end, 0, (from - end) * sizeof(ListId));
    }
    const std::size_t groups = (std::size_t{last} + 63) / 64;
    std::uint32_t* const of_groups = scratch.group_blocks.reserve(groups, from / 64);
    for (std::size_t group = from / 64; group < groups; ++group)
        of_groups[group] = static_cast<std::uint32_t>(block);
}

/// Makes the list of supertile x from place `begin` on, a multiple of 64, out of list `band` + its panel of each block.
/// Returns how many lights it has.
inline std::uint32_t list_supertile(Scratch& scratch, const ListedBands& listed,
                                                    std::size_t band, unsigned x, std::uint32_t begin) {
    const std::size_t list = band + x / panel_side;
    std::uint32_t end = begin;
    for (std::size_t block = 0; block < listed.block_count; ++block) {
        const std::uint32_t size = listed.size[block * listed.count + list], from = (end + 63) & ~63u;
        if (size == 0) continue;
        const std::uint64_t capacity = std::uint64_t{from} + size + 128;
        std::uint8_t* columns = scratch.list_columns.reserve(capacity, end);
        std::uint8_t* rows = scratch.list_rows.reserve(capacity, end);
        ListId* ids = scratch.list_ids.template reserve<ListId>(capacity, end);
        const std::uint32_t picked =
            pick_lights(listed, listed.place(block, list), size, 8 * (x % panel_side), columns + from,
                        rows + from, ids + from);
        if (picked == 0) continue;
        if constexpr (sizeof(ListId) == 2) begin_block(scratch, end, from, from + picked, block);
        end = from + picked;
    }
    return end - begin;
}

/// Makes the lists of the band that begins at tile row `top`. `listed` is kept from band to band.
template <bool with_words, class Id>
BandLists<ListId> make_lists(const BinJob<Id>& job, Scratch& scratch,
                                             const BandJob<Id>& bands, unsigned top, unsigned width,
                                             ListedBands& listed) {
    if (top >= listed.end) list_bands<with_words>(job, scratch, top, bands.end, width, listed);
    const std::size_t band = (top - listed.begin) / 8 * listed.panels;
    bool any = false;
    for (std::size_t block = 0; block < listed.block_count; ++block)
        for (std::size_t panel = 0; panel < listed.panels; ++panel)
            any |= listed.size[block * listed.count + band + panel] > 0;
    if (!any) return {};
    SupertileList* const lists = scratch.supertile_lists.reserve(width);
    std::uint32_t used = 0;
    for (unsigned x = 0; x < width; ++x) {
        lists[x] = {used, list_supertile(scratch, listed, band, x, used), 0};
        used += (lists[x].count + 63) & ~63u;
    }
    return {lists, scratch.list_ids.template reserve<ListId>(used, used),
            listed.blocks[listed.block_count - 1].upper != 0};
}

}}}}  // namespace lightbin::detail
