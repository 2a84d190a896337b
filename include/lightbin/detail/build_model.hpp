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
using BuildTerms = std::array<double, 12>;

inline BuildTerms build_terms(const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    BuildTerms terms = {1, survey.lights, grid.tiles, grid.supertiles, rung.entries};
    if (rung.footprint == Footprint::silhouette) terms[5] = grid.rows;
    if (rung.depth_test != DepthTest::none) {
        const std::size_t test = static_cast<std::size_t>(rung.depth_test) - 1;
        terms[6 + test] = grid.tiles;
        terms[9 + test] = grid.supertiles;
    }
    return terms;
}

/// By Isa.
inline constexpr BuildTerms build_models[] = {
    // call, light, tile, supertile, entry, silhouette row, tile and supertile of interval, box, split_box
    {174, 2.51, 0.128, 15.5, 0.38, 30.9, 1, 1.3, 1.38, 32.4, 66.6, 99},
    {103, 0.957, 0.0867, 13.2, 0.233, 16.1, 0.781, 0.804, 0.926, 11.2, 17.8, 29.9},
    {98.8, 0.502, 0.091, 11.1, 0.113, 12.1, 0.85, 0.745, 0.957, 6.24, 9.83, 17.4},
    {135, 0.284, 0.116, 2.69, 0.0843, 11.7, 0.261, 0.359, 0.368, 7.44, 9.68, 14.9},
    // NEON: not measured, as SSE2
    {103, 0.957, 0.0867, 13.2, 0.233, 16.1, 0.781, 0.804, 0.926, 11.2, 17.8, 29.9},
};

inline double predicted_build_ns(Isa isa, const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    const BuildTerms terms = build_terms(survey, grid, rung);
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * build_models[static_cast<std::size_t>(isa)][i];
    return ns;
}

}  // namespace lightbin::detail
