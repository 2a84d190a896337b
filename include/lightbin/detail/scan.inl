// SPDX-License-Identifier: MIT
// Step 1 of supertile.inl by scanning, on AVX2. Instead of each light being inserted in the lists it belongs
// to, a band of 8 tile rows picks its lights out of all, and each of its supertiles out of the band's: 32 at a
// time and without a branch on what a light covers. Where a row has very many supertiles, inserting is cheaper.

inline constexpr bool scans_lists = true;

LIGHTBIN_TARGET inline __m256i load(const void* p) {
    return _mm256_loadu_si256(static_cast<const __m256i*>(p));
}
LIGHTBIN_TARGET inline void store(void* p, __m256i v) {
    _mm256_storeu_si256(static_cast<__m256i*>(p), v);
}

/// 32 coordinates (plus `more`) counted from `begin`, as bytes: 0 if before, 255 if far beyond.
LIGHTBIN_TARGET inline __m256i load_from(const std::uint16_t* p, unsigned more, unsigned begin) {
    const __m256i add = _mm256_set1_epi16(static_cast<short>(more)),
                  start = _mm256_set1_epi16(static_cast<short>(begin)), most = _mm256_set1_epi16(255);
    const __m256i low = _mm256_subs_epu16(_mm256_add_epi16(load(p), add), start),
                  high = _mm256_subs_epu16(_mm256_add_epi16(load(p + 16), add), start);
    // Packing takes words as signed, and the end of the last of 32768 rows is 0x8000.
    return _mm256_permute4x64_epi64(
        _mm256_packus_epi16(_mm256_min_epu16(low, most), _mm256_min_epu16(high, most)), 0xd8);
}

/// Of each light first..end-1 (bytes), which of the 8 tiles from `begin` on it covers, a bit a tile.
LIGHTBIN_TARGET inline __m256i covered_bytes(__m256i first, __m256i end, unsigned begin) {
    const __m256i from = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(-1, -2, -4, -8, -16, -32, -64, -128, 0, 0, 0, 0, 0, 0, 0, 0));
    const __m256i before =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 3, 7, 15, 31, 63, 127, -1, 0, 0, 0, 0, 0, 0, 0));
    const __m256i start = _mm256_set1_epi8(static_cast<char>(begin)), eight = _mm256_set1_epi8(8);
    return _mm256_and_si256(
        _mm256_shuffle_epi8(from, _mm256_min_epu8(_mm256_subs_epu8(first, start), eight)),
        _mm256_shuffle_epi8(before, _mm256_min_epu8(_mm256_subs_epu8(end, start), eight)));
}

/// A bit for each byte that is not zero, of the first `count`.
LIGHTBIN_TARGET inline std::uint32_t not_zero(__m256i bytes, std::size_t count) {
    const std::uint32_t zero =
        static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(bytes, _mm256_setzero_si256())));
    return ~zero & (count < 32 ? (1u << count) - 1 : ~0u);
}

/// Stores those of two times 8 bytes whose bit is set, each followed by bytes that mean nothing.
LIGHTBIN_TARGET inline void store_chosen(std::uint8_t* a_to, std::uint8_t* b_to, const std::uint8_t* a,
                                         const std::uint8_t* b, unsigned chosen) {
    const __m128i places = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(set_bits[chosen].data()));
    const __m128i both = _mm_unpacklo_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(a)),
                                            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(b)));
    const __m128i first =
        _mm_shuffle_epi8(both, _mm_unpacklo_epi64(places, _mm_add_epi8(places, _mm_set1_epi8(8))));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(a_to), first);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(b_to), _mm_unpackhi_epi64(first, first));
}

/// Picks the lights of the band of tile rows top..end_row-1 into scratch.band_*: the columns that they cover,
/// first..end-1, their byte of rows, and id or, for words, visible index. Returns how many.
template <bool with_words, class Id>
LIGHTBIN_TARGET std::uint32_t scan_band(const BinJob<Id>& job, Scratch& scratch, unsigned top,
                                        unsigned end_row) {
    const FootprintArrays& lights = job.lights;
    const std::uint64_t room = std::uint64_t{job.visible} + 64;
    std::uint8_t* first = scratch.band_x0.room(room);
    std::uint8_t* end = scratch.band_x1.room(room);
    std::uint8_t* rows = scratch.band_rows.room(room);
    std::uint32_t* ids = scratch.band_light_ids.room(room);
    const __m256i in_band = _mm256_set1_epi8(static_cast<char>((1u << (end_row - top)) - 1));
    std::uint32_t count = 0;
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; i += 32) {
            const __m256i covered = _mm256_and_si256(
                covered_bytes(load_from(lights.y0 + i, 0, top), load_from(lights.y1 + i, 1, top), 0),
                in_band);
            const std::uint32_t chosen = not_zero(covered, run.end - i);
            if (chosen == 0) continue;
            alignas(32) std::uint8_t bytes[3][32];
            store(bytes[0], load_from(lights.x0 + i, 0, 0));
            store(bytes[1], load_from(lights.x1 + i, 1, 0));
            store(bytes[2], covered);
            for (unsigned j = 0; j < 32; j += 8) {
                const unsigned here = chosen >> j & 0xff;
                const std::uint32_t at =
                    count + static_cast<std::uint32_t>(std::popcount(chosen & ((1u << j) - 1)));
                store_chosen(first + at, end + at, bytes[0] + j, bytes[1] + j, here);
                store_chosen(rows + at, rows + at, bytes[2] + j, bytes[2] + j, here);
                if constexpr (with_words)
                    store(ids + at,
                          _mm256_add_epi32(_mm256_cvtepu8_epi32(_mm_loadl_epi64(
                                               reinterpret_cast<const __m128i*>(set_bits[here].data()))),
                                           _mm256_set1_epi32(static_cast<int>(i + j))));
                else
                    append(ids + at, lights.ids + i + j, here);
            }
            count += static_cast<std::uint32_t>(std::popcount(chosen));
        }
    return count;
}

/// Makes the lists of the `width` supertiles of that band, as fill_lists() does those of all.
template <bool with_words, class Id>
LIGHTBIN_TARGET void scan_lists(const BinJob<Id>& job, Scratch& scratch, unsigned top, unsigned end_row,
                                unsigned width) {
    const std::uint32_t count = scan_band<with_words>(job, scratch, top, end_row);
    std::uint32_t* begin = scratch.list_begin.room(width + 1);
    std::uint32_t* size = scratch.list_size.room(width + 1);
    std::uint32_t total = 0;
    for (unsigned x = 0; x < width; ++x) {
        const std::uint64_t room = std::uint64_t{total} + count + 64;
        std::uint8_t* columns = scratch.list_columns.room(room, total) + total;
        std::uint8_t* rows = scratch.list_rows.room(room, total) + total;
        std::uint32_t* ids = scratch.list_ids.room(room, total) + total;
        std::uint32_t listed = 0;
        for (std::uint32_t i = 0; i < count; i += 32) {
            alignas(32) std::uint8_t covered[32];
            const __m256i here =
                covered_bytes(load(scratch.band_x0.data() + i), load(scratch.band_x1.data() + i), 8 * x);
            const std::uint32_t chosen = not_zero(here, count - i);
            if (chosen == 0) continue;
            store(covered, here);
            for (unsigned j = 0; j < 32; j += 8) {
                const unsigned mask = chosen >> j & 0xff;
                const std::uint32_t at =
                    listed + static_cast<std::uint32_t>(std::popcount(chosen & ((1u << j) - 1)));
                store_chosen(columns + at, rows + at, covered + j, scratch.band_rows.data() + i + j, mask);
                append(ids + at, scratch.band_light_ids.data() + i + j, mask);
            }
            listed += static_cast<std::uint32_t>(std::popcount(chosen));
        }
        begin[x] = total;
        size[x] = listed;
        total += (listed + 64) & ~63u;
    }
    begin[width] = total;
}
