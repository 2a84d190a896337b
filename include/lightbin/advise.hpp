// SPDX-License-Identifier: MIT
// What a scene can do without: the options and the tile size that cost least, to build and to shade,
// predicted from a sample of the lights.
#pragma once

#include <lightbin/detail/build_model.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string>

namespace lightbin {

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
    bool tiled =
        true;  ///< false: no grid; every pixel evaluates every light. The rest is then without meaning
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
    const Plan& best() const { return plans_[0]; }
    std::span<const Plan> plans() const { return {plans_.data(), count_}; }

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

    /// Adds a plan behind those that cost as much.
    void add(const Plan& plan) {
        const auto end = plans_.begin() + static_cast<std::ptrdiff_t>(count_++);
        const auto place = std::upper_bound(plans_.begin(), end, plan.total_ns,
                                            [](double total, const Plan& p) { return total < p.total_ns; });
        std::move_backward(place, end, end + 1);
        *place = plan;
    }

private:
    std::array<Plan, 2 + detail::Survey::most_grids* 8> plans_ = {};
    std::size_t count_ = 0;
};

/// Returns what the ways to light a view are predicted to cost: no tiling; one list for the whole screen (the
/// lights in view); tiles of the view's size and of 2, 4 and 8 times it, with each footprint and each depth
/// test that `bounds` allow. So give the view of the smallest tiles that you would use. Errors: as bin().
///
/// lights  as for Binner::bin
/// bounds  of the view's own tiles; larger tiles' bounds are merged from them. None: no depth test is weighed
/// costs   the build model knows the machine that it was fitted on (detail/build_model.hpp)
///
/// The lists' lengths are estimated from a sample: at most 1,024 lights, through the library's own
/// projection, and 192 (light, tile) pairs a tile size, through its own depth tests. With no more lights
/// than that the sums over rectangles are exact. Takes tens of microseconds and a little memory.
template <class LightRange>
Result<Advice> advise(const View& view, const LightRange& lights, const Costs& costs = {},
                      const ZBounds& bounds = {}) {
    const auto& source = detail::as_lights(lights);
    if (!source.valid) return Error{ErrorCode::view_matrix_not_affine};
    for (const std::span<const float> side : {bounds.min, bounds.max, bounds.gap_min, bounds.gap_max})
        if (!side.empty() && side.size() < view.tile_count())
            return Error{ErrorCode::z_bounds_too_small, view.tile_count(), side.size()};

    const Isa isa = detail::machine_isa(costs.isa);
    const detail::Survey survey = detail::survey(isa, view, source, bounds);
    Advice advice;
    const auto weigh = [&](Plan plan) {
        plan.total_ns = plan.build_ns + plan.evaluations * costs.evaluation_ns;
        advice.add(plan);
    };
    const Index index = source.array.size() <= 0x10000 ? Index::u16 : Index::u32;
    weigh({.tiled = false, .evaluations = survey.lights * survey.pixels});
    for (const detail::GridSurvey& grid : std::span(survey.grids).first(survey.grid_count))
        for (const detail::Rung& rung : std::span(grid.rungs).first(grid.rung_count))
            weigh({.footprint = rung.footprint,
                   .depth_test = rung.depth_test,
                   .index = index,
                   .tile_size = grid.tile_size,
                   .build_ns = costs.machine * detail::predicted_build_ns(isa, survey, grid, rung) +
                               (rung.depth_test != DepthTest::none ? costs.z_bounds_ns : 0),
                   .evaluations = rung.evaluations});
    return advice;
}

}  // namespace lightbin
