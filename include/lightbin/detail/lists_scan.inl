// SPDX-License-Identifier: MIT
// Step 1 of bin.inl, for tiers with vectors of bytes: each list picks its lights out of many, a vector of them at a time
// and without a branch on what a light covers. Included once such a tier, see all.inl for what it defines.
//
//   1. A vector of lights' rows against each band of 8 tile rows: a saturating subtraction and two byte shuffles
//      give each light's byte of covered rows, zero if it misses the band. Those that do not are appended to the
//      band's list.
//   2. The same with the band's list and each supertile's 8 columns: the supertile's list.
//
// Coordinates are bytes here. So bands are listed by panels of 248 tiles a side, coordinates counted from the panel.

inline constexpr unsigned panel_side = 31;  // in supertiles

/// The lights of some bands, from tile row `begin` to end-1, in a list for each band and panel: number
/// band * panels + panel, with room for `stride` lights. Of each light the columns that it covers, x0..x1-1, its byte of
/// rows, and its id or, for words, its visible index.
struct ListedBands {
    unsigned begin = 0, end = 0, panels = 0;
    bool wide = false;  ///< some ids are longer than 16 bits
    std::size_t stride = 0;
    std::uint8_t *x0 = nullptr, *x1 = nullptr, *rows = nullptr;
    std::uint32_t* size = nullptr;
    ListIds ids = {};
};

/// Of each light first..end-1, which of the 8 tiles from `begin` on it covers, a bit per tile.
LIGHTBIN_TARGET inline Bytes covered_bytes(Bytes first, Bytes end, unsigned begin) {
    static constexpr std::uint8_t from[16] = {255, 254, 252, 248, 240, 224, 192, 128};
    static constexpr std::uint8_t before[16] = {0, 1, 3, 7, 15, 31, 63, 127, 255};
    const Bytes start = all_bytes(begin), eight = all_bytes(8);
    return look_up(from, lesser(subtract(first, start), eight)) &
           look_up(before, lesser(subtract(end, start), eight));
}

/// The first `count` bytes of a vector, or all.
LIGHTBIN_TARGET inline ByteMask first_bytes(std::size_t count) {
    const ByteMask all = ~ByteMask{0};
    return count < byte_lanes ? static_cast<ByteMask>(~(all << count)) : all;
}

/// Whether ids or visible indices are longer than 16 bits.
template <class Id> bool wide_ids(const BinJob<Id>& job) {
    for (const FootprintRun& run : job.runs)
        if (run.begin < run.end && (run.end | job.lights.ids[run.end - 1]) > 0xffff) return true;
    return false;
}

/// Appends a vector of lights, `count` or as many as it has, from visible index i on, to the lists of the bands and panels that they meet.
template <bool with_words>
LIGHTBIN_TARGET inline void add_to_bands(const FootprintArrays& lights, const ListedBands& listed, std::uint32_t i,
                                         std::size_t count) {
    const ListedBands to = listed;  // a copy, that no store can change
    const Bytes first_y = coordinates(lights.y0 + i, 0, to.begin), end_y = coordinates(lights.y1 + i, 1, to.begin);
    const ByteIds ids = with_words ? count_ids(i) : load_ids(lights.ids + i, count);
    const unsigned bands = (to.end - to.begin + 7) / 8;
    for (unsigned panel = 0; panel < to.panels; ++panel) {
        const unsigned begin = 8 * panel_side * panel;
        const Bytes first_x = coordinates(lights.x0 + i, 0, begin), end_x = coordinates(lights.x1 + i, 1, begin);
        ByteMask in_panel = first_bytes(count);
        if (to.panels > 1) in_panel &= not_zero(end_x) & not_zero(subtract(all_bytes(8 * panel_side), first_x));
        for (unsigned band = 0; band < bands; ++band) {
            const Bytes rows = covered_bytes(first_y, end_y, 8 * band);
            const ByteMask chosen = not_zero(rows) & in_panel;
            if (chosen == 0) continue;
            const std::size_t list = std::size_t{band} * to.panels + panel, at = list * to.stride + to.size[list];
            append_chosen(chosen, first_x, to.x0 + at);
            append_chosen(chosen, end_x, to.x1 + at);
            append_chosen(chosen, rows, to.rows + at);
            append_chosen(chosen, ids, to.ids.from(at));
            to.size[list] += static_cast<std::uint32_t>(std::popcount(chosen));
        }
    }
}

/// Lists as many bands from tile row `begin` on as one pass over the lights takes.
template <bool with_words, class Id>
LIGHTBIN_TARGET void list_bands(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                                unsigned width, ListedBands& to) {
    to.panels = (width + panel_side - 1) / panel_side;
    const std::uint64_t together =
        std::clamp<std::uint64_t>(most_band_places / (std::uint64_t{job.visible} * to.panels + 1), 1, panel_side);
    to.begin = begin;
    to.end = (std::min)(begin + 8 * static_cast<unsigned>(together), end);
    const std::uint64_t lists = std::uint64_t{(to.end - to.begin + 7) / 8} * to.panels,
                        stride = std::uint64_t{job.visible} + 64;  // whole vectors are stored and read
    to.stride = static_cast<std::size_t>(stride);
    to.x0 = scratch.band_x0.reserve(lists * stride);
    to.x1 = scratch.band_x1.reserve(lists * stride);
    to.rows = scratch.band_rows.reserve(lists * stride);
    to.wide = wide_ids(job);
    to.ids = ListIds::reserve(scratch.band_ids, lists * stride, 0, to.wide);
    to.size = scratch.band_size.reserve(lists);
    std::fill_n(to.size, lists, 0u);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; i += byte_lanes)
            add_to_bands<with_words>(job.lights, to, i, run.end - i);
}

/// Makes the list of the supertile whose columns begin at `begin` in its panel, out of the panel's list number `list`, at
/// the places given. Returns how many lights it has.
LIGHTBIN_TARGET inline std::uint32_t pick_lights(const ListedBands& listed, std::size_t list, unsigned begin,
                                                 std::uint8_t* columns, std::uint8_t* rows, ListIds ids) {
    const ListedBands bands = listed;  // a copy, that no store can change
    std::uint32_t count = 0;
    for (std::size_t at = list * bands.stride, end = at + bands.size[list]; at < end; at += byte_lanes) {
        const Bytes here = covered_bytes(load_bytes(bands.x0 + at), load_bytes(bands.x1 + at), begin);
        const ByteMask chosen = not_zero(here) & first_bytes(end - at);
        if (chosen == 0) continue;
        append_chosen(chosen, here, columns + count);
        append_chosen(chosen, load_bytes(bands.rows + at), rows + count);
        append_chosen(chosen, load_ids(bands.ids.from(at), end - at), ids.from(count));
        count += static_cast<std::uint32_t>(std::popcount(chosen));
    }
    return count;
}

/// Makes the lists of the band that begins at tile row `top`. `listed` is kept from band to band.
template <bool with_words, class Id>
LIGHTBIN_TARGET BandLists<ListIds> make_lists(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands,
                                          unsigned top, unsigned width, ListedBands& listed) {
    if (top >= listed.end) list_bands<with_words>(job, scratch, top, bands.end, width, listed);
    const std::uint32_t* const sizes = listed.size + std::size_t{(top - listed.begin) / 8} * listed.panels;
    const std::uint32_t longest = listed.panels > 0 ? *std::max_element(sizes, sizes + listed.panels) : 0;
    if (longest == 0) return {};
    SupertileList* const lists = scratch.supertile_lists.reserve(width);
    ListIds ids = {};
    std::uint32_t used = 0;
    for (unsigned x = 0; x < width; ++x) {
        const std::size_t list = static_cast<std::size_t>(sizes - listed.size) + x / panel_side;
        const std::uint64_t capacity = std::uint64_t{used} + listed.size[list] + 128;
        ids = ListIds::reserve(scratch.list_ids, capacity, used, listed.wide);
        const std::uint32_t count =
            pick_lights(listed, list, 8 * (x % panel_side), scratch.list_columns.reserve(capacity, used) + used,
                        scratch.list_rows.reserve(capacity, used) + used, ids.from(used));
        lists[x] = {used, count, 0};
        used += (count + 63) & ~63u;
    }
    return {lists, ids, longest <= 64};
}
