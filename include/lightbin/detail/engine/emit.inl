// SPDX-License-Identifier: MIT
// Step 3 of bin.inl, for tiers without a compress instruction, and the form of the words that it reads. Included
// once such a tier, after its append().
//
// Words are 64 lights' columns, 8 words with a bit a light, and their rows, 8 more: the lights of tile (row,
// column) are rows[row] & columns[column]. With row spans or a depth test they are 8 lights' 64 tiles, a byte per
// tile with a bit a light.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Stores what stands for the words of empty lists: nothing. Returns where it ends.
inline std::uint32_t store_no_words(Scratch&) {
    return 0;
}

/// The ids of a list in the form that append() takes.
template <class Id>
inline Packed<Id>* packed_ids(const Scratch& scratch, const BandLists<ListId>& band,
                                              const SupertileList& list) {
    if constexpr (packs_ids)
        return reinterpret_cast<Packed<Id>*>(scratch.packed_ids.data()) + (list.begin - band.lists->begin);
    else
        return band.ids + list.begin;
}

/// Packs the ids of a list.
template <class Id>
inline void pack_ids(Scratch& scratch, const BandLists<ListId>& band,
                                     const SupertileList& list) {
    if constexpr (packs_ids) {
        const std::size_t before = list.begin - band.lists->begin, size = sizeof(Packed<Id>);
        const std::uint64_t after = before + ((list.count + std::uint64_t{63}) & ~std::uint64_t{63});
        scratch.packed_ids.reserve(after * size, before * size);
        pack(band.ids + list.begin, list.count, packed_ids<Id>(scratch, band, list));
    }
}

/// Stores the words of a list at list.words of scratch.words. Returns where they end.
template <bool with_words, class Id>
inline std::uint32_t store_words(Scratch& scratch, const BandLists<ListId>& band,
                                                 const SupertileList& list) {
    const std::uint32_t groups = (list.count + 63) / 64, eights = (list.count + 7) / 8,
                        end = list.words + (with_words ? 8 * eights : 16 * groups);
    std::uint64_t* words = scratch.words.reserve(end, list.words) + list.words;
    if constexpr (with_words) {
        std::uint64_t* const masks = scratch.masks.data();
        fill_items(masks + list.count, 8 * eights - list.count, 0);
        for (std::uint32_t i = 0; i < list.count; i += 8, words += 8)
            transpose_words(masks + i, words);
    } else {
        std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
        std::uint8_t* const rows = scratch.list_rows.data() + list.begin;
        std::memset(columns + list.count, 0, 64 * groups - list.count);
        std::memset(rows + list.count, 0, 64 * groups - list.count);
        for (std::uint32_t i = 0; i < list.count; i += 64, words += 16) {
            split_bits(columns + i, words);
            split_bits(rows + i, words + 8);
        }
    }
    pack_ids<Id>(scratch, band, list);
    return end;
}

/// Of 8 lights at most, those that miss the boxes of a supertile: a byte per tile, a bit a light.
template <class Light>
inline void store_missed(const Camera& camera, const SupertileBoxes& boxes,
                                         const Light* lights_by_id, const ListId* ids, std::uint32_t count,
                                         std::uint64_t* words) {
    const float* const(&ends)[4] = boxes.slab.ends;
    fill_items(words, 8, 0);
    for (std::uint32_t first = 0; first < 8 && first < count; first += lanes) {
        const auto lights = load_slab_lights(camera, boxes.slab, lights_by_id, ids + first, count - first);
        for (unsigned test = 0; test < lights.tests; ++test) {
            float by_column[8][lanes];
            for (unsigned column = 0; column < 8; ++column)
                store_floats(by_column[column], lights.by_column(test, ends[0][column], ends[1][column]));
            for (unsigned row = 0; row < boxes.rows; ++row)
                words[row] |=
                    movemask_of_8_less(lights.left_by_row(test, ends[2][row], ends[3][row]), by_column[0])
                    << first;
        }
    }
}

/// Makes the words of a list, by the boxes of the supertile from column 8 x and row `top` on, and stores them as
/// store_words() does.
template <bool spots, class Id>
inline std::uint32_t store_slab_words(const BinJob<Id>& job, Scratch& scratch, unsigned x,
                                                      unsigned top, const BandLists<ListId>& band,
                                                      const SupertileList& list) {
    const std::uint32_t eights = (list.count + 7) / 8, end = list.words + 8 * eights;
    std::uint64_t* words = scratch.words.reserve(end, list.words) + list.words;
    std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* const rows = scratch.list_rows.data() + list.begin;
    const ListId* const ids = band.ids + list.begin;
    std::memset(columns + list.count, 0, 8 * eights - list.count);
    const SupertileBoxes boxes = boxes_at(job, scratch, x, top);
    for (std::uint32_t i = 0; i < list.count; i += 8, words += 8) {
        store_missed(*job.camera, boxes, lights_of<spots>(job), ids + i, list.count - i, words);
        const std::uint64_t in_columns = transpose_bits(load_8_bytes(columns + i)),
                            in_rows = transpose_bits(load_8_bytes(rows + i));
        for (unsigned row = 0; row < boxes.rows; ++row)
            words[row] = ~words[row] & in_columns & (in_rows >> 8 * row & 0xff) * 0x0101010101010101;
    }
    pack_ids<Id>(scratch, band, list);
    return end;
}

/// Appends those of 8 ids whose bit is set in the lowest byte, then those of 8 more by the next. Returns the end.
template <class Id, class Ids>
inline Id* append_16(Id* out, const Ids* ids, std::uint64_t chosen) {
    out += append(out, ids, static_cast<unsigned>(chosen & 0xff));
    return out + append(out, ids + 8, static_cast<unsigned>(chosen >> 8 & 0xff));
}

/// Appends those of `count` ids, up to 64, whose bit is set. Returns the end. No loop, whose end is predicted worse
/// than these branches.
template <class Id, class Ids>
inline Id* append_64(Id* out, const Ids* ids, std::uint64_t chosen, std::uint32_t count) {
    out = append_16(out, ids, chosen);
    if (count <= 16) return out;
    out = append_16(out, ids + 16, chosen >> 16);
    if (count <= 32) return out;
    out = append_16(out, ids + 32, chosen >> 32);
    if (count <= 48) return out;
    return append_16(out, ids + 48, chosen >> 48);
}

/// Appends the lights of a tile by its words: bytes[0], bytes[64] ... have 8 lights each. Returns the end.
template <class Id, class Ids>
inline Id* append_tile(Id* out, const Ids* ids, std::uint32_t count,
                                       const std::uint8_t* bytes) {
    std::size_t i = 0;
    do
        out += append(out, ids + i, bytes[i * 8]);
    while ((i += 8) < count);
    return out;
}

/// The same by the words of its column and its row: [0], [16] ... have 64 lights each.
template <bool up_to_64, class Id, class Ids>
inline Id* append_tile(Id* out, const Ids* ids, std::uint32_t count,
                                       const std::uint64_t* column, const std::uint64_t* row) {
    if constexpr (!up_to_64)
        for (; count > 64; count -= 64, ids += 64, column += 16, row += 16)
            out = append_64(out, ids, *column & *row, 64);
    return append_64(out, ids, *column & *row, count);
}

/// Appends a row of a supertile's tiles. Returns the end. Not inline, as in a longer function compilers keep what it
/// needs on the stack.
template <bool with_words, bool up_to_64, class Id>
LIGHTBIN_NOINLINE Id*
append_tiles(Id* out, ListRange* tiles, std::ptrdiff_t columns, std::uint32_t at, const Packed<Id>* ids,
             std::uint32_t count, const std::uint64_t* words, unsigned row) {
    for (std::ptrdiff_t column = 0; column < columns; ++column) {
        Id* const from = out;
        if constexpr (with_words)
            out = append_tile(out, ids, count,
                              reinterpret_cast<const std::uint8_t*>(words) + 8 * row + byte_place(column));
        else
            out = append_tile<up_to_64>(out, ids, count, words + column, words + 8 + row);
        const std::uint32_t lights = static_cast<std::uint32_t>(out - from);
        tiles[column] = {at, lights};
        at += lights;
    }
    return out;
}

#if defined(LIGHTBIN_TIER_HAS_BYTES)
/// Of a long list whose lights cover few of its rows, those of a row are picked first, and the row's 8 tiles are made
/// of them: where that is faster, replaces a supertile's list, its ids and words by those of its lights in a row. In
/// their words that row has all of them.
LIGHTBIN_NOINLINE inline void pick_row(Scratch& scratch, const SupertileList& list,
                                                       unsigned row, const std::uint32_t*& ids,
                                                       const std::uint64_t*& words, std::uint32_t& count) {
    std::uint32_t in_row = 0;
    for (std::uint32_t i = 0; i < count; i += 64)
        in_row += static_cast<unsigned>(std::popcount(words[i / 4 + 8 + row]));
    if (!picking_is_faster(count, in_row)) return;

    std::uint32_t* const to_ids = scratch.row_ids.reserve(in_row + std::uint64_t{64});
    std::uint8_t* const to_columns = scratch.row_columns.reserve(in_row + std::uint64_t{64});
    const std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    std::uint32_t picked = 0;
    for (std::uint32_t i = 0; i < count; i += 64) {
        std::uint64_t chosen = words[i / 4 + 8 + row];
        const std::uint32_t end = min_of(i + 64, count);
        for (std::uint32_t j = i; j < end; j += 8, chosen >>= 8)
            picked += append_lights(to_ids + picked, to_columns + picked, ids + j, columns + j,
                                    static_cast<unsigned>(chosen & 0xff));
    }
    std::memset(to_columns + picked, 0, 64);
    std::uint64_t* const to_words = scratch.row_words.reserve(std::uint64_t{in_row} / 4 + 16);
    for (std::uint32_t i = 0; i < picked; i += 64) {
        split_bits(to_columns + i, to_words + i / 4);
        to_words[i / 4 + 8 + row] = ~std::uint64_t{0};
    }
    ids = to_ids;
    words = to_words;
    count = picked;
}
#endif

/// Emits a row of tiles, `row` of its supertiles. `at` is the offset of `out` in the index list. Returns the end.
template <bool with_words, class Id>
Id* emit_row(Id* out, ListRange* tiles, unsigned tiles_x, std::uint32_t at, Scratch& scratch,
                             const BandLists<ListId>& band, unsigned row) {
    const SupertileList* list = band.lists;
    for (const ListRange* const end = tiles + tiles_x; tiles < end; tiles += 8, ++list) {
        const std::ptrdiff_t columns = min_of<std::ptrdiff_t>(end - tiles, 8);
        const Packed<Id>* ids = packed_ids<Id>(scratch, band, *list);
        const std::uint64_t* words = scratch.words.data() + list->words;
        std::uint32_t count = list->count;
#if defined(LIGHTBIN_TIER_HAS_BYTES)
        if (!with_words && count > 64) pick_row(scratch, *list, row, ids, words, count);
#endif
        Id* const from = out;
        if (count == 0)
            fill_items(tiles, static_cast<std::size_t>(columns), {at, 0});
        else if (with_words || count <= 64)
            out = append_tiles<with_words, true>(out, tiles, columns, at, ids, count, words, row);
        else
            out = append_tiles<with_words, false>(out, tiles, columns, at, ids, count, words, row);
        at += static_cast<std::uint32_t>(out - from);
    }
    return out;
}

}}}}  // namespace lightbin::detail
