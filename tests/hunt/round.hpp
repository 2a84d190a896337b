// SPDX-License-Identifier: MIT
// One round: a camera, lights and Z bounds, all ways to make their grid, and what must be true of it.
#pragma once

#include "scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace hunt {

/// What a hunt has come to so far.
struct Report {
    Tally tally;               ///< rounds by what they had
    std::uint64_t points = 0;  ///< looked for in lists, all options together
    std::uint64_t grids = 0;
    std::uint64_t entries = 0;
    std::vector<std::string> faults;
};

/// Names all that a run of some rounds must have had, with a count of 0.
void expect_all(Tally& tally);

void hunt_round(std::uint64_t seed, std::uint64_t round, Report& report);

/// What is refused, and what is not, at the limit of each size. `large`: with grids that take gigabytes, too.
void hunt_limits(Report& report, bool large);

}  // namespace hunt
