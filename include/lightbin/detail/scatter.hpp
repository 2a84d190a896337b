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
#include <cstring>

namespace lightbin::detail {

/// Tiles left..right of the rows top..bottom-1.
struct TileBox {
    unsigned left, right, top, bottom;
};

/// Writes the rows of a box, from the first column to the last, each tile with how many lights it has and where its
/// list ends, the first one at `at`. Returns where the last one ends. May write more of the rows before `writable`.
template <class Id>
using LayOutRows = std::uint32_t (*)(const BinJob<Id>& job, Scratch& scratch, const TileBox& box,
                                     unsigned writable, std::uint32_t at);

inline namespace LIGHTBIN_FLAVOUR {

/// Tiles without lights, at a place in the index list.
inline void fill_empty(Tile* tiles, std::size_t count, std::uint32_t at) {
    if (at == 0) {
        std::memset(tiles, 0, count * sizeof *tiles);
        return;
    }
    // A few by hand, the rest by doubling them: memcpy has the machine's widest stores.
    const std::size_t some = (std::min<std::size_t>)(count, 64);
    std::fill_n(tiles, some, Tile{at, 0});
    for (std::size_t done = some; done < count; done *= 2)
        std::memcpy(tiles + done, tiles, (std::min)(done, count - done) * sizeof *tiles);
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

/// The part of the tile rows begin..end-1 that has lights, if there are so few that it can be much smaller. Where
/// there are none, top is not above bottom.
template <class Id> TileBox lit_part(const BinJob<Id>& job, unsigned begin, unsigned end) {
    const unsigned width = static_cast<unsigned>(job.camera->x.tiles);
    std::uint32_t count = 0;
    for (const FootprintRun& run : job.runs)
        count += run.end - run.begin;
    if (count >= 16) return {0, width - 1, begin, end};
    TileBox box = {width - 1, 0, end, begin};
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            if (job.lights.y1[i] < begin || job.lights.y0[i] >= end) continue;
            box.left = (std::min<unsigned>)(box.left, job.lights.x0[i]);
            box.right = (std::max<unsigned>)(box.right, job.lights.x1[i]);
            box.top = (std::min)(box.top, (std::max<unsigned>)(job.lights.y0[i], begin));
            box.bottom = (std::max)(box.bottom, (std::min)(job.lights.y1[i] + 1u, end));
        }
    return box;
}

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id, LayOutRows<Id> lay_out_rows>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    std::uint32_t at = bands.at;
    constexpr unsigned some = 512;  // rows at a time, for the memory that they take
    for (unsigned begin = bands.begin; begin < bands.end; begin += some) {
        const unsigned end = (std::min)(begin + some, bands.end);
        const TileBox lit = lit_part(job, begin, end);
        const bool none = lit.top >= lit.bottom;
        fill_empty(job.tiles + begin * width, ((none ? end : lit.top) - begin) * width, at);
        if (none) continue;
        at = lay_out_rows(job, scratch, lit, end, at);
        fill_empty(job.tiles + lit.bottom * width, (end - lit.bottom) * width, at);
    }

    // Backward, so that each offset walks from its list's end to its begin.
    Id* const list = bands.out - bands.at;  // the whole list
    for (std::size_t run = job.runs.size(); run-- > 0;)
        for (std::uint32_t i = job.runs[run].end; i-- > job.runs[run].begin;) {
            const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], bands.begin),
                              y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, bands.end);
            if (y0 < y1)
                put_id(list, job.tiles + y0 * width + lights.x0[i], job.tiles + y1 * width, width,
                       lights.x1[i] - lights.x0[i] + std::size_t{1}, static_cast<Id>(lights.ids[i]));
        }
    return at - bands.at;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
