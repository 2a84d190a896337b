// SPDX-License-Identifier: MIT
// Binning by count, prefix and fill (Tiled Shading, section 3), for all tiers: small lights, nearly empty grids.
// A rectangle costs four corners of a difference array, whose sums along both axes are the counts.
#pragma once

#include <lightbin/detail/costs.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/plain.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// Writes the tile rows begin..end-1, each tile with how many lights it has and where its list ends, the first one at
/// `at`. Returns where the last one ends. May write more up to `writable`.
template <class Id>
using LayOutRows = std::uint32_t (*)(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                                     const ListRange* writable, std::uint32_t at);

/// Writes `count` tiles without lights, at a place in the index list.
using FillEmpty = void (*)(ListRange* tiles, std::size_t count, std::uint32_t at);

/// Puts an id in front of what the lists of `columns` tiles in each row have so far. One branch for all rows
/// on the usual numbers of columns mispredicts less than a loop's end in each row.
template <std::size_t fixed = 1, class Id>
inline void put_id(Id* list, ListRange* row, const ListRange* end, std::size_t pitch, std::size_t columns, Id id) {
    if constexpr (fixed <= 8)
        if (columns != fixed) return put_id<fixed + 1>(list, row, end, pitch, columns, id);
    for (; row < end; row += pitch)
        for (std::size_t x = 0; x < (fixed <= 8 ? fixed : columns); ++x)
            list[--row[x].offset] = id;
}

/// Puts the ids in the lists of the tile rows begin..end-1. Not inline: within another loop it is a tenth slower.
template <class Id>
LIGHTBIN_NOINLINE void put_ids(const BinJob<Id>& job, Id* list, std::size_t begin, std::size_t end) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    // Backward, so that each offset walks from its list's end to its begin.
    for (std::size_t run = job.runs.size(); run-- > 0;)
        for (std::uint32_t i = job.runs[run].end; i-- > job.runs[run].begin;) {
            const std::size_t y0 = max_of<std::size_t>(lights.y0[i], begin),
                              y1 = min_of<std::size_t>(lights.y1[i] + 1u, end);
            if (y0 < y1)
                put_id(list, job.tiles + y0 * width + lights.x0[i], job.tiles + y1 * width, width,
                       lights.x1[i] - lights.x0[i] + std::size_t{1}, static_cast<Id>(lights.ids[i]));
        }
}

/// The same of any number of lights.
template <class Id, LayOutRows<Id> lay_out_rows>
std::uint64_t scatter_lights(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const bool to_the_end = bands.end == static_cast<unsigned>(job.camera->y.tiles);
    const ListRange* const writable = job.tiles + bands.end * width + (to_the_end ? job.spare_tiles : 0);
    std::uint32_t at = bands.at;
    for (unsigned begin = bands.begin; begin < bands.end; begin += rows_laid_out)
        at = lay_out_rows(job, scratch, begin, min_of(begin + rows_laid_out, bands.end), writable, at);

    if (at == bands.at) return 0;  // the rows may have no tiles, too

    const std::uint64_t entries = at - bands.at;
    const std::size_t step = rows_scattered(bands.end - bands.begin, width, job.visible, entries);
    Id* const list = bands.out - bands.at;  // the whole list
    for (std::size_t begin = bands.begin; begin < bands.end; begin += step)
        put_ids(job, list, begin, min_of<std::size_t>(begin + step, bands.end));
    return entries;
}

/// The same of no light or one: it needs no sums, and its list is only its id.
template <class Id, FillEmpty fill_empty>
std::uint64_t scatter_one(const BinJob<Id>& job, const FootprintRun& run, const BandJob<Id>& bands) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    ListRange *tile = job.tiles + bands.begin * width, *const end = job.tiles + bands.end * width;
    std::uint32_t at = bands.at;
    if (run.begin < run.end) {
        const std::size_t x0 = job.lights.x0[run.begin], x1 = job.lights.x1[run.begin] + std::size_t{1};
        const unsigned y1 = min_of(job.lights.y1[run.begin] + 1u, bands.end);
        for (unsigned y = max_of<unsigned>(job.lights.y0[run.begin], bands.begin); y < y1; ++y) {
            ListRange* const row = job.tiles + y * width;
            fill_empty(tile, static_cast<std::size_t>(row + x0 - tile), at);
            for (tile = row + x0; tile < row + x1; ++tile)
                *tile = {at++, 1};
        }
        fill_items(bands.out, at - bands.at, static_cast<Id>(job.lights.ids[run.begin]));
    }
    fill_empty(tile, static_cast<std::size_t>(end - tile), at);
    return at - bands.at;
}

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id, LayOutRows<Id> lay_out_rows, FillEmpty fill_empty>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintRun run = job.runs[0];
    if (job.runs.size() == 1 && run.end - run.begin <= 1) return scatter_one<Id, fill_empty>(job, run, bands);
    return scatter_lights<Id, lay_out_rows>(job, scratch, bands);
}

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
