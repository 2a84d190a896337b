// SPDX-License-Identifier: MIT
// Step 3 of binning, and what runs all steps: emits the lists of the tiles. Tiles are visited in row-major order, so
// the index list is written strictly in sequence, without counting, scattering or sorting. Included once per tier
// (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/depth_tests.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The lights of one row of a block's tiles: for each light its id, and a byte with a bit for each tile that it is in.
struct RowLights {
    const std::uint32_t* ids;
    const std::uint8_t* columns;
    std::uint32_t count;
};

/// Returns the lights from which a row of a block's tiles is emitted: no lights if none is in the row, else all lights
/// of the block. In a block of more than 64 lights, it is a copy of the lights in the row: builds of 10,000 lights take
/// 1.1 to 1.25 times as long without it.
inline RowLights pick_row(Scratch& scratch, const BlockList& list, unsigned row) {
    const RowLights all = {scratch.list_ids.data() + list.begin,
                           scratch.row_columns_of(list) + std::size_t{row} * list.padded_count(), list.count};
    if (all.count <= 16) {
        const std::uint64_t any = load_8_bytes(all.columns) | (all.count > 8 ? load_8_bytes(all.columns + 8) : 0);
        return any != 0 ? all : RowLights{};
    }
    if (all.count <= 64) return all;
    const std::uint64_t capacity = all.count + std::uint64_t{2 * widest_vector};
    std::uint32_t* const ids = scratch.row_ids.reserve(capacity);
    std::uint8_t* const columns = scratch.picked_columns.reserve(capacity);
    std::uint32_t picked = 0;
    for (std::uint32_t i = 0; i < all.count; i += byte_lanes) {
        const Bytes here = load_bytes(all.columns + i);
        const ByteMask chosen = static_cast<ByteMask>(not_zero(here) & first_bytes(all.count - i));
        compress_store(chosen, here, columns + picked);
        compress_store(chosen, all.ids + i, ids + picked);
        picked += static_cast<std::uint32_t>(std::popcount(chosen));
    }
    std::memset(columns + picked, 0, widest_lanes);
    return {ids, columns, picked};
}

/// Appends to `out` each of `count` ids, up to 64, whose bit in `chosen` is set. Returns the end. It has branches in
/// place of a loop, whose end would be mispredicted more often.
template <class Id>
LIGHTBIN_INLINE Id* append_64(Id* out, const std::uint32_t* ids, std::uint64_t chosen, std::uint32_t count) {
    out = append_16(out, ids, static_cast<unsigned>(chosen & 0xffff));
    if (count <= 16) return out;
    out = append_16(out, ids + 16, static_cast<unsigned>(chosen >> 16 & 0xffff));
    if (count <= 32) return out;
    out = append_16(out, ids + 32, static_cast<unsigned>(chosen >> 32 & 0xffff));
    if (count <= 48) return out;
    return append_16(out, ids + 48, static_cast<unsigned>(chosen >> 48));
}

/// Emits one row of a block's tiles: appends each tile's ids to the index list, and writes the tile's range. Returns
/// the end of the index list. Not inlined, as compilers would keep its variables on the stack in a longer function.
///
/// columns  the number of tiles, up to 8
/// offset   the offset of `out` in the whole index list
/// words    for each 64 lights 8 words, one for each tile, with a bit for each light
template <class Id>
LIGHTBIN_NOINLINE Id* emit_tiles(Id* out, ListRange* tiles, unsigned columns, std::uint32_t offset, const RowLights& row,
                                 const std::uint64_t* words) {
    const std::uint32_t* const ids = row.ids;
    const std::uint32_t count = row.count;
    for (unsigned column = 0; column < columns; ++column) {
        Id* const begin = out;
        std::uint32_t i = 0;
        for (; i + 64 < count; i += 64)
            out = append_64(out, ids + i, words[i / 8 + column], 64);
        out = append_64(out, ids + i, words[i / 8 + column], count - i);
        const std::uint32_t size = static_cast<std::uint32_t>(out - begin);
        tiles[column] = {offset, size};
        offset += size;
    }
    return out;
}

/// emit_tiles() for a block of up to 8 lights.
///
/// row_columns  for each light a byte with a bit for each tile that it is in
template <class Id>
LIGHTBIN_NOINLINE Id* emit_short(Id* out, ListRange* tiles, unsigned columns, std::uint32_t offset,
                                 const std::uint32_t* ids, const std::uint8_t* row_columns) {
    std::uint64_t lights = transpose_bits(load_8_bytes(row_columns));
    for (unsigned column = 0; column < columns; ++column, lights >>= 8) {
        Id* const begin = out;
        out = append_8(out, ids, static_cast<unsigned>(lights & 0xff));
        const std::uint32_t size = static_cast<std::uint32_t>(out - begin);
        tiles[column] = {offset, size};
        offset += size;
    }
    return out;
}

/// Appends the light ids of one row of tiles to the index list, and writes the tiles' ranges. Returns the list's end.
///
/// lists  the lists of the blocks of 8x8 tiles that the row runs through, from left to right
/// row    the row's number in these blocks, 0 to 7
template <class Id>
LIGHTBIN_NOINLINE Id* emit_row(Id* out, ListRange* tiles, unsigned tiles_x, std::uint32_t offset, Scratch& scratch,
                               const BlockList* lists, unsigned row) {
    for (unsigned x = 0; x < tiles_x; x += 8, ++lists) {
        const unsigned columns = min_of(tiles_x - x, 8u);
        RowLights lights = {};
        if (lists->count > 0) lights = pick_row(scratch, *lists, row);
        if (lights.count == 0) {
            fill_items(tiles + x, columns, {offset, 0});
            continue;
        }
        Id* end;
        if (lights.count <= 8) {
            end = emit_short(out, tiles + x, columns, offset, lights.ids, lights.columns);
        } else {
            std::uint64_t few[8], *words = few;
            if (lights.count > 64) words = scratch.row_words.reserve(lights.count / 8 + std::uint64_t{8});
            for (std::uint32_t i = 0; i < lights.count; i += 64)
                split_bits(lights.columns + i, words + i / 8);
            end = emit_tiles(out, tiles + x, columns, offset, lights, words);
        }
        offset += static_cast<std::uint32_t>(end - out);
        out = end;
    }
    return out;
}

/// Removes from the table of Scratch::row_columns_of() the tiles whose bit in `drawn` is not set.
inline void keep_drawn(Scratch& scratch, const BlockList& list, std::uint64_t drawn) {
    std::uint8_t* at = scratch.row_columns_of(list);
    for (unsigned row = 0; row < 8; ++row, drawn >>= 8)
        for (std::uint32_t i = 0; i < list.padded_count(); i += 8, at += 8)
            store_8_bytes(at, load_8_bytes(at) & (drawn & 0xff) * std::uint64_t{0x0101010101010101});
}

/// Lists the lights of the blocks of 8x8 tiles in the 8 rows from `top` on, and fills the table of
/// Scratch::row_columns_of() with a bit for each tile that a light is in. Returns the lists, or null if all are empty.
///
/// slab   with Tested::slab, the boxes around the depth slice's cells, which lights are tested against
/// bands  the lists of several bands of 8 tile rows, kept for the calls for the next bands
/// end    the end of the tile rows that the caller will ask for
template <Tested tested, LightKind kind>
const BlockList* list_lights(const BinJob& job, Scratch& scratch, const SlabBoxes& slab, BandLists& bands,
                             unsigned top, unsigned end) {
    const unsigned width = (static_cast<unsigned>(job.camera->x.tiles) + 7) / 8;
    if (top >= bands.end) list_bands(job, scratch, top, end, bands);
    BlockList* const lists = scratch.lists.reserve(width);
    std::uint32_t used = 0;
    for (unsigned x = 0; x < width; ++x) {
        BlockList& list = lists[x];
        const std::uint64_t drawn = job.drawn != nullptr ? job.drawn[top / 8 * width + x] : ~std::uint64_t{0};
        list = {used, drawn != 0 ? list_block(scratch, bands, (top - bands.begin) / 8, x, used) : 0};
        if (list.count == 0) continue;
        if constexpr (tested == Tested::nothing)
            store_rectangles(scratch, list, [](Bytes columns, std::size_t) { return columns; });
        else
            find_tested_tiles<tested, kind>(job, scratch, slab, x, top, list);
        if (list.count > 0 && ~drawn != 0) keep_drawn(scratch, list, drawn);
        if (list.count > 0) used += list.padded_count();
    }
    return used == 0 ? nullptr : lists;
}

/// Bins one thread's share of tile rows, band by band: lists the lights of each block of 8x8 tiles, tests them, and
/// writes the tiles' lists. Returns the number of list entries. May write up to `widest_vector` elements past them.
///
/// slab       the boxes around a depth slice's cells, if list_band reads them
/// list_band  list_lights() for the options
template <class Id, class ListLights>
std::uint64_t bin_blocks_by(const BinJob& job, Scratch& scratch, const BinShare<Id>& share, const SlabBoxes& slab,
                            ListLights list_band) {
    const unsigned tiles_x = static_cast<unsigned>(job.camera->x.tiles);
    ListRange* tiles = job.tiles + share.begin * std::size_t{tiles_x};
    Id* out = share.out;
    std::uint32_t offset = share.offset;
    if (job.visible == 0) {
        fill_empty(tiles, (share.end - share.begin) * std::size_t{tiles_x}, offset);
        return 0;
    }
    BandLists bands;
    for (unsigned top = share.begin; top < share.end; top += 8) {
        const BlockList* const lists = list_band(job, scratch, slab, bands, top, share.end);
        const unsigned rows = min_of(share.end - top, 8u);
        if (lists == nullptr) {
            fill_empty(tiles, rows * std::size_t{tiles_x}, offset);
            tiles += rows * std::size_t{tiles_x};
            continue;
        }
        for (unsigned row = 0; row < rows; ++row, tiles += tiles_x) {
            Id* const end = emit_row(out, tiles, tiles_x, offset, scratch, lists, row);
            offset += static_cast<std::uint32_t>(end - out);
            out = end;
        }
    }
    return offset - share.offset;
}

/// bin_blocks_by() with the list_lights() of the given options.
template <class Id, Tested tested, LightKind kind>
std::uint64_t bin_blocks(const BinJob& job, Scratch& scratch, const BinShare<Id>& share) {
    SlabBoxes slab;
    if constexpr (tested == Tested::slab)
        if (job.visible != 0) slab = arrange_slab(job, scratch);
    return bin_blocks_by(job, scratch, share, slab, list_lights<tested, kind>);
}

}}}}  // namespace lightbin::detail
