// SPDX-License-Identifier: MIT
// Step 3 of bin.inl on AVX-512, and the forms of the words that it reads. A compress instruction moves the places
// of the set bits of 64 together, and a permutation makes ids of them.
//
// - Lists of up to 8, 16 or 31 lights: a compress does 8, 4 or 2 tiles of a row at once. For each row its 8 tiles'
//   bits, a bit a light, 1, 2 or 4 words a row; before them the running numbers of set bits.
// - Longer ones: a word a tile, a bit a light, for each 64 lights.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A vector's bytes: place(0), place(1) ...
template <class Place> constexpr std::array<std::uint8_t, 64> table_of(Place place) {
    std::array<std::uint8_t, 64> table = {};
    for (unsigned i = 0; i < table.size(); ++i)
        table[i] = static_cast<std::uint8_t>(place(i));
    return table;
}
/// 0, 1, 2 ...
inline constexpr auto byte_places = table_of([](unsigned i) { return i; });
/// 0 eight times, 1 eight times ...
inline constexpr auto eight_each = table_of([](unsigned i) { return i / 8; });
/// Permutation of 64 bytes that transposes 8x8 of them.
inline constexpr auto byte_transpose = table_of([](unsigned i) { return i % 8 * 8 + i / 8; });
/// Permutation of two vectors that takes a byte of each in turn, from the first half of both.
inline constexpr auto interleave = table_of([](unsigned i) { return i / 2 + i % 2 * 64; });

inline __m512i load(const void* p) {
    return _mm512_loadu_si512(p);
}
inline void store(void* p, __m512i v) {
    _mm512_storeu_si512(p, v);
}

/// Up to 64 ids of a list: the lower 16 bits of each in two vectors, and the upper ones that they share. These are
/// read only by functions that are `wide`: some ids of the grid have upper bits.
struct IdTable {
    __m512i low, high;
    std::uint32_t upper;
};

/// The ids of a list, and of each 64 of them the number of their block.
struct GroupedIds {
    const std::uint16_t* ids;
    const std::uint32_t* group_blocks;
    const IdBlock* blocks;
};

/// Those of a group of 64.
inline IdTable load_table(const GroupedIds& list, std::size_t group) {
    const std::uint16_t* const ids = list.ids + 64 * group;
    return {load(ids), load(ids + 32), list.blocks[list.group_blocks[group]].upper};
}

/// Stores the ids at 32 places of a table with up to `lights`.
template <unsigned lights, bool wide, class Id>
inline void store_32(Id* to, const IdTable& table, __m256i places) {
    const __m512i at = _mm512_cvtepu8_epi16(places);
    const __m512i ids = lights <= 32 ? _mm512_permutexvar_epi16(at, table.low)
                                     : _mm512_permutex2var_epi16(table.low, at, table.high);
    if constexpr (sizeof(Id) == 2) {
        store(to, ids);
    } else {
        __m512i low = _mm512_cvtepu16_epi32(_mm512_castsi512_si256(ids)),
                high = _mm512_cvtepu16_epi32(_mm512_extracti64x4_epi64(ids, 1));
        if constexpr (wide) {
            const __m512i upper = _mm512_set1_epi32(static_cast<int>(table.upper));
            low = _mm512_or_si512(upper, low);
            high = _mm512_or_si512(upper, high);
        }
        store(to, low);
        store(to + 16, high);
    }
}

/// Appends the ids of a table with up to `lights` whose bit is set, of one tile after another, `lights` bits each;
/// then more that mean nothing. Returns how many.
template <unsigned lights, bool wide, class Id>
inline std::uint32_t append(Id* to, std::uint64_t lit, const IdTable& table) {
    const std::uint32_t count = static_cast<std::uint32_t>(std::popcount(lit));
    const __m512i numbers =
        _mm512_and_si512(load(byte_places.data()), _mm512_set1_epi8(static_cast<char>(lights - 1)));
    const __m512i places = compressed_bytes(lit, numbers);
    store_32<lights, wide>(to, table, _mm512_castsi512_si256(places));
    if (count > 32) store_32<lights, wide>(to + 32, table, _mm512_extracti64x4_epi64(places, 1));
    return count;
}

/// The bits of `mask` swapped with those `distance` above.
template <unsigned distance> inline __m512i swap_bits(__m512i v, long long mask) {
    const __m512i t =
        _mm512_and_si512(_mm512_xor_si512(v, _mm512_srli_epi64(v, distance)), _mm512_set1_epi64(mask));
    return _mm512_xor_si512(v, _mm512_xor_si512(t, _mm512_slli_epi64(t, distance)));
}

/// Eight times 8x8 bits, as transpose_bits().
inline __m512i transpose_bits(__m512i x) {
    x = swap_bits<7>(x, 0x00aa00aa00aa00aa);
    x = swap_bits<14>(x, 0x0000cccc0000cccc);
    return swap_bits<28>(x, 0x00000000f0f0f0f0);
}

/// The words of a list of up to 8 or 16 lights, given by the words of its lights or by their columns and rows. For each
/// row of the supertile stores, after one another, the 8 tiles' bits, a bit a light: `eights` words a row. Before them,
/// for each row, 8 bytes: the running number of set bits up to and with each tile, at most 248.
template <bool with_words, unsigned eights>
inline void store_short_words(const std::uint64_t* masks, const std::uint8_t* columns,
                                              const std::uint8_t* rows, std::uint32_t count,
                                              std::uint64_t* to) {
    __m512i lights[eights];
    for (unsigned i = 0; i < eights; ++i) {
        const std::uint32_t left = count > 8 * i ? count - 8 * i : 0;
        if constexpr (with_words) {
            lights[i] = _mm512_maskz_loadu_epi64(static_cast<__mmask8>(first_bytes(left)), masks + 8 * i);
        } else {
            // A light's byte of columns in each row it covers: its byte of rows is the mask.
            std::uint64_t covered_rows;
            std::memcpy(&covered_rows, rows + 8 * i, 8);
            lights[i] = _mm512_maskz_permutexvar_epi8(
                covered_rows & first_bytes(8 * left),
                _mm512_add_epi8(load(eight_each.data()), _mm512_set1_epi8(static_cast<char>(8 * i))),
                load(columns));
        }
        // From a word a light, a bit per tile, to a word a row, a byte per tile.
        lights[i] = transpose_bits(_mm512_permutexvar_epi8(load(byte_transpose.data()), lights[i]));
    }
    __m512i sums;
    if constexpr (eights == 1) {
        store(to + 8, lights[0]);
        sums = _mm512_popcnt_epi8(lights[0]);
    } else {
        const __m512i bytes = load(interleave.data()), more = _mm512_add_epi8(bytes, _mm512_set1_epi8(32));
        const __m512i low = _mm512_permutex2var_epi8(lights[0], bytes, lights[1]),
                      high = _mm512_permutex2var_epi8(lights[0], more, lights[1]);
        store(to + 8, low);
        store(to + 16, high);
        sums = _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi16_epi8(_mm512_popcnt_epi16(low))),
                                  _mm512_cvtepi16_epi8(_mm512_popcnt_epi16(high)), 1);
    }
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 8));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 16));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 32));
    store(to, sums);
}

/// For each of 8 bits, which of 64 bytes have it: words[bit], one bit a byte.
inline void split_bits(__m512i bytes, std::uint64_t* words) {
    for (unsigned bit = 0; bit < 8; ++bit)
        words[bit] = _mm512_test_epi8_mask(bytes, _mm512_set1_epi8(static_cast<char>(1 << bit)));
}

/// Transposes the words of 64 lights, a bit per tile, to a word per tile, a bit a light.
inline void transpose_64_words(const std::uint64_t* lights, std::uint32_t count,
                                               std::uint64_t* tiles) {
    // Bytes first: in each vector of 8 lights, the bytes of one tile row side by side ...
    __m512i v[8], w[8];
    const __m512i by_row = load(byte_transpose.data());
    for (unsigned i = 0; i < 8; ++i)
        v[i] = _mm512_permutexvar_epi8(
            by_row,
            _mm512_maskz_loadu_epi64(static_cast<__mmask8>(first_bytes(count > 8 * i ? count - 8 * i : 0)),
                                     lights + 8 * i));
    // ... then those of all 64 lights, 8x8 words transposed ...
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
        split_bits(_mm512_shuffle_i64x2(v[i], v[i + 4], 0x88), tiles + 8 * i);
        split_bits(_mm512_shuffle_i64x2(v[i], v[i + 4], 0xdd), tiles + 8 * (i + 4));
    }
}

/// The columns and rows of 64 lights, or `count` if those are fewer.
struct Rectangles {
    Rectangles(const std::uint8_t* columns, const std::uint8_t* rows, std::uint32_t count) {
        split_bits(_mm512_maskz_loadu_epi8(first_bytes(count), columns), in_column);
        split_bits(load(rows), in_row);
    }
    /// The words of the tiles of a row, a bit a light.
    __m512i row_words(unsigned row) const {
        return _mm512_and_si512(load(in_column), _mm512_set1_epi64(static_cast<long long>(in_row[row])));
    }

    std::uint64_t in_column[8], in_row[8];
};

/// The words of 64 lights of a list, from `first` on or as many as it has: a word a tile, a bit a light. For long lists.
template <bool with_words>
inline void store_64_words(const std::uint64_t* masks, const std::uint8_t* columns,
                                           const std::uint8_t* rows, std::uint32_t first, std::uint32_t count,
                                           std::uint64_t* tiles) {
    if constexpr (with_words) {
        transpose_64_words(masks + first, count - first, tiles);
    } else {
        const Rectangles lights(columns + first, rows + first, count - first);
        for (unsigned row = 0; row < 8; ++row)
            store(tiles + 8 * row, lights.row_words(row));
    }
}

/// Of 16 lights at most, those that miss the boxes of a supertile: missed[4 * tile], a bit a light.
template <class Light>
inline void store_missed(const Camera& camera, const SupertileBoxes& boxes,
                                         const Light* lights_by_id, const ListId* places, std::uint32_t count,
                                         std::uint16_t* missed) {
    const float* const(&ends)[4] = boxes.slab.ends;
    const auto lights = load_slab_lights(camera, boxes.slab, lights_by_id, places, count);
    constexpr unsigned tests = decltype(lights)::tests;
    Floats by_column[tests][8];
    for (unsigned test = 0; test < tests; ++test)
        for (unsigned column = 0; column < 8; ++column)
            by_column[test][column] = lights.by_column(test, ends[0][column], ends[1][column]);
    for (unsigned row = 0; row < boxes.rows; ++row) {
        Floats left[tests];
        for (unsigned test = 0; test < tests; ++test)
            left[test] = lights.left_by_row(test, ends[2][row], ends[3][row]);
        for (unsigned column = 0; column < 8; ++column, missed += 4) {
            *missed = less(left[0], by_column[0][column]);
            for (unsigned test = 1; test < tests; ++test)
                *missed = either(*missed, less(left[test], by_column[test][column]));
        }
    }
}

/// Stores a row of a short list in the form of store_short_words(), out of a word a tile.
template <unsigned eights>
inline void store_short_row(__m512i tiles, unsigned row, std::uint64_t* to) {
    const __m128i sizes = _mm512_cvtepi64_epi8(_mm512_popcnt_epi64(tiles));
    to[row] = static_cast<std::uint64_t>(_mm_cvtsi128_si64(sizes)) * 0x0101010101010101;  // running sums
    std::uint64_t* const words = to + 8 + eights * row;
    if constexpr (eights == 1)
        _mm_storel_epi64(reinterpret_cast<__m128i*>(words), _mm512_cvtepi64_epi8(tiles));
    else if constexpr (eights == 2)
        _mm_storeu_si128(reinterpret_cast<__m128i*>(words), _mm512_cvtepi64_epi16(tiles));
    else
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(words), _mm512_cvtepi64_epi32(tiles));
}

/// Stores the words that empty lists, whose `words` is 0, share: of a short one without a bit. Returns where they
/// end.
inline std::uint32_t store_no_words(Scratch& scratch) {
    constexpr std::uint32_t size = 24;
    fill_items(scratch.words.reserve(size), size, 0);
    return size;
}

/// How many words a list of `count` lights takes.
inline std::uint32_t words_of(std::uint32_t count) {
    return count < 32 ? 40 : (count + 63) / 64 * 64;
}

/// Stores the words of a list at list.words of scratch.words. Returns where they end.
template <bool with_words, class Id>
inline std::uint32_t store_words(Scratch& scratch, const BandLists<ListId>&,
                                                 const SupertileList& list) {
    const std::uint32_t count = list.count, end = list.words + words_of(count);
    std::uint64_t* const words = scratch.words.reserve(end, list.words) + list.words;
    const std::uint64_t* masks = scratch.masks.data();
    const std::uint8_t* columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* rows = scratch.list_rows.data() + list.begin;
    if (count <= 8) {
        store_short_words<with_words, 1>(masks, columns, rows, count, words);
    } else if (count <= 16) {
        store_short_words<with_words, 2>(masks, columns, rows, count, words);
    } else if (count < 32) {
        std::uint64_t tiles[64];
        store_64_words<with_words>(masks, columns, rows, 0, count, tiles);
        for (unsigned row = 0; row < 8; ++row)
            store_short_row<4>(load(tiles + 8 * row), row, words);
    } else {
        for (std::uint32_t i = 0; i < count; i += 64)
            store_64_words<with_words>(masks, columns, rows, i, count, words + i);
    }
    return end;
}

/// Makes the words of a list, by the boxes of the supertile from column 8 x and row `top` on, and stores them as
/// store_words() does.
template <bool spots, class Id>
inline std::uint32_t store_slab_words(const BinJob<Id>& job, Scratch& scratch, unsigned x,
                                                      unsigned top, const BandLists<ListId>& band,
                                                      const SupertileList& list) {
    const std::uint32_t count = list.count, end = list.words + words_of(count);
    std::uint64_t* const words = scratch.words.reserve(end, list.words) + list.words;
    const SupertileBoxes boxes = boxes_at(job, scratch, x, top);
    for (std::uint32_t i = 0; i < count; i += 64) {
        const std::uint32_t begin = list.begin + i, left = min_of(count - i, 64u);
        const IdBlock& block = scratch.blocks.data()[scratch.group_blocks.data()[begin / 64]];
        std::uint16_t missed[4 * 64];
        for (std::uint32_t j = 0; j < left; j += lanes)
            store_missed(*job.camera, boxes, lights_of<spots>(job) + block.upper, band.ids + begin + j,
                         left - j, missed + j / 16);
        const Rectangles lights(scratch.list_columns.data() + begin, scratch.list_rows.data() + begin, left);
        for (unsigned row = 0; row < boxes.rows; ++row) {
            const __m512i tiles = _mm512_andnot_si512(load(missed + 32 * row), lights.row_words(row));
            if (count <= 8)
                store_short_row<1>(tiles, row, words);
            else if (count <= 16)
                store_short_row<2>(tiles, row, words);
            else if (count < 32)
                store_short_row<4>(tiles, row, words);
            else
                store(words + i + 8 * row, tiles);
        }
    }
    return end;
}

/// Appends a row of a supertile with a short list, `words` from store_short_words, and its `columns` tiles. Returns
/// how many ids.
template <unsigned eights, bool wide, class Id>
inline std::uint32_t append_row(Id* to, ListRange* tiles, __mmask8 columns, std::uint32_t at,
                                                const std::uint64_t* words, unsigned row,
                                                const IdTable& table) {
    // Tiles are pairs of 32 bits, offset and count: the difference of running sums.
    const std::uint64_t sums = words[row];
    const __m512i ends = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(static_cast<long long>(sums))),
                  begins = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(static_cast<long long>(sums << 8)));
    _mm512_mask_storeu_epi64(tiles, columns,
                             _mm512_or_si512(_mm512_add_epi32(begins, _mm512_set1_epi64(at)),
                                             _mm512_slli_epi64(_mm512_sub_epi64(ends, begins), 32)));
    for (unsigned i = 0; i < eights; ++i)  // a word has 8 / eights tiles
        to += append<8 * eights, wide>(to, words[8 + eights * row + i], table);
    return static_cast<std::uint32_t>(sums >> 56);
}

/// Appends the tiles of a row of a supertile with a longer list: `words` has those of its first tile. Returns how many
/// ids. With 64 lights or less their ids stay in registers.
template <bool wide, bool up_to_64, class Id>
inline std::uint32_t append_tiles(Id* to, ListRange* tiles, unsigned columns,
                                                  std::uint32_t at, const std::uint64_t* words,
                                                  const GroupedIds& ids, std::uint32_t lights) {
    const Id* const begin = to;
    const std::size_t groups = up_to_64 ? 1 : (lights + std::size_t{63}) / 64;
    const IdTable first = load_table(ids, 0);
    for (unsigned column = 0; column < columns; ++column) {
        const Id* const from = to;
        for (std::size_t group = 0; group < groups; ++group)
            to += append<64, wide>(to, words[64 * group + column], up_to_64 ? first : load_table(ids, group));
        const std::uint32_t count = static_cast<std::uint32_t>(to - from);
        tiles[column] = {at, count};
        at += count;
    }
    return static_cast<std::uint32_t>(to - begin);
}

/// Emits a row of tiles as emit_row() does. Not inline, as in a longer function compilers keep what it needs on the
/// stack.
template <bool wide, class Id>
LIGHTBIN_NOINLINE Id* emit_tiles(Id* out, ListRange* tiles, unsigned tiles_x,
                                                 std::uint32_t at, const Scratch& scratch,
                                                 const BandLists<ListId>& band, unsigned row) {
    const std::uint32_t* const group_blocks = scratch.group_blocks.data();
    const IdBlock* const blocks = scratch.blocks.data();
    const SupertileList* list = band.lists;
    const std::uint64_t* const all_words = scratch.words.data();
    for (const ListRange* const end = tiles + tiles_x; tiles < end; tiles += 8, ++list) {
        const std::uint32_t lights = list->count;
        const std::uint64_t* words = all_words + list->words;
        const GroupedIds ids = {band.ids + list->begin, group_blocks + list->begin / 64, blocks};
        const unsigned columns = static_cast<unsigned>(min_of<std::ptrdiff_t>(end - tiles, 8));
        const __mmask8 stored = static_cast<__mmask8>(0xff >> (8 - columns));
        std::uint32_t count;
        if (lights <= 8)
            count = append_row<1, wide>(out, tiles, stored, at, words, row, load_table(ids, 0));
        else if (lights <= 16)
            count = append_row<2, wide>(out, tiles, stored, at, words, row, load_table(ids, 0));
        else if (lights < 32)
            count = append_row<4, wide>(out, tiles, stored, at, words, row, load_table(ids, 0));
        else if (lights <= 64)
            count = append_tiles<wide, true>(out, tiles, columns, at, words + 8 * row, ids, lights);
        else
            count = append_tiles<wide, false>(out, tiles, columns, at, words + 8 * row, ids, lights);
        out += count;
        at += count;
    }
    return out;
}

/// Emits a row of tiles, `row` of its supertiles. `at` is the offset of `out` in the index list. Returns the end.
template <bool with_words, class Id>
Id* emit_row(Id* out, ListRange* tiles, unsigned tiles_x, std::uint32_t at, const Scratch& scratch,
                             const BandLists<ListId>& band, unsigned row) {
    if constexpr (sizeof(Id) > 2)
        if (band.wide) return emit_tiles<true>(out, tiles, tiles_x, at, scratch, band, row);
    return emit_tiles<false>(out, tiles, tiles_x, at, scratch, band, row);
}

}}}}  // namespace lightbin::detail
