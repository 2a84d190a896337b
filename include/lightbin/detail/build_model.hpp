// SPDX-License-Identifier: MIT
// How long a build takes: what the grid holds, times constants. They were fitted by `sh bench/run.sh advise
// --fit` (bench/advise.cpp) on an AMD EPYC (Zen 5), g++ 12, one thread. Nine in ten of 512 builds with AVX-512
// take 0.7 to 2 times what is predicted. Another machine is brought in by one factor, Costs::machine.
#pragma once

#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/options.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightbin::detail {

/// Amounts that a build's time is made of, or nanoseconds for each.
using BuildTerms = std::array<double, 12>;

inline BuildTerms build_terms(const Survey& survey, const GridSurvey& grid, std::size_t rung) {
    const auto [footprint, depth_test] = rungs[rung];
    const double occupied = (std::min)(grid.supertiles, grid.tiles / 64);  // supertiles with any light
    BuildTerms terms = {1, survey.lights, grid.tiles, occupied, grid.supertiles};
    terms[rung == 0 ? 5 : 6] = grid.entries[rung];
    if (footprint == Footprint::silhouette) terms[7] = grid.rows;
    if (depth_test == DepthTest::box) terms[8] = occupied, terms[9] = grid.supertiles;
    if (depth_test == DepthTest::split_box) terms[10] = occupied, terms[11] = grid.supertiles;
    return terms;
}

/// By Isa.
inline constexpr BuildTerms build_models[] = {
    // call, light, tile, supertile with any light, supertile of a light, entry, entry of a tested light,
    // silhouette row, then the two kinds of supertile again for box, and for split_box
    {0, 3.48, 0.185, 29.4, 12.9, 0.388, 0.568, 36.3, 288, 67.6, 469, 108},
    {49.2, 1.1, 0.261, 39.7, 12.1, 0.157, 0.467, 17.7, 120, 16.3, 190, 29.3},
    {29.6, 0.647, 0.252, 42.7, 6.83, 0.0287, 0.326, 12.6, 83.3, 8.81, 128, 17.3},
    {95.3, 0.441, 0.132, 35.4, 2.6, 0.0431, 0.238, 10.4, 69.8, 8.15, 115, 13.6},
    // NEON: not measured, as SSE2
    {49.2, 1.1, 0.261, 39.7, 12.1, 0.157, 0.467, 17.7, 120, 16.3, 190, 29.3},
};

inline double predicted_build_ns(Isa isa, const BuildTerms& terms) {
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * build_models[static_cast<std::size_t>(isa)][i];
    return ns;
}

}  // namespace lightbin::detail
