// SPDX-License-Identifier: MIT
// How long a build takes: what the grid holds, times constants. They were fitted by `sh bench/run.sh advise --fit`
// (bench/advise.cpp) on an AMD EPYC 9005 (Zen 5), g++ 12, one thread, lights and lists in its caches. Another
// machine is brought in by one factor, Costs::machine.
#pragma once

#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/options.hpp>

#include <array>
#include <cstddef>

namespace lightbin::detail {

/// Amounts that a build's time is made of, or nanoseconds for each.
using BuildTerms = std::array<double, 13>;

inline BuildTerms build_terms(const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    BuildTerms terms = {1, survey.lights, survey.visible, grid.tiles, grid.supertiles, rung.entries};
    if (rung.footprint == Footprint::silhouette) terms[6] = grid.rows;
    if (rung.depth_test != DepthTest::none) {
        const std::size_t test = static_cast<std::size_t>(rung.depth_test) - 1;
        terms[7 + test] = grid.tiles;
        terms[10 + test] = grid.supertiles;
    }
    return terms;
}

/// By Isa.
inline constexpr BuildTerms build_models[] = {
    // call, light, visible, tile, supertile, entry, silhouette row, tile and supertile of interval, box, split_box
    {500, 10, 10, 1, 10, 1, 5, 1, 3, 6, 100, 200, 300},
    {500, 3, 8, 1, 6, .6, 5, 1, 3, 6, 50, 80, 120},
    {500, 1.5, 5, 1, 4, .4, 5, 1, 2, 4, 15, 25, 40},
    {500, 1, 3, .5, 2, .2, 2, .5, 1, 2, 8, 12, 20},
};

inline double predicted_build_ns(Isa isa, const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    const BuildTerms terms = build_terms(survey, grid, rung);
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * build_models[static_cast<std::size_t>(isa)][i];
    return ns;
}

}  // namespace lightbin::detail
