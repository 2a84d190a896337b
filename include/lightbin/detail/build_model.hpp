// SPDX-License-Identifier: MIT
// How long a build takes: constants times what the grid holds.
#pragma once

#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/survey.hpp>
#include <lightbin/options.hpp>

#include <cstddef>

namespace lightbin::detail {

/// Nanoseconds each.
struct BuildModel {
    double call, light, visible, tile, supertile, entry;
    double depth_tile[3], depth_supertile[3];  ///< added by interval, box, split_box
    double silhouette_row;                     ///< added by silhouettes
};

inline constexpr BuildModel build_models[] = {
    {500, 10, 10, 1, 10, 1, {1, 3, 6}, {100, 200, 300}, 5},
    {500, 3, 8, 1, 6, .6, {1, 3, 6}, {50, 80, 120}, 5},
    {500, 1.5, 5, 1, 4, .4, {1, 2, 4}, {15, 25, 40}, 5},
    {500, 1, 3, .5, 2, .2, {.5, 1, 2}, {8, 12, 20}, 2},
};

inline double predicted_build_ns(Isa isa, const Survey& survey, const GridSurvey& grid, const Rung& rung) {
    const BuildModel& model = build_models[static_cast<std::size_t>(isa)];
    double ns = model.call + model.light * survey.lights + model.visible * survey.visible +
                model.tile * grid.tiles + model.supertile * grid.supertiles + model.entry * rung.entries;
    if (rung.footprint == Footprint::silhouette) ns += model.silhouette_row * grid.rows;
    if (rung.depth_test != DepthTest::none) {
        const std::size_t test = static_cast<std::size_t>(rung.depth_test) - 1;
        ns += model.depth_tile[test] * grid.tiles + model.depth_supertile[test] * grid.supertiles;
    }
    return ns;
}

}  // namespace lightbin::detail
