// SPDX-License-Identifier: MIT
// What depth tests leave of some lights in a block of tiles of four sizes, asked of the tests that bin. Included once
// a tier, after tile_masks.inl.

/// Writes the numbers of those of `count` lights whose rectangles, in blocks of tiles, meet block (x, y). Returns how
/// many they are. Reads up to `lanes` more than there are.
LIGHTBIN_TARGET inline std::uint32_t lights_of_block(const float* x0, const float* x1, const float* y0,
                                                     const float* y1, std::uint32_t count, float x, float y,
                                                     std::uint16_t* numbers) {
    const Floats column = all(x), row = all(y);
    std::uint32_t found = 0;
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const auto out = either(either(less(column, load_floats(x0 + i)), less(load_floats(x1 + i), column)),
                                either(less(row, load_floats(y0 + i)), less(load_floats(y1 + i), row)));
        for (std::uint64_t in = ~std::uint64_t{bits(out)} & every_lane; in != 0; in &= in - 1)
            numbers[found++] = static_cast<std::uint16_t>(i + static_cast<unsigned>(std::countr_zero(in)));
    }
    return found;
}

/// Makes a grid's tiles of those of half the size, `count` and four times `count`, and after them what means nothing.
/// What lies before or behind a tile's gap counts as drawn all over, so the gaps around the middle of the depths are
/// at most as wide as reduce_depth() would find.
LIGHTBIN_TARGET inline void merge_tiles(SurveyBlock& block, unsigned from, unsigned to, unsigned count) {
    const Floats endless = all(infinity);
    for (unsigned i = 0; i < count; i += lanes) {
        Floats x0 = endless, x1 = -endless, y0 = endless, y1 = -endless, least = endless, most = -endless;
        for (unsigned tile = from + i; tile < to; tile += count) {
            x0 = lesser(load_floats(block.x0 + tile), x0);
            x1 = greater(load_floats(block.x1 + tile), x1);
            y0 = lesser(load_floats(block.y0 + tile), y0);
            y1 = greater(load_floats(block.y1 + tile), y1);
            least = lesser(load_floats(block.min + tile), least);
            most = greater(load_floats(block.max + tile), most);
        }
        const Floats middle = mul(least, all(0.5f)) + mul(most, all(0.5f));
        Floats gap_min = -endless, gap_max = endless;
        for (unsigned tile = from + i; tile < to; tile += count) {
            const Floats min = load_floats(block.min + tile), max = load_floats(block.max + tile),
                         before = load_floats(block.gap_min + tile), behind = load_floats(block.gap_max + tile);
            const auto gap = less(before, behind);
            const Floats end = select(gap, before, max), begin = select(gap, behind, min);
            const Floats below = select(less_equal(begin, middle), max, select(less_equal(min, middle), end, -endless)),
                         above = select(less_equal(middle, end), min, select(less_equal(middle, max), begin, endless));
            gap_min = greater(lesser(below, middle), gap_min);
            gap_max = lesser(greater(above, middle), gap_max);
        }
        store_floats(block.x0 + to + i, x0);
        store_floats(block.x1 + to + i, x1);
        store_floats(block.y0 + to + i, y0);
        store_floats(block.y1 + to + i, y1);
        store_floats(block.min + to + i, least);
        store_floats(block.max + to + i, most);
        store_floats(block.gap_min + to + i, gap_min);
        store_floats(block.gap_max + to + i, gap_max);
    }
}

/// Of some of 64 tiles, those whose boxes the light meets.
template <DepthTest depth_test>
LIGHTBIN_TARGET std::uint64_t tiles_met(const float* cells, const TestedLight& light, std::uint64_t tiles) {
    std::uint64_t met = 0;
    for (unsigned place = 0; place < 64; place += lanes)
        if ((tiles >> place & every_lane) != 0) met |= tiles_met<depth_test>(cells + place, light) << place;
    return met & tiles;
}

/// Adds what the lights' rectangles list in a block, and what box and, with gaps, split_box leave of it.
LIGHTBIN_TARGET inline void survey_block(const Camera& camera, SurveyBlock& block, bool gaps,
                                         const BlockLight* lights, std::uint32_t count, BlockSums& sums) {
    merge_tiles(block, 0, 64, 16);
    merge_tiles(block, 64, 80, 4);
    merge_tiles(block, 80, 84, 1);
    float cells[2][(6 + 12) * 64];  // the finest tiles; the coarser ones
    for (unsigned i = 0; i < 96; i += lanes) {
        float* const cell = cells[i / 64] + i % 64;
        const Floats x0 = load_floats(block.x0 + i), x1 = load_floats(block.x1 + i),
                     y0 = load_floats(block.y0 + i), y1 = load_floats(block.y1 + i),
                     min = load_floats(block.min + i), max = load_floats(block.max + i);
        store_boxes<DepthTest::box>(camera, cell, x0, x1, y0, y1, min, max, min, max);
        if (gaps)
            store_boxes<DepthTest::split_box>(camera, cell + 6 * 64, x0, x1, y0, y1, min, max,
                                              load_floats(block.gap_min + i), load_floats(block.gap_max + i));
    }
    const std::uint64_t drawn = block.drawn, coarse_drawn = coarser_tiles(drawn);
    std::uint64_t fine[3][BlockLight::most] = {}, coarse[3][BlockLight::most] = {};
    for (std::uint32_t i = 0; i < count; ++i) {
        const TestedLight light(camera, lights[i].sphere);
        fine[0][i] = lights[i].tiles;
        coarse[0][i] = coarser_tiles(fine[0][i]);
        fine[1][i] = tiles_met<DepthTest::box>(cells[0], light, fine[0][i] & drawn);
        coarse[1][i] = tiles_met<DepthTest::box>(cells[1], light, coarse[0][i] & coarse_drawn);
        if (!gaps) continue;
        fine[2][i] = tiles_met<DepthTest::split_box>(cells[0] + 6 * 64, light, fine[1][i]);
        coarse[2][i] = tiles_met<DepthTest::split_box>(cells[1] + 6 * 64, light, coarse[1][i]);
    }
    for (unsigned rung = 0; rung < 3; ++rung)
        for (unsigned i = 0; i < BlockLight::most; ++i) {
            const std::uint64_t sixteen = coarse[rung][i] & 0xffff, four = coarse[rung][i] >> 16 & 0xf,
                                one = coarse[rung][i] >> 20;
            const std::uint64_t tiles[] = {fine[rung][i], sixteen, four, one};
            const std::uint64_t finest[] = {fine[rung][i], sixteen * 0x0001000100010001,
                                            four * 0x1111111111111111, 0 - one};
            for (unsigned grid = 0; grid < 4; ++grid) {
                sums.tiles[rung][grid] += static_cast<std::uint32_t>(std::popcount(tiles[grid]));
                sums.lit[rung][grid] += static_cast<std::uint32_t>(std::popcount(finest[grid] & drawn));
            }
        }
}
