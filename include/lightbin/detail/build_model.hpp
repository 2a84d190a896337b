// SPDX-License-Identifier: MIT
// How long a build takes: what the grid holds, times constants. They were fitted by `sh bench/run.sh advise
// --fit` (bench/advise.cpp) on an AMD EPYC (Zen 5), g++ 12, one thread. Of its 1,024 builds nine in ten take
// 0.7 to 3.7 times what is predicted. Another machine is brought in by one factor, Costs::machine.
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
    {52.8, 2.94, 0.0655, 15.9, 0.351, 29.1, 0.589, 0.798, 0.839, 32.3, 68.1, 100},
    {107, 0.956, 0.0758, 13.5, 0.221, 15.6, 0.615, 0.731, 0.745, 11.7, 19.4, 30.1},
    {106, 0.521, 0.0791, 10.4, 0.0914, 12.7, 0.816, 0.734, 1.01, 7.52, 10.8, 18.5},
    {115, 0.29, 0.0821, 2.68, 0.0932, 11.2, 0.00647, 0.108, 0.102, 8.4, 10.9, 15.8},
    // NEON: not measured, as SSE2
    {107, 0.956, 0.0758, 13.5, 0.221, 15.6, 0.615, 0.731, 0.745, 11.7, 19.4, 30.1},
};

inline double predicted_build_ns(Isa isa, const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    const BuildTerms terms = build_terms(survey, grid, rung);
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * build_models[static_cast<std::size_t>(isa)][i];
    return ns;
}

}  // namespace lightbin::detail
