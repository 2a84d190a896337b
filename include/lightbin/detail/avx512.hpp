// SPDX-License-Identifier: MIT
// The AVX-512 tier: vectors of 16 lights, and a binning kernel of its own built on compress instructions.
#pragma once

#include <lightbin/detail/platform.hpp>

#if defined(LIGHTBIN_X86)

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/detail/supertile.hpp>

#include <bit>
#include <cstring>
#include <immintrin.h>

#define LIGHTBIN_TARGET                                                                                      \
    __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2,avx512bitalg,"          \
                          "avx512vpopcntdq,bmi,bmi2,popcnt")))

// gcc 12's own AVX-512 header gives these warnings, about values it leaves undefined on purpose.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace lightbin::detail {
inline namespace LIGHTBIN_FLAVOUR {
namespace avx512 {

using Floats = __m512;
using Doubles = __m512d;
using Mask = __mmask16;
using DoubleMask = __mmask8;
inline constexpr std::uint32_t lanes = 16, double_lanes = 8;

LIGHTBIN_TARGET inline Floats sqrt(Floats a) {
    return _mm512_sqrt_ps(a);
}
LIGHTBIN_TARGET inline Doubles sqrt(Doubles a) {
    return _mm512_sqrt_pd(a);
}

#include <lightbin/detail/vectors.inl>

LIGHTBIN_TARGET inline Mask less(Floats a, Floats b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
LIGHTBIN_TARGET inline DoubleMask less(Doubles a, Doubles b) {
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
}
LIGHTBIN_TARGET inline Mask less_equal(Floats a, Floats b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
LIGHTBIN_TARGET inline DoubleMask less_equal(Doubles a, Doubles b) {
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}
LIGHTBIN_TARGET inline Floats select(Mask mask, Floats a, Floats b) {
    return _mm512_mask_mov_ps(b, mask, a);
}
LIGHTBIN_TARGET inline Doubles select(DoubleMask mask, Doubles a, Doubles b) {
    return _mm512_mask_mov_pd(b, mask, a);
}
LIGHTBIN_TARGET inline Floats lesser(Floats a, Floats b) {
    return _mm512_min_ps(a, b);
}
LIGHTBIN_TARGET inline Floats greater(Floats a, Floats b) {
    return _mm512_max_ps(a, b);
}
LIGHTBIN_TARGET inline unsigned bits(unsigned mask) {
    return mask;
}

/// Half 0 or 1 of the lanes.
LIGHTBIN_TARGET inline Doubles widened(Floats a, unsigned half) {
    return _mm512_cvtps_pd(half == 0 ? _mm512_castps512_ps256(a) : _mm512_extractf32x8_ps(a, 1));
}

LIGHTBIN_TARGET inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z,
                                         Floats& radius) {
    const float* p = &spheres->x;
    const Floats s0 = _mm512_loadu_ps(p), s4 = _mm512_loadu_ps(p + 16);
    const Floats s8 = _mm512_loadu_ps(p + 32), s12 = _mm512_loadu_ps(p + 48);
    const Floats even_low = _mm512_shuffle_f32x4(s0, s4, 0x88), odd_low = _mm512_shuffle_f32x4(s0, s4, 0xdd);
    const Floats even_high = _mm512_shuffle_f32x4(s8, s12, 0x88),
                 odd_high = _mm512_shuffle_f32x4(s8, s12, 0xdd);
    const Floats a = _mm512_shuffle_f32x4(even_low, even_high, 0x88);  // spheres 0 4 8 12
    const Floats b = _mm512_shuffle_f32x4(odd_low, odd_high, 0x88);    // 1 5 9 13
    const Floats c = _mm512_shuffle_f32x4(even_low, even_high, 0xdd);  // 2 6 10 14
    const Floats d = _mm512_shuffle_f32x4(odd_low, odd_high, 0xdd);    // 3 7 11 15
    const Floats xy_low = _mm512_unpacklo_ps(a, b), zr_low = _mm512_unpackhi_ps(a, b);
    const Floats xy_high = _mm512_unpacklo_ps(c, d), zr_high = _mm512_unpackhi_ps(c, d);
    x = _mm512_shuffle_ps(xy_low, xy_high, 0x44);
    y = _mm512_shuffle_ps(xy_low, xy_high, 0xee);
    z = _mm512_shuffle_ps(zr_low, zr_high, 0x44);
    radius = _mm512_shuffle_ps(zr_low, zr_high, 0xee);
}

LIGHTBIN_TARGET inline void store_tiles(std::uint16_t* tiles, Floats values) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(tiles),
                        _mm512_cvtusepi32_epi16(_mm512_cvttps_epi32(values)));
}
LIGHTBIN_TARGET inline void store_tiles(std::uint16_t* tiles, Doubles values) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(tiles), _mm256_cvtepi32_epi16(_mm512_cvttpd_epi32(values)));
}

/// As the general append_visible, with compress instructions.
LIGHTBIN_TARGET inline void append_visible(const FootprintArrays& out, ProjectCounts& counts,
                                           std::uint32_t first_id, unsigned visible, const ChunkRects& rects,
                                           std::uint32_t first) {
    const Mask kept = static_cast<Mask>(visible);
    const __m256i x0 = _mm256_load_si256(reinterpret_cast<const __m256i*>(rects.x0 + first));
    const __m256i y0 = _mm256_load_si256(reinterpret_cast<const __m256i*>(rects.y0 + first));
    const __m256i x1 = _mm256_load_si256(reinterpret_cast<const __m256i*>(rects.x1 + first));
    const __m256i y1 = _mm256_load_si256(reinterpret_cast<const __m256i*>(rects.y1 + first));
    const std::uint32_t at = counts.visible;
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.x0 + at), _mm256_maskz_compress_epi16(kept, x0));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.y0 + at), _mm256_maskz_compress_epi16(kept, y0));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.x1 + at), _mm256_maskz_compress_epi16(kept, x1));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.y1 + at), _mm256_maskz_compress_epi16(kept, y1));
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i ids = _mm512_add_epi32(lane, _mm512_set1_epi32(static_cast<int>(first_id + first)));
    _mm512_storeu_si512(out.ids + at, _mm512_maskz_compress_epi32(kept, ids));
    counts.visible += static_cast<std::uint32_t>(std::popcount(visible));

    const __m512i one = _mm512_set1_epi32(1);
    const __m512i width = _mm512_add_epi32(_mm512_cvtepu16_epi32(_mm256_sub_epi16(x1, x0)), one);
    const __m512i height = _mm512_add_epi32(_mm512_cvtepu16_epi32(_mm256_sub_epi16(y1, y0)), one);
    const __m512i area = _mm512_maskz_mullo_epi32(kept, width, height);  // at most 2^30 each
    const __m512i sums = _mm512_add_epi64(_mm512_cvtepu32_epi64(_mm512_castsi512_si256(area)),
                                          _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64(area, 1)));
    counts.area += static_cast<std::uint64_t>(_mm512_reduce_add_epi64(sums));
}

#include <lightbin/detail/project.inl>

// Binning by supertiles of 8x8 tiles, as supertile.inl, but lists are made by compressing 64 lights at a time
// instead of inserting them one by one:
//
//   1. 64 lights' rows against each band of 8 tile rows: a saturating subtraction and two byte shuffles give
//      each light's byte of covered rows, zero if it misses the band. Those that do not are compressed onto
//      the band's list.
//   2. The same with the band's list and each supertile's 8 columns: the supertile's list, then its words.
//   3. Tiles in row-major order: the lights of tile (row, column) are rows[row] & columns[column]; their ids
//      are compressed onto the index list. A supertile of up to 8 lights takes one compress for 8 tiles.
//
// Coordinates are bytes and ids 16 bits here, so the grid is at most 248 x 248 tiles and the ids of one call
// share their upper 16 bits.

LIGHTBIN_TARGET inline __m512i load(const void* p) {
    return _mm512_loadu_si512(p);
}
LIGHTBIN_TARGET inline void store(void* p, __m512i v) {
    _mm512_storeu_si512(p, v);
}
LIGHTBIN_TARGET inline __m512i halves(__m256i low, __m256i high) {
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
LIGHTBIN_TARGET inline __m512i load_as_bytes(const std::uint16_t* p) {
    return halves(_mm512_cvtepi16_epi8(load(p)), _mm512_cvtepi16_epi8(load(p + 32)));
}
LIGHTBIN_TARGET inline __m512i load_as_words(const std::uint32_t* p) {
    return halves(_mm512_cvtepi32_epi16(load(p)), _mm512_cvtepi32_epi16(load(p + 16)));
}
LIGHTBIN_TARGET inline __mmask64 first_lanes(std::size_t count) {
    return count >= 64 ? ~__mmask64{0} : (__mmask64{1} << count) - 1;
}

/// Of each light first..end-1 (bytes), which of the 8 tiles from `begin` on it covers, a bit a tile.
LIGHTBIN_TARGET inline __m512i covered(__m512i first, __m512i end, unsigned begin) {
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
    store(to, _mm512_maskz_compress_epi16(chosen_low, low));
    store(to + std::popcount(chosen_low),
          _mm512_maskz_compress_epi16(static_cast<__mmask32>(chosen >> 32), high));
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
    const __m512i places = _mm512_maskz_compress_epi8(lit, load(every_byte.data()));
    const std::uint32_t count = static_cast<std::uint32_t>(std::popcount(lit));
    const __m512i first = _mm512_cvtepu8_epi16(_mm512_castsi512_si256(places));
    store_ids(to, _mm512_permutex2var_epi16(low, first, high), upper);
    if (count > 32) {
        const __m512i rest = _mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(places, 1));
        store_ids(to + 32, _mm512_permutex2var_epi16(low, rest, high), upper);
    }
    return count;
}

/// Step 1. Returns the lists' stride; their sizes are in band_size.
template <class Id>
LIGHTBIN_TARGET std::size_t fill_bands(const BinJob<Id>& job, Scratch& scratch, unsigned bands) {
    const FootprintArrays& lights = job.lights;
    const std::size_t stride = job.count + 192;  // whole vectors are stored and read
    std::uint8_t* x0 = scratch.band_x0.room(bands * stride);
    std::uint8_t* x1 = scratch.band_x1.room(bands * stride);
    std::uint8_t* rows = scratch.band_rows.room(bands * stride);
    std::uint16_t* ids = scratch.band_ids.room(bands * stride);
    std::uint32_t* size = scratch.band_size.room(bands);
    std::memset(size, 0, bands * sizeof *size);
    const __m512i one = _mm512_set1_epi8(1);
    for (std::size_t i = 0; i < job.count; i += 64) {
        const __m512i first_x = load_as_bytes(lights.x0 + i),
                      end_x = _mm512_add_epi8(load_as_bytes(lights.x1 + i), one);
        const __m512i first_y = load_as_bytes(lights.y0 + i),
                      end_y = _mm512_add_epi8(load_as_bytes(lights.y1 + i), one);
        const __m512i low_ids = load_as_words(lights.ids + i), high_ids = load_as_words(lights.ids + i + 32);
        const __mmask64 valid = first_lanes(job.count - i);
        for (unsigned band = 0; band < bands; ++band) {
            const __m512i here = covered(first_y, end_y, 8 * band);
            const __mmask64 chosen = _mm512_mask_test_epi8_mask(valid, here, here);
            const std::size_t to = band * stride + size[band];
            store(x0 + to, _mm512_maskz_compress_epi8(chosen, first_x));
            store(x1 + to, _mm512_maskz_compress_epi8(chosen, end_x));
            store(rows + to, _mm512_maskz_compress_epi8(chosen, here));
            append_ids(ids + to, chosen, low_ids, high_ids);
            size[band] += static_cast<std::uint32_t>(std::popcount(chosen));
        }
    }
    return stride;
}

/// 8x8 bits turned: byte i bit j to byte j bit i.
LIGHTBIN_TARGET inline long long turned(std::uint64_t bytes) {
    const __m512i bit = _mm512_setr_epi64(0x0101010101010101, 0x0202020202020202, 0x0404040404040404,
                                          0x0808080808080808, 0x1010101010101010, 0x2020202020202020,
                                          0x4040404040404040, static_cast<long long>(0x8080808080808080));
    return static_cast<long long>(
        _mm512_test_epi8_mask(_mm512_set1_epi64(static_cast<long long>(bytes)), bit));
}

/// The words of up to 8 lights: for each of 8 rows, 8 bytes (one a column) of 8 bits (one a light); after
/// them, for each row, the running number of set bits up to and with each byte.
LIGHTBIN_TARGET inline void small_words(const std::uint8_t* columns, const std::uint8_t* rows,
                                        std::uint32_t count, std::uint64_t* words) {
    const __m512i each_row =
        _mm512_setr_epi64(0, 0x0101010101010101, 0x0202020202020202, 0x0303030303030303, 0x0404040404040404,
                          0x0505050505050505, 0x0606060606060606, 0x0707070707070707);
    std::uint64_t column_bytes, row_bytes;
    std::memcpy(&column_bytes, columns, 8);
    std::memcpy(&row_bytes, rows, 8);
    if (count < 8) column_bytes &= (std::uint64_t{1} << 8 * count) - 1;
    const __m512i lit = _mm512_and_si512(_mm512_set1_epi64(turned(column_bytes)),
                                         _mm512_shuffle_epi8(_mm512_set1_epi64(turned(row_bytes)), each_row));
    __m512i sums = _mm512_popcnt_epi8(lit);
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 8));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 16));
    sums = _mm512_add_epi8(sums, _mm512_slli_epi64(sums, 32));
    store(words, lit);
    store(words + 8, sums);
}

/// Appends one row of a supertile of up to 8 lights, and its 8 offsets. Returns how many ids.
template <class Id>
LIGHTBIN_TARGET inline std::uint32_t append_small(Id* to, std::uint32_t* offsets, std::uint32_t at,
                                                  const std::uint64_t* words, const std::uint16_t* ids,
                                                  std::uint32_t upper) {
    const std::uint64_t lit = words[0], sums = words[8];
    const __m512i light = _mm512_and_si512(load(every_byte.data()), _mm512_set1_epi8(7));
    const __m512i places = _mm512_maskz_compress_epi8(lit, light);
    _mm256_storeu_si256(
        reinterpret_cast<__m256i*>(offsets),
        _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(at)),
                         _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(sums << 8)))));
    const __m512i table = _mm512_castsi128_si512(_mm_loadu_si128(reinterpret_cast<const __m128i*>(ids)));
    const std::uint32_t count = static_cast<std::uint32_t>(sums >> 56);
    store_ids(to, _mm512_permutexvar_epi16(_mm512_cvtepu8_epi16(_mm512_castsi512_si256(places)), table),
              upper);
    if (count > 32)
        store_ids(to + 32,
                  _mm512_permutexvar_epi16(_mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(places, 1)), table),
                  upper);
    return count;
}

/// One bit a tile of the supertile: !(light.max < low) && !(light.min > high).
LIGHTBIN_TARGET inline std::uint64_t tiles_met(const float* low, const float* high, DepthInterval light) {
    const Floats nearest = all(light.min), farthest = all(light.max);
    std::uint64_t met = 0;
    for (int i = 0; i < 64; i += 16)
        met |= std::uint64_t{_mm512_mask_cmp_ps_mask(
                   _mm512_cmp_ps_mask(farthest, _mm512_loadu_ps(low + i), _CMP_NLT_UQ), nearest,
                   _mm512_loadu_ps(high + i), _CMP_NGT_UQ)}
               << i;
    return met;
}

/// For each of 8 bits, which of 64 bytes have it: words[bit], one bit a byte.
LIGHTBIN_TARGET inline void split_bits(__m512i bytes, __mmask64 valid, std::uint64_t* words) {
    for (int bit = 0; bit < 8; ++bit)
        words[bit] = _mm512_mask_test_epi8_mask(valid, bytes, _mm512_set1_epi8(static_cast<char>(1 << bit)));
}

/// Returns the number of entries. May write BinJob::slack elements past the end of both arrays.
template <bool with_depth, class Id>
LIGHTBIN_TARGET std::uint64_t bin_compress(const BinJob<Id>& job, Scratch& scratch) {
    constexpr std::size_t group = Words<with_depth>::size;
    const unsigned tiles_x = static_cast<unsigned>(job.tiles_x), tiles_y = static_cast<unsigned>(job.tiles_y);
    const unsigned width = (tiles_x + 7) / 8, height = (tiles_y + 7) / 8;
    if constexpr (with_depth) arrange_bounds(job, scratch, width, height);
    const std::size_t stride = fill_bands(job, scratch, height);
    const std::uint32_t upper = job.count > 0 ? job.lights.ids[0] & 0xffff0000 : 0;
    std::uint32_t* size = scratch.list_size.room(width);
    std::uint32_t* begin = scratch.list_begin.room(width);
    std::uint32_t* first_word = scratch.word_begin.room(width);

    Id* out = job.indices;
    for (unsigned y = 0; y < height; ++y) {
        const std::uint32_t in_band = scratch.band_size.data()[y];
        std::uint8_t* columns = scratch.list_columns.room(in_band + 192);
        std::uint8_t* rows = scratch.list_rows.room(in_band + 192);
        std::uint32_t ids_used = 0, words_used = 0;
        for (unsigned x = 0; x < width; ++x) {  // step 2
            std::uint16_t* ids = scratch.short_ids.room(ids_used + in_band + 192, ids_used) + ids_used;
            std::uint32_t count = 0;
            for (std::uint32_t i = 0; i < in_band; i += 64) {
                const std::size_t from = y * stride + i;
                const __m512i here =
                    covered(load(scratch.band_x0.data() + from), load(scratch.band_x1.data() + from), 8 * x);
                const __mmask64 chosen = _mm512_mask_test_epi8_mask(first_lanes(in_band - i), here, here);
                store(columns + count, _mm512_maskz_compress_epi8(chosen, here));
                store(rows + count,
                      _mm512_maskz_compress_epi8(chosen, load(scratch.band_rows.data() + from)));
                append_ids(ids + count, chosen, load(scratch.band_ids.data() + from),
                           load(scratch.band_ids.data() + from + 32));
                count += static_cast<std::uint32_t>(std::popcount(chosen));
            }
            size[x] = count;
            begin[x] = ids_used;
            first_word[x] = words_used;
            const std::uint32_t needed = static_cast<std::uint32_t>((count + 63) / 64 * group);
            std::uint64_t* words = scratch.words.room(words_used + needed, words_used) + words_used;
            if (!with_depth && count > 0 && count <= 8) {
                small_words(columns, rows, count, words);
            } else {
                for (std::uint32_t i = 0; i < count; i += 64, words += group) {
                    const __mmask64 valid = first_lanes(count - i);
                    if constexpr (!with_depth) {
                        split_bits(load(columns + i), valid, words);
                        split_bits(load(rows + i), valid, words + 8);
                    } else {
                        const std::size_t list = y * width + x;
                        alignas(64) std::uint8_t by_row[8][64];
                        const std::uint32_t used = count - i < 64 ? count - i : 64;
                        for (std::uint32_t light = 0; light < used; ++light) {
                            const std::uint64_t tiles =
                                tiles_met(scratch.tile_min.data() + list * 64,
                                          scratch.tile_max.data() + list * 64,
                                          job.bounds.of(
                                              load_sphere(job.lights.spheres + (upper | ids[i + light])))) &
                                scratch.lit_tiles.data()[list];
                            for (unsigned row = 0; row < 8; ++row)
                                by_row[row][light] = static_cast<std::uint8_t>(tiles >> 8 * row);
                        }
                        const __m512i covers = load(columns + i), covered_rows = load(rows + i);
                        for (unsigned row = 0; row < 8; ++row)
                            split_bits(
                                _mm512_and_si512(covers, load(by_row[row])),
                                _mm512_mask_test_epi8_mask(valid, covered_rows,
                                                           _mm512_set1_epi8(static_cast<char>(1 << row))),
                                words + 8 * row);
                    }
                }
            }
            words_used += needed;
            ids_used += (count + 63) & ~63u;
        }
        const unsigned last_row = tiles_y - 8 * y < 8 ? tiles_y - 8 * y : 8;
        for (unsigned row = 0; row < last_row; ++row)  // step 3
            for (unsigned x = 0; x < width; ++x) {
                const std::uint32_t count = size[x];
                const std::uint64_t* words = scratch.words.data() + first_word[x];
                const std::uint16_t* ids = scratch.short_ids.data() + begin[x];
                std::uint32_t* offset = job.offsets + (8 * y + row) * std::size_t{tiles_x} + 8 * x;
                const std::uint32_t at = static_cast<std::uint32_t>(out - job.indices);
                const unsigned last_column = tiles_x - 8 * x < 8 ? tiles_x - 8 * x : 8;
                if (count == 0) {
                    _mm256_storeu_si256(reinterpret_cast<__m256i*>(offset),
                                        _mm256_set1_epi32(static_cast<int>(at)));
                } else if (!with_depth && count <= 8) {
                    out += append_small(out, offset, at, words + row, ids, upper);
                } else if (count <= 64) {
                    const __m512i low = load(ids), high = load(ids + 32);
                    for (unsigned column = 0; column < last_column; ++column) {
                        offset[column] = static_cast<std::uint32_t>(out - job.indices);
                        out += append(out, Words<with_depth>::of_tile(words, row, column), low, high, upper);
                    }
                } else {
                    for (unsigned column = 0; column < last_column; ++column) {
                        offset[column] = static_cast<std::uint32_t>(out - job.indices);
                        for (std::uint32_t i = 0; i < count; i += 64)
                            out +=
                                append(out, Words<with_depth>::of_tile(words + i / 64 * group, row, column),
                                       load(ids + i), load(ids + i + 32), upper);
                    }
                }
            }
    }
    return static_cast<std::uint64_t>(out - job.indices);
}

}  // namespace avx512
}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail

#undef LIGHTBIN_TARGET
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#endif
