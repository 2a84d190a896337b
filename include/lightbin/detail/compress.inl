// SPDX-License-Identifier: MIT
// Binning by supertiles of 8x8 tiles on AVX-512, as supertile.inl, but lists are made by compressing 64 lights
// at a time instead of inserting them one by one:
//
//   1. 64 lights' rows against each band of 8 tile rows: a saturating subtraction and two byte shuffles give
//      each light's byte of covered rows, zero if it misses the band. Those that do not are compressed onto
//      the band's list.
//   2. The same with the band's list and each supertile's 8 columns: the supertile's list, then its words.
//   3. Tiles in row-major order: the lights of tile (row, column) are rows[row] & columns[column]; their ids
//      are compressed onto the index list. With up to 8, 16 or 31 lights a compress does 8, 4 or 2 tiles.
//
// Coordinates are bytes and ids 16 bits here. So lists are made for panels of 248 tiles a side, coordinates
// counted from the panel; and lights are taken in blocks whose ids share their upper 16 bits: in every list a
// block begins at a multiple of 64, filled up with lights that cover nothing.

inline constexpr unsigned panel_side = 31;  // in supertiles

/// A vector's worth of place(0), place(1) ...
template <class T, class Place> constexpr std::array<T, 64 / sizeof(T)> table_of(Place place) {
    std::array<T, 64 / sizeof(T)> table = {};
    for (unsigned i = 0; i < table.size(); ++i)
        table[i] = static_cast<T>(place(i));
    return table;
}
/// 0, 1, 2 ...
template <class T> inline constexpr auto counted = table_of<T>([](unsigned i) { return i; });
/// 0 eight times, 1 eight times ...
inline constexpr auto eight_each = table_of<std::uint8_t>([](unsigned i) { return i / 8; });
/// Permutation of 64 bytes that turns 8x8 of them.
inline constexpr auto turned_bytes = table_of<std::uint8_t>([](unsigned i) { return i % 8 * 8 + i / 8; });
/// Permutation of two vectors that takes an element of each in turn, from the first half of both.
template <class T>
inline constexpr auto in_turn = table_of<T>([](unsigned i) { return i / 2 + i % 2 * (64 / sizeof(T)); });

LIGHTBIN_TARGET inline __m512i load(const void* p) {
    return _mm512_loadu_si512(p);
}
LIGHTBIN_TARGET inline void store(void* p, __m512i v) {
    _mm512_storeu_si512(p, v);
}
/// On Zen 5 the form of a compress instruction that zeroes the rest waits for what its register held before, which
/// makes a chain of one iteration and the next: it is given fresh zeros.
LIGHTBIN_TARGET inline __m512i fresh_zeros() {
    __m512i zeros = _mm512_setzero_si512();
    LIGHTBIN_FORGET(zeros);  // or the compiler picks that form
    return zeros;
}
/// Those of the chosen elements, then zeros.
LIGHTBIN_TARGET inline __m512i compressed_bytes(__mmask64 chosen, __m512i from) {
    return _mm512_mask_compress_epi8(fresh_zeros(), chosen, from);
}
LIGHTBIN_TARGET inline __m512i compressed_words(__mmask32 chosen, __m512i from) {
    return _mm512_mask_compress_epi16(fresh_zeros(), chosen, from);
}
LIGHTBIN_TARGET inline __m512i halves(__m256i low, __m256i high) {
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
LIGHTBIN_TARGET inline __m512i load_low_halves(const std::uint32_t* p) {
    return halves(_mm512_cvtepi32_epi16(load(p)), _mm512_cvtepi32_epi16(load(p + 16)));
}
LIGHTBIN_TARGET inline __mmask64 first_lanes(std::size_t count) {
    return count >= 64 ? ~__mmask64{0} : (__mmask64{1} << count) - 1;
}
/// 64 coordinates (plus `more`) counted from `begin`, as bytes: 0 if before, 248 or more if beyond the panel.
LIGHTBIN_TARGET inline __m512i load_from(const std::uint16_t* p, unsigned more, unsigned begin) {
    const __m512i one = _mm512_set1_epi16(static_cast<short>(more)),
                  start = _mm512_set1_epi16(static_cast<short>(begin));
    return halves(_mm512_cvtusepi16_epi8(_mm512_subs_epu16(_mm512_add_epi16(load(p), one), start)),
                  _mm512_cvtusepi16_epi8(_mm512_subs_epu16(_mm512_add_epi16(load(p + 32), one), start)));
}

/// Of each light first..end-1 (bytes), which of the 8 tiles from `begin` on it covers, a bit a tile.
LIGHTBIN_TARGET inline __m512i covered_bytes(__m512i first, __m512i end, unsigned begin) {
    const __m512i from =
        _mm512_broadcast_i32x4(_mm_setr_epi8(-1, -2, -4, -8, -16, -32, -64, -128, 0, 0, 0, 0, 0, 0, 0, 0));
    const __m512i before =
        _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 3, 7, 15, 31, 63, 127, -1, 0, 0, 0, 0, 0, 0, 0));
    const __m512i start = _mm512_set1_epi8(static_cast<char>(begin)), eight = _mm512_set1_epi8(8);
    return _mm512_and_si512(
        _mm512_shuffle_epi8(from, _mm512_min_epu8(_mm512_subs_epu8(first, start), eight)),
        _mm512_shuffle_epi8(before, _mm512_min_epu8(_mm512_subs_epu8(end, start), eight)));
}

/// Appends the chosen of 64 ids of 16 bits. Stores whole vectors.
LIGHTBIN_TARGET inline void append_ids(std::uint16_t* to, __mmask64 chosen, __m512i low, __m512i high) {
    const __mmask32 chosen_low = static_cast<__mmask32>(chosen);
    store(to, compressed_words(chosen_low, low));
    store(to + std::popcount(chosen_low), compressed_words(static_cast<__mmask32>(chosen >> 32), high));
}

/// Stores 32 ids of 16 bits as Ids with the given upper bits.
template <class Id> LIGHTBIN_TARGET inline void store_ids(Id* to, __m512i ids, std::uint32_t upper) {
    if constexpr (sizeof(Id) == 2) {
        store(to, ids);
    } else {
        const __m512i base = _mm512_set1_epi32(static_cast<int>(upper));
        store(to, _mm512_or_si512(base, _mm512_cvtepu16_epi32(_mm512_castsi512_si256(ids))));
        store(to + 16, _mm512_or_si512(base, _mm512_cvtepu16_epi32(_mm512_extracti64x4_epi64(ids, 1))));
    }
}

/// Appends those of 64 ids (in two vectors of 16 bits) whose bit is set. Returns how many.
template <class Id>
LIGHTBIN_TARGET inline std::uint32_t append(Id* to, std::uint64_t lit, __m512i low, __m512i high,
                                            std::uint32_t upper) {
    const __m512i places = compressed_bytes(lit, load(counted<std::uint8_t>.data()));
    const std::uint32_t count = static_cast<std::uint32_t>(std::popcount(lit));
    const __m512i first = _mm512_cvtepu8_epi16(_mm512_castsi512_si256(places));
    store_ids(to, _mm512_permutex2var_epi16(low, first, high), upper);
    if (count > 32) {
        const __m512i rest = _mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(places, 1));
        store_ids(to + 32, _mm512_permutex2var_epi16(low, rest, high), upper);
    }
    return count;
}

/// Fills scratch.blocks; returns how many there are.
template <class Id> std::size_t make_blocks(const BinJob<Id>& job, Scratch& scratch) {
    std::size_t count = 0;
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin, end; i < run.end; i = end) {
            const std::uint32_t* ids = job.lights.ids;
            const std::uint32_t upper = ids[i] & 0xffff0000, last = upper | 0xffff;
            end = ids[run.end - 1] <= last
                      ? run.end
                      : static_cast<std::uint32_t>(std::upper_bound(ids + i, ids + run.end, last) - ids);
            IdBlock* const blocks = scratch.blocks.room(count + 1, count);
            if (count > 0 && blocks[count - 1].upper == upper && end - blocks[count - 1].begin <= 0x10000)
                blocks[count - 1].end = end;
            else
                blocks[count++] = {i, end, upper};
        }
    return count;
}

/// Lists of one band and panel, each of `stride` places: ids of 16 bits, or, where lights get words, places
/// within the block; and its lights' columns and rows.
struct BandLists {
    std::size_t stride;
    std::uint8_t *x0, *x1, *rows;
    std::uint16_t* ids;
    std::uint32_t* ends;  ///< of each block, rounded up to 64 but for the last
};

/// 64 lights of such a list.
struct Chunk {
    __m512i x0, x1, rows, low_ids, high_ids;
};

LIGHTBIN_TARGET inline Chunk load_chunk(const BandLists& lists, std::size_t from) {
    return {load(lists.x0 + from), load(lists.x1 + from), load(lists.rows + from), load(lists.ids + from),
            load(lists.ids + from + 32)};
}

/// Step 1, for `bands` bands from tile row `first_row` on. List (band, panel) is number band * panels + panel.
template <bool with_words, class Id>
LIGHTBIN_TARGET BandLists fill_bands(const BinJob<Id>& job, Scratch& scratch, std::size_t block_count,
                                     unsigned first_row, unsigned bands, unsigned panels) {
    const FootprintArrays& lights = job.lights;
    const IdBlock* blocks = scratch.blocks.data();
    const std::size_t lists = std::size_t{bands} * panels;
    const std::uint64_t stride =
        std::uint64_t{job.visible} + 64 * block_count + 192;  // whole vectors are stored and read
    BandLists to = {};
    to.stride = static_cast<std::size_t>(stride);
    to.x0 = scratch.band_x0.room(lists * stride);
    to.x1 = scratch.band_x1.room(lists * stride);
    to.rows = scratch.band_rows.room(lists * stride);
    to.ids = scratch.band_ids.room(lists * stride);
    to.ends = scratch.block_ends.room(lists * block_count);
    std::uint32_t* size = scratch.band_size.room(lists);
    std::fill_n(size, lists, 0u);
    for (std::size_t block = 0; block < block_count; ++block) {
        for (const FootprintRun& run : job.runs) {
            const std::size_t end = (std::min)(run.end, blocks[block].end);
            for (std::size_t i = (std::max)(run.begin, blocks[block].begin); i < end; i += 64) {
                const __m512i first_y = load_from(lights.y0 + i, 0, first_row),
                              end_y = load_from(lights.y1 + i, 1, first_row);
                const __mmask64 valid = first_lanes(end - i);
                __m512i low_ids, high_ids;
                if constexpr (with_words) {
                    low_ids =
                        _mm512_add_epi16(load(counted<std::uint16_t>.data()),
                                         _mm512_set1_epi16(static_cast<short>(i - blocks[block].begin)));
                    high_ids = _mm512_add_epi16(low_ids, _mm512_set1_epi16(32));
                } else {
                    low_ids = load_low_halves(lights.ids + i);
                    high_ids = load_low_halves(lights.ids + i + 32);
                }
                for (unsigned panel = 0; panel < panels; ++panel) {
                    const __m512i first_x = load_from(lights.x0 + i, 0, 8 * panel_side * panel),
                                  end_x = load_from(lights.x1 + i, 1, 8 * panel_side * panel);
                    __mmask64 in_panel = valid;
                    if (panels > 1)
                        in_panel = _mm512_mask_cmplt_epu8_mask(
                            _mm512_mask_test_epi8_mask(valid, end_x, end_x), first_x,
                            _mm512_set1_epi8(static_cast<char>(8 * panel_side)));
                    if (in_panel == 0) continue;
                    for (unsigned band = 0; band < bands; ++band) {
                        const __m512i here = covered_bytes(first_y, end_y, 8 * band);
                        const __mmask64 chosen = _mm512_mask_test_epi8_mask(in_panel, here, here);
                        const std::size_t list = std::size_t{band} * panels + panel,
                                          at = list * to.stride + size[list];
                        store(to.x0 + at, compressed_bytes(chosen, first_x));
                        store(to.x1 + at, compressed_bytes(chosen, end_x));
                        store(to.rows + at, compressed_bytes(chosen, here));
                        append_ids(to.ids + at, chosen, low_ids, high_ids);
                        size[list] += static_cast<std::uint32_t>(std::popcount(chosen));
                    }
                }
            }
        }
        for (std::size_t list = 0; list < lists; ++list) {
            if (block + 1 < block_count) {
                // x1 = 0: covers no column
                store(to.x1 + list * to.stride + size[list], _mm512_setzero_si512());
                size[list] = (size[list] + 63) & ~63u;
            }
            to.ends[list * block_count + block] = size[list];
        }
    }
    return to;
}

/// The bits of `mask` swapped with those `distance` above.
template <unsigned distance> LIGHTBIN_TARGET inline __m512i swapped(__m512i v, long long mask) {
    const __m512i t =
        _mm512_and_si512(_mm512_xor_si512(v, _mm512_srli_epi64(v, distance)), _mm512_set1_epi64(mask));
    return _mm512_xor_si512(v, _mm512_xor_si512(t, _mm512_slli_epi64(t, distance)));
}

/// Eight times 8x8 bits turned, see the scalar one.
LIGHTBIN_TARGET inline __m512i turned(__m512i x) {
    x = swapped<7>(x, 0x00aa00aa00aa00aa);
    x = swapped<14>(x, 0x0000cccc0000cccc);
    return swapped<28>(x, 0x00000000f0f0f0f0);
}

/// Short lists, of up to 8, 16 or 31 lights: `blocks` = 1, 2 or 4 vectors of 8 lights' words, a bit a tile. For
/// each row of the supertile stores, after one another, the 8 tiles' bits, a bit a light: `blocks` words a row.
/// Before them, for each row, 8 bytes: the running number of set bits up to and with each tile, at most 248.
template <unsigned blocks>
LIGHTBIN_TARGET inline void store_rows(__m512i (&lights)[blocks], std::uint64_t* to) {
    for (__m512i& v : lights)  // a word a row, a byte a tile
        v = turned(_mm512_permutexvar_epi8(load(turned_bytes.data()), v));
    __m512i sums;
    if constexpr (blocks == 1) {
        store(to + 8, lights[0]);
        sums = _mm512_popcnt_epi8(lights[0]);
    } else {
        const __m512i bytes = load(in_turn<std::uint8_t>.data()),
                      more_bytes = _mm512_add_epi8(bytes, _mm512_set1_epi8(32));
        const __m512i low = _mm512_permutex2var_epi8(lights[0], bytes, lights[1]),
                      high = _mm512_permutex2var_epi8(lights[0], more_bytes, lights[1]);
        if constexpr (blocks == 2) {
            store(to + 8, low);
            store(to + 16, high);
            sums = halves(_mm512_cvtepi16_epi8(_mm512_popcnt_epi16(low)),
                          _mm512_cvtepi16_epi8(_mm512_popcnt_epi16(high)));
        } else {
            const __m512i low2 = _mm512_permutex2var_epi8(lights[2], bytes, lights[3]),
                          high2 = _mm512_permutex2var_epi8(lights[2], more_bytes, lights[3]);
            const __m512i pairs = load(in_turn<std::uint16_t>.data()),
                          more_pairs = _mm512_add_epi16(pairs, _mm512_set1_epi16(16));
            const __m512i rows[] = {_mm512_permutex2var_epi16(low, pairs, low2),
                                    _mm512_permutex2var_epi16(low, more_pairs, low2),
                                    _mm512_permutex2var_epi16(high, pairs, high2),
                                    _mm512_permutex2var_epi16(high, more_pairs, high2)};
            __m128i sum[4];
            for (unsigned i = 0; i < 4; ++i) {
                store(to + 8 + 8 * i, rows[i]);
                sum[i] = _mm512_cvtepi32_epi8(_mm512_popcnt_epi32(rows[i]));
            }
            sums = halves(_mm256_set_m128i(sum[1], sum[0]), _mm256_set_m128i(sum[3], sum[2]));
        }
    }
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 8));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 16));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 32));
    store(to, sums);
}

/// The same for a list given by the words of its lights, or by their columns and rows.
template <bool with_words, unsigned blocks>
LIGHTBIN_TARGET inline void store_rows(const std::uint64_t* masks, const std::uint8_t* columns,
                                       const std::uint8_t* rows, std::uint32_t count, std::uint64_t* to) {
    __m512i lights[blocks];
    for (unsigned i = 0; i < blocks; ++i) {
        const std::uint32_t left = count > 8 * i ? count - 8 * i : 0;
        if constexpr (with_words) {
            lights[i] = _mm512_maskz_loadu_epi64(static_cast<__mmask8>(first_lanes(left)), masks + 8 * i);
        } else {
            // A light's byte of columns in each row it covers: its byte of rows is the mask.
            std::uint64_t covered_rows;
            std::memcpy(&covered_rows, rows + 8 * i, 8);
            lights[i] = _mm512_maskz_permutexvar_epi8(
                covered_rows & first_lanes(8 * left),
                _mm512_add_epi8(load(eight_each.data()), _mm512_set1_epi8(static_cast<char>(8 * i))),
                load(columns));
        }
    }
    store_rows(lights, to);
}

/// Appends a row of a supertile with a short list, `words` from store_rows, and its `columns` tiles. Returns
/// how many ids.
template <unsigned blocks, class Id>
LIGHTBIN_TARGET inline std::uint32_t append_row(Id* to, Tile* tiles, __mmask8 columns, std::uint32_t at,
                                                const std::uint64_t* words, unsigned row, __m512i ids,
                                                std::uint32_t upper) {
    // Tiles are pairs of 32 bits, offset and count: the difference of running sums.
    const std::uint64_t sums = words[row];
    const __m512i ends = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(static_cast<long long>(sums))),
                  begins = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(static_cast<long long>(sums << 8)));
    _mm512_mask_storeu_epi64(tiles, columns,
                             _mm512_or_si512(_mm512_add_epi32(begins, _mm512_set1_epi64(at)),
                                             _mm512_slli_epi64(_mm512_sub_epi64(ends, begins), 32)));
    const __m512i light =
        _mm512_and_si512(load(counted<std::uint8_t>.data()), _mm512_set1_epi8(8 * blocks - 1));
    for (unsigned i = 0; i < blocks; ++i) {  // a word has 8 / blocks tiles
        const std::uint64_t lit = words[8 + blocks * row + i];
        const __m512i places = compressed_bytes(lit, light);
        const unsigned count = static_cast<unsigned>(std::popcount(lit));
        store_ids(to, _mm512_permutexvar_epi16(_mm512_cvtepu8_epi16(_mm512_castsi512_si256(places)), ids),
                  upper);
        if (count > 32)
            store_ids(
                to + 32,
                _mm512_permutexvar_epi16(_mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(places, 1)), ids),
                upper);
        to += count;
    }
    return static_cast<std::uint32_t>(sums >> 56);
}

/// For each of 8 bits, which of 64 bytes have it: words[bit * stride], one bit a byte.
LIGHTBIN_TARGET inline void split_bits(__m512i bytes, __mmask64 valid, std::uint64_t* words,
                                       std::size_t stride) {
    for (unsigned bit = 0; bit < 8; ++bit)
        words[bit * stride] =
            _mm512_mask_test_epi8_mask(valid, bytes, _mm512_set1_epi8(static_cast<char>(1 << bit)));
}

/// Turns the words of 64 lights, a bit a tile, into a word a tile, a bit a light.
LIGHTBIN_TARGET inline void turn_64_words(const std::uint64_t* lights, std::uint32_t count,
                                          std::uint64_t* tiles, std::size_t stride) {
    // Bytes first: in each vector of 8 lights, the bytes of one tile row side by side ...
    __m512i v[8], w[8];
    const __m512i by_row = load(turned_bytes.data());
    for (unsigned i = 0; i < 8; ++i)
        v[i] = _mm512_permutexvar_epi8(
            by_row,
            _mm512_maskz_loadu_epi64(static_cast<__mmask8>(first_lanes(count > 8 * i ? count - 8 * i : 0)),
                                     lights + 8 * i));
    // ... then those of all 64 lights, 8x8 words turned ...
    for (unsigned i = 0; i < 8; i += 2) {
        w[i] = _mm512_unpacklo_epi64(v[i], v[i + 1]);
        w[i + 1] = _mm512_unpackhi_epi64(v[i], v[i + 1]);
    }
    for (unsigned i = 0; i < 8; i += 4)
        for (unsigned odd = 0; odd < 2; ++odd) {
            v[i + odd] = _mm512_shuffle_i64x2(w[i + odd], w[i + odd + 2], 0x88);
            v[i + odd + 2] = _mm512_shuffle_i64x2(w[i + odd], w[i + odd + 2], 0xdd);
        }
    for (unsigned i = 0; i < 4; ++i) {
        split_bits(_mm512_shuffle_i64x2(v[i], v[i + 4], 0x88), ~__mmask64{0}, tiles + 8 * i * stride, stride);
        split_bits(_mm512_shuffle_i64x2(v[i], v[i + 4], 0xdd), ~__mmask64{0}, tiles + 8 * (i + 4) * stride,
                   stride);
    }
}

/// Step 3 for one row of tiles, `row` of its supertiles; lists of up to `up_to_8` lights have the form of one block.
/// Returns how many ids. A function of its own, as in a longer one compilers keep what it needs on the stack.
template <bool with_words, class Id>
LIGHTBIN_TARGET std::uint32_t append_tiles(Id* out, Tile* tiles, unsigned tiles_x, std::uint32_t at,
                                           const Scratch& scratch, unsigned row, std::uint32_t up_to_8) {
    const std::uint64_t* const all_words = scratch.words.data();
    const std::uint16_t* const all_ids = scratch.short_ids.data();
    const std::uint32_t* const all_uppers = scratch.uppers.data();
    const Id* const begin = out;
    const SupertileList* list = scratch.supertile_lists.data();
    for (const Tile* const end = tiles + tiles_x; tiles < end; tiles += 8, ++list) {
        const std::uint32_t count = list->count;
        const std::uint64_t* words = all_words + list->words;
        const std::uint16_t* ids = all_ids + list->ids;
        const std::uint32_t* uppers = all_uppers + list->ids / 64;
        const unsigned here = static_cast<unsigned>((std::min<std::ptrdiff_t>)(end - tiles, 8));
        if (count < 32) {
            const __mmask8 columns = static_cast<__mmask8>(0xff >> (8 - here));
            const __m512i table = load(ids);
            std::uint32_t n;
            if (count <= up_to_8)
                n = append_row<1>(out, tiles, columns, at, words, row, table, uppers[0]);
            else if (count <= 16)
                n = append_row<2>(out, tiles, columns, at, words, row, table, uppers[0]);
            else
                n = append_row<4>(out, tiles, columns, at, words, row, table, uppers[0]);
            out += n;
            at += n;
        } else if (count <= 64) {
            const __m512i low = load(ids), high = load(ids + 32);
            for (unsigned column = 0; column < here; ++column) {
                const std::uint64_t bits =
                    with_words ? words[row * 8 + column] : words[column] & words[8 + row];
                const std::uint32_t n = append(out, bits, low, high, uppers[0]);
                tiles[column] = {at, n};
                out += n;
                at += n;
            }
        } else {
            const std::size_t groups = (count + 63) / 64;
            for (unsigned column = 0; column < here; ++column) {
                const std::uint32_t from = at;
                for (std::uint32_t i = 0; i < count; i += 64) {
                    const std::uint64_t* w = words + i / 64;
                    const std::uint64_t bits = with_words ? w[(row * 8 + column) * groups]
                                                          : w[column * groups] & w[(8 + row) * groups];
                    const std::uint32_t n =
                        append(out, bits, load(ids + i), load(ids + i + 32), uppers[i / 64]);
                    out += n;
                    at += n;
                }
                tiles[column] = {from, at - from};
            }
        }
    }
    return static_cast<std::uint32_t>(out - begin);
}

/// Bins the tile rows of `bands`. Returns the number of entries. May write BandJob::slack ids past them.
template <Footprint footprint, DepthTest depth_test, class Id>
LIGHTBIN_TARGET std::uint64_t bin_compress(const BinJob<Id>& job, Scratch& scratch,
                                           const BandJob<Id>& bands) {
    constexpr bool with_words = masked<footprint, depth_test>;
    constexpr std::uint32_t group =
        with_words ? 64 : 16;  // words for 64 lights: one a tile, or column and row
    const unsigned tiles_x = static_cast<unsigned>(job.camera->x.tiles);
    const unsigned width = (tiles_x + 7) / 8, panels = (width + panel_side - 1) / panel_side;
    const std::size_t block_count = make_blocks(job, scratch);
    const IdBlock* blocks = scratch.blocks.data();
    SupertileList* in_row = scratch.supertile_lists.room(width);

    // As many bands in one pass over the lights as a panel has, where their lists' room stays within reason.
    const unsigned together = static_cast<unsigned>(std::clamp<std::uint64_t>(
        (std::uint64_t{1} << 26) / (std::uint64_t{job.visible} * panels + 1), 1, panel_side));

    BandLists lists = {};
    const unsigned band_count = (bands.end - bands.begin + 7) / 8;
    unsigned listed = 0, first_listed = 0;  // the bands that `lists` has
    Id* out = bands.out;
    std::uint32_t at = bands.at;
    for (unsigned band = 0; band < band_count; ++band) {
        const unsigned top = bands.begin + 8 * band, rows_here = (std::min)(8u, bands.end - top);
        if (band == listed) {
            first_listed = band;
            listed = (std::min)(band + together, band_count);
            lists = fill_bands<with_words>(job, scratch, block_count, top, listed - band, panels);
        }
        std::uint32_t longest = 0;
        for (std::size_t list = std::size_t{band - first_listed} * panels;
             list < (band - first_listed + 1) * panels; ++list)
            if (block_count > 0) longest = (std::max)(longest, lists.ends[(list + 1) * block_count - 1]);
        if (longest == 0) {
            avx2::fill_empty(job.tiles + top * std::size_t{tiles_x}, rows_here * std::size_t{tiles_x}, at);
            if (bands.spare_row - top < 8) out = bands.spare;
            continue;
        }
        std::uint8_t* columns = scratch.list_columns.room(longest + 192);
        std::uint8_t* rows = scratch.list_rows.room(longest + 192);
        std::uint64_t* masks = nullptr;
        if constexpr (with_words) masks = scratch.masks.room(longest + 64);
        // Empty lists share the words of one without a bit.
        std::uint32_t ids_used = 0, words_used = 24;
        std::fill_n(scratch.words.room(words_used), words_used, 0u);
        *scratch.uppers.room(1) = 0;
        // Lists of up to 8 have their own form where most are such: elsewhere it would be one more to mispredict.
        const std::uint32_t up_to_8 = longest <= 64 ? 8 : 0;
        Chunk chunk = {};
        for (unsigned x = 0; x < width; ++x) {  // step 2
            const std::size_t list = std::size_t{band - first_listed} * panels + x / panel_side,
                              list_begin = list * lists.stride;
            const std::uint32_t in_band = lists.ends[(list + 1) * block_count - 1];
            const bool one_chunk = in_band <= 64;
            if (one_chunk && x % panel_side == 0) chunk = load_chunk(lists, list_begin);
            std::uint16_t* ids =
                scratch.short_ids.room(std::uint64_t{ids_used} + in_band + 192, ids_used) + ids_used;
            float cells[cell_planes<depth_test> * 64];
            std::uint64_t lit = 0;
            bool arranged = false;
            std::uint32_t count = 0, i = 0;
            for (std::size_t block = 0; block < block_count; ++block) {
                const std::uint32_t block_begin = count, in_block = lists.ends[list * block_count + block];
                for (; i < in_block; i += 64) {
                    if (!one_chunk) chunk = load_chunk(lists, list_begin + i);
                    const __m512i here = covered_bytes(chunk.x0, chunk.x1, 8 * (x % panel_side));
                    const __mmask64 chosen =
                        _mm512_mask_test_epi8_mask(first_lanes(in_block - i), here, here);
                    if (chosen == 0) continue;
                    store(columns + count, compressed_bytes(chosen, here));
                    store(rows + count, compressed_bytes(chosen, chunk.rows));
                    append_ids(ids + count, chosen, chunk.low_ids, chunk.high_ids);
                    count += static_cast<std::uint32_t>(std::popcount(chosen));
                }
                if constexpr (with_words)
                    if (count > block_begin) {
                        if (depth_test != DepthTest::none && !arranged)
                            lit = avx2::arrange_cells<depth_test>(job, x, top, cells);
                        arranged = true;
                        count = block_begin +
                                mask_lights<footprint, depth_test>(job, x, top, cells, lit, ids + block_begin,
                                                                   blocks[block].begin, columns + block_begin,
                                                                   rows + block_begin, count - block_begin,
                                                                   masks + block_begin);
                    }
                const std::uint32_t end = (count + 63) & ~63u, group_begin = (ids_used + block_begin) / 64,
                                    group_end = (ids_used + end) / 64;
                std::uint32_t* uppers = scratch.uppers.room(group_end, group_begin);
                for (std::uint32_t g = group_begin; g < group_end; ++g)
                    uppers[g] = blocks[block].upper;
                if (block + 1 < block_count) {
                    store(columns + count, _mm512_setzero_si512());
                    if constexpr (with_words) std::memset(masks + count, 0, (end - count) * sizeof *masks);
                    count = end;
                }
            }
            in_row[x] = {};
            if (count == 0) continue;
            in_row[x] = {count, ids_used, words_used};
            const std::uint32_t needed =
                count < 32 ? 40 : (count + 63) / 64 * group;  // short lists: see store_rows
            std::uint64_t* words =
                scratch.words.room(std::uint64_t{words_used} + needed, words_used) + words_used;
            if (count <= up_to_8) {
                store_rows<with_words, 1>(masks, columns, rows, count, words);
            } else if (count <= 16) {
                store_rows<with_words, 2>(masks, columns, rows, count, words);
            } else if (count < 32) {
                store_rows<with_words, 4>(masks, columns, rows, count, words);
            } else {
                // A tile's, or column's or row's, words lie side by side.
                const std::uint32_t groups = (count + 63) / 64;
                for (std::uint32_t j = 0; j < count; j += 64, ++words) {
                    if constexpr (with_words) {
                        turn_64_words(masks + j, count - j, words, groups);
                    } else {
                        split_bits(load(columns + j), first_lanes(count - j), words, groups);
                        split_bits(load(rows + j), first_lanes(count - j), words + 8 * groups, groups);
                    }
                }
            }
            words_used += needed;
            ids_used += (count + 63) & ~63u;
        }
        for (unsigned row = 0; row < rows_here; ++row) {  // step 3
            if (top + row == bands.spare_row) out = bands.spare;
            const std::uint32_t n = append_tiles<with_words>(
                out, job.tiles + (top + row) * std::size_t{tiles_x}, tiles_x, at, scratch, row, up_to_8);
            out += n;
            at += n;
        }
    }
    return at - bands.at;
}
