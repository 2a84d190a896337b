// SPDX-License-Identifier: MIT
// Clusters and z-bins of a scene, cut where its points are.
#pragma once

#include "bounds.hpp"
#include "round.hpp"

#include <string>
#include <vector>

namespace hunt {

inline constexpr const char* slicing_names[] = {"clusters", "clusters, box", "clusters, box, silhouette",
                                                "z_bins", "z_bins, silhouette"};

/// Looks for each point's light in the list of its tile, and of its depth. Returns what is wrong; empty: nothing.
std::string hunt_slices(const lightbin::View& view, const Scene& scene, const std::vector<Placed>& points,
                        Random& random, Report& report);

}  // namespace hunt
