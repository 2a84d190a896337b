// SPDX-License-Identifier: MIT
// What grids of several tile sizes would hold, estimated from a sample of the lights in view.
#pragma once

#include <lightbin/detail/cell_boxes.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scalar.hpp>
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

/// Calls visit(tile, min, max) for those of the view's tiles in tile (x, y) of a grid of 2^shift times their
/// size that have something to light. Returns their share of all.
template <class Visit>
double each_drawn(const View& view, const ZBounds& bounds, int shift, int x, int y, Visit visit) {
    const int x0 = x << shift, x1 = (std::min)((x + 1) << shift, view.tiles_x());
    const int y0 = y << shift, y1 = (std::min)((y + 1) << shift, view.tiles_y());
    int drawn = 0;
    for (int row = y0; row < y1; ++row)
        for (int column = x0; column < x1; ++column) {
            const std::size_t tile =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(view.tiles_x()) +
                static_cast<std::size_t>(column);
            const float min = bounds.min.empty() ? -infinity : bounds.min[tile];
            const float max = bounds.max.empty() ? infinity : bounds.max[tile];
            if (min > max) continue;
            visit(tile, min, max);
            ++drawn;
        }
    return static_cast<double>(drawn) / ((x1 - x0) * (y1 - y0));
}

/// The depths of a tile's cell, and how much of it has something to light.
struct Cell {
    float min = infinity, max = -infinity, gap_min = -infinity, gap_max = infinity;
    double drawn = 1;  ///< share of its pixels
};

inline Cell merge_bounds(const View& view, const ZBounds& bounds, int shift, int x, int y) {
    Cell cell;
    cell.drawn = each_drawn(view, bounds, shift, x, y, [&](std::size_t, float min, float max) {
        cell.min = min < cell.min ? min : cell.min;
        cell.max = max > cell.max ? max : cell.max;
    });
    return cell;
}

/// Finds the gap around the middle of the cell's depths. What lies before or behind a tile's own gap counts
/// as drawn all over, so this gap is at most as wide as reduce_depth() would find.
inline void merge_gaps(const View& view, const ZBounds& bounds, int shift, int x, int y, Cell& cell) {
    const float middle = cell.min / 2 + cell.max / 2;
    const auto draw = [&](float from, float to) {
        const float below = from <= middle ? (std::min)(to, middle) : -infinity;
        const float above = to >= middle ? (std::max)(from, middle) : infinity;
        cell.gap_min = (std::max)(cell.gap_min, below);
        cell.gap_max = (std::min)(cell.gap_max, above);
    };
    each_drawn(view, bounds, shift, x, y, [&](std::size_t tile, float min, float max) {
        if (!(cell.gap_min < cell.gap_max)) return;
        const bool gap = bounds.gap_min[tile] < bounds.gap_max[tile];
        draw(min, gap ? bounds.gap_min[tile] : max);
        draw(gap ? bounds.gap_max[tile] : min, max);
    });
}

/// How many of the depth tests box and split_box, in this order, a light passes in the cell of tile (x, y) of a
/// grid. Asks the tests that bin, the scalar tier's.
inline std::size_t tests_passed(const View& view, const ZBounds& bounds, const Camera& grid, int shift, int x,
                                int y, Cell& cell, const Sphere& sphere) {
    const TestedLight light(grid, sphere);
    if (cell.drawn == 0 || light.farthest < cell.min || light.nearest > cell.max) return 0;
    float x0, x1, y0, y1;
    tile_edges(grid.x, x, x0, x1);
    tile_edges(grid.y, y, y0, y1);
    float cells[12 * 64];  // planes of 64 tiles, of which the first is the one
    scalar::store_boxes<DepthTest::box>(grid, cells, x0, x1, y0, y1, cell.min, cell.max, 0, 0);
    if (scalar::tiles_met<DepthTest::box>(cells, light) == 0) return 0;
    if (!weighed(DepthTest::split_box, bounds)) return 1;
    merge_gaps(view, bounds, shift, x, y, cell);
    scalar::store_boxes<DepthTest::split_box>(grid, cells, x0, x1, y0, y1, cell.min, cell.max, cell.gap_min,
                                              cell.gap_max);
    return scalar::tiles_met<DepthTest::split_box>(cells, light) != 0 ? 2 : 1;
}

/// How many pixels lie in tiles that have something to light, by a sample of the tiles.
inline double lit_pixels(const View& view, const ZBounds& bounds) {
    const std::size_t count = (std::min)(view.tile_count(), std::size_t{32});
    double lit = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int tile = static_cast<int>(spread(i, count, static_cast<double>(view.tile_count())));
        lit += merge_bounds(view, bounds, 0, tile % view.tiles_x(), tile / view.tiles_x()).drawn;
    }
    return count == 0 ? 0 : lit / static_cast<double>(count) * view.viewport().width * view.viewport().height;
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

/// Sums over pairs of a light and a tile of one grid: all of them, and by rung what is listed and lit.
struct PairSums {
    double tiles = 0, pixels = 0, listed[silhouettes] = {}, lit[silhouettes] = {};
};

/// Adds the pair of a light and tile (x, y) of a grid of 2^shift times the view's tile size, `weight` times.
inline void add_pair(const View& view, const ZBounds& bounds, const View& grid, int shift, int x, int y,
                     const Sphere& sphere, double weight, PairSums& sums) {
    const double pixels = weight * static_cast<double>(TileRect{x, y, x, y}.pixels(grid));
    Cell cell = merge_bounds(view, bounds, shift, x, y);
    const std::size_t passed = tests_passed(view, bounds, grid.camera(), shift, x, y, cell, sphere);
    sums.tiles += weight;
    sums.pixels += pixels;
    for (std::size_t rung = 0; rung <= passed; ++rung) {
        sums.listed[rung] += weight;
        sums.lit[rung] += pixels * cell.drawn;
    }
}

/// Estimates what depth tests leave, and what has something to light, from `count` pairs of a sampled light and
/// a tile, drawn in proportion to the rectangles' areas: the same pairs for every rung, and the same lights and
/// places on the screen for every grid, so that comparisons are sharper than the numbers.
template <class Light, class ToViewSphere>
void survey_pairs(const View& view, const Lights<Light, ToViewSphere>& lights, const ZBounds& bounds,
                  std::size_t count, Survey& survey) {
    if (survey.visible == 0 || !weighed(DepthTest::box, bounds)) return;
    PairSums sums[4];
    const FootprintArrays& footprints = survey.footprints.arrays();
    const double area = survey.grids[0].entries[0] / survey.lights_each;
    std::int64_t before = 0;  // area of the lights before this one
    std::size_t pair = 0;
    for (const std::uint32_t light : survey.sample) {
        const TileRect drawn = rect_of(footprints, light, 0);
        for (; pair < count; ++pair) {
            const std::int64_t place = static_cast<std::int64_t>(spread(pair, count, area)) - before;
            if (place >= drawn.area()) break;
            const double u = (static_cast<double>(place % drawn.width()) + 0.5) / drawn.width();
            const double v = (static_cast<double>(place / drawn.width()) + 0.5) / drawn.height();
            const Sphere sphere = std::invoke(lights.to_view_sphere, lights.array[footprints.ids[light]]);
            for (std::size_t at = 0; at < survey.grids.size(); ++at) {
                const int shift = survey.grids[at].shift;
                const TileRect rect = rect_of(footprints, light, shift);
                const int x = rect.x0 + static_cast<int>(u * rect.width());
                const int y = rect.y0 + static_cast<int>(v * rect.height());
                const double weight = static_cast<double>(rect.area()) / static_cast<double>(drawn.area());
                add_pair(view, bounds, survey.views[at], shift, x, y, sphere, weight, sums[at]);
            }
        }
        before += drawn.area();
    }
    for (std::size_t at = 0; at < survey.grids.size(); ++at) {
        GridSurvey& grid = survey.grids[at];
        const double all_pixels = grid.evaluations[0];
        for (std::size_t rung = 0; rung < silhouettes; ++rung) {
            grid.entries[rung] = grid.entries[0] * sums[at].listed[rung] / sums[at].tiles;
            grid.evaluations[rung] = all_pixels * sums[at].lit[rung] / sums[at].pixels;
        }
        grid.evaluations[silhouettes] *= grid.evaluations[0] / all_pixels;
    }
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
