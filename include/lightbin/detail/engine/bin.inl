// SPDX-License-Identifier: MIT
// Binning by supertiles of 8x8 tiles, a band of them after another, in three steps. Included once a tier, after its
// steps.
//
//   1. Lists: which lights meet which supertile, with a byte of the columns and a byte of the rows that each covers
//      there (lists_insert.inl, lists_scan.inl).
//   2. Words: which of its tiles each light is in, by its rectangle, row spans and depth (words.inl), as bits.
//   3. Emit: the lights of each tile, those whose bit is set (emit.inl, emit_compress.inl). Tiles are taken in
//      row-major order, so the index list is written strictly in sequence: no count pass over tiles, no scatter, no
//      sort.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The number of entries of the grid. For tiers without a compress instruction, whose words have a bit each.
template <Footprint footprint, DepthTest depth_test, bool by_slab, bool spots, class Id>
std::uint64_t count_entries(const BinJob<Id>& job, Scratch& scratch) {
    const BandJob<Id> bands = {0, static_cast<unsigned>(job.camera->y.tiles), nullptr, 0};
    const unsigned width = (static_cast<unsigned>(job.camera->x.tiles) + 7) / 8;
    if constexpr (by_slab) arrange_slab(job, scratch);
    ListedBands listed;
    std::uint64_t entries = 0;
    for (unsigned top = bands.begin; top < bands.end; top += 8) {
        const BandLists<ListId> band = make_lists < with_words<footprint, depth_test> &&
                                       !by_slab > (job, scratch, bands, top, width, listed);
        if (band.lists == nullptr) continue;
        const std::uint32_t end =
            make_words<footprint, depth_test, by_slab, spots>(job, scratch, top, band, width);
        for (std::uint32_t i = 0; i < end; ++i)
            entries += static_cast<unsigned>(std::popcount(scratch.words.data()[i]));
    }
    return entries;
}

/// Bins the tile rows of `bands`. Returns the number of entries. May write BandJob::slack elements past them.
template <Footprint footprint, DepthTest depth_test, class Id, bool by_slab, bool spots>
std::uint64_t bin_supertiles(const BinJob<Id>& job, Scratch& scratch,
                                             const BandJob<Id>& bands) {
    constexpr bool worded = with_words<footprint, depth_test>;
    const unsigned tiles_x = static_cast<unsigned>(job.camera->x.tiles), width = (tiles_x + 7) / 8;
    if constexpr (by_slab) {
        if (job.visible == 0) {
            fill_empty(job.tiles + bands.begin * std::size_t{tiles_x},
                       (bands.end - bands.begin) * std::size_t{tiles_x}, bands.at);
            return 0;
        }
        arrange_slab(job, scratch);
    }
    ListedBands listed;
    Id* out = bands.out;
    std::uint32_t at = bands.at;
    for (unsigned top = bands.begin; top < bands.end; top += 8) {
        const BandLists<ListId> band =
            make_lists < worded && !by_slab > (job, scratch, bands, top, width, listed);
        const unsigned end_row = min_of(top + 8, bands.end);
        if (band.lists == nullptr ||
            make_words<footprint, depth_test, by_slab, spots>(job, scratch, top, band, width) == 0) {
            fill_empty(job.tiles + top * std::size_t{tiles_x}, (end_row - top) * std::size_t{tiles_x}, at);
            if (bands.spare_row >= top && bands.spare_row < end_row) out = bands.spare;
            continue;
        }
        for (unsigned y = top; y < end_row; ++y) {
            if (y == bands.spare_row) out = bands.spare;
            ListRange* const tiles = job.tiles + y * std::size_t{tiles_x};
            Id* const end = emit_row<worded>(out, tiles, tiles_x, at, scratch, band, y - top);
            at += static_cast<std::uint32_t>(end - out);
            out = end;
        }
    }
    return at - bands.at;
}

}}}}  // namespace lightbin::detail
