// SPDX-License-Identifier: MIT
// What grids of several tile sizes would hold, estimated from a sample of the lights.
#pragma once

#include <lightbin/detail/buffer.hpp>
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
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace lightbin::detail {

/// What the lists hold with one footprint and depth test.
struct Rung {
    Footprint footprint = Footprint::rectangle;
    DepthTest depth_test = DepthTest::none;
    double entries = 0;
    double evaluations = 0;  ///< sum over the pixels with something to light of their lists' lengths
};

/// A grid of one tile size, and sums over the lights in view.
struct GridSurvey {
    int tile_size = 0;
    double tiles = 0;
    double candidates = 0;  ///< tiles in the lights' rectangles
    double rows = 0;        ///< tile rows there
    double supertiles = 0;  ///< supertiles there, 8x8 tiles each
    std::array<Rung, 8> rungs = {};
    std::size_t rung_count = 0;
};

struct Survey {
    static constexpr std::size_t most_grids = 5;

    double lights = 0, visible = 0;
    double pixels = 0;  ///< those with something to light, as far as the Z bounds tell
    std::array<GridSurvey, most_grids> grids = {};
    std::size_t grid_count = 0;
};

/// The Z bounds of one tile, and how much of it has something to light.
struct CellBounds {
    float min = infinity, max = -infinity, gap_min = -infinity, gap_max = infinity;
    double drawn = 1;  ///< share of its pixels
};

inline namespace LIGHTBIN_FLAVOUR {

/// A place in part `i` of the `count` equal parts of 0..total, moved on by the golden ratio from part to
/// part: a fixed step would see only one kind of light where the caller's array has them in turn.
inline double spread(std::size_t i, std::size_t count, double total) {
    const double turn = 0.6180339887498949 * static_cast<double>(i);
    return (static_cast<double>(i) + turn - std::floor(turn)) * total / static_cast<double>(count);
}

/// Z bounds as arrays to read without asking which sides there are.
struct BoundsReader {
    explicit BoundsReader(const ZBounds& bounds)
        : lower(bounds.min.empty() ? &lowest : bounds.min.data()),
          upper(bounds.max.empty() ? &highest : bounds.max.data()),
          lower_mask(bounds.min.empty() ? 0 : ~std::size_t{0}),
          upper_mask(bounds.max.empty() ? 0 : ~std::size_t{0}),
          gap_min(bounds.gap_max.empty() ? nullptr : bounds.gap_min.data()), gap_max(bounds.gap_max.data()) {}

    static constexpr float lowest = -infinity, highest = infinity;
    const float *lower, *upper;
    std::size_t lower_mask, upper_mask;
    const float *gap_min, *gap_max;
};

/// Calls visit(tile, depths, drawn) for the tiles that make up tile (x, y) of a grid of 2^shift times the
/// view's tile size; `drawn` is false for those with nothing to light. Returns how many tiles there are.
template <class Visit>
int each_tile(const View& view, const BoundsReader& bounds, int shift, int x, int y, Visit visit) {
    const int x0 = x << shift, x1 = (std::min)((x + 1) << shift, view.tiles_x());
    const int y0 = y << shift, y1 = (std::min)((y + 1) << shift, view.tiles_y());
    for (int row = y0; row < y1; ++row) {
        const std::size_t line = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.tiles_x());
        for (std::size_t tile = line + static_cast<std::size_t>(x0),
                         end = line + static_cast<std::size_t>(x1);
             tile < end; ++tile) {
            const DepthInterval depths = {bounds.lower[tile & bounds.lower_mask],
                                          bounds.upper[tile & bounds.upper_mask]};
            visit(tile, depths, !(depths.min > depths.max));
        }
    }
    return (x1 - x0) * (y1 - y0);
}

inline CellBounds merge_bounds(const View& view, const BoundsReader& bounds, int shift, int x, int y) {
    float lowest = infinity, highest = -infinity;
    int count = 0;
    const int tiles =
        each_tile(view, bounds, shift, x, y, [&](std::size_t, DepthInterval depths, bool drawn) {
            const float low = drawn ? depths.min : infinity, high = drawn ? depths.max : -infinity;
            lowest = low < lowest ? low : lowest;
            highest = high > highest ? high : highest;
            count += drawn;
        });
    return {.min = lowest, .max = highest, .drawn = static_cast<double>(count) / tiles};
}

/// Finds the gap around the middle of the cell's depths. What lies before or behind a tile's own gap counts
/// as drawn all over, so this gap is at most as wide as reduce_depth() would find.
inline void merge_gaps(const View& view, const BoundsReader& bounds, int shift, int x, int y,
                       CellBounds& cell) {
    const float middle = cell.min / 2 + cell.max / 2;
    each_tile(view, bounds, shift, x, y, [&](std::size_t tile, DepthInterval depths, bool drawn) {
        if (!drawn) return;
        const bool gap = bounds.gap_min[tile] < bounds.gap_max[tile];
        const DepthInterval parts[] = {{depths.min, gap ? bounds.gap_min[tile] : depths.max},
                                       {gap ? bounds.gap_max[tile] : depths.min, depths.max}};
        for (const DepthInterval& part : parts) {
            if (part.min <= middle) cell.gap_min = (std::max)(cell.gap_min, (std::min)(part.max, middle));
            if (part.max >= middle) cell.gap_max = (std::min)(cell.gap_max, (std::max)(part.min, middle));
        }
    });
}

/// How many pixels of an axis of `pixels` pixels lie in the tiles first..last.
inline double pixels_in(int first, int last, int tile_size, int pixels) {
    return (std::min)((last + 1) * tile_size, pixels) - first * tile_size;
}

/// Tiles x0..x1, y0..y1 of a light in view, in a grid of 2^shift times the view's tile size.
struct ScaledRect {
    ScaledRect(const FootprintArrays& lights, std::size_t i, int shift)
        : x0(lights.x0[i] >> shift), y0(lights.y0[i] >> shift), x1(lights.x1[i] >> shift),
          y1(lights.y1[i] >> shift) {}

    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    double area() const { return static_cast<double>(width()) * height(); }
    double supertiles() const { return static_cast<double>((x1 / 8 - x0 / 8 + 1) * (y1 / 8 - y0 / 8 + 1)); }

    int x0, y0, x1, y1;
};

/// True where visible light i reaches tile (x, y) of a grid of 2^shift times the view's tile size: by the row
/// spans of the view's own tiles, which bound those of larger ones.
inline bool in_silhouette(const FootprintArrays& lights, std::size_t i, int shift, int x, int y) {
    if (lights.span_begin[i] == FootprintArrays::whole_rectangle) return true;
    const int end = (std::min)((y + 1) << shift, lights.y1[i] + 1);
    for (int row = (std::max)(y << shift, int{lights.y0[i]}); row < end; ++row) {
        const RowSpan span =
            lights.spans[lights.span_begin[i] + static_cast<std::uint32_t>(row - lights.y0[i])];
        if (span.first <= span.last && span.first >> shift <= x && span.last >> shift >= x) return true;
    }
    return false;
}

/// Whether a light meets the cell of tile (x, y) of a grid of 2^shift times the view's tile size, by depth
/// test: asks the tests that bin, the scalar tier's. None finds more than the one before it.
inline std::array<bool, 4> depth_tests_met(const View& view, const BoundsReader& bounds, const Camera& grid,
                                           int shift, int x, int y, CellBounds cell, const Sphere& sphere) {
    std::array<bool, 4> met = {true, false, false, false};
    const TestedLight light(grid, sphere);
    float cells[12 * 64];  // planes of 64 tiles, of which the first is the one
    cells[0] = cell.min;
    cells[64] = cell.max;
    met[1] = cell.drawn > 0 && scalar::tiles_met<DepthTest::interval>(cells, light, 1) != 0;
    if (!met[1]) return met;
    float x0, x1, y0, y1;
    tile_edges(grid.x, x, x0, x1);
    tile_edges(grid.y, y, y0, y1);
    scalar::store_boxes<DepthTest::box>(grid, cells, x0, x1, y0, y1, cell.min, cell.max, 0, 0);
    met[2] = scalar::tiles_met<DepthTest::box>(cells, light, 1) != 0;
    if (!met[2] || bounds.gap_min == nullptr) return met;
    merge_gaps(view, bounds, shift, x, y, cell);
    scalar::store_boxes<DepthTest::split_box>(grid, cells, x0, x1, y0, y1, cell.min, cell.max, cell.gap_min,
                                              cell.gap_max);
    met[3] = scalar::tiles_met<DepthTest::split_box>(cells, light, 1) != 0;
    return met;
}

/// How many pixels lie in tiles that have something to light, by a sample of the tiles.
inline double lit_pixels(const View& view, const BoundsReader& bounds, std::size_t most_tiles) {
    const std::size_t count = (std::min)(view.tile_count(), most_tiles);
    double lit = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int tile = static_cast<int>(spread(i, count, static_cast<double>(view.tile_count())));
        lit += merge_bounds(view, bounds, 0, tile % view.tiles_x(), tile / view.tiles_x()).drawn;
    }
    return count == 0 ? 0 : lit / static_cast<double>(count) * view.viewport().width * view.viewport().height;
}

/// Surveys grids of the view's tile size, of 2, 4 and 8 times it, and of one tile. Sums over rectangles are
/// exact for the sampled lights. What silhouettes and depth tests leave of them is estimated from (light,
/// tile) pairs, drawn in proportion to the rectangles' areas: the same pairs for every option, and the same
/// lights and places on the screen for every grid, so that comparisons are sharper than the numbers.
template <class Light, class ToViewSphere>
Survey survey(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights, const ZBounds& z_bounds,
              std::size_t most_lights = 1024, std::size_t most_pairs = 192) {
    const std::size_t count = lights.array.size(), sampled = (std::min)(count, most_lights);
    Buffer<Sphere> buffer;
    Sphere* spheres = buffer.room(sampled);
    for (std::size_t i = 0; i < sampled; ++i) {
        const std::size_t place =
            sampled == count ? i : static_cast<std::size_t>(spread(i, sampled, static_cast<double>(count)));
        spheres[i] = std::invoke(lights.to_view_sphere, lights.array[place]);
    }
    Footprints<Footprint::rectangle, false> footprints;
    footprints.project(isa, view, view_space(std::span<const Sphere>(spheres, sampled)), Parallel());
    const FootprintArrays& sample = footprints.arrays();
    const std::size_t visible = footprints.visible();
    const double lights_each = sampled > 0 ? static_cast<double>(count) / static_cast<double>(sampled) : 0;

    const BoundsReader bounds(z_bounds);
    const bool with_depth = !z_bounds.min.empty() || !z_bounds.max.empty();
    Survey result;
    result.lights = static_cast<double>(count);
    result.visible = static_cast<double>(visible) * lights_each;
    result.pixels = lit_pixels(view, bounds, 64);

    // Grids, and sums over rectangles.
    const Extent screen = view.viewport();
    const int longest = (std::max)(screen.width, screen.height);
    std::array<View, Survey::most_grids> views = {view, view, view, view, view};
    std::array<double, Survey::most_grids> rect_pixels = {};
    for (int shift = 0; shift == 0 || (shift <= 3 && view.tile_size() <= (longest - 1) >> shift); ++shift) {
        GridSurvey& grid = result.grids[result.grid_count++];
        grid.tile_size = view.tile_size() << shift;
        views[static_cast<std::size_t>(shift)] = *view.with_tile_size(grid.tile_size);
        grid.tiles = static_cast<double>(views[static_cast<std::size_t>(shift)].tile_count());
        for (std::size_t i = 0; i < visible; ++i) {
            const ScaledRect rect(sample, i, shift);
            grid.candidates += rect.area();
            grid.rows += rect.height();
            grid.supertiles += rect.supertiles();
            rect_pixels[static_cast<std::size_t>(shift)] +=
                pixels_in(rect.x0, rect.x1, grid.tile_size, screen.width) *
                pixels_in(rect.y0, rect.y1, grid.tile_size, screen.height);
        }
        for (const Footprint footprint : {Footprint::rectangle, Footprint::silhouette})
            for (const DepthTest depth_test :
                 {DepthTest::none, DepthTest::interval, DepthTest::box, DepthTest::split_box}) {
                if (depth_test != DepthTest::none && !with_depth) continue;
                if (depth_test == DepthTest::split_box && bounds.gap_min == nullptr) continue;
                grid.rungs[grid.rung_count++] = {.footprint = footprint, .depth_test = depth_test};
            }
    }
    const std::span<GridSurvey> grids(result.grids.data(), result.grid_count);

    // The pairs: a light and a place in its rectangle.
    const int drawn_shift = grids.size() > 1 ? 1 : 0;
    const double area = grids[static_cast<std::size_t>(drawn_shift)].candidates;
    const std::size_t pairs = visible == 0 ? 0 : (std::clamp)(8 * visible, most_pairs / 8, most_pairs);
    struct Pair {
        std::size_t light;  ///< in the order of first use
        double u, v;
    };
    Buffer<Pair> pair_buffer;
    Buffer<Sphere> used_buffer;
    Pair* const drawn_pairs = pair_buffer.room(pairs);
    Sphere* const used = used_buffer.room(pairs);
    std::size_t used_count = 0;
    double before = 0;  // area of the lights before this one
    for (std::size_t pair = 0, light = 0, last = visible; pair < pairs; ++pair) {
        const double place = spread(pair, pairs, area);
        ScaledRect rect(sample, light, drawn_shift);
        while (before + rect.area() <= place && light + 1 < visible) {
            before += rect.area();
            rect = ScaledRect(sample, ++light, drawn_shift);
        }
        if (light != last) used[used_count++] = spheres[sample.ids[light]];
        last = light;
        const int tile = static_cast<int>(place - before);
        drawn_pairs[pair] = {used_count - 1, (tile % rect.width() + 0.5) / rect.width(),
                             (tile / rect.width() + 0.5) / rect.height()};
    }
    Footprints<Footprint::silhouette, true> silhouettes;
    silhouettes.project(isa, view, view_space(std::span<const Sphere>(used, used_count)), Parallel());

    // What is left of them.
    std::array<double, Survey::most_grids> tried = {}, tried_pixels = {};
    for (const Pair& pair : std::span(drawn_pairs, pairs)) {
        const std::size_t light = pair.light;
        const double drawn_area = ScaledRect(silhouettes.arrays(), light, drawn_shift).area();
        for (int shift = 0; shift < static_cast<int>(grids.size()); ++shift) {
            const std::size_t at = static_cast<std::size_t>(shift);
            const ScaledRect rect(silhouettes.arrays(), light, shift);
            const int x = rect.x0 + static_cast<int>(pair.u * rect.width());
            const int y = rect.y0 + static_cast<int>(pair.v * rect.height());
            const CellBounds cell = with_depth ? merge_bounds(view, bounds, shift, x, y) : CellBounds();
            const bool inside = in_silhouette(silhouettes.arrays(), light, shift, x, y);
            std::array<bool, 4> met = {true};
            if (with_depth)
                met = depth_tests_met(view, bounds, views[at].camera(), shift, x, y, cell, used[light]);
            const double weight = rect.area() / drawn_area;
            const double pixels = weight * pixels_in(x, x, grids[at].tile_size, screen.width) *
                                  pixels_in(y, y, grids[at].tile_size, screen.height);
            tried[at] += weight;
            tried_pixels[at] += pixels;
            for (Rung& rung : std::span(grids[at].rungs).first(grids[at].rung_count)) {
                if (!met[static_cast<std::size_t>(rung.depth_test)]) continue;
                if (rung.footprint == Footprint::silhouette && !inside) continue;
                rung.entries += weight;
                rung.evaluations += pixels * cell.drawn;
            }
        }
    }
    for (std::size_t at = 0; at < grids.size(); ++at) {
        GridSurvey& grid = grids[at];
        grid.candidates *= lights_each;
        grid.rows *= lights_each;
        grid.supertiles *= lights_each;
        for (Rung& rung : grid.rungs) {
            rung.entries *= pairs == 0 ? 0 : grid.candidates / tried[at];
            rung.evaluations *= pairs == 0 ? 0 : lights_each * rect_pixels[at] / tried_pixels[at];
        }
    }

    // One list for the whole screen: the lights in view.
    if (longest > grids.back().tile_size) {
        GridSurvey& whole = result.grids[result.grid_count++];
        whole.tile_size = longest;
        whole.tiles = 1;
        whole.candidates = whole.rows = whole.supertiles = result.visible;
        whole.rungs[whole.rung_count++] = {.entries = result.visible,
                                           .evaluations = result.visible * result.pixels};
    }
    return result;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
