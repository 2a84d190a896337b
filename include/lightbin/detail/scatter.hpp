// SPDX-License-Identifier: MIT
// Binning by count, prefix and fill (Tiled Shading, section 3), for all tiers: small lights, nearly empty grids.
// A rectangle costs four corners of a difference array, whose sums along both axes are the counts.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lightbin::detail {

/// Tiles left..right-1 of the rows top..bottom-1; left and right are multiples of 4, right may be beyond the row's end.
struct TileBox {
    unsigned left, right, top, bottom;
};

/// Writes the rows of a box, each tile with how many lights it has and where its list ends, the first one at `at`: from
/// column `left` of the first row on, as what is before is as empty as the rows above. Returns where the last one ends.
/// May write more up to `writable`.
template <class Id>
using LayOutRows = std::uint32_t (*)(const BinJob<Id>& job, Scratch& scratch, const TileBox& box,
                                     const Tile* writable, std::uint32_t at);

inline namespace LIGHTBIN_FLAVOUR {

/// Tiles without lights, at a place in the index list.
inline void fill_empty(Tile* tiles, std::size_t count, std::uint32_t at) {
#if defined(LIGHTBIN_X86)
    // memset's speed, for 8 bytes over and over.
    __asm__ volatile("rep stosq" : "+D"(tiles), "+c"(count) : "a"(std::uint64_t{at}) : "memory");
#else
    std::fill_n(tiles, count, Tile{at, 0});
#endif
}

/// Puts an id in front of what the lists of `columns` tiles in each row have so far. One branch for all rows
/// on the usual numbers of columns mispredicts less than a loop's end in each row.
template <std::size_t fixed = 1, class Id>
inline void put_id(Id* list, Tile* row, const Tile* end, std::size_t pitch, std::size_t columns, Id id) {
    if constexpr (fixed <= 8)
        if (columns != fixed) return put_id<fixed + 1>(list, row, end, pitch, columns, id);
    for (; row < end; row += pitch)
        for (std::size_t x = 0; x < (fixed <= 8 ? fixed : columns); ++x)
            list[--row[x].offset] = id;
}

/// The part of the tile rows begin..end-1 that has lights, if there are so few that it can be much smaller. Where there
/// are none, top is not above bottom.
template <class Id> TileBox lit_part(const BinJob<Id>& job, unsigned begin, unsigned end) {
    const unsigned width = static_cast<unsigned>(job.camera->x.tiles);
    const FootprintRun& run = job.runs.front();
    if (job.runs.size() > 1 || run.end - run.begin >= 16) return {0, (width + 3) / 4 * 4, begin, end};
    TileBox box = {width - 1, 0, end, begin};
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
        if (job.lights.y1[i] < begin || job.lights.y0[i] >= end) continue;
        box.left = (std::min<unsigned>)(box.left, job.lights.x0[i]);
        box.right = (std::max<unsigned>)(box.right, job.lights.x1[i]);
        box.top = (std::min)(box.top, (std::max<unsigned>)(job.lights.y0[i], begin));
        box.bottom = (std::max)(box.bottom, (std::min)(job.lights.y1[i] + 1u, end));
    }
    if (box.top >= box.bottom) return box;
    const unsigned height = (box.bottom - box.top + 7) / 8 * 8;  // in whole bands
    return {box.left / 4 * 4, (box.right / 4 + 1) * 4, box.top, (std::min)(box.top + height, end)};
}

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id, LayOutRows<Id> lay_out_rows>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const bool to_the_end = bands.end == static_cast<unsigned>(job.camera->y.tiles);
    const Tile* const writable = job.tiles + bands.end * width + (to_the_end ? job.slack(width) : 0);
    std::uint32_t at = bands.at;
    constexpr unsigned some = 512;  // rows at a time, for the memory that they take
    for (unsigned begin = bands.begin; begin < bands.end; begin += some) {
        const unsigned end = (std::min)(begin + some, bands.end);
        const TileBox lit = lit_part(job, begin, end);
        const bool none = lit.top >= lit.bottom;
        fill_empty(job.tiles + begin * width,
                   none ? (end - begin) * width : (lit.top - begin) * width + lit.left, at);
        if (none) continue;
        at = lay_out_rows(job, scratch, lit, writable, at);
        fill_empty(job.tiles + lit.bottom * width, (end - lit.bottom) * width, at);
    }

    // Long lists have cache lines and pages of their own, and of all tiles at once too many: then some rows at a time.
    const std::size_t height = bands.end - bands.begin, entries = at - bands.at;
    const std::size_t step =
        entries > 256 * height * width + std::size_t{8} * job.runs.back().end ? 512 / width + 1 : height;
    Id* const list = bands.out - bands.at;  // the whole list
    for (std::size_t begin = bands.begin; begin < bands.end; begin += step) {
        const std::size_t end = (std::min<std::size_t>)(begin + step, bands.end);
        // Backward, so that each offset walks from its list's end to its begin.
        for (std::size_t run = job.runs.size(); run-- > 0;)
            for (std::uint32_t i = job.runs[run].end; i-- > job.runs[run].begin;) {
                const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], begin),
                                  y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, end);
                if (y0 < y1)
                    put_id(list, job.tiles + y0 * width + lights.x0[i], job.tiles + y1 * width, width,
                           lights.x1[i] - lights.x0[i] + std::size_t{1}, static_cast<Id>(lights.ids[i]));
            }
    }
    return entries;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
