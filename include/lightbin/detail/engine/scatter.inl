// SPDX-License-Identifier: MIT
// Binning by count, prefix and fill (Tiled Shading, section 6.1): small lights, nearly empty grids. A rectangle costs four
// corners of a difference array, whose sums along both axes are the counts. Included once a tier that scatters; where it
// has Rows, for the sums, it defines: a vector of counts with + and -; all_rows(count); last_row(rows), the last one in
// all; low_pairs and high_pairs(ends, counts), half of the rows as Tiles each, see BandTiles; and transpose(Tiles*), of a
// square of tiles.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

#if defined(LIGHTBIN_TIER_HAS_ROWS)

// A vector is a column of a band, a lane a tile row: sums along rows are then plain additions, where lanes along a row
// would have to be shuffled up for each. What is shuffled instead is the result, a square of tiles at a time.

inline constexpr unsigned band_rows = sizeof(Rows) / 4, tiles_stored = band_rows / 2;
using EachRow = std::make_integer_sequence<int, band_rows>;
using EachTile = std::make_integer_sequence<int, tiles_stored>;

inline Rows load_rows(const std::uint32_t* from) {
    Rows rows;
    std::memcpy(&rows.v, from, sizeof rows.v);
    return rows;
}
inline void store_rows(std::uint32_t* to, Rows rows) {
    std::memcpy(to, &rows.v, sizeof rows.v);
}

inline void add(std::uint32_t* to, Rows rows) {
    store_rows(to, load_rows(to) + rows);
}

/// For each row of a band, ones from it on.
inline constexpr auto ones_from = [] {
    std::array<std::array<std::uint32_t, band_rows>, band_rows> rows = {};
    for (unsigned from = 0; from < band_rows; ++from)
        for (unsigned row = from; row < band_rows; ++row)
            rows[from][row] = 1;
    return rows;
}();

/// `tiles_stored` tiles of each of a band's rows: vectors are columns, and then, transposed, rows.
struct BandTiles {
    /// Of half the rows each: pairs are made within 128 bits, so of each four rows two.
    Tiles low[tiles_stored], high[tiles_stored];
};

/// Stores transposed tiles, row after row: so what is beyond a row's end is overwritten by the next row.
template <int... i>
inline void store(const BandTiles& tiles, ListRange* column, std::size_t width,
                                  std::integer_sequence<int, i...>) {
    (std::memcpy(static_cast<void*>(column + i * width),
                 &(i / 2 % 2 == 0 ? tiles.low : tiles.high)[i / 4 * 2 + i % 2], sizeof(Tiles)),
     ...);
}

/// The tiles of a column. Then `ends` is where those of the next column to the left end, and `above` what the next
/// band's steps are on top of.
inline void take_column(const std::uint32_t* steps, std::uint32_t* above, Rows& counts,
                                        Rows& ends, Tiles& low, Tiles& high) {
    const Rows step = load_rows(steps) + load_rows(above);
    store_rows(above, last_row(step));
    counts = counts + step;
    low = low_pairs(ends, counts);
    high = high_pairs(ends, counts);
    ends = ends - counts;
}

/// Writes a band's tiles, `columns` of each row. Stores may go on for less than a vector.
///
/// steps     of each column, what its counts have more than the next one's, less `above`
/// above     of each column, the steps of the row above in every lane; then those of the band's last row
/// row_ends  where the list of each row ends; no vector, as GCC 12 leaves the registers' upper halves set after a call
///           that takes one, which slows down what comes next
template <int... i>
inline void lay_out(const std::uint32_t* steps, std::uint32_t* above,
                                    const std::uint32_t* row_ends, std::size_t columns, std::size_t width,
                                    ListRange* rows, std::integer_sequence<int, i...>) {
    constexpr int most = tiles_stored - 1;
    Rows ends = load_rows(row_ends), counts = {};
    BandTiles tiles;
    for (std::size_t x = columns; x > 0;) {
        x -= tiles_stored;
        (take_column(steps + (x + most - i) * band_rows, above + (x + most - i) * band_rows, counts, ends,
                     tiles.low[most - i], tiles.high[most - i]),
         ...);
        transpose(tiles.low);
        transpose(tiles.high);
        store(tiles, rows + x, width, EachRow{});
    }
}

/// Writes the tile rows begin..end-1, each tile with how many lights it has and where its list ends, the first one at
/// `at`. Returns where the last one ends.
template <class Id>
std::uint32_t lay_out_rows(const BinJob<Id>& job, Scratch& scratch, unsigned begin,
                                           unsigned end, std::uint32_t at) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const std::size_t columns = (width + 3) / 4 * 4;  // in whole vectors
    const std::size_t height = end - begin, band_count = height / band_rows + 1;

    // A rectangle is four corners: in its last column one more from its first row on, one less below its last; in the
    // column before its first the opposite.
    const std::size_t pitch = (columns + 1) * band_rows;  // from the column before the first
    const std::size_t size = pitch * (band_count + 1) + band_count * band_rows;
    std::uint32_t* steps = scratch.corners.reserve(size + 16);
    steps += -reinterpret_cast<std::uintptr_t>(steps) % 64 / sizeof *steps;
    std::memset(steps, 0, size * sizeof *steps);
    std::uint32_t *above = steps + pitch * band_count, *row_ends = above + pitch;
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            unsigned y0 = max_of<unsigned>(lights.y0[i], begin), y1 = min_of(lights.y1[i] + 1u, end);
            if (y0 >= y1) continue;
            y0 -= begin;
            y1 -= begin;
            const std::uint32_t reach = lights.x1[i] - lights.x0[i] + 1u;
            row_ends[y0] += reach;
            row_ends[y1] -= reach;
            std::uint32_t* column = steps + lights.x0[i] * band_rows;
            std::uint32_t *first = column + pitch * (y0 / band_rows),
                          *last = column + pitch * (y1 / band_rows);
            const Rows within = load_rows(ones_from[y0 % band_rows].data()),
                       below = load_rows(ones_from[y1 % band_rows].data());
            add(first, Rows{} - within);
            add(first + reach * band_rows, within);
            add(last, below);
            add(last + reach * band_rows, Rows{} - below);
        }
    std::uint32_t entries = 0;  // of a row: so far row_ends has how many it has more than the one above
    for (std::size_t row = 0; row < band_count * band_rows; ++row)
        row_ends[row] = at += entries += row_ends[row];

    ListRange* tile = job.tiles + begin * width;
    for (std::size_t row = 0; row < height; row += band_rows, steps += pitch, tile += band_rows * width) {
        // Beyond a band's tiles there are others still to be written, but beyond the last row perhaps another thread's.
        const std::size_t own = (height - row) * width, stored = band_rows * width + 4;
        ListRange* rows = own < stored ? scratch.last_rows.reserve(stored) : tile;
        lay_out(steps + band_rows, above, row_ends + row, columns, width, rows, EachTile{});
        if (rows != tile) copy_items(rows, min_of(own, band_rows * width), tile);
    }
    return at;
}

/// Stores sixteen tiles, two cache lines if aligned: with one a loop, what the loop itself takes would show.
inline void fill_lines(ListRange* tiles, const Tiles& value) {
    for (std::size_t i = 0; i < 16; i += tiles_stored)
        std::memcpy(static_cast<void*>(tiles + i), &value, sizeof value);
}

/// Writes `count` tiles without lights, at a place in the index list. Narrow vectors are slower than memset, which can
/// write place 0 alone; others are faster. The lines between the first and the last, which may overlap others, are
/// aligned as far as the table's address allows.
inline void fill_empty(ListRange* tiles, std::size_t count, std::uint32_t at) {
    if constexpr (tiles_stored == 2)
        if (at == 0)
            return static_cast<void>(std::memset(static_cast<void*>(tiles), 0, count * sizeof *tiles));
    if (count < 16) return fill_items(tiles, count, {at, 0});
    const Tiles empty = low_pairs(all_rows(at), Rows{});
    ListRange* const last = tiles + count - 16;
    fill_lines(tiles, empty);
    tiles += 8 - reinterpret_cast<std::uintptr_t>(tiles) / sizeof *tiles % 8;
    for (; tiles < last; tiles += 16)
        fill_lines(tiles, empty);
    fill_lines(last, empty);
}

#else

/// Writes `count` tiles without lights, at a place in the index list.
inline void fill_empty(ListRange* tiles, std::size_t count, std::uint32_t at) {
    if (at == 0)
        std::memset(static_cast<void*>(tiles), 0, count * sizeof *tiles);
    else
        fill_items(tiles, count, {at, 0});
}

/// The same by numbers.
template <class Id>
std::uint32_t lay_out_rows(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                                           std::uint32_t at) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles), pitch = width + 1,
                      size = pitch * (end - begin + 1);
    std::uint32_t* steps = scratch.corners.reserve(size);
    std::memset(steps, 0, size * sizeof *steps);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const unsigned y0 = max_of<unsigned>(lights.y0[i], begin), y1 = min_of(lights.y1[i] + 1u, end);
            if (y0 >= y1) continue;
            const std::uint32_t reach = lights.x1[i] - lights.x0[i] + 1u;
            std::uint32_t *const first = steps + (y0 - begin) * pitch + lights.x0[i],
                          *const last = steps + (y1 - begin) * pitch + lights.x0[i];
            ++first[0];
            --first[reach];
            --last[0];
            ++last[reach];
        }
    ListRange* tile = job.tiles + begin * width;
    for (unsigned y = begin; y < end; ++y, steps += pitch)
        for (std::uint32_t x = 0, count = 0; x < width; ++x) {
            const std::uint32_t step = steps[x];
            steps[x + pitch] += step;
            count += step;
            at += count;
            *tile++ = {at, count};
        }
    return at;
}

#endif

/// Puts an id in front of what the lists of `columns` tiles in each row have so far. One branch for all rows
/// on the usual numbers of columns mispredicts less than a loop's end in each row.
template <std::size_t fixed = 1, class Id>
inline void put_id(Id* list, ListRange* row, const ListRange* end, std::size_t pitch,
                                   std::size_t columns, Id id) {
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
template <class Id>
std::uint64_t scatter_lights(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    std::uint32_t at = bands.at;
    for (unsigned begin = bands.begin; begin < bands.end; begin += rows_laid_out)
        at = lay_out_rows(job, scratch, begin, min_of(begin + rows_laid_out, bands.end), at);

    if (at == bands.at) return 0;  // the rows may have no tiles, too

    const std::uint64_t entries = at - bands.at;
    const std::size_t step = rows_scattered(bands.end - bands.begin, width, job.visible, entries);
    Id* const list = bands.out - bands.at;  // the whole list
    for (std::size_t begin = bands.begin; begin < bands.end; begin += step)
        put_ids(job, list, begin, min_of<std::size_t>(begin + step, bands.end));
    return entries;
}

/// The same of no light or one: it needs no sums, and its list is only its id.
template <class Id>
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
template <class Id>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintRun run = job.runs[0];
    if (job.runs.size() == 1 && run.end - run.begin <= 1) return scatter_one(job, run, bands);
    return scatter_lights(job, scratch, bands);
}

}}}}  // namespace lightbin::detail
