// SPDX-License-Identifier: MIT
// What grids of several tile sizes would hold, estimated from a sample of the lights in view.
#pragma once

#include <lightbin/detail/cell_boxes.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/survey_block.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/project.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numbers>
#include <vector>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// What is weighed. An interval test, and silhouettes beside a depth test, were the cheapest in no scene that was
/// measured with vectors: a box takes about as long and leaves less. (The scalar tier has the interval sooner.)
struct Rung {
    Footprint footprint;
    DepthTest depth_test;
};
inline constexpr Rung rungs[] = {{Footprint::rectangle, DepthTest::none},
                                 {Footprint::rectangle, DepthTest::box},
                                 {Footprint::rectangle, DepthTest::split_box},
                                 {Footprint::silhouette, DepthTest::none}};
inline constexpr std::size_t silhouettes = 3;

/// Whether Z bounds allow a depth test.
inline bool weighed(DepthTest test, const ZBounds& bounds) {
    if (test == DepthTest::split_box) return !bounds.gap_min.empty() && !bounds.gap_max.empty();
    return test == DepthTest::none || !bounds.min.empty() || !bounds.max.empty();
}

/// A grid; sums over the lights in view.
struct GridSurvey {
    int tile_size = 0;
    double tiles = 0;
    double rows = 0;        ///< tile rows in the lights' rectangles
    double supertiles = 0;  ///< supertiles there, 8x8 tiles each
    /// By rung: the lists' lengths, summed over the tiles, and over the pixels that have something to light.
    double entries[std::size(rungs)] = {}, evaluations[std::size(rungs)] = {};
};

/// Tiles x0..x1, y0..y1 of a grid, both ends included.
struct TileRect {
    int x0, y0, x1, y1;

    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    std::int64_t area() const { return std::int64_t{width()} * height(); }
    /// Without a branch: no difference is negative.
    bool holds(int x, int y) const { return ((x - x0) | (x1 - x) | (y - y0) | (y1 - y)) >= 0; }

    /// The same in a grid of 2^shift times the tile size.
    TileRect coarser(int shift) const { return {x0 >> shift, y0 >> shift, x1 >> shift, y1 >> shift}; }
};

struct Survey {
    /// Some of the lights in view: tiles of the view's size, and ids.
    std::vector<TileRect> rects;
    std::vector<std::uint32_t> ids;
    double lights = 0, visible = 0;
    double pixels = 0;              ///< those with something to light, as far as the Z bounds tell
    std::vector<GridSurvey> grids;  ///< of the view's tile size, twice, 4 and 8 times that
};

/// A place in part `i` of the `count` equal parts of 0..total, moved on by the golden ratio from part to
/// part: a fixed step would see only one kind of light where the caller's array has them in turn.
inline std::size_t spread(std::size_t i, std::size_t count, double total) {
    const double turn = static_cast<std::uint32_t>(i * 2654435769u) * 0x1p-32;
    return static_cast<std::size_t>((static_cast<double>(i) + turn) * total / static_cast<double>(count));
}

/// How many pixels lie in tiles that have something to light, by a sample of the tiles.
inline double lit_pixels(const View& view, const ZBounds& bounds) {
    constexpr std::size_t count = 64;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t tile = spread(i, count, static_cast<double>(view.tile_count()));
        lit += bounds.min.empty() || bounds.max.empty() || !(bounds.min[tile] > bounds.max[tile]);
    }
    return static_cast<double>(lit) / count * view.viewport().width * view.viewport().height;
}

/// Sums over the rectangles of the sampled lights in a view of 2^shift times their tile size, as if all pixels had
/// something to light.
///
/// A convex outline of area A in a box of a x b meets A + a + b + 1 tiles in the mean over its places, the box
/// ab + a + b + 1. An ellipse's A is pi / 4 ab, unless the screen cuts it on both sides.
inline GridSurvey sum_rectangles(const Survey& survey, const View& tiled, int shift) {
    std::int64_t tiles = 0, cut = 0, pixels = 0, rows = 0, supertiles = 0;
    const int size = tiled.tile_size();
    for (const TileRect& finest : survey.rects) {
        const TileRect rect = finest.coarser(shift);
        tiles += rect.area();
        if (rect.width() < tiled.tiles_x() && rect.height() < tiled.tiles_y())
            cut += std::int64_t{rect.width() - 1} * (rect.height() - 1);
        pixels += std::int64_t{(std::min)((rect.x1 + 1) * size, tiled.viewport().width) - rect.x0 * size} *
                  ((std::min)((rect.y1 + 1) * size, tiled.viewport().height) - rect.y0 * size);
        rows += rect.height();
        supertiles += rect.coarser(3).area();
    }
    const double left =
        tiles == 0 ? 1
                   : 1 - (1 - std::numbers::pi / 4) * static_cast<double>(cut) / static_cast<double>(tiles);
    const double lights_each =
        survey.visible / static_cast<double>((std::max<std::size_t>)(survey.rects.size(), 1));
    const auto of_all = [&](std::int64_t sampled) { return lights_each * static_cast<double>(sampled); };
    return {.tile_size = size,
            .tiles = static_cast<double>(tiled.tile_count()),
            .rows = of_all(rows),
            .supertiles = of_all(supertiles),
            .entries = {of_all(tiles), 0, 0, left * of_all(tiles)},
            .evaluations = {of_all(pixels), 0, 0, left * of_all(pixels)}};
}

/// Projects the lights and surveys grids of the view's tile size and of 2, 4 and 8 times it, by their
/// rectangles: exact up to `most` lights in view.
template <class Light, class ToViewSphere>
Survey survey_rectangles(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights,
                         const ZBounds& bounds, std::size_t most = 512) {
    Survey survey;
    Footprints<Footprint::rectangle, false> footprints;
    footprints.project(isa, view, lights, Parallel());
    const FootprintArrays& arrays = footprints.arrays();
    survey.lights = static_cast<double>(footprints.lights());
    survey.visible = static_cast<double>(footprints.visible());
    survey.pixels = lit_pixels(view, bounds);
    const std::size_t sampled = (std::min<std::size_t>)(footprints.visible(), most);
    for (std::size_t i = 0; i < sampled; ++i) {
        const std::size_t light = spread(i, sampled, survey.visible);
        survey.rects.push_back({arrays.x0[light], arrays.y0[light], arrays.x1[light], arrays.y1[light]});
        survey.ids.push_back(arrays.ids[light]);
    }
    const int longest = (std::max)(view.viewport().width, view.viewport().height);
    for (int shift = 0; shift == 0 || (shift <= 3 && view.tile_size() <= (longest - 1) >> shift); ++shift)
        survey.grids.push_back(
            sum_rectangles(survey, *view.with_tile_size(view.tile_size() << shift), shift));
    return survey;
}

/// Reads the finest tiles of block (x, y).
inline void read_block(const View& view, const ZBounds& bounds, int x, int y, SurveyBlock& block) {
    const std::size_t width = static_cast<std::size_t>(view.tiles_x());
    const unsigned columns = static_cast<unsigned>((std::min)(8, view.tiles_x() - 8 * x));
    const unsigned rows = static_cast<unsigned>((std::min)(8, view.tiles_y() - 8 * y));
    block.in_grid = columns_before[columns] & rows_before[rows];
    block.drawn = 0;
    if (columns * rows < 64)
        for (unsigned side = 0; side < 3; ++side) {
            std::fill_n(block.low[side], 64, infinity);
            std::fill_n(block.high[side], 64, -infinity);
        }
    const bool gaps = weighed(DepthTest::split_box, bounds);
    float left[8], right[8], top, bottom;
    for (unsigned column = 0; column < columns; ++column)
        tile_edges(view.camera().x, 8 * x + static_cast<int>(column), left[column], right[column]);
    for (unsigned row = 0; row < rows; ++row) {
        tile_edges(view.camera().y, 8 * y + static_cast<int>(row), top, bottom);
        std::size_t tile = (8 * static_cast<std::size_t>(y) + row) * width + 8 * static_cast<std::size_t>(x);
        for (unsigned column = 0; column < columns; ++column, ++tile) {
            const unsigned place = block_place(column, row);
            const float min = bounds.min.empty() ? -infinity : bounds.min[tile];
            const float max = bounds.max.empty() ? infinity : bounds.max[tile];
            const bool drawn = !(min > max);
            block.drawn |= std::uint64_t{drawn} << place;
            block.low[0][place] = left[column];
            block.high[0][place] = right[column];
            block.low[1][place] = top;
            block.high[1][place] = bottom;
            block.low[2][place] = drawn ? min : infinity;
            block.high[2][place] = drawn ? max : -infinity;
            if (!gaps) continue;
            block.gap_min[place] = bounds.gap_min[tile];
            block.gap_max[place] = bounds.gap_max[tile];
        }
    }
}

/// The part of a rectangle in block (x, y).
inline std::uint64_t tiles_in_block(const TileRect& rect, int x, int y) {
    const auto before = [](int tile, int block) {
        return static_cast<std::size_t>(std::clamp(tile - 8 * block, 0, 8));
    };
    return columns_before[before(rect.x1 + 1, x)] & ~columns_before[before(rect.x0, x)] &
           rows_before[before(rect.y1 + 1, y)] & ~rows_before[before(rect.y0, y)];
}

/// Estimates what depth tests leave, and what has something to light, from `count` blocks of tiles, drawn evenly
/// from the pairs of a sampled light and a block, and from up to BlockLight::most of the lights in each: the same for
/// every rung and grid, so that comparisons are sharper than the numbers.
template <class Light, class ToViewSphere>
void survey_blocks(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights,
                   const ZBounds& bounds, std::size_t count, Survey& survey) {
    if (survey.visible == 0 || !weighed(DepthTest::box, bounds)) return;
    const SurveyKernel kernel = survey_kernel(isa);
    std::vector<TileRect> in_blocks;
    double area = 0;
    for (const TileRect& rect : survey.rects) {
        in_blocks.push_back(rect.coarser(3));
        area += static_cast<double>(in_blocks.back().area());
    }
    std::vector<std::uint32_t> found(survey.rects.size());
    double tiles[3][4] = {}, drawn[3][4] = {}, finest[4] = {};
    SurveyBlock block = {};
    std::size_t done = 0;
    std::int64_t before = 0;  // blocks of the lights before this one
    for (const TileRect& blocks : in_blocks) {
        for (; done < count; ++done) {
            const std::int64_t place = static_cast<std::int64_t>(spread(done, count, area)) - before;
            if (place >= blocks.area()) break;
            const int x = blocks.x0 + static_cast<int>(place % blocks.width());
            const int y = blocks.y0 + static_cast<int>(place / blocks.width());
            std::size_t here = 0;
            for (std::size_t i = 0; i < in_blocks.size(); ++i) {
                found[here] = static_cast<std::uint32_t>(i);
                here += in_blocks[i].holds(x, y);
            }
            const std::size_t tested = (std::min<std::size_t>)(here, BlockLight::most);
            BlockLight some[BlockLight::most];
            for (std::size_t i = 0; i < tested; ++i) {
                const std::size_t light = found[spread(i, tested, static_cast<double>(here))];
                some[i] = {std::invoke(lights.to_view_sphere, lights.array[survey.ids[light]]),
                           tiles_in_block(survey.rects[light], x, y)};
            }
            read_block(view, bounds, x, y, block);
            const BlockSums sums = kernel(view.camera(), block, weighed(DepthTest::split_box, bounds), some,
                                          static_cast<std::uint32_t>(tested));
            const double share = 1 / static_cast<double>(tested);
            for (std::size_t grid = 0; grid < 4; ++grid) {
                for (std::size_t test = 0; test < silhouettes; ++test) {
                    tiles[test][grid] += share * sums.tiles[test][grid];
                    drawn[test][grid] += share * sums.drawn[test][grid];
                }
                finest[grid] += share * sums.finest[grid];
            }
        }
        before += blocks.area();
    }
    for (std::size_t at = 0; at < survey.grids.size(); ++at) {
        GridSurvey& grid = survey.grids[at];
        const double all_pixels = grid.evaluations[0];
        for (std::size_t rung = 0; rung < silhouettes; ++rung) {
            grid.entries[rung] = grid.entries[0] * tiles[rung][at] / tiles[0][at];
            grid.evaluations[rung] = all_pixels * drawn[rung][at] / finest[at];
        }
        grid.evaluations[silhouettes] *= grid.evaluations[0] / all_pixels;
    }
}

}  // namespace lightbin::detail

#include <lightbin/detail/warnings_on.inl>
