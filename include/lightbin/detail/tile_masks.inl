// SPDX-License-Identifier: MIT
// Which of a supertile's 8x8 tiles a light is in, as one word with a bit a tile: its rectangle, and-ed with its
// silhouette's row spans and with the tiles whose Z bounds it meets. Included once a tier, after its vectors.
//
//     bit  0  1 ..  7      . . . . . . . .      rows that the rectangle covers     0 1 1 1 0 0 0 0
//          8  9 .. 15      . . # # # # . .      columns                            0 0 1 1 1 1 0 0
//          :               . . # # # # . .
//         56 57 .. 63      . . # # # # . .      Each pair of a light and a tile is tested once.
//                          . . . . . . . .

inline constexpr std::uint64_t every_lane = (std::uint64_t{1} << lanes) - 1;

/// See cell_boxes.hpp.
LIGHTBIN_TARGET inline void store_box(const Camera& camera, float* box, Floats x0, Floats x1, Floats y0,
                                      Floats y1, Floats z0, Floats z1) {
    const Floats zero = all(0.0f), front = camera.orthographic ? all(1.0f) : z0,
                 back = camera.orthographic ? all(1.0f) : z1;
    store_floats(box, z0);
    store_floats(box + 64, z1);
    store_floats(box + 128, mul(x0, select(less(x0, zero), back, front)) - all(flushed));
    store_floats(box + 192, mul(x1, select(less(zero, x1), back, front)) + all(flushed));
    store_floats(box + 256, mul(y0, select(less(y0, zero), back, front)) - all(flushed));
    store_floats(box + 320, mul(y1, select(less(zero, y1), back, front)) + all(flushed));
}

/// Writes the boxes of some tiles' cells, or for split_box the two before and behind each one's gap. The tiles' Z
/// bounds (minima, maxima, gap_min, gap_max) lie at place `at`.
///
/// Boxes are clamped to the near and far plane: lights in view meet the clamped depths just as the given ones.
template <DepthTest depth_test>
LIGHTBIN_TARGET inline void store_boxes(const Camera& camera, float* boxes, Floats x0, Floats x1, Floats y0,
                                        Floats y1, const float* const (&bounds)[4], std::size_t at) {
    const Floats front = all(camera.near_depth), back = all(camera.far_depth);
    const Floats min = load_floats(bounds[0] + at), max = load_floats(bounds[1] + at);
    const Floats largest = all(FLT_MAX);  // 0 * infinity is to be avoided
    const Floats z0 = lesser(select(less(front, min), min, front), largest);
    const Floats z1 = select(less(max, back), max, back);
    if constexpr (depth_test == DepthTest::box) {
        store_box(camera, boxes, x0, x1, y0, y1, z0, z1);
    } else {
        const Floats gap_min = load_floats(bounds[2] + at), gap_max = load_floats(bounds[3] + at);
        const auto gap = less(gap_min, gap_max);
        const Floats end = select(both(gap, less(gap_min, z1)), gap_min, z1);
        const Floats begin = lesser(select(both(gap, less(z0, gap_max)), gap_max, z0), largest);
        store_box(camera, boxes, x0, x1, y0, y1, z0, end);
        store_box(camera, boxes + next_box, x0, x1, y0, y1, begin, z1);
    }
}

/// Writes what a depth test needs to know of a supertile's tiles, from column 8 x and row `top` on, in planes
/// of 64 floats: the minimum and maximum depth, for boxes followed by the ends along x and y; split_box has a
/// second box. Returns a bit for each tile that has anything to light.
template <DepthTest depth_test, class Id>
LIGHTBIN_TARGET std::uint64_t arrange_cells(const BinJob<Id>& job, unsigned x, unsigned top, float* cells) {
    static_assert(lanes <= 8 || sizeof(Id) == 0, "a vector would reach beyond its row of 8 tiles");
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const unsigned rows = (std::min)(8u, static_cast<unsigned>(job.camera->y.tiles) - top);
    const unsigned columns = (std::min)(8u, static_cast<unsigned>(width) - 8 * x);
    constexpr float absent[] = {-infinity, infinity, infinity, -infinity};
    std::uint64_t lit = 0;
    for (unsigned row = 0; row < rows; ++row) {
        float padded[4][8];
        const float* sides[4];
        for (unsigned side = 0; side < (depth_test == DepthTest::split_box ? 4 : 2); ++side) {
            const float* given = job.bounds[side];
            if (given != nullptr) given += (top + row) * width + 8 * x;
            sides[side] = given;
            if (given != nullptr && columns == 8) continue;
            for (unsigned column = 0; column < 8; ++column)
                padded[side][column] =
                    given != nullptr ? given[(std::min)(column, columns - 1)] : absent[side];
            sides[side] = padded[side];
        }
        for (unsigned column = 0; column < 8; column += lanes) {
            const unsigned place = 8 * row + column;
            const Floats min = load_floats(sides[0] + column), max = load_floats(sides[1] + column);
            lit |= (~std::uint64_t{bits(less(max, min))} & every_lane) << place;
            if constexpr (depth_test == DepthTest::interval) {
                store_floats(cells + place, min);
                store_floats(cells + 64 + place, max);
            } else {
                const unsigned at_x = 8 * x + column, at_y = top + row;
                store_boxes<depth_test>(*job.camera, cells + place, load_floats(job.edges[0] + at_x),
                                        load_floats(job.edges[1] + at_x), all(job.edges[2][at_y]),
                                        all(job.edges[3][at_y]), sides, column);
            }
        }
    }
    return lit;
}

/// The distance of a coordinate from an interval.
LIGHTBIN_TARGET inline Floats distance(Floats c, const float* ends) {
    return greater(greater(load_floats(ends) - c, c - load_floats(ends + 64)), all(0.0f));
}

/// Of the first `lanes` tiles of `cells`, those whose Z bounds or boxes the light meets. NaN tests nothing.
template <DepthTest depth_test>
LIGHTBIN_TARGET inline std::uint64_t tiles_met(const float* cells, const TestedLight& light) {
    const Floats nearest = all(light.nearest), farthest = all(light.farthest);
    std::uint64_t met = 0;
    for (const float* cell = cells; cell < cells + 64 * cell_planes<depth_test>; cell += next_box) {
        auto missed = either(less(farthest, load_floats(cell)), less(load_floats(cell + 64), nearest));
        if constexpr (depth_test != DepthTest::interval) {
            const Floats z = distance(all(light.z), cell), x = distance(all(light.x), cell + 128),
                         y = distance(all(light.y), cell + 256);
            const Floats distance2 = mul(x, x) + mul(y, y) + mul(z, z);
            missed = either(missed, less(all(light.reach2), distance2));
        }
        met |= ~bits(missed) & every_lane;
    }
    return met;
}

/// Adds the tiles that they meet to the words of 1 to 64 lights with these bytes of columns and rows; the tiles of a
/// vector count if any of them is in the rectangle. A vector of tiles stays in registers while its lights pass: loops
/// over a light's few vectors would be mispredicted once a light.
template <DepthTest depth_test>
LIGHTBIN_TARGET inline void meet_tiles(const float* cells, std::uint64_t lit, const TestedLight* lights,
                                       const std::uint8_t* columns, const std::uint8_t* rows,
                                       std::uint32_t count, std::uint64_t* met) {
    std::uint64_t in_column[8], in_row[8];
    split_bits(columns, in_column);
    split_bits(rows, in_row);
    const std::uint64_t valid = ~std::uint64_t{0} >> (64 - count);
    for (unsigned place = 0; place < 64; place += lanes) {
        if ((lit >> place & every_lane) == 0) continue;
        std::uint64_t in_rows = 0, in_columns = 0;
        for (unsigned lane = 0; lane < lanes; lane += 8)
            in_rows |= in_row[(place + lane) / 8];
        for (unsigned lane = 0; lane < lanes && lane < 8; ++lane)
            in_columns |= in_column[place % 8 + lane];
        for (std::uint64_t rest = in_rows & in_columns & valid; rest != 0; rest &= rest - 1) {
            const unsigned light = static_cast<unsigned>(std::countr_zero(rest));
            met[light] |= tiles_met<depth_test>(cells + place, lights[light]) << place;
        }
    }
}

/// Of the tiles of a supertile, from column 8 x and row `top` on, those within the row spans of visible light i.
LIGHTBIN_TARGET inline std::uint64_t silhouette_tiles(const FootprintArrays& lights, std::uint32_t i,
                                                      unsigned x, unsigned top, std::uint64_t tiles) {
    if (lights.span_begin[i] == FootprintArrays::whole_rectangle) return tiles;
    std::uint64_t spanned = 0;
    for (unsigned row = static_cast<unsigned>(std::countr_zero(tiles)) / 8,
                  last = 7 - static_cast<unsigned>(std::countl_zero(tiles)) / 8;
         row <= last; ++row) {
        const RowSpan span = lights.spans[lights.span_begin[i] + (top + row - lights.y0[i])];
        const bool here = span.first <= span.last && span.first < 8 * x + 8 && span.last >= 8 * x;
        spanned |= std::uint64_t{here ? covered(span.first, span.last, 8 * x) & 0xff : 0} << 8 * row;
    }
    return tiles & spanned;
}

/// Makes the words of a supertile's lights, given by visible index (in `list`, counted from `first`) with the
/// columns and the rows that they cover. Lights that are in none of the tiles are dropped; `list` then holds
/// the ids of the others. Returns how many are left.
template <Footprint footprint, DepthTest depth_test, class Id, class Listed>
LIGHTBIN_TARGET std::uint32_t mask_lights(const BinJob<Id>& job, unsigned x, unsigned top, const float* cells,
                                          std::uint64_t lit, Listed* list, std::uint32_t first,
                                          const std::uint8_t* columns, const std::uint8_t* rows,
                                          std::uint32_t count, std::uint64_t* words) {
    std::uint32_t left = 0;
    for (std::uint32_t begin = 0; begin < count; begin += 64) {
        const std::uint32_t end = (std::min)(begin + 64, count);
        std::uint64_t met[64];
        if constexpr (depth_test != DepthTest::none) {
            TestedLight lights[64];
            for (std::uint32_t j = begin; j < end; ++j) {
                lights[j - begin] = TestedLight(
                    *job.camera, load_sphere(job.lights.spheres + job.lights.ids[first + list[j]]));
                met[j - begin] = 0;
            }
            meet_tiles<depth_test>(cells, lit, lights, columns + begin, rows + begin, end - begin, met);
        }
        for (std::uint32_t j = begin; j < end; ++j) {
            const std::uint32_t i = first + list[j];
            std::uint64_t tiles = spread_rows(rows[j]) & columns[j] * std::uint64_t{0x0101010101010101};
            if constexpr (footprint == Footprint::silhouette)
                tiles = silhouette_tiles(job.lights, i, x, top, tiles);
            if constexpr (depth_test != DepthTest::none) tiles &= met[j - begin] & lit;
            list[left] = static_cast<Listed>(job.lights.ids[i]);
            words[left] = tiles;
            left += tiles != 0;
        }
    }
    return left;
}
