// SPDX-License-Identifier: MIT
// What building spots takes beside as many spheres whose lists are as long, in the same rung, in turns.
#pragma once

#include "goals.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

struct SpotTime {
    std::string set;
    std::size_t lights;
    std::string footprint, depth_test, slicing, tier;
    double ns_per_spot, ns_per_sphere;
    double ratio;                        ///< of the medians
    double spread;                       ///< 10th to 90th percentile of the turns' own ratios
    double entries, entries_of_spheres;  ///< a light

    std::string rung() const { return footprint + ", " + depth_test + ", " + slicing; }
};

struct SpotTimeCase {
    std::string name;  ///< what a filter finds it by
    std::function<SpotTime(double seconds)> time;
};

/// A case for each set, number of lights, rung and tier that this machine has. Those of a set and number follow each other.
std::vector<SpotTimeCase> spot_time_cases(bool quick);

void write_spot_times(const std::vector<SpotTime>& times, const char* path);

/// The worst of each rung and tier.
void add_spot_time_goals(const std::vector<SpotTime>& times, Goals& goals);
