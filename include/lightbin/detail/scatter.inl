// SPDX-License-Identifier: MIT
// Binning by count, prefix and fill (Tiled Shading, section 3): small lights, nearly empty grids. A rectangle
// costs four corners of a difference array, whose sums along both axes are the counts. Included once a tier,
// after its Floats.

#if defined(LIGHTBIN_X86) || defined(LIGHTBIN_NEON)
using Words = std::uint32_t __attribute__((vector_size(sizeof(Floats))));
inline constexpr std::make_integer_sequence<int, lanes> each_lane;

/// The lanes moved up by some, zeros in front.
template <int by, int... i> LIGHTBIN_TARGET inline Words moved(Words v, std::integer_sequence<int, i...>) {
    const Words zero = {};
    return __builtin_shufflevector(zero, v, (int{lanes} - by + i)...);
}
/// For each lane the sum of those up to it.
template <int by = 1> LIGHTBIN_TARGET inline Words sums(Words v) {
    if constexpr (by < lanes) return sums<2 * by>(v + moved<by>(v, each_lane));
    return v;
}
/// The last lane in all of them.
template <int... i> LIGHTBIN_TARGET inline Words last(Words v, std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(v, v, (int{lanes} - 1 + 0 * i)...);
}
/// Of two vectors an element each in turn, half the lanes, from lane `from` on.
template <int from, int... i>
LIGHTBIN_TARGET inline Words paired(Words a, Words b, std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(a, b, (from + i / 2 + i % 2 * int{lanes})...);
}
#endif

/// Tiles without lights, at a place in the index list.
LIGHTBIN_TARGET inline void fill_empty(Tile* tiles, std::size_t count, std::uint32_t at) {
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

/// Writes a row of tiles, up to a multiple of the lanes: how many lights each has, the sum of the steps up to
/// it, and where its list ends. The steps are those of the row above and the row's corners. Returns where the
/// last list ends.
LIGHTBIN_TARGET inline std::uint32_t lay_out(std::uint32_t* steps, const std::uint32_t* corners,
                                             std::size_t width, std::uint32_t at, Tile* tiles) {
#if defined(LIGHTBIN_X86) || defined(LIGHTBIN_NEON)
    Words counts = {}, ends = counts + at;
    for (std::size_t x = 0; x < width; x += lanes) {
        Words step, corner;
        std::memcpy(&step, steps + x, sizeof step);
        std::memcpy(&corner, corners + x, sizeof corner);
        step += corner;
        std::memcpy(steps + x, &step, sizeof step);
        counts = last(counts, each_lane) + sums(step);
        ends = last(ends, each_lane) + sums(counts);
        const Words low = paired<0>(ends, counts, each_lane),
                    high = paired<lanes / 2>(ends, counts, each_lane);
        std::memcpy(static_cast<void*>(tiles + x), &low, sizeof low);
        std::memcpy(static_cast<void*>(tiles + x + lanes / 2), &high, sizeof high);
    }
    return ends[lanes - 1];
#else
    std::uint32_t count = 0;
    for (std::size_t x = 0; x < width; ++x) {
        count += steps[x] += corners[x];
        at += count;
        tiles[x] = {at, count};
    }
    return at;
#endif
}

/// Puts an id in front of what the lists of `columns` tiles in each row have so far. One branch for all rows
/// on the usual numbers of columns mispredicts less than a loop's end in each row.
template <std::size_t fixed = 1, class Id>
LIGHTBIN_TARGET inline void put_id(Id* list, Tile* row, const Tile* end, std::size_t pitch,
                                   std::size_t columns, Id id) {
    if constexpr (fixed <= 8)
        if (columns != fixed) return put_id<fixed + 1>(list, row, end, pitch, columns, id);
    for (; row < end; row += pitch)
        for (std::size_t x = 0; x < (fixed <= 8 ? fixed : columns); ++x)
            list[--row[x].offset] = id;
}

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id>
LIGHTBIN_TARGET std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintArrays lights = job.lights;  // a copy, that no store can change
    Id* const list = bands.out - bands.at;      // the whole list
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const std::size_t first = bands.begin, end = bands.end, height = end - first;
    // One more column, where rectangles at the edge end, and whole vectors.
    const std::size_t pitch = width / lanes * lanes + lanes;

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
            lay_out(steps, put[row] == 0 ? none : corners + row * pitch, width, at, to);
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
