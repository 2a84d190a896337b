// SPDX-License-Identifier: MIT
// The rows of tiles of bin_scatter, see LayOut. Included once a tier of vectors, after its Floats.

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

LIGHTBIN_TARGET inline std::uint32_t lay_out(std::uint32_t* steps, const std::uint32_t* corners,
                                             std::size_t width, std::uint32_t at, Tile* tiles) {
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
}
