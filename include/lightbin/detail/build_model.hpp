// SPDX-License-Identifier: MIT
// How long a build takes: what the grid holds, times constants. They were fitted by `sh bench/run.sh advise
// --fit` (bench/advise.cpp) on an AMD EPYC (Zen 5), g++ 12, one thread. Nine in ten of 512 builds with AVX-512
// take 0.74 to 1.7 times what is predicted. Another machine is brought in by one factor, Costs::machine.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/options.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// Amounts that a build's time is made of, or nanoseconds for each.
using BuildTerms = std::array<double, 15>;

inline BuildTerms build_terms(const Survey& survey, const GridSurvey& grid, std::size_t rung) {
    const auto [footprint, depth_test] = rungs[rung];
    const double occupied = (std::min)(grid.supertiles, grid.tiles / 64);  // supertiles with any light
    const bool tested = rung != 0;
    BuildTerms terms = {1, survey.lights, grid.tiles, tested ? grid.tiles : 0, occupied, grid.supertiles};
    terms[tested ? 7 : 6] = grid.entries[rung];
    if (footprint == Footprint::silhouette) terms[8] = grid.rows;
    if (depth_test != DepthTest::none) {
        const std::size_t first = depth_test == DepthTest::box ? 9 : 12;
        terms[first] = occupied;
        terms[first + 1] = grid.supertiles;
        terms[first + 2] = grid.entries[0];
    }
    return terms;
}

/// By Isa.
inline constexpr BuildTerms build_models[] = {
    // call, light, tile, tile again where lights are tested, supertile with any light, supertile of a light, entry,
    // entry of a tested light, silhouette row, then for box the two kinds of supertile again and each test, and the
    // same for split_box
    {23.3, 1.15, 0.0459, 0.816, 16.8, 17.3, 0.264, 0.482, 41.2, 346, 33.2, 2.44, 470, 36.7, 4.43},
    {24.8, 0.972, 0.0449, 0.674, 19.8, 13.4, 0.143, 0.355, 18.4, 150, 10, 0.345, 182, 13, 0.768},
    {36.8, 0.536, 0.0432, 0.689, 26.5, 7.64, 0.00869, 0.301, 13.3, 66.4, 5.55, 0.117, 112, 8.62, 0.343},
    {65.4, 0.352, 0.0398, 0.0705, 29.1, 2.8, 0.0306, 0.22, 10.1, 83.7, 5.61, 0.0145, 115, 8.09, 0.0874},
};

/// A block of a survey, by Isa.
inline constexpr double survey_block_ns[] = {6100, 2550, 1350, 1100};

/// NEON is not measured: it has SSE2's.
template <class Value> const Value& of_tier(const Value (&tiers)[4], Isa isa) {
    return tiers[static_cast<std::size_t>(isa == Isa::neon ? Isa::sse2 : isa)];
}

inline double predicted_ns(const BuildTerms& terms, const BuildTerms& model) {
    double ns = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
        ns += terms[i] * model[i];
    return ns;
}

}  // namespace lightbin::detail
