// SPDX-License-Identifier: MIT
// transpose_words(), see portable.hpp, by instructions that every 64-bit x86 has. Included once a tier.

/// The bits of `mask` swapped with those `distance` above.
template <int distance> inline __m128i swap_bits(__m128i v, long long mask) {
    const __m128i t = _mm_and_si128(_mm_xor_si128(v, _mm_srli_epi64(v, distance)), _mm_set1_epi64x(mask));
    return _mm_xor_si128(v, _mm_xor_si128(t, _mm_slli_epi64(t, distance)));
}

inline void transpose_words(const std::uint64_t* words, std::uint64_t* tiles) {
    // Bytes first: the 8 lights' of a row of tiles side by side ...
    __m128i pairs[4], fours[4];
    for (int i = 0; i < 4; ++i)
        pairs[i] = _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(words + 2 * i)),
                                     _mm_loadl_epi64(reinterpret_cast<const __m128i*>(words + 2 * i + 1)));
    for (int i = 0; i < 4; i += 2) {
        fours[i] = _mm_unpacklo_epi16(pairs[i], pairs[i + 1]);
        fours[i + 1] = _mm_unpackhi_epi16(pairs[i], pairs[i + 1]);
    }
    const __m128i rows[] = {
        _mm_unpacklo_epi32(fours[0], fours[2]), _mm_unpackhi_epi32(fours[0], fours[2]),
        _mm_unpacklo_epi32(fours[1], fours[3]), _mm_unpackhi_epi32(fours[1], fours[3])};
    // ... then the bits of each row, as transpose_bits().
    for (int i = 0; i < 4; ++i) {
        __m128i v = swap_bits<7>(rows[i], 0x00aa00aa00aa00aa);
        v = swap_bits<14>(v, 0x0000cccc0000cccc);
        v = swap_bits<28>(v, 0x00000000f0f0f0f0);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(tiles + 2 * i), v);
    }
}
