// SPDX-License-Identifier: MIT
// How long a build takes: what the grid holds, times constants. They were fitted by `sh bench/run.sh advise
// --fit` (bench/advise.cpp) on an AMD EPYC (Zen 5), g++ 12, one thread. Nine in ten of 512 builds with AVX-512
// take 0.7 to 1.8 times what is predicted. Another machine is brought in by one factor, Costs::machine.
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
    {0, 3.39, 0.184, 31.3, 12.7, 0.399, 0.522, 35.5, 290, 69.2, 449, 115},
    {0, 1.7, 0.254, 49.9, 13.6, 0.282, 0.716, 25.4, 216, 24, 367, 40.3},
    {36.2, 0.665, 0.229, 43.7, 6.9, 0.0242, 0.324, 13.1, 92.1, 8.92, 111, 17.5},
    {87, 0.338, 0.0926, 27.1, 2.65, 0.0337, 0.237, 10.2, 57.7, 8.84, 89.6, 13.3},
    // NEON: not measured, as SSE2
    {0, 1.7, 0.254, 49.9, 13.6, 0.282, 0.716, 25.4, 216, 24, 367, 40.3},
};

/// A block of a survey.
inline constexpr double survey_block_ns[] = {6000, 2600, 1000, 900, 2600};

inline double predicted_build_ns(Isa isa, const BuildTerms& terms) {
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * build_models[static_cast<std::size_t>(isa)][i];
    return ns;
}

}  // namespace lightbin::detail
