// SPDX-License-Identifier: MIT
// What a scene can do without: the options and the tile size that cost least, to build and to shade, measured on
// the scene itself.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/rounding.hpp>
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

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What advise() can't measure. Times in nanoseconds, 0 or more.
struct Costs {
    /// One light evaluated at one pixel, as the whole device does it: about 0.005 to 0.05 on a GPU, 1 on a
    /// core.
    double evaluation_ns = 0.02;
    /// The depth pre-pass and the reduction to Z bounds, unless the renderer has them anyway.
    double z_bounds_ns = 0;
    /// One byte of the lists on its way to where the shader reads it: 0.1 at 10 GB/s.
    double upload_byte_ns = 0;
    /// How many fragments are shaded for each pixel that is seen, where no depth pre-pass comes first: 1 or more. Plans
    /// without Z bounds evaluate the lights of all of them.
    double overdraw = 1;
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
    double upload_ns = 0;       ///< of the lists
    std::uint64_t entries = 0;  ///< length of the light index list
    /// Sum over the pixels with something to light of their lists' lengths; without Z bounds times Costs::overdraw.
    double evaluations = 0;
    double total_ns = 0;  ///< build_ns + upload_ns + evaluations * Costs::evaluation_ns

    bool has_z_bounds() const {
        return tiled && depth_test != DepthTest::none && slicing != Slicing::clusters;
    }
};

/// Returns a plan in words, such as "16 px, rectangle, box".
inline std::string to_string(const Plan& plan) {
    if (!plan.tiled) return "every light in every pixel";
    std::string words = std::to_string(plan.tile_size) + " px, " + to_string(plan.footprint);
    if (plan.depth_test != DepthTest::none) words += std::string(", ") + to_string(plan.depth_test);
    if (plan.slicing != Slicing::none) words += std::string(", ") + to_string(plan.slicing);
    return words;
}

/// What a part that a plan has is worth, or what one that it lacks would cost.
struct Verdict {
    std::string part;     ///< the part's name, such as "box"
    bool keep = false;    ///< whether the plan has the part
    Plan other = {};      ///< the cheapest weighed plan that differs from it in the part
    std::string instead;  ///< `other` in words; empty where no weighed plan differs in the part
    double saved_ns = 0;  ///< the frame's time by `other` minus that by the plan
};

/// Returns a line such as "box          keep: saves 1.200 ms                instead: 16 px, rectangle, interval".
inline std::string to_string(const Verdict& verdict) {
    const bool weighed = !verdict.instead.empty(), gains = verdict.saved_ns >= 0;
    const char* const keep = !weighed ? "keep: no other was weighed"
                             : gains  ? "keep: saves"
                                      : "keep: costs only";
    const char* const leave_out = !weighed ? "leave out: was not weighed"
                                  : gains  ? "leave out: would cost"
                                           : "leave out: would save only";
    char line[100];
    std::snprintf(line, sizeof line, "%-12s %s", verdict.part.c_str(), verdict.keep ? keep : leave_out);
    std::string words = line;
    if (!weighed) return words + "\n";
    std::snprintf(line, sizeof line, " %.3f ms", std::fabs(verdict.saved_ns) * 1e-6);
    words += line;
    words.resize((std::max)(words.size() + 1, std::size_t{50}), ' ');
    return words + "instead: " + verdict.instead + "\n";
}

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

    /// Returns a verdict on each part that a plan has or lacks. What it is held against is the cheapest plan that differs
    /// in the part, and may differ in others, too, as it would for whoever did without this one. Allocates.
    std::vector<Verdict> verdicts(const Plan& plan) const {
        constexpr std::pair<const char*, bool (*)(const Plan&)> parts[] = {
            {"tiles", [](const Plan& p) { return p.tiled; }},
            {"pre-pass", [](const Plan& p) { return p.has_z_bounds(); }},
            {"box", [](const Plan& p) { return p.tiled && p.depth_test >= DepthTest::box; }},
            {"split boxes", [](const Plan& p) { return p.tiled && p.depth_test == DepthTest::split_box; }},
            {"clusters", [](const Plan& p) { return p.tiled && p.slicing == Slicing::clusters; }},
            {"z-bins", [](const Plan& p) { return p.tiled && p.slicing == Slicing::z_bins; }},
            {"silhouettes", [](const Plan& p) { return p.tiled && p.footprint == Footprint::silhouette; }}};
        std::vector<Verdict> all;
        for (const auto& [part, has] : parts) {
            Verdict verdict = {.part = part, .keep = has(plan), .instead = {}};
            for (const Plan& other : plans()) {
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

private:
    std::vector<Plan> plans_;
};

/// Returns for a person what was found: the cheapest plan, and a line for each part, which it saves or would cost.
inline std::string to_string(const Advice& advice) {
    char line[160];
    std::snprintf(line, sizeof line, "%.3f ms a frame: %s; the cheapest of %zu plans\n",
                  advice.best().total_ns * 1e-6, to_string(advice.best()).c_str(), advice.plans().size());
    std::string lines = line;
    for (const Verdict& verdict : advice.verdicts(advice.best()))
        lines += to_string(verdict);
    return lines;
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
constexpr Options weighed_options(Options base, const Options& way) {
    base.footprint = way.footprint;
    base.depth_test = way.depth_test;
    base.slicing = way.slicing;
    return base;
}

template <const auto& table, Options base, std::size_t i, class Visit>
decltype(auto) with_options_from(const Plan& plan, Visit& visit) {
    constexpr Options options = weighed_options(base, table[i]);
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
auto weighed_binners(std::index_sequence<i...>) -> std::tuple<Binner<weighed_options(base, table[i])>...>;

/// The bound of a tile, or where there is none, an endless one.
inline float bound(std::span<const float> side, std::size_t tile, float endless) {
    return side.empty() || std::isnan(side[tile]) ? endless : side[tile];
}

/// Calls visit(x, y, tile, low, high) for the tiles with something to light, as far as the bounds tell: a tile's first
/// pixel and its depths.
template <class Visit> void for_each_drawn(const View& view, const ZBounds& bounds, Visit visit) {
    const auto [width, height] = view.viewport();
    const int size = view.tile_size();
    std::size_t tile = 0;
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size, ++tile) {
            const float low = bound(bounds.min, tile, -infinity), high = bound(bounds.max, tile, infinity);
            if (!(low > high)) visit(x, y, tile, low, high);
        }
}

/// A grid that is weighed: the view's own, or one whose tiles are made of whole ones of the view's.
struct WeighedGrid {
    View view;
    ZBounds bounds;  ///< the caller's, or those below as far as the caller has them
    std::vector<float> lowest, highest, gap_begin, gap_end;

    /// What lies before or behind a fine tile's gap counts as drawn all over, so the gaps around the middle of the
    /// depths are at most as wide as reduce_depth() would find.
    WeighedGrid(const View& fine, const ZBounds& of_fine, int tile_size)
        : view(*fine.with_tile_size(tile_size)), bounds(of_fine), lowest(view.tile_count(), infinity),
          highest(view.tile_count(), -infinity), gap_begin(highest), gap_end(lowest) {
        if (tile_size == fine.tile_size()) return;
        const auto tile_at = [&](int x, int y) {
            return static_cast<std::size_t>(y / tile_size * view.tiles_x() + x / tile_size);
        };
        for_each_drawn(fine, of_fine, [&](int x, int y, std::size_t, float low, float high) {
            const std::size_t tile = tile_at(x, y);
            lowest[tile] = (std::min)(lowest[tile], low);
            highest[tile] = (std::max)(highest[tile], high);
        });
        for_each_drawn(fine, of_fine, [&](int x, int y, std::size_t from, float low, float high) {
            const std::size_t tile = tile_at(x, y);
            const float middle = 0.5f * std::clamp(lowest[tile], -FLT_MAX, FLT_MAX) +
                                 0.5f * std::clamp(highest[tile], -FLT_MAX, FLT_MAX);
            const auto draw = [&](float nearest, float farthest) {
                if (nearest <= middle)
                    gap_begin[tile] = (std::max)(gap_begin[tile], (std::min)(farthest, middle));
                if (farthest >= middle)
                    gap_end[tile] = (std::min)(gap_end[tile], (std::max)(nearest, middle));
            };
            const float end = bound(of_fine.gap_min, from, infinity),
                        begin = bound(of_fine.gap_max, from, -infinity);
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
/// slices        null where no options of the table need them
/// for_each_lit  for_each_lit(visit) calls visit(x, y, depth, pixels) for what is lit: a pixel, how many it stands for,
///               and with slices their depth
template <const auto& table, Options base, class Clock, class LightRange, class ForEachLit>
Result<Advice> weigh(const View& view, const ZBounds& bounds, const WeighedSlices* slices,
                     const LightRange& lights, const Costs& costs, ForEachLit for_each_lit) {
    using Id = typename Binner<base>::Id;
    const std::vector<WeighedGrid> grids = weighed_grids(view, bounds);
    decltype(weighed_binners<table, base>(std::make_index_sequence<std::size(table)>())) binners;
    const auto build = [&](Plan& plan, const auto& seen, bool first) -> std::optional<Error> {
        const WeighedGrid* grid = grids.data();
        while (grid->view.tile_size() != plan.tile_size)
            ++grid;
        const auto with = [&]<Options options>() -> std::optional<Error> {
            Binner<options>& binner = std::get<Binner<options>>(binners);
            constexpr bool with_bounds =
                options.depth_test != DepthTest::none && options.slicing == Slicing::none;
            const Slices* const by = options.slicing == Slicing::none       ? nullptr
                                     : options.slicing == Slicing::clusters ? &slices->clusters
                                                                            : &slices->z_bins;
            const auto inputs = [&] {
                if constexpr (options.slicing == Slicing::none)
                    return inputs_for<options>(grid->bounds);
                else
                    return inputs_for<options>({}, *by);
            };
            const auto start = Clock::now();
            const Result<LightGrid<Id>> built = binner.bin(grid->view, seen, inputs());
            const std::chrono::duration<double, std::nano> time = Clock::now() - start;
            if (!built) return built.error();
            plan.build_ns = (std::min)(plan.build_ns, time.count() + (with_bounds ? costs.z_bounds_ns : 0));
            if (!first) return std::nullopt;
            const LightRanks& ranks = built->ranks();
            plan.upload_ns = costs.upload_byte_ns *
                             static_cast<double>(built->ranges().size_bytes() + built->ids().size_bytes() +
                                                 ranks.order.size_bytes() + ranks.bins.size_bytes());
            plan.entries = built->ids().size();
            for_each_lit([&](int x, int y, float depth, double pixels) {
                const int slice = by != nullptr ? by->slice_at(depth) : 0,
                          layer = options.slicing == Slicing::clusters ? slice : 0;
                auto met = built->lights_in(x / plan.tile_size, y / plan.tile_size, layer);
                if constexpr (options.slicing == Slicing::z_bins)
                    met = lights_of_bin(met, built->ranks().bins[static_cast<std::size_t>(slice)]);
                plan.evaluations += pixels * static_cast<double>(met.size());
            });
            if (!with_bounds) plan.evaluations *= costs.overdraw;
            return std::nullopt;
        };
        return with_options_from<table, base, 0>(plan, with);
    };

    const auto& source = as_lights(lights);
    std::vector<Plan> plans = {{.tiled = false}};
    for_each_lit([&](int, int, float, double pixels) {
        plans[0].evaluations += costs.overdraw * pixels * static_cast<double>(source.array.size());
    });
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
            plan.total_ns = plan.build_ns + plan.upload_ns + plan.evaluations * costs.evaluation_ns;
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

    const Extent window = view.viewport();
    const int size = view.tile_size();
    return detail::weigh<detail::weighed, base, Clock>(view, bounds, nullptr, lights, costs, [&](auto visit) {
        detail::for_each_drawn(view, bounds, [&](int x, int y, std::size_t, float low, float) {
            visit(x, y, low, 1.0 * (std::min)(size, window.width - x) * (std::min)(size, window.height - y));
        });
    });
}

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
    const Extent window = view.viewport(), grid = samples.size;
    const auto side = [](int n) { return static_cast<std::uint64_t>((std::max)(n, 0)); };
    const std::uint64_t count = side(grid.width) * side(grid.height);
    if (samples.depths.size() < count)
        return Error{ErrorCode::depth_buffer_too_small, count, samples.depths.size()};
    const double pixels =
        1.0 * window.width * window.height / static_cast<double>((std::max)(count, std::uint64_t{1}));
    const auto pixel = [](int i, int samples_across, int pixels_across) {
        return static_cast<int>((2 * std::int64_t{i} + 1) * pixels_across /
                                (2 * std::int64_t{samples_across}));
    };
    return detail::weigh<detail::weighed_sliced, base, Clock>(
        view, {}, &slices, lights, costs, [&](auto visit) {
            if (view.tile_count() == 0) return;
            const float* depth = samples.depths.data();
            for (int y = 0; y < grid.height; ++y)
                for (int x = 0; x < grid.width; ++x, ++depth)
                    if (std::isfinite(*depth))
                        visit(pixel(x, grid.width, window.width), pixel(y, grid.height, window.height),
                              *depth, pixels);
        });
}

}}  // namespace lightbin
