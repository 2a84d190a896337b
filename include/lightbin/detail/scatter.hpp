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

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    Id* const list = bands.out - bands.at;      // the whole list
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const std::size_t first = bands.begin, end = bands.end, height = end - first;
    // One more column, where rectangles at the edge end, and whole vectors.
    const std::size_t pitch = width / row_step * row_step + row_step;

    // A row's corners are cleared when the first is put there, so rows without are never touched.
    std::uint32_t* put = scratch.cursors.room(height + 1);  // corners in a row
    std::fill_n(put, height + 1, 0u);
    std::uint32_t* corners = scratch.corners.room(pitch * (height + 3));
    const auto corner_row = [=](std::size_t row) {
        if (put[row]++ == 0) std::memset(corners + row * pitch, 0, pitch * sizeof *corners);
        return corners + row * pitch;
    };
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], first),
                              y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, end);
            if (y0 >= y1) continue;
            std::uint32_t *top = corner_row(y0 - first), *bottom = corner_row(y1 - first);
            ++top[lights.x0[i]];
            --top[lights.x1[i] + 1u];
            --bottom[lights.x0[i]];
            ++bottom[lights.x1[i] + 1u];
        }

    // The counts of a row are the sums of the row's steps, which are the sums of the corners above.
    std::uint32_t *steps = corners + pitch * (height + 1), *none = steps + pitch;
    std::memset(steps, 0, 2 * pitch * sizeof *steps);
    Tile* last_rows = scratch.last_rows.room(pitch);
    std::uint32_t at = bands.at;
    Tile *tile = job.tiles + first * width, *const tiles_end = job.tiles + end * width;
    bool empty = true;  // the row above
    for (std::size_t row = 0; row < height;) {
        if (empty && put[row] == 0) {
            const std::size_t from = row;
            while (row < height && put[row] == 0)
                ++row;
            fill_empty(tile, (row - from) * width, at);
            tile += (row - from) * width;
            continue;
        }
        // Beyond a row's end are the next ones, still to be written; beyond the last one's nothing.
        Tile* to = static_cast<std::size_t>(tiles_end - tile) < pitch ? last_rows : tile;
        const std::uint32_t end_at =
            job.lay_out(steps, put[row] == 0 ? none : corners + row * pitch, width, at, to);
        if (to != tile) std::copy_n(to, width, tile);
        empty = end_at == at;
        at = end_at;
        tile += width;
        ++row;
    }

    // Backward, so that each offset walks from its list's end to its begin.
    for (std::size_t run = job.runs.size(); run-- > 0;)
        for (std::uint32_t i = job.runs[run].end; i-- > job.runs[run].begin;) {
            const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], first),
                              y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, end);
            if (y0 < y1)
                put_id(list, job.tiles + y0 * width + lights.x0[i], job.tiles + y1 * width, width,
                       lights.x1[i] - lights.x0[i] + std::size_t{1}, static_cast<Id>(lights.ids[i]));
        }
    return at - bands.at;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
