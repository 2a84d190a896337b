// SPDX-License-Identifier: MIT
// Scattering: binning by counting, prefix sums and filling (Tiled Shading, section 6.1). A light is listed in all tiles
// of its rectangle: there is no depth test. It is the faster method for small lights and nearly empty
// grids, and on machines without vectors. The code is the same for all instruction sets.
#pragma once

#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/engine/costs.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Writes the ranges of the tile rows begin..end-1: the number of lights of each tile, and where its list ends in the
/// index list, from which fill_rows() counts down. The first list begins at `offset`. Returns where the last one ends.
///
/// The counts come from a difference array: each rectangle adds 1 at two of its corners and subtracts 1 at the other
/// two, so that prefix sums along columns and rows give the number of rectangles over each tile.
inline std::uint32_t count_rows(const BinJob& job, Scratch& scratch, unsigned begin, unsigned end,
                                std::uint32_t offset) {
    const FootprintArrays lights = job.lights;  // a local copy, so that compilers need not reload it after each store
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles), pitch = width + 1,
                      size = pitch * (end - begin + 1);
    std::uint32_t* steps = scratch.corners.reserve(size);
    std::memset(steps, 0, size * sizeof *steps);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const unsigned y0 = max_of<unsigned>(lights.y0[i], begin), y1 = min_of(lights.y1[i] + 1u, end);
            if (y0 >= y1) continue;
            const std::uint32_t columns = lights.x1[i] - lights.x0[i] + 1u;
            std::uint32_t *const first = steps + (y0 - begin) * pitch + lights.x0[i],
                          *const below = steps + (y1 - begin) * pitch + lights.x0[i];
            ++first[0];
            --first[columns];
            --below[0];
            ++below[columns];
        }
    ListRange* tiles = job.tiles + begin * width;
    for (unsigned y = begin; y < end; ++y, steps += pitch, tiles += width) {
        std::uint32_t count = 0, *const below = steps + pitch;
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint32_t step = steps[x];
            below[x] += step;
            count += step;
            offset += count;
            tiles[x] = {offset, count};
        }
    }
    return offset;
}

/// Prepends an id to the list of each tile in a rectangle, and moves the tile's offset down to it.
///
/// row, end  the rectangle's first tile, and the first tile of the grid's row below the rectangle
/// pitch     tiles from one row of the grid to the next
/// columns   tiles in each of the rectangle's rows
///
/// Each of the usual numbers of columns has its own loop, chosen by one branch for the whole light. A loop over any
/// number would be mispredicted at the end of each row, which takes 1.5 to 1.8 times as long.
template <std::size_t fixed = 1, class Id>
void prepend_id(Id* list, ListRange* row, const ListRange* end, std::size_t pitch, std::size_t columns, Id id) {
    if constexpr (fixed <= 8)
        if (columns != fixed) return prepend_id<fixed + 1>(list, row, end, pitch, columns, id);
    for (; row < end; row += pitch)
        for (std::size_t x = 0; x < (fixed <= 8 ? fixed : columns); ++x)
            list[--row[x].offset] = id;
}

/// Prepends all lights' ids to the lists of the tile rows begin..end-1, the last light first, so that ids ascend in
/// each list. It is not inlined, as it takes a tenth longer inside another loop.
///
/// list  the whole grid's index list
template <class Id>
LIGHTBIN_NOINLINE void fill_rows(const BinJob& job, Id* list, std::size_t begin, std::size_t end) {
    const FootprintArrays lights = job.lights;  // a local copy, so that compilers need not reload it after each store
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    for (std::size_t run = job.runs.size(); run-- > 0;)
        for (std::uint32_t i = job.runs[run].end; i-- > job.runs[run].begin;) {
            const std::size_t y0 = max_of<std::size_t>(lights.y0[i], begin),
                              y1 = min_of<std::size_t>(lights.y1[i] + 1u, end);
            if (y0 < y1)
                prepend_id(list, job.tiles + y0 * width + lights.x0[i], job.tiles + y1 * width, width,
                           lights.x1[i] - lights.x0[i] + std::size_t{1}, static_cast<Id>(lights.ids[i]));
        }
}

/// Bins one light or none, without prefix sums, as the index list is one id repeated. Returns the number of entries.
template <class Id>
std::uint64_t scatter_one(const BinJob& job, const FootprintRun& run, const BinShare<Id>& share) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    ListRange *tile = job.tiles + share.begin * width, *const end = job.tiles + share.end * width;
    std::uint32_t offset = share.offset;
    if (run.begin < run.end) {
        const std::size_t x0 = job.lights.x0[run.begin], x1 = job.lights.x1[run.begin] + std::size_t{1};
        const unsigned y1 = min_of(job.lights.y1[run.begin] + 1u, share.end);
        for (unsigned y = max_of<unsigned>(job.lights.y0[run.begin], share.begin); y < y1; ++y) {
            ListRange* const row = job.tiles + y * width;
            fill_empty(tile, static_cast<std::size_t>(row + x0 - tile), offset);
            for (tile = row + x0; tile < row + x1; ++tile)
                *tile = {offset++, 1};
        }
        fill_items(share.out, offset - share.offset, static_cast<Id>(job.lights.ids[run.begin]));
    }
    fill_empty(tile, static_cast<std::size_t>(end - tile), offset);
    return offset - share.offset;
}

/// Removes the lists of the tiles whose bit in job.drawn is not set. Returns the number of entries left.
template <class Id> std::uint64_t keep_drawn_lists(const BinJob& job, const BinShare<Id>& share) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles), blocks = (width + 7) / 8;
    Id* const list = share.out - share.offset;
    std::uint32_t offset = share.offset;
    for (std::size_t y = share.begin; y < share.end; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            ListRange& tile = job.tiles[y * width + x];
            const bool drawn = (job.drawn[y / 8 * blocks + x / 8] >> (y % 8 * 8 + x % 8) & 1) != 0;
            const ListRange kept = {offset, drawn ? tile.count : 0};
            std::memmove(list + offset, list + tile.offset, kept.count * sizeof(Id));
            tile = kept;
            offset += kept.count;
        }
    return offset - share.offset;
}

/// Bins one thread's share of tile rows: counts each tile's lights, then writes each light's id to its tiles' lists.
/// Returns the number of list entries, and writes no element past the last entry.
template <class Id>
std::uint64_t scatter_lights(const BinJob& job, Scratch& scratch, const BinShare<Id>& share) {
    const FootprintRun run = job.runs[0];
    std::uint64_t entries = 0;
    if (job.runs.size() == 1 && run.end - run.begin <= 1) {
        entries = scatter_one(job, run, share);
    } else {
        std::uint32_t offset = share.offset;
        for (unsigned begin = share.begin; begin < share.end; begin += rows_counted_at_once)
            offset = count_rows(job, scratch, begin, min_of(begin + rows_counted_at_once, share.end), offset);
        entries = offset - share.offset;
        if (entries == 0) return 0;  // also where the rows have no tiles
        fill_rows(job, share.out - share.offset, share.begin, share.end);
    }
    return job.drawn == nullptr ? entries : keep_drawn_lists(job, share);
}

}}}  // namespace lightbin::detail
