// SPDX-License-Identifier: MIT
// The lists again, by a plain two-pass in double precision: what the timed ones are verified against.
#pragma once

#include "exact/filter.hpp"
#include "lens.hpp"

#include <lightbin/binner.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// A lens as the exact arithmetic takes it.
inline oracle::Camera exact_camera(const Lens& lens, int tile_size) {
    oracle::Camera camera;
    const glm::dmat4 projection = lens.projection();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            camera.m[column][row] = projection[column][row];
    camera.doubles = true;
    camera.width = lens.screen.width, camera.height = lens.screen.height, camera.tile = tile_size;
    return camera;
}

/// One light and one tile, as the rungs of the ladder see them.
class PairTest {
public:
    PairTest(const Lens& lens, int tile_size, const lightbin::ZBounds& bounds)
        : oracle_(exact_camera(lens, tile_size)), filter_(oracle_), pyramid_(oracle_.range()), bounds_(bounds) {}

    /// Whether a light whose rectangle has the tile stays in its list.
    bool passes(lightbin::Footprint footprint, lightbin::DepthTest test, const glm::vec4& light, int x,
                int y) {
        using lightbin::DepthTest;
        const oracle::FlatBall ball = {double(light.x), double(light.y), -double(light.z), double(light.w)};
        const double reach = ball.radius * ball.radius;
        if (footprint == lightbin::Footprint::silhouette &&
            filter_.cell_distance2(x, y, pyramid_, ball) > reach)
            return false;
        if (test == DepthTest::none) return true;
        const std::size_t tile = std::size_t(y * oracle_.tiles_x() + x);
        const double min = double(bounds_.min[tile]), max = double(bounds_.max[tile]);
        if (ball.depth + ball.radius < min || ball.depth - ball.radius > max) return false;
        if (test == DepthTest::interval) return true;
        const auto meets_box = [&](double from, double to) {
            return from <= to && filter_.box_distance2(x, y, {from, to}, ball) <= reach;
        };
        if (test == DepthTest::box) return meets_box(min, max);
        const double gap_min = double(bounds_.gap_min[tile]), gap_max = double(bounds_.gap_max[tile]);
        if (!(gap_min < gap_max)) return meets_box(min, max);
        return meets_box(min, gap_min) || meets_box(gap_max, max);
    }

private:
    oracle::Oracle oracle_;
    oracle::Filter filter_;
    oracle::FlatDepths pyramid_;
    const lightbin::ZBounds& bounds_;
};

/// Stops the run unless the lists of a frame hold what the double-precision two-pass finds, and next to nothing else.
template <class Grid>
void verify(const Frame& frame, int tile_size, const Grid& grid, const lightbin::Options& options,
            const lightbin::ZBounds& bounds) {
    const FlatView view = frame.lens.flat_view(tile_size);
    const Lights& lights = frame.lights;
    Flat<double> flat;
    flat.build<false>(view, lights, nullptr, nullptr);
    PairTest pair(frame.lens, tile_size, bounds);
    // A light that crosses the near plane may keep its rectangle.
    const auto may_be_there = [&](std::uint32_t id) {
        return options.footprint == lightbin::Footprint::silhouette &&
               -double(lights[id].z) - double(lights[id].w) <= view.near_depth;
    };
    std::size_t missing = 0, extra = 0, common = 0;
    for (std::size_t tile = 0; tile < grid.ranges().size(); ++tile) {
        const int x = int(tile) % view.tiles_x, y = int(tile) / view.tiles_x;
        const auto ours = grid.ids().subspan(grid.ranges()[tile].offset, grid.ranges()[tile].count);
        auto next = ours.begin();
        for (std::uint32_t i = flat.offsets[tile]; i < flat.offsets[tile + 1]; ++i) {
            const std::uint32_t id = flat.indices[i];
            if (!pair.passes(options.footprint, options.depth_test, lights[id], x, y)) continue;
            for (; next != ours.end() && *next < id; ++next)
                extra += may_be_there(*next) ? 0 : 1;
            const bool found = next != ours.end() && *next == id;
            ++(found ? common : missing);
            if (found) ++next;
        }
        for (; next != ours.end(); ++next)
            extra += may_be_there(*next) ? 0 : 1;
    }
    if (missing * 100000 <= common && extra * 500 <= common + 1000) return;
    std::fprintf(stderr, "binning: wrong lists: %zu entries are missing, %zu are extra, %zu are right\n",
                 missing, extra, common);
    std::exit(EXIT_FAILURE);
}
