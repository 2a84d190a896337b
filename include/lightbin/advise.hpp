// SPDX-License-Identifier: MIT
// What a scene can do without: the options and the tile size that cost least, to build and to shade, measured on
// the scene itself.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/rounding.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/result.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cfloat>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// What advise() can't measure. Times in nanoseconds a frame, 0 or more.
struct Costs {
    /// One light evaluated at one pixel, as the whole device does it: about 0.005 to 0.05 on a GPU, 1 on a
    /// core.
    double evaluation_ns = 0.02;
    /// The depth pre-pass and the reduction to Z bounds, unless the renderer has them anyway.
    double z_bounds_ns = 0;
};

/// One way to light a view, and what it costs a frame. with_options() or with_sliced_options() applies its options, and
/// View::with_tile_size() its tile size.
struct Plan {
    bool tiled = true;  ///< false: every pixel evaluates every light; the next four are without meaning
    Footprint footprint = Footprint::rectangle;
    DepthTest depth_test = DepthTest::none;
    Slicing slicing = Slicing::none;  ///< advise_slices(): with the slices that it was given for this
    int tile_size = 0;
    double build_ns = 0;        ///< with Costs::z_bounds_ns where there are Z bounds
    std::uint64_t entries = 0;  ///< length of the light index list
    double evaluations = 0;     ///< sum over the pixels with something to light of their lists' lengths
    double total_ns = 0;        ///< build_ns + evaluations * Costs::evaluation_ns
};

/// Every plan that was weighed, the cheapest first.
class Advice {
public:
    explicit Advice(std::vector<Plan> plans) : plans_(std::move(plans)) {
        const auto is_cheaper = [](const Plan& a, const Plan& b) { return a.total_ns < b.total_ns; };
        // In their order where they cost the same; std::stable_sort is noisy with some compilers' warnings.
        for (auto plan = plans_.begin(); plan != plans_.end(); ++plan)
            std::rotate(std::upper_bound(plans_.begin(), plan, *plan, is_cheaper), plan, plan + 1);
    }

    const Plan& best() const { return plans_[0]; }
    std::span<const Plan> plans() const& { return plans_; }
    std::span<const Plan> plans() && = delete;  // would dangle

    /// Returns a table of the plans for a person, a line each. Allocates.
    std::string text() const {
        std::string lines = "   cost  tile  footprint   depth test  slicing      entries   build us  "
                            "M evaluations   total us\n";
        for (const Plan& plan : plans()) {
            char tile[16] = "-", line[160];
            if (plan.tiled) std::snprintf(tile, sizeof tile, "%d", plan.tile_size);
            std::snprintf(line, sizeof line, "%7.2f  %4s  %-10s  %-10s  %-8s  %10llu  %9.1f  %13.3f  %9.1f\n",
                          plan.total_ns / (std::max)(best().total_ns, 1.0), tile,
                          plan.tiled ? to_string(plan.footprint) : "no tiling",
                          plan.tiled ? to_string(plan.depth_test) : "-",
                          plan.tiled ? to_string(plan.slicing) : "-",
                          static_cast<unsigned long long>(plan.entries), plan.build_ns * 1e-3,
                          plan.evaluations * 1e-6, plan.total_ns * 1e-3);
            lines += line;
        }
        return lines;
    }

private:
    std::vector<Plan> plans_;
};

namespace detail {

/// What is weighed. Silhouettes beside a depth test were the cheapest in no scene that was measured with AVX-512, and
/// by 1 % at most with SSE2: a box leaves little for them to drop.
inline constexpr Options weighed[] = {{.footprint = Footprint::rectangle, .depth_test = DepthTest::none},
                                      {.footprint = Footprint::rectangle, .depth_test = DepthTest::interval},
                                      {.footprint = Footprint::rectangle, .depth_test = DepthTest::box},
                                      {.footprint = Footprint::rectangle, .depth_test = DepthTest::split_box},
                                      {.footprint = Footprint::silhouette, .depth_test = DepthTest::none}};

/// What is weighed where depth is known no sooner than it is shaded. Here silhouettes beside boxes are, too: without
/// them, the best plan cost up to 10 % more where an evaluation cost 1 ns.
inline constexpr Options weighed_sliced[] = {
    {.footprint = Footprint::rectangle},
    {.footprint = Footprint::silhouette},
    {.footprint = Footprint::rectangle, .slicing = Slicing::z_bins},
    {.footprint = Footprint::rectangle, .slicing = Slicing::clusters},
    {.footprint = Footprint::rectangle, .depth_test = DepthTest::box, .slicing = Slicing::clusters},
    {.footprint = Footprint::silhouette, .depth_test = DepthTest::box, .slicing = Slicing::clusters}};

/// A Binner's options for what is weighed, with the rest from `base`.
template <const auto& table, Options base, std::size_t i>
inline constexpr Options weighed_options = [] {
    Options options = base;
    options.footprint = table[i].footprint;
    options.depth_test = table[i].depth_test;
    options.slicing = table[i].slicing;
    return options;
}();

template <const auto& table, Options base, std::size_t i, class Visit>
decltype(auto) with_options_from(const Plan& plan, Visit& visit) {
    constexpr Options options = weighed_options<table, base, i>;
    const bool found = plan.footprint == options.footprint && plan.depth_test == options.depth_test &&
                       plan.slicing == options.slicing;
    if constexpr (i + 1 < std::size(table)) {
        if (!found) return with_options_from<table, base, i + 1>(plan, visit);
    } else {
        LIGHTBIN_ASSERT(found);
    }
    return visit.template operator()<options>();
}

template <const auto& table, Options base, std::size_t... i>
auto weighed_binners(std::index_sequence<i...>) -> std::tuple<Binner<weighed_options<table, base, i>>...>;

/// A grid that is weighed: the view's own, or one whose tiles are made of whole ones of the view's.
struct WeighedGrid {
    View view;
    ZBounds bounds;              ///< the caller's, or those below as far as the caller has them
    std::vector<double> pixels;  ///< by tile: those with something to light, as far as the bounds tell
    std::vector<float> lowest, highest, gap_begin, gap_end;

    /// What lies before or behind a fine tile's gap counts as drawn all over, so the gaps around the middle of the
    /// depths are at most as wide as reduce_depth() would find.
    WeighedGrid(const View& fine, const ZBounds& of_fine, int tile_size)
        : view(*fine.with_tile_size(tile_size)), bounds(of_fine), pixels(view.tile_count()),
          lowest(view.tile_count(), infinity), highest(view.tile_count(), -infinity), gap_begin(highest),
          gap_end(lowest) {
        const auto read = [](std::span<const float> side, std::size_t tile, float endless) {
            return side.empty() || std::isnan(side[tile]) ? endless : side[tile];
        };
        const auto for_each_drawn = [&](auto merge) {
            const auto [width, height] = view.viewport();
            const int size = fine.tile_size();
            std::size_t from = 0;
            for (int y = 0; y < height; y += size)
                for (int x = 0; x < width; x += size, ++from) {
                    const float low = read(of_fine.min, from, -infinity),
                                high = read(of_fine.max, from, infinity);
                    const int tile = y / tile_size * view.tiles_x() + x / tile_size;
                    const double area = 1.0 * (std::min)(size, width - x) * (std::min)(size, height - y);
                    if (!(low > high)) merge(static_cast<std::size_t>(tile), from, low, high, area);
                }
        };
        for_each_drawn([&](std::size_t tile, std::size_t, float low, float high, double area) {
            pixels[tile] += area;
            lowest[tile] = (std::min)(lowest[tile], low);
            highest[tile] = (std::max)(highest[tile], high);
        });
        if (tile_size == fine.tile_size()) return;
        for_each_drawn([&](std::size_t tile, std::size_t from, float low, float high, double) {
            const float middle = 0.5f * std::clamp(lowest[tile], -FLT_MAX, FLT_MAX) +
                                 0.5f * std::clamp(highest[tile], -FLT_MAX, FLT_MAX);
            const auto draw = [&](float nearest, float farthest) {
                if (nearest <= middle)
                    gap_begin[tile] = (std::max)(gap_begin[tile], (std::min)(farthest, middle));
                if (farthest >= middle)
                    gap_end[tile] = (std::min)(gap_end[tile], (std::max)(nearest, middle));
            };
            const float end = read(of_fine.gap_min, from, infinity),
                        begin = read(of_fine.gap_max, from, -infinity);
            draw(low, end < begin ? end : high);
            draw(end < begin ? begin : low, high);
        });
        const auto merged = [](std::span<const float> given, const std::vector<float>& side) {
            return given.empty() ? given : std::span<const float>(side);
        };
        bounds = {.min = merged(of_fine.min, lowest),
                  .max = merged(of_fine.max, highest),
                  .gap_min = merged(of_fine.gap_min, gap_begin),
                  .gap_max = merged(of_fine.gap_max, gap_end)};
    }
    WeighedGrid(WeighedGrid&&) = default;  // a copy's bounds would be this one's
};

/// Whether Z bounds allow a depth test. That of clusters needs none.
inline bool allowed(const Options& options, const ZBounds& bounds) {
    if (options.depth_test == DepthTest::none || options.slicing == Slicing::clusters) return true;
    if (options.depth_test == DepthTest::split_box)
        return !bounds.gap_min.empty() && !bounds.gap_max.empty();
    return !bounds.min.empty() || !bounds.max.empty();
}

/// The grids of the view's tiles, and of 2, 4 and 8 times as large ones as far as they are smaller than the screen, and
/// of one as large.
inline std::vector<WeighedGrid> weighed_grids(const View& view, const ZBounds& bounds) {
    std::vector<WeighedGrid> grids;
    const int whole = (std::max)({view.viewport().width, view.viewport().height, view.tile_size()});
    for (int size = view.tile_size(); size < whole && grids.size() < 4;
         size = size > whole / 2 ? whole : 2 * size)
        grids.emplace_back(view, bounds, size);
    grids.emplace_back(view, bounds, whole);
    return grids;
}

/// Weighs each of a table's options on each of the grids, by advise()'s turns.
///
/// pixels       with something to light
/// inputs       inputs.operator()<options>(grid) returns what a Binner needs beside the lights
/// evaluations  evaluations.operator()<options>(grid, built) returns what the pixels evaluate of a light grid
template <const auto& table, Options base, class Clock, class LightRange, class Inputs, class Evaluations>
Result<Advice> weigh(const std::vector<WeighedGrid>& grids, const LightRange& lights, const Costs& costs,
                     double pixels, Inputs inputs, Evaluations evaluations) {
    using Id = typename Binner<base>::Id;
    decltype(weighed_binners<table, base>(std::make_index_sequence<std::size(table)>())) binners;
    const auto build = [&](Plan& plan, const auto& seen, bool first) -> std::optional<Error> {
        const WeighedGrid* grid = grids.data();
        while (grid->view.tile_size() != plan.tile_size)
            ++grid;
        const auto with = [&]<Options options>() -> std::optional<Error> {
            Binner<options>& binner = std::get<Binner<options>>(binners);
            constexpr bool with_bounds =
                options.depth_test != DepthTest::none && options.slicing == Slicing::none;
            const auto start = Clock::now();
            const Result<LightGrid<Id>> built =
                binner.bin(grid->view, seen, inputs.template operator()<options>(*grid));
            const std::chrono::duration<double, std::nano> time = Clock::now() - start;
            if (!built) return built.error();
            plan.build_ns = (std::min)(plan.build_ns, time.count() + (with_bounds ? costs.z_bounds_ns : 0));
            if (!first) return std::nullopt;
            plan.entries = built->ids().size();
            plan.evaluations = evaluations.template operator()<options>(*grid, *built);
            return std::nullopt;
        };
        return with_options_from<table, base, 0>(plan, with);
    };

    const View& view = grids[0].view;
    const auto& source = as_lights(lights);
    std::vector<Plan> plans = {
        {.tiled = false, .evaluations = pixels * static_cast<double>(source.array.size())}};
    for (const WeighedGrid& grid : grids)
        for (const Options& options : table) {
            if (!allowed(options, grid.bounds)) continue;
            Plan plan = {.footprint = options.footprint,
                         .depth_test = options.depth_test,
                         .slicing = options.slicing,
                         .tile_size = grid.view.tile_size(),
                         .build_ns = HUGE_VAL};
            if (const auto error = build(plan, lights, true)) return *error;
            plans.push_back(plan);
        }

    // By turns: a slow moment of the machine meets all alike. Branch predictors learn a scene that is built again and
    // again, some plans by half, so each turn has the lights elsewhere: up to a 32nd of the picture to the side. The
    // first build found no memory. After two more, a time is taken for at most twice the true one.
    constexpr int turns = 8;
    for (int turn = 0;; ++turn) {
        double least = HUGE_VAL;
        for (Plan& plan : plans) {
            plan.total_ns = plan.build_ns + plan.evaluations * costs.evaluation_ns;
            least = (std::min)(least, plan.total_ns);
        }
        if (turn == turns) return Advice(std::move(plans));
        const float aside = static_cast<float>((2.0 * turn / (turns - 1) - 1) / 32 * view.tiles_x() /
                                               camera_of(view).x.scale);
        const auto moved = view_space(source.array, [&](const auto& light) {
            auto in_view = source.view_light(light);
            in_view.x += aside * (view.orthographic() ? 1 : in_view.z);
            return in_view;
        });
        for (Plan& plan : plans)
            if (plan.tiled && (turn < 2 || plan.total_ns - 0.5 * plan.build_ns < least))
                static_cast<void>(build(plan, moved, false));
    }
}

}  // namespace detail

/// Applies a plan: calls visit.operator()<options>() with its options as a constant, and returns what that returns. A
/// Binner is compiled for each of the options that advise() weighs, and for no other.
///
///     lightbin::with_options(plan, [&]<lightbin::Options options> {
///         lightbin::Binner<options> binner;
///         draw_frames(binner, *view.with_tile_size(plan.tile_size));  // a template of yours, which calls
///     });                                        // binner.bin(view, lights, inputs_for<options>(bounds))
///
/// plan  one of advise()'s. Of one that is not tiled the options mean nothing: look at Plan::tiled first
/// base  the options that a plan leaves to you: ids, isa
template <Options base = Options{}, class Visit>
decltype(auto) with_options(const Plan& plan, Visit&& visit) {
    return detail::with_options_from<detail::weighed, base, 0>(plan, visit);
}

/// The same for a plan of advise_slices(), some of whose options need slices: inputs_for<options>({}, slices) are the
/// inputs of each.
template <Options base = Options{}, class Visit>
decltype(auto) with_sliced_options(const Plan& plan, Visit&& visit) {
    return detail::with_options_from<detail::weighed_sliced, base, 0>(plan, visit);
}

/// Measures what the ways to light a view cost, on the scene itself: no tiling; tiles of the view's size, of 2, 4 and 8
/// times it, and one as large as the screen; each with rectangles or silhouettes, and as far as `bounds` allow with the
/// depth tests. So give the view of the smallest tiles that you would use. Errors: as bin(), if it refuses any of them.
///
/// Ask once a scene, not once a frame, and in the program as it is shipped, that is, optimised. Each grid is built 3
/// to 9 times, by turns and on this thread: once as it is, to count its entries and evaluations, then with the lights a
/// little to one side or the other, as a scene that is repeated is built faster than frames are. The shortest time
/// counts. That takes as long as some hundreds of builds of the view's tiles without options, where those are short a
/// thousand.
/// Allocates; keeps nothing.
///
/// lights  as for Binner::bin
/// bounds  of the view's own tiles; larger tiles' bounds are merged from them. None: no depth test is weighed, and every
///         pixel is taken to have something to light; where a third of them is sky, make Costs::evaluation_ns two thirds
/// base    the options that a plan leaves to you: ids, isa
/// Clock   as those of <chrono>: where other work keeps the cores busy, better one of this thread's own time
template <Options base = Options{}, class Clock = std::chrono::steady_clock, class LightRange>
Result<Advice> advise(const View& view, const LightRange& lights, const Costs& costs = {},
                      const ZBounds& bounds = {}) {
    for (const std::span<const float> side : {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max})
        if (!side.empty() && side.size() < view.tile_count())
            return Error{ErrorCode::z_bounds_too_small, view.tile_count(), side.size()};

    const std::vector<detail::WeighedGrid> grids = detail::weighed_grids(view, bounds);
    double pixels = 0;
    for (const double of_tile : grids[0].pixels)
        pixels += of_tile;
    return detail::weigh<detail::weighed, base, Clock>(
        grids, lights, costs, pixels,
        []<Options options>(const detail::WeighedGrid& grid) { return inputs_for<options>(grid.bounds); },
        []<Options options>(const detail::WeighedGrid& grid, const auto& built) {
            double sum = 0;
            for (std::size_t tile = 0; tile < grid.pixels.size(); ++tile)
                sum += grid.pixels[tile] * built.ranges()[tile].count;
            return sum;
        });
}

/// The view depths of what is lit, at points evenly spread over the viewport: of the frame before, or of a few that
/// tell what the scene is like.
struct DepthSamples {
    /// Row by row from the view's window origin. Where one is NaN or infinite there is nothing to light.
    std::span<const float> depths;
    Extent size;  ///< columns and rows, such as those of the depth buffer of an eighth of the size
};

/// The slices that are weighed.
struct WeighedSlices {
    const Slices& clusters;  ///< some dozens
    const Slices& z_bins;    ///< some hundreds
};

namespace detail {

/// How many lights what lies at a depth evaluates of a tile.
template <Slicing slicing, class Id>
std::size_t evaluated(const LightGrid<Id>& grid, int x, int y, const WeighedSlices& slices, float depth) {
    if constexpr (slicing == Slicing::none) {
        return grid.lights_in(x, y).size();
    } else if constexpr (slicing == Slicing::clusters) {
        return grid.lights_in(x, y, slices.clusters.slice_at(depth)).size();
    } else {
        const BinRange bin = grid.ranks().bins[static_cast<std::size_t>(slices.z_bins.slice_at(depth))];
        return lights_of_bin(grid.lights_in(x, y), bin).size();
    }
}

/// Calls visit(x, y, depth) for the samples with something to light, by the pixel in which they are.
template <class Visit> void for_each_sample(const View& view, const DepthSamples& samples, Visit visit) {
    const auto pixel = [](int i, int count, int pixels) {
        return static_cast<int>((2 * std::int64_t{i} + 1) * pixels / (2 * std::int64_t{count}));
    };
    const auto [width, height] = view.viewport();
    const auto [columns, rows] = samples.size;
    if (view.tile_count() == 0) return;
    const float* depth = samples.depths.data();
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x, ++depth)
            if (std::isfinite(*depth)) visit(pixel(x, columns, width), pixel(y, rows, height), *depth);
}

}  // namespace detail

/// The same where there is no depth pre-pass: no tiling; tiles with rectangles or silhouettes; with rectangles and
/// z-bins; clusters with rectangles, `none` and `box`, and with silhouettes and `box`; all on the same tile sizes. Each
/// sample stands for as many pixels as any other, which evaluate the lights of its tile, of its tile from its bin's
/// least to its greatest rank, or of its cell. with_sliced_options() applies a plan. Errors: as bin(), if it refuses any
/// of them; fewer depths than samples.size has.
///
/// Beside what advise() says of Z bounds for the same view, this tells what a pre-pass is worth. It takes longer, as
/// clusters of the smallest tiles do.
template <Options base = Options{}, class Clock = std::chrono::steady_clock, class LightRange>
Result<Advice> advise_slices(const View& view, const LightRange& lights, const WeighedSlices& slices,
                             const DepthSamples& samples, const Costs& costs = {}) {
    const auto [columns, rows] = samples.size;
    const std::uint64_t count = columns > 0 && rows > 0 ? std::uint64_t{1} * static_cast<unsigned>(columns) *
                                                              static_cast<unsigned>(rows)
                                                        : 0;
    if (samples.depths.size() < count)
        return Error{ErrorCode::depth_buffer_too_small, count, samples.depths.size()};
    const auto [width, height] = view.viewport();
    const double area = 1.0 * width * height / (std::max)(static_cast<double>(count), 1.0);
    double lit = 0;
    detail::for_each_sample(view, samples, [&](int, int, float) { ++lit; });
    return detail::weigh<detail::weighed_sliced, base, Clock>(
        detail::weighed_grids(view, {}), lights, costs, lit * area,
        [&]<Options options>(const detail::WeighedGrid&) {
            if constexpr (options.slicing == Slicing::z_bins)
                return inputs_for<options>({}, slices.z_bins);
            else
                return inputs_for<options>({}, slices.clusters);
        },
        [&]<Options options>(const detail::WeighedGrid& grid, const auto& built) {
            const int size = grid.view.tile_size();
            double sum = 0;
            detail::for_each_sample(view, samples, [&](int x, int y, float depth) {
                sum += static_cast<double>(
                    detail::evaluated<options.slicing>(built, x / size, y / size, slices, depth));
            });
            return sum * area;
        });
}

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR
