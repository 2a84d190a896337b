// SPDX-License-Identifier: MIT
// What grids of several tile sizes would hold, estimated from a sample of the lights in view.
#pragma once

#include <lightbin/detail/cell_boxes.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/kernels.hpp>
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
#include <span>
#include <vector>

namespace lightbin::detail {

/// What is weighed. An interval test, and silhouettes beside a depth test, were the cheapest in no scene that
/// was measured: a box takes about as long and leaves less.
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

/// A grid of 2^shift times the view's tile size; sums over the lights in view.
struct GridSurvey {
    int shift = 0, tile_size = 0;
    double tiles = 0;
    double rows = 0;        ///< tile rows in the lights' rectangles
    double supertiles = 0;  ///< supertiles there, 8x8 tiles each
    /// By rung: the lists' lengths, summed over the tiles, and over the pixels that have something to light.
    double entries[4] = {}, evaluations[4] = {};
};

struct Survey {
    Footprints<Footprint::rectangle, false> footprints;
    std::vector<std::uint32_t> sample;  ///< some of the lights in view, by visible index
    double lights_each = 0;             ///< lights in view for each of these
    double lights = 0, visible = 0;
    double pixels = 0;  ///< those with something to light, as far as the Z bounds tell
    std::vector<View> views;
    std::vector<GridSurvey> grids;  ///< of the views
};

inline namespace LIGHTBIN_FLAVOUR {

/// A place in part `i` of the `count` equal parts of 0..total, moved on by the golden ratio from part to
/// part: a fixed step would see only one kind of light where the caller's array has them in turn.
inline std::size_t spread(std::size_t i, std::size_t count, double total) {
    const double turn = static_cast<std::uint32_t>(i * 2654435769u) * 0x1p-32;
    return static_cast<std::size_t>((static_cast<double>(i) + turn) * total / static_cast<double>(count));
}

/// Tiles x0..x1, y0..y1 of a grid, both ends included.
struct TileRect {
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    std::int64_t area() const { return std::int64_t{width()} * height(); }
    std::int64_t pixels(const View& grid) const {
        const int size = grid.tile_size();
        return std::int64_t{(std::min)((x1 + 1) * size, grid.viewport().width) - x0 * size} *
               ((std::min)((y1 + 1) * size, grid.viewport().height) - y0 * size);
    }

    int x0, y0, x1, y1;
};

/// The rectangle of visible light i in a grid of 2^shift times the view's tile size.
inline TileRect rect_of(const FootprintArrays& lights, std::size_t i, int shift) {
    return {lights.x0[i] >> shift, lights.y0[i] >> shift, lights.x1[i] >> shift, lights.y1[i] >> shift};
}

/// How many pixels lie in tiles that have something to light, by a sample of the tiles.
inline double lit_pixels(const View& view, const ZBounds& bounds) {
    constexpr std::size_t count = 128;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t tile = spread(i, count, static_cast<double>(view.tile_count()));
        lit += bounds.min.empty() || bounds.max.empty() || !(bounds.min[tile] > bounds.max[tile]);
    }
    return static_cast<double>(lit) / count * view.viewport().width * view.viewport().height;
}

/// Sums over the rectangles of the sampled lights into a grid, as if all pixels had something to light.
///
/// A convex outline of area A in a box of a x b meets A + a + b + 1 tiles in the mean over its places, the box
/// ab + a + b + 1. An ellipse's A is pi / 4 ab, unless the screen cuts it on both sides.
inline void sum_rectangles(const Survey& survey, const View& tiled, GridSurvey& grid) {
    std::int64_t tiles = 0, cut = 0, pixels = 0, rows = 0, supertiles = 0;
    for (const std::uint32_t light : survey.sample) {
        const TileRect rect = rect_of(survey.footprints.arrays(), light, grid.shift);
        tiles += rect.area();
        if (rect.width() < tiled.tiles_x() && rect.height() < tiled.tiles_y())
            cut += std::int64_t{rect.width() - 1} * (rect.height() - 1);
        pixels += rect.pixels(tiled);
        rows += rect.height();
        supertiles += (rect.x1 / 8 - rect.x0 / 8 + 1) * (rect.y1 / 8 - rect.y0 / 8 + 1);
    }
    const double left =
        tiles == 0 ? 1
                   : 1 - (1 - std::numbers::pi / 4) * static_cast<double>(cut) / static_cast<double>(tiles);
    grid.entries[0] = survey.lights_each * static_cast<double>(tiles);
    grid.entries[silhouettes] = left * grid.entries[0];
    grid.evaluations[0] = survey.lights_each * static_cast<double>(pixels);
    grid.evaluations[silhouettes] = left * grid.evaluations[0];
    grid.rows = survey.lights_each * static_cast<double>(rows);
    grid.supertiles = survey.lights_each * static_cast<double>(supertiles);
}

/// Projects the lights and surveys grids of the view's tile size and of 2, 4 and 8 times it, by their
/// rectangles: exact up to `most` lights in view.
template <class Light, class ToViewSphere>
Survey survey_rectangles(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights,
                         const ZBounds& bounds, std::size_t most = 512) {
    Survey survey;
    survey.footprints.project(isa, view, lights, Parallel());
    const std::size_t visible = survey.footprints.visible();
    survey.lights = static_cast<double>(survey.footprints.lights());
    survey.visible = static_cast<double>(visible);
    survey.pixels = lit_pixels(view, bounds);
    survey.sample.resize((std::min)(visible, most));
    for (std::size_t i = 0; i < survey.sample.size(); ++i)
        survey.sample[i] = static_cast<std::uint32_t>(spread(i, survey.sample.size(), survey.visible));
    survey.lights_each = visible == 0 ? 0 : survey.visible / static_cast<double>(survey.sample.size());
    const int longest = (std::max)(view.viewport().width, view.viewport().height);
    survey.views.reserve(4);
    survey.grids.reserve(4);
    for (int shift = 0; shift == 0 || (shift <= 3 && view.tile_size() <= (longest - 1) >> shift); ++shift) {
        const View& tiled = survey.views.emplace_back(*view.with_tile_size(view.tile_size() << shift));
        survey.grids.push_back({.shift = shift,
                                .tile_size = tiled.tile_size(),
                                .tiles = static_cast<double>(tiled.tile_count())});
        sum_rectangles(survey, tiled, survey.grids.back());
    }
    return survey;
}

/// Reads the finest tiles of block (x, y).
inline void read_block(const View& view, const ZBounds& bounds, int x, int y, SurveyBlock& block) {
    const std::size_t width = static_cast<std::size_t>(view.tiles_x());
    const unsigned columns = static_cast<unsigned>((std::min)(8, view.tiles_x() - 8 * x));
    const unsigned rows = static_cast<unsigned>((std::min)(8, view.tiles_y() - 8 * y));
    if (columns < 8 || rows < 8) {
        for (float* const least : {block.x0, block.y0, block.min})
            std::fill_n(least, 64, infinity);
        for (float* const most : {block.x1, block.y1, block.max})
            std::fill_n(most, 64, -infinity);
    }
    const bool gaps = weighed(DepthTest::split_box, bounds);
    block.drawn = 0;
    float left[8], right[8], top, bottom;
    for (unsigned column = 0; column < columns; ++column)
        tile_edges(view.camera().x, 8 * x + static_cast<int>(column), left[column], right[column]);
    for (unsigned row = 0; row < rows; ++row) {
        tile_edges(view.camera().y, 8 * y + static_cast<int>(row), top, bottom);
        std::size_t tile = (8 * static_cast<std::size_t>(y) + row) * width + 8 * static_cast<std::size_t>(x);
        for (unsigned column = 0; column < columns; ++column, ++tile) {
            const unsigned place = block_place(column, row);
            block.x0[place] = left[column];
            block.x1[place] = right[column];
            block.y0[place] = top;
            block.y1[place] = bottom;
            const float min = bounds.min.empty() ? -infinity : bounds.min[tile];
            const float max = bounds.max.empty() ? infinity : bounds.max[tile];
            const bool drawn = !(min > max);
            block.drawn |= std::uint64_t{drawn} << place;
            block.min[place] = drawn ? min : infinity;
            block.max[place] = drawn ? max : -infinity;
            if (!gaps) continue;
            block.gap_min[place] = bounds.gap_min[tile];
            block.gap_max[place] = bounds.gap_max[tile];
        }
    }
}

/// Estimates what depth tests leave, and what has something to light, from `count` blocks of tiles and up to
/// 8 lights in each: those of a light drawn evenly from pairs of a sampled light and a block. All rungs and grids are asked of the same
/// ones, so that comparisons are sharper than the numbers.
template <class Light, class ToViewSphere>
void survey_blocks(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights, const ZBounds& bounds,
                   std::size_t count, Survey& survey) {
    if (survey.visible == 0 || !weighed(DepthTest::box, bounds)) return;
    const FootprintArrays& footprints = survey.footprints.arrays();
    const std::size_t sampled = survey.sample.size(), room = sampled + 16;
    std::vector<float> sides(4 * room, infinity);
    std::int64_t area = 0;
    for (std::size_t i = 0; i < sampled; ++i) {
        const TileRect blocks = rect_of(footprints, survey.sample[i], 3);
        sides[i] = static_cast<float>(blocks.x0);
        sides[room + i] = static_cast<float>(blocks.x1);
        sides[2 * room + i] = static_cast<float>(blocks.y0);
        sides[3 * room + i] = static_cast<float>(blocks.y1);
        area += blocks.area();
    }
    std::vector<std::uint16_t> numbers(room);
    SurveyBlock block = {};
    double tiles[3][4] = {}, lit[3][4] = {};
    std::int64_t before = 0;  // area of the lights before this one
    std::size_t done = 0;
    for (const std::uint32_t light : survey.sample) {
        const TileRect blocks = rect_of(footprints, light, 3);
        for (; done < count; ++done) {
            const std::int64_t place = static_cast<std::int64_t>(spread(done, count, static_cast<double>(area))) - before;
            if (place >= blocks.area()) break;
            const int x = blocks.x0 + static_cast<int>(place % blocks.width()), y = blocks.y0 + static_cast<int>(place / blocks.width());
            read_block(view, bounds, x, y, block);
            const SurveyKernels kernels = survey_kernels(isa);
            const std::uint32_t found = kernels.lights_of_block(sides.data(), sides.data() + room, sides.data() + 2 * room, sides.data() + 3 * room, static_cast<std::uint32_t>(sampled), static_cast<float>(x), static_cast<float>(y), numbers.data());
            const std::uint32_t tested = (std::min)(found, BlockLight::most);
            BlockLight some[BlockLight::most];
            for (std::uint32_t i = 0; i < tested; ++i) {
                const std::uint32_t chosen = survey.sample[numbers[spread(i, tested, found)]];
                const TileRect rect = rect_of(footprints, chosen, 0);
                const auto covered = [](const auto& before_tile, int first, int last) {
                    return before_tile[static_cast<std::size_t>((std::min)(last, 7) + 1)] & ~before_tile[static_cast<std::size_t>((std::max)(first, 0))];
                };
                some[i] = {std::invoke(lights.to_view_sphere, lights.array[footprints.ids[chosen]]),
                           covered(block_columns, rect.x0 - 8 * x, rect.x1 - 8 * x) & covered(block_rows, rect.y0 - 8 * y, rect.y1 - 8 * y)};
            }
            BlockSums sums;
            kernels.survey_block(view.camera(), block, weighed(DepthTest::split_box, bounds), some, tested, sums);
            for (std::size_t rung = 0; rung < 3; ++rung)
                for (std::size_t grid = 0; grid < 4; ++grid) {
                    tiles[rung][grid] += sums.tiles[rung][grid] / static_cast<double>(tested);
                    lit[rung][grid] += sums.lit[rung][grid] / static_cast<double>(tested);
                }
        }
        before += blocks.area();
    }
    for (std::size_t at = 0; at < survey.grids.size(); ++at) {
        GridSurvey& grid = survey.grids[at];
        const double all_pixels = grid.evaluations[0];
        for (std::size_t rung = 0; rung < silhouettes; ++rung) {
            grid.entries[rung] = grid.entries[0] * tiles[rung][at] / tiles[0][at];
            grid.evaluations[rung] = all_pixels * lit[rung][at] / (tiles[0][at] * static_cast<double>(1 << 2 * at));
        }
        grid.evaluations[silhouettes] *= grid.evaluations[0] / all_pixels;
    }
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
