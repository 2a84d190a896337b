// SPDX-License-Identifier: MIT
// What a scene can do without: the options and the tile size that cost least, to build and to shade,
// predicted from the lights in view and a sample of the tiles they are in.
#pragma once

#include <lightbin/detail/build_model.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// What advise() can't know. Times in nanoseconds a frame, 0 or more.
struct Costs {
    /// One light evaluated at one pixel, as the whole device does it: about 0.005 to 0.05 on a GPU, 1 on a
    /// core.
    double evaluation_ns = 0.02;
    /// The depth pre-pass and the reduction to Z bounds, unless the renderer has them anyway.
    double z_bounds_ns = 0;
    /// Build time here over the one predicted: measure one build to bring the model to this machine.
    double machine = 1;
    Isa isa = detail::compiled_isa;  ///< as in Options
};

/// One way to light a view, and what it is predicted to cost a frame.
struct Plan {
    bool tiled = true;  ///< false: every pixel evaluates every light; the next four are without meaning
    Footprint footprint = Footprint::rectangle;
    DepthTest depth_test = DepthTest::none;
    Index index = Index::u32;  ///< the narrowest that counts the lights
    int tile_size = 0;         ///< for View::with_tile_size
    double build_ns = 0;       ///< with Costs::z_bounds_ns where there is a depth test
    double evaluations = 0;    ///< sum over the pixels with something to light of their lists' lengths
    double total_ns = 0;       ///< build_ns + evaluations * Costs::evaluation_ns
};

/// Every plan that was weighed, the cheapest first.
class Advice {
public:
    explicit Advice(std::vector<Plan> plans) : plans_(std::move(plans)) {
        std::ranges::sort(plans_, {}, &Plan::total_ns);
    }

    const Plan& best() const { return plans_[0]; }
    std::span<const Plan> plans() const& { return plans_; }
    std::span<const Plan> plans() && = delete;  // would dangle

    /// Returns a table of the plans for a person, a line each. Allocates.
    std::string text() const {
        static constexpr const char* footprints[] = {"rectangle", "silhouette"};
        static constexpr const char* depth_tests[] = {"none", "interval", "box", "split_box"};
        std::string lines =
            "   cost  tile  footprint   depth test  ids   build us  M evaluations   total us\n";
        for (const Plan& plan : plans()) {
            char tile[16] = "-", line[160];
            if (plan.tiled) std::snprintf(tile, sizeof tile, "%d", plan.tile_size);
            std::snprintf(line, sizeof line, "%7.2f  %4s  %-10s  %-10s  %-3s  %9.1f  %13.3f  %9.1f\n",
                          plan.total_ns / (std::max)(best().total_ns, 1.0), tile,
                          plan.tiled ? footprints[static_cast<int>(plan.footprint)] : "no tiling",
                          plan.tiled ? depth_tests[static_cast<int>(plan.depth_test)] : "-",
                          !plan.tiled                ? "-"
                          : plan.index == Index::u16 ? "u16"
                                                     : "u32",
                          plan.build_ns * 1e-3, plan.evaluations * 1e-6, plan.total_ns * 1e-3);
            lines += line;
        }
        return lines;
    }

private:
    std::vector<Plan> plans_;
};

/// Returns what the ways to light a view are predicted to cost: no tiling; one list for the whole screen (the
/// lights in view); tiles of the view's size and of 2, 4 and 8 times it, with rectangles or silhouettes, and
/// as far as `bounds` allow with box or split_box. So give the view of the smallest tiles that you would use.
/// Errors: as bin().
///
/// lights  as for Binner::bin
/// bounds  of the view's own tiles; larger tiles' bounds are merged from them. None: no depth test is weighed
/// costs   the build model knows the machine that it was fitted on (detail/build_model.hpp)
///
/// Projects all lights as a build does; the rest is estimated from at most 512 of those in view, and from 1 to 384
/// blocks of 8x8 tiles and up to 8 lights in each, the more the longer a build. So asking takes less than a build of
/// the view's tiles without options, but for the shortest. Allocates.
template <class LightRange>
Result<Advice> advise(const View& view, const LightRange& lights, const Costs& costs = {},
                      const ZBounds& bounds = {}) {
    const auto& source = detail::as_lights(lights);
    if (const auto error = detail::refuse(source)) return *error;
    for (const std::span<const float> side : {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max})
        if (!side.empty() && side.size() < view.tile_count())
            return Error{ErrorCode::z_bounds_too_small, view.tile_count(), side.size()};

    const Isa isa = detail::machine_isa(costs.isa);
    const detail::BuildTerms& model = detail::of_tier(detail::build_models, isa);
    detail::Survey survey = detail::survey_rectangles(isa, view, source, bounds);
    // Asking is to take less than a build, which may be predicted to take 1.4 times what it does: 0.7 of that. What
    // is left when the lights are projected and sampled, 25 ns each, goes to blocks: more than 384 would tell little,
    // as the standard error of a test's share is 0.02 then. No more than there are lights in view, either: one that is
    // alone is binned faster than predicted.
    const double plain_ns = detail::predicted_ns(detail::build_terms(survey, survey.grids[0], 0), model);
    const double spare_ns =
        0.7 * plain_ns - model[1] * survey.lights - 25.0 * static_cast<double>(survey.rects.size());
    const double most = std::clamp(survey.visible, 1.0, 384.0);
    const double blocks = std::clamp(spare_ns / detail::of_tier(detail::survey_block_ns, isa), 1.0, most);
    detail::survey_blocks(isa, view, source, bounds, static_cast<std::size_t>(blocks), survey);

    std::vector<Plan> plans;
    plans.reserve(2 + std::size(detail::rungs) * survey.grids.size());
    const auto weigh = [&](Plan plan) {
        plan.index = source.array.size() <= 0x10000 ? Index::u16 : Index::u32;
        plan.total_ns = plan.build_ns + plan.evaluations * costs.evaluation_ns;
        plans.push_back(plan);
    };
    const auto weigh_grid = [&](const detail::GridSurvey& grid, std::size_t rung) {
        const auto [footprint, depth_test] = detail::rungs[rung];
        const double ns = detail::predicted_ns(detail::build_terms(survey, grid, rung), model);
        weigh({.footprint = footprint,
               .depth_test = depth_test,
               .tile_size = grid.tile_size,
               .build_ns = costs.machine * ns + (depth_test != DepthTest::none ? costs.z_bounds_ns : 0),
               .evaluations = grid.evaluations[rung]});
    };
    weigh({.tiled = false, .evaluations = survey.lights * survey.pixels});
    const int longest = (std::max)(view.viewport().width, view.viewport().height);
    if (longest > survey.grids.back().tile_size)
        weigh_grid({.tile_size = longest,
                    .tiles = 1,
                    .supertiles = survey.visible,
                    .entries = {survey.visible},
                    .evaluations = {survey.visible * survey.pixels}},
                   0);
    for (const detail::GridSurvey& grid : survey.grids)
        for (std::size_t rung = 0; rung < std::size(detail::rungs); ++rung)
            if (detail::weighed(detail::rungs[rung].depth_test, bounds)) weigh_grid(grid, rung);
    return Advice(std::move(plans));
}

}  // namespace lightbin
