// SPDX-License-Identifier: MIT
// The slices that lights meet, by a comparison with every boundary, which is fast where those are few. Included once a
// tier, after its vectors.

/// Writes the first and the last slice that meet the depths from nearest[i] to farthest[i], ends included: how many
/// boundaries are less than the one, how many are not greater than the other. Whole vectors are read and written.
LIGHTBIN_TARGET inline void slices_met(const float* nearest, const float* farthest, std::uint32_t count,
                                       std::span<const float> boundaries, std::uint16_t* first,
                                       std::uint16_t* last) {
    const Floats zero = all(0.0f), one = all(1.0f);
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const Floats from = load_floats(nearest + i), to = load_floats(farthest + i);
        Floats before = zero, up_to = zero;
        for (const float boundary : boundaries) {
            before = before + select(less(all(boundary), from), one, zero);
            up_to = up_to + select(less_equal(all(boundary), to), one, zero);
        }
        store_tiles(first + i, before);
        store_tiles(last + i, up_to);
    }
}
