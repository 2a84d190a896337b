// SPDX-License-Identifier: MIT
// What depth tests leave of some lights in a block of tiles of four sizes, asked of the tests that bin. Included once
// a tier, after tile_masks.inl.

/// Makes a block's coarser tiles, each of four of half its size, and after the last of a grid what means nothing. What
/// lies before or behind a tile's gap counts as drawn all over, so the gaps around the middle of the depths are at
/// most as wide as reduce_depth() would find.
LIGHTBIN_TARGET inline void merge_tiles(SurveyBlock& block) {
    const Floats endless = all(infinity);
    for (unsigned from = 0, to = 64, count = 16; count > 0; from = to, to += count, count /= 4)
        for (unsigned i = 0; i < count; i += lanes) {
            Floats least = endless, most = -endless;
            for (unsigned side = 0; side < 3; ++side) {
                least = endless;
                most = -endless;
                for (unsigned tile = from + i; tile < to; tile += count) {
                    least = lesser(load_floats(block.low[side] + tile), least);
                    most = greater(load_floats(block.high[side] + tile), most);
                }
                store_floats(block.low[side] + to + i, least);
                store_floats(block.high[side] + to + i, most);
            }
            const Floats middle = mul(least, all(0.5f)) + mul(most, all(0.5f));
            Floats gap_min = -endless, gap_max = endless;
            for (unsigned tile = from + i; tile < to; tile += count) {
                const Floats min = load_floats(block.low[2] + tile), max = load_floats(block.high[2] + tile),
                             before = load_floats(block.gap_min + tile),
                             behind = load_floats(block.gap_max + tile);
                const auto gap = less(before, behind);
                const Floats end = select(gap, before, max), begin = select(gap, behind, min);
                const Floats nearer = select(less_equal(begin, middle), max,
                                             select(less_equal(min, middle), end, -endless)),
                             farther = select(less_equal(middle, end), min,
                                              select(less_equal(middle, max), begin, endless));
                gap_min = greater(lesser(nearer, middle), gap_min);
                gap_max = lesser(greater(farther, middle), gap_max);
            }
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

/// Sums what 1 to BlockLight::most lights' rectangles list in a block, and what box and, with gaps, split_box leave
/// of it.
LIGHTBIN_TARGET inline BlockSums survey_block(const Camera& camera, SurveyBlock& block, bool gaps,
                                              const BlockLight* lights, std::uint32_t count) {
    merge_tiles(block);
    // Of the finest tiles, and of the others: a box each, then two boxes each.
    float cells[2][3 * next_box];
    const float* const bounds[] = {block.low[2], block.high[2], block.gap_min, block.gap_max};
    for (unsigned i = 0; i < 96; i += lanes) {
        float* const cell = cells[i / 64] + i % 64;
        const Floats x0 = load_floats(block.low[0] + i), x1 = load_floats(block.high[0] + i),
                     y0 = load_floats(block.low[1] + i), y1 = load_floats(block.high[1] + i);
        store_boxes<DepthTest::box>(camera, cell, x0, x1, y0, y1, bounds, i);
        if (gaps) store_boxes<DepthTest::split_box>(camera, cell + next_box, x0, x1, y0, y1, bounds, i);
    }
    std::uint64_t listed[2][3][BlockLight::most];
    for (std::uint32_t i = 0; i < count; ++i) {
        const TestedLight light(camera, lights[i].sphere);
        for (unsigned coarser = 0; coarser < 2; ++coarser) {
            const float* const boxes = cells[coarser];
            const std::uint64_t tiles = coarser == 0 ? lights[i].tiles : coarser_tiles(lights[i].tiles);
            const std::uint64_t box = tiles_met<DepthTest::box>(boxes, light, tiles);
            listed[coarser][0][i] = tiles;
            listed[coarser][1][i] = box;
            if (gaps) listed[coarser][2][i] = tiles_met<DepthTest::split_box>(boxes + next_box, light, box);
        }
    }
    constexpr unsigned shift[] = {0, 0, 16, 20};
    constexpr std::uint64_t all_tiles[] = {~std::uint64_t{0}, 0xffff, 0xf, 1};
    constexpr std::uint64_t finest_in_each[] = {1, 0x0001000100010001, 0x1111111111111111, ~std::uint64_t{0}};
    BlockSums sums;
    for (unsigned test = 0; test < (gaps ? 3 : 2); ++test)
        for (unsigned grid = 0; grid < 4; ++grid)
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint64_t tiles = listed[grid != 0][test][i] >> shift[grid] & all_tiles[grid],
                                    finest = tiles * finest_in_each[grid];
                sums.tiles[test][grid] += static_cast<std::uint32_t>(std::popcount(tiles));
                sums.drawn[test][grid] += static_cast<std::uint32_t>(std::popcount(finest & block.drawn));
                if (test == 0)
                    sums.finest[grid] += static_cast<std::uint32_t>(std::popcount(finest & block.in_grid));
            }
    return sums;
}
