// SPDX-License-Identifier: MIT
// Step 1 of bin.inl, for tiers without vectors of bytes: each light is put in the lists of the supertiles that its
// rectangle meets, of all bands at once. A difference array has sized the lists. Included once such a tier.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// What make_lists keeps from band to band: nothing, as the lists of all bands are made with those of the first.
struct ListedBands {};

/// The tile rows of a light that are in some bands, counted from their begin.
struct RowsHere {
    bool any;
    unsigned first, last;
};
template <class Id>
inline RowsHere rows_here(const FootprintArrays& lights, std::uint32_t i,
                                          const BandJob<Id>& bands) {
    const unsigned first = max_of<unsigned>(lights.y0[i], bands.begin),
                   last = min_of<unsigned>(lights.y1[i], bands.end - 1);
    return {first <= last, first - bands.begin, last - bands.begin};
}

/// Sizes the lists of all bands, `pitch` a band, and gives them their places: from multiples of 64 on, and followed
/// by at least one free place. Returns where the last one ends. Then scratch.corners has where each list begins.
template <class Id>
std::uint64_t size_lists(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands,
                                         std::size_t pitch) {
    const std::size_t count = pitch * ((bands.end - bands.begin + 7) / 8 + 2);
    std::uint32_t* corners = scratch.corners.reserve(count);
    std::memset(corners, 0, count * sizeof *corners);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const RowsHere rows = rows_here(job.lights, i, bands);
            if (!rows.any) continue;
            const std::size_t left = job.lights.x0[i] / 8u, right = job.lights.x1[i] / 8u + 1;
            const std::size_t top = rows.first / 8 * pitch, bottom = (rows.last / 8 + 1) * pitch;
            ++corners[top + left];
            --corners[top + right];
            --corners[bottom + left];
            ++corners[bottom + right];
        }
    SupertileList* lists = scratch.supertile_lists.reserve(count);
    std::uint32_t total = 0;
    for (std::size_t list = 0; list < count; ++list) {
        std::uint32_t here = corners[list];  // sums wrap, and come out right
        if (list > 0) here += lists[list - 1].count;
        if (list >= pitch) here += lists[list - pitch].count;
        if (list > pitch) here -= lists[list - pitch - 1].count;
        lists[list] = {total, here, 0};
        corners[list] = total;
        total += (here + 64) & ~63u;
    }
    return total;
}

/// Where lights are put: the next place of each list, and what lies at each place.
struct ListPlaces {
    std::uint32_t *next, *ids;
    std::uint8_t *columns, *rows;

    void put(std::uint32_t place, std::uint32_t id, unsigned column_bits, unsigned row_bits) const {
        ids[place] = id;
        columns[place] = static_cast<std::uint8_t>(column_bits);
        rows[place] = static_cast<std::uint8_t>(row_bits);
    }
};

/// Puts a light with the tiles x0..x1, y0..y1 in its lists.
inline void put_light(const ListPlaces& to, std::size_t pitch, std::uint32_t id, unsigned x0,
                                      unsigned x1, unsigned y0, unsigned y1) {
    const unsigned left = x0 / 8, top = y0 / 8, more_x = x1 / 8 - left, more_y = y1 / 8 - top;
    std::uint32_t* list = to.next + top * pitch + left;
    if ((more_x | more_y) <= 1) {
        // Most lights: written to all four supertiles, kept in those they meet, without a branch.
        const unsigned column_bits = ((2u << (x1 - 8 * left)) - 1) & (~0u << x0 % 8);
        const unsigned row_bits = ((2u << (y1 - 8 * top)) - 1) & (~0u << y0 % 8);
        to.put(list[0]++, id, column_bits, row_bits);
        to.put(list[1], id, column_bits >> 8, row_bits);
        list[1] += more_x;
        to.put(list[pitch], id, column_bits, row_bits >> 8);
        list[pitch] += more_y;
        to.put(list[pitch + 1], id, column_bits >> 8, row_bits >> 8);
        list[pitch + 1] += more_x & more_y;
        return;
    }
    for (unsigned y = top; y <= top + more_y; ++y, list += pitch)
        for (unsigned x = left; x <= left + more_x; ++x)
            to.put(list[x - left]++, id, covered(x0, x1, 8 * x), covered(y0, y1, 8 * y));
}

/// Makes the lists of the band that begins at tile row `top`.
template <bool with_words, class Id>
BandLists<ListId> make_lists(const BinJob<Id>& job, Scratch& scratch,
                                             const BandJob<Id>& bands, unsigned top, unsigned width,
                                             ListedBands&) {
    // One more column and row: the difference array closes there, and branch-free writes may go there.
    const std::size_t pitch = width + 2;
    if (top == bands.begin) {
        const std::uint64_t capacity = size_lists(job, scratch, bands, pitch) + 64;
        const ListPlaces to = {scratch.corners.data(), scratch.list_ids.whole.reserve(capacity),
                               scratch.list_columns.reserve(capacity), scratch.list_rows.reserve(capacity)};
        for (const FootprintRun& run : job.runs)
            for (std::uint32_t i = run.begin; i < run.end; ++i) {
                const RowsHere rows = rows_here(job.lights, i, bands);
                if (rows.any)
                    put_light(to, pitch, with_words ? i : job.lights.ids[i], job.lights.x0[i],
                              job.lights.x1[i], rows.first, rows.last);
            }
    }
    return {scratch.supertile_lists.data() + (top - bands.begin) / 8 * pitch, scratch.list_ids.whole.data(),
            true};
}

}}}}  // namespace lightbin::detail
