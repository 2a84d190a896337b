// SPDX-License-Identifier: MIT
// A part of step 3 of bin.inl: of a long list whose lights cover few of its rows, those of a row are picked first, and
// the row's 8 tiles are made of them. Included once a tier, before emit.inl, that has append_lights().

/// Where that is faster, replaces a supertile's list, its ids and words by those of its lights in a row. In their words
/// that row has all of them.
LIGHTBIN_TARGET LIGHTBIN_NOINLINE inline void pick_row(Scratch& scratch, const SupertileList& list,
                                                       unsigned row, const std::uint32_t*& ids,
                                                       const std::uint64_t*& words, std::uint32_t& count) {
    std::uint32_t in_row = 0;
    for (std::uint32_t i = 0; i < count; i += 64)
        in_row += static_cast<unsigned>(std::popcount(words[i / 4 + 8 + row]));
    if (!picking_is_faster(count, in_row)) return;

    std::uint32_t* const to_ids = scratch.row_ids.reserve(in_row + std::uint64_t{64});
    std::uint8_t* const to_columns = scratch.row_columns.reserve(in_row + std::uint64_t{64});
    const std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    std::uint32_t picked = 0;
    for (std::uint32_t i = 0; i < count; i += 64) {
        std::uint64_t chosen = words[i / 4 + 8 + row];
        const std::uint32_t end = min_of(i + 64, count);
        for (std::uint32_t j = i; j < end; j += 8, chosen >>= 8)
            picked += append_lights(to_ids + picked, to_columns + picked, ids + j, columns + j,
                                    static_cast<unsigned>(chosen & 0xff));
    }
    std::memset(to_columns + picked, 0, 64);
    std::uint64_t* const to_words = scratch.row_words.reserve(std::uint64_t{in_row} / 4 + 16);
    for (std::uint32_t i = 0; i < picked; i += 64) {
        split_bits(to_columns + i, to_words + i / 4);
        to_words[i / 4 + 8 + row] = ~std::uint64_t{0};
    }
    ids = to_ids;
    words = to_words;
    count = picked;
}
