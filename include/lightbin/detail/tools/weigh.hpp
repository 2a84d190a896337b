// SPDX-License-Identifier: MIT
// How advise() and advise_slices() measure plans, and how Advice finds what techniques save.
#pragma once

#include <lightbin/advise.hpp>
#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>

#include <cmath>
#include <cstdio>
#include <tuple>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

inline std::string to_string(const AdviceVerdict& verdict) {
    const bool weighed = !verdict.instead.empty(), gains = verdict.saved_ns >= 0;
    const char* said = verdict.keep ? "keep: no other was weighed" : "leave out: was not weighed";
    if (weighed && verdict.keep) said = gains ? "keep: saves" : "keep: costs only";
    if (weighed && !verdict.keep) said = gains ? "leave out: would cost" : "leave out: would save only";
    char line[100];
    std::snprintf(line, sizeof line, "%-12s %s", verdict.part.c_str(), said);
    std::string words = line;
    if (!weighed) return words + "\n";
    std::snprintf(line, sizeof line, " %.3f ms", std::fabs(verdict.saved_ns) * 1e-6);
    words += line;
    words.resize((std::max)(words.size() + 1, std::size_t{50}), ' ');
    return words + "instead: " + verdict.instead + "\n";
}

LIGHTBIN_SMALL inline std::vector<AdviceVerdict> Advice::verdicts(const AdvicePlan& plan) const {
    constexpr std::pair<const char*, bool (*)(const AdvicePlan&)> parts[] = {
        {"tiles", [](const AdvicePlan& p) { return p.tiled; }},
        {"masks", [](const AdvicePlan& p) { return p.tiled && p.masks; }},
        {"pre-pass", [](const AdvicePlan& p) { return p.has_z_bounds(); }},
        {"depth test", [](const AdvicePlan& p) { return p.tiled && p.depth_test; }},
        {"clusters", [](const AdvicePlan& p) { return p.tiled && p.slicing == Slicing::clusters; }},
        {"z-bins", [](const AdvicePlan& p) { return p.tiled && p.slicing == Slicing::z_bins; }}};
    std::vector<AdviceVerdict> all;
    for (const auto& [part, has] : parts) {
        AdviceVerdict verdict = {.part = part, .keep = has(plan), .instead = {}};
        for (const AdvicePlan& other : plans()) {
            if (has(other) == verdict.keep) continue;
            verdict.other = other;
            verdict.instead = to_string(other);
            verdict.saved_ns = other.total_ns - plan.total_ns;
            break;
        }
        all.push_back(std::move(verdict));
    }
    return all;
}

inline std::string to_string(const Advice& advice) {
    char line[160];
    std::snprintf(line, sizeof line, "%.3f ms a frame: %s; the cheapest of %zu plans\n",
                  advice.best().total_ns * 1e-6, to_string(advice.best()).c_str(), advice.plans().size());
    std::string lines = line;
    for (const AdviceVerdict& verdict : advice.verdicts(advice.best()))
        lines += to_string(verdict);
    return lines;
}

namespace detail {

/// The size of the image that tile columns and rows divide: with a turned projection, width and height are exchanged.
inline ImageSize size_of_grid(const View& view) {
    return {camera_of(view).x.split.side, camera_of(view).y.split.side};
}

/// A view with one of the tile sizes that advise() and advise_slices() try, and the Z bounds of its tiles.
struct WeighedGrid {
    View view;
    /// The caller's Z bounds or, for tiles larger than the caller's, merged bounds, which the std::vectors below hold.
    ZBounds bounds;
    std::vector<float> lowest, highest;

    /// Merges the Z bounds of the caller's fine tiles.
    WeighedGrid(const View& fine, const ZBounds& of_fine, int tile_size)
        : view(*fine.with_tile_size(tile_size)), bounds(of_fine), lowest(view.tile_count(), infinity),
          highest(view.tile_count(), -infinity) {
        if (tile_size == fine.tile_size()) return;
        const int size = fine.tile_size();
        for_each_drawn(fine, of_fine, [&](int x, int y, float low, float high) {
            const auto tile = static_cast<std::size_t>(y * size / tile_size * view.tiles_x() + x * size / tile_size);
            lowest[tile] = (std::min)(lowest[tile], low);
            highest[tile] = (std::max)(highest[tile], high);
        });
        if (!bounds.min.empty()) bounds.min = lowest;
        if (!bounds.max.empty()) bounds.max = highest;
    }
    WeighedGrid(WeighedGrid&&) = default;  // the spans of a copy would point into the original
};

/// Returns a view whose image is moved sideways by a part of its width.
inline View moved_aside(const View& view, double part) {
    Matrix matrix = projection_of(view).matrix;
    for (double(&column)[4] : matrix.columns)
        column[0] += 2 * part * column[3];
    const auto clip_depth = static_cast<ClipDepth>(projection_of(view).depth.zero_to_one);
    const auto moved = View::from_projection(matrix, view.viewport(),
                                             {.tile_size = view.tile_size(),
                                              .clip_depth = clip_depth,
                                              .origin = view.origin(),
                                              .reversed_z = view.reversed_z()});
    return moved ? *moved : view;
}

/// Times a Binner with each of the options `measured`, and MaskBinners, on grids of several tile sizes.
///
/// for_each_visible  for_each_visible(visit) calls visit(x, y, depth, pixels) for every point with something to light:
///                   its pixel, its depth (read only with slices), and the number of pixels that it stands for
template <class Clock, Options... measured, class LightRange, class ForEachVisible>
LIGHTBIN_SMALL Result<Advice> weigh(const View& view, const ZBounds& bounds, const WeighedSlices& slices,
                                    const LightRange& lights, const AdviceCosts& costs,
                                    ForEachVisible for_each_visible) {
    if (view.tile_size() == 0) return Error{ErrorCode::tile_size_out_of_range};
    // The grids: tiles of the view's tile size, of 2, 4 and 8 times that size while that is smaller than the screen,
    // and one tile as large as the screen.
    std::vector<WeighedGrid> grids;
    const int whole = (std::max)({view.viewport().width, view.viewport().height, view.tile_size()});
    for (int size = view.tile_size(); size < whole && grids.size() < 4;
         size = size > whole / 2 ? whole : 2 * size)
        grids.emplace_back(view, bounds, size);
    grids.emplace_back(view, bounds, whole);
    std::tuple<Binner<measured>...> binners;
    const auto for_each_binner = [&](auto visit) { std::apply([&](auto&... each) { (visit(each), ...); }, binners); };
    MaskBinner mask_binner;
    // Builds the masks or lists of a plan, with the image moved sideways by `aside` of its width. plan.build_ns becomes
    // the time that this took, if it is less than before. If this is the plan's `first` build, it also counts the light
    // evaluations of all pixels or, with masks, the words of masks that they look at.
    const auto build = [&](AdvicePlan& plan, double aside, bool first) -> std::optional<Error> {
        const WeighedGrid* grid = grids.data();
        while (grid->view.tile_size() != plan.tile_size)
            ++grid;
        const View moved = moved_aside(grid->view, aside);
        const bool binned = plan.slicing == Slicing::z_bins, clusters = plan.slicing == Slicing::clusters;
        const Slices& by = clusters ? slices.clusters : slices.z_bins;
        const double layers = plan.has_z_bounds() ? 1 : costs.overdraw;
        const auto timed = [&](const auto& bin) {
            const auto start = Clock::now();
            const auto built = bin();
            const std::chrono::duration<double, std::nano> time = Clock::now() - start;
            const double with_bounds = time.count() + (plan.has_z_bounds() ? costs.z_bounds_ns : 0);
            if (built) plan.build_ns = (std::min)(plan.build_ns, with_bounds);
            return built;
        };
        const auto build_masks = [&]() -> std::optional<Error> {
            const auto built = timed([&] {
                return binned ? mask_binner.bin(moved, lights, by) : mask_binner.bin(moved, lights);
            });
            if (!built) return built.error();
            if (!first) return std::nullopt;
            plan.upload_ns = costs.upload_byte_ns * static_cast<double>(built->words().size_bytes());
            plan.entries = built->words().size();
            for_each_visible([&](int, int, float depth, double pixels) {
                std::uint32_t words = built->mask_words();
                if (binned) {
                    const BinRange bin = built->bins()[static_cast<std::size_t>(by.slice_at(depth))];
                    words = min_of(words, bin.greatest / 32 + 1 - bin.least / 32);  // a bin without lights is {1, 0}
                }
                plan.words += layers * pixels * words;
            });
            return std::nullopt;
        };
        const auto build_lists = [&]<Options options>(Binner<options>& binner) -> std::optional<Error> {
            const auto built = timed([&] { return binner.bin(moved, lights, inputs_for<options>(grid->bounds, by)); });
            if (!built) return built.error();
            if (!first) return std::nullopt;
            const LightRanks& ranks = built->ranks();
            plan.upload_ns = costs.upload_byte_ns *
                             static_cast<double>(built->ranges().size_bytes() + built->ids().size_bytes() +
                                                 ranks.order.size_bytes() + ranks.bins.size_bytes());
            plan.entries = built->ids().size();
            for_each_visible([&](int x, int y, float depth, double pixels) {
                const int slice = binned || clusters ? by.slice_at(depth) : 0;
                auto list = built->lights_in(x / plan.tile_size, y / plan.tile_size, clusters ? slice : 0);
                if (binned) list = lights_of_bin(list, ranks.bins[static_cast<std::size_t>(slice)]);
                plan.evaluations += layers * pixels * static_cast<double>(list.size());
            });
            return std::nullopt;
        };
        if (plan.masks) return build_masks();
        std::optional<Error> error;
        for_each_binner([&]<Options options>(Binner<options>& binner) {
            if (plan.depth_test == options.depth_test && plan.slicing == options.slicing) error = build_lists(binner);
        });
        return error;
    };

    const auto& source = as_lights(lights);
    std::vector<AdvicePlan> plans = {{.tiled = false}};
    for_each_visible([&](int, int, float, double pixels) {
        plans[0].evaluations += costs.overdraw * pixels * static_cast<double>(light_count(source));
    });
    std::optional<Error> error;
    for (const WeighedGrid& grid : grids)
        for_each_binner([&]<Options options>(const Binner<options>&) {
            const bool lacks_bounds = grid.bounds.min.empty() && grid.bounds.max.empty();
            if (error || (options.depth_test && options.slicing == Slicing::none && lacks_bounds)) return;
            AdvicePlan plan = {.depth_test = options.depth_test,
                               .slicing = options.slicing,
                               .tile_size = grid.view.tile_size(),
                               .build_ns = HUGE_VAL};
            error = build(plan, 0, true);
            plans.push_back(plan);
            if (error || options.depth_test || options.slicing == Slicing::clusters) return;
            plan.masks = true;  // of the same lights, so that pixels evaluate as many
            plan.build_ns = HUGE_VAL;
            error = build(plan, 0, true);
            plans.push_back(plan);
        });
    if (error) return *error;

    // Each turn builds all plans, so that a slow moment of the machine slows all of them alike. The first builds,
    // above, took longer because they allocated memory. In each turn the image is moved sideways, by up to 1/32 of
    // its width, because branch predictors learn a scene that is built repeatedly, which halves the time of
    // some plans. After two turns a plan's time is assumed to be at most twice its true time, so plans that would not
    // be the cheapest even at half their time are not built again.
    constexpr int turns = 8;
    for (int turn = 0;; ++turn) {
        double least = HUGE_VAL;
        for (AdvicePlan& plan : plans) {
            plan.total_ns = plan.build_ns + plan.upload_ns +
                            (plan.evaluations + plan.words * costs.word_evaluations) * costs.evaluation_ns;
            least = (std::min)(least, plan.total_ns);
        }
        if (turn == turns) return Advice(std::move(plans));
        const double aside = (2.0 * turn / (turns - 1) - 1) / 32;
        for (AdvicePlan& plan : plans)
            if (plan.tiled && (turn < 2 || plan.total_ns - 0.5 * plan.build_ns < least))
                static_cast<void>(build(plan, aside, false));
    }
}

}  // namespace detail

template <class Clock, class LightRange>
Result<Advice> advise(const View& view, const LightRange& lights, const AdviceCosts& costs, const ZBounds& bounds) {
    for (const std::span<const float> side : {bounds.min, bounds.max})
        if (!side.empty() && side.size() < view.tile_count())
            return Error{ErrorCode::z_bounds_too_small, view.tile_count(), side.size()};

    const ImageSize window = detail::size_of_grid(view);
    const int size = view.tile_size();
    const Slices one = *Slices::from_boundaries({});  // read by no plan
    constexpr Options lists, tested = {.depth_test = true};
    return detail::weigh<Clock, lists, tested>(view, bounds, {one, one}, lights, costs, [&](auto visit) {
        detail::for_each_drawn(view, bounds, [&](int x, int y, float low, float) {
            x *= size;
            y *= size;
            visit(x, y, low, 1.0 * (std::min)(size, window.width - x) * (std::min)(size, window.height - y));
        });
    });
}

template <class Clock, class LightRange>
Result<Advice> advise_slices(const View& view, const LightRange& lights, const WeighedSlices& slices,
                             const DepthSamples& samples, const AdviceCosts& costs) {
    const ImageSize window = view.viewport(), grid = samples.size;
    const auto side = [](int n) { return static_cast<std::uint64_t>((std::max)(n, 0)); };
    const std::uint64_t count = side(grid.width) * side(grid.height);
    if (samples.depths.size() < count)
        return Error{ErrorCode::depth_buffer_too_small, count, samples.depths.size()};
    const double pixels =
        1.0 * window.width * window.height / static_cast<double>((std::max)(count, std::uint64_t{1}));
    // Returns the pixel column (or row) at the middle of column (or row) i of the samples.
    const auto pixel = [](std::int64_t i, std::int64_t samples_across, int pixels_across) {
        return static_cast<int>((2 * i + 1) * pixels_across / (2 * samples_across));
    };
    constexpr Options lists, z_bins = {.slicing = Slicing::z_bins}, clusters = {.slicing = Slicing::clusters},
                             tested = {.depth_test = true, .slicing = Slicing::clusters};
    return detail::weigh<Clock, lists, z_bins, clusters, tested>(
        view, {}, slices, lights, costs, [&](auto visit) {
            if (view.tile_count() == 0) return;
            const float* depth = samples.depths.data();
            for (int y = 0; y < grid.height; ++y)
                for (int x = 0; x < grid.width; ++x, ++depth)
                    if (std::isfinite(*depth)) {
                        int column = pixel(x, grid.width, window.width), row = pixel(y, grid.height, window.height);
                        if (view.turned()) std::swap(column, row);
                        visit(column, row, *depth, pixels);
                    }
        });
}

}}  // namespace lightbin
