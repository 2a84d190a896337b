// SPDX-License-Identifier: MIT
// The lists again, by a plain two-pass in double precision: what the timed ones are verified against.
#pragma once

#include "flat.hpp"

#include <lightbin/binner.hpp>

#include <algorithm>
#include <cmath>
#include <span>

/// One light and one tile, as the rungs of the ladder see them.
class PairTest {
public:
    PairTest(const FlatView& view, const lightbin::ZBounds& bounds) : view_(view), bounds_(bounds) {}

    /// Whether the sphere meets the view-space box around the tile between two depths.
    bool meets_box(const glm::vec4& light, int tile_x, int tile_y, double z0, double z1) const {
        if (!(z0 <= z1)) return false;
        const auto gap = [&](double c, Slopes s) {
            return std::max(
                {std::min(s.low * z0, s.low * z1) - c, c - std::max(s.high * z0, s.high * z1), 0.0});
        };
        const double z = -double(light.z), r = double(light.w);
        const double dx = gap(double(light.x), columns(tile_x)), dy = gap(double(light.y), rows(tile_y)),
                     dz = std::max({z0 - z, z - z1, 0.0});
        return dx * dx + dy * dy + dz * dz <= r * r;
    }

    /// Whether the sphere meets the pyramid of the tile beyond the near plane: the least distance over the
    /// pyramid's sections, which is a convex function of their depth.
    bool meets_pyramid(const glm::vec4& light, int tile_x, int tile_y) const {
        const Slopes sx = columns(tile_x), sy = rows(tile_y);
        const double x = double(light.x), y = double(light.y), z = -double(light.z), r = double(light.w);
        const auto distance2 = [&](double depth) {
            const double dx = std::max({sx.low * depth - x, x - sx.high * depth, 0.0});
            const double dy = std::max({sy.low * depth - y, y - sy.high * depth, 0.0});
            return dx * dx + dy * dy + (depth - z) * (depth - z);
        };
        double low = std::max(view_.near_depth, z - r), high = std::min(view_.far_depth, z + r);
        for (int step = 0; step < 60; ++step) {
            const double a = low + (high - low) * 0.45, b = low + (high - low) * 0.55;
            if (distance2(a) <= r * r) return true;
            (distance2(a) < distance2(b) ? high : low) = distance2(a) < distance2(b) ? b : a;
        }
        return distance2(low) <= r * r;
    }

    /// Whether a light whose rectangle has the tile stays in its list.
    bool passes(lightbin::Footprint footprint, lightbin::DepthTest test, const glm::vec4& light, int tile_x,
                int tile_y) const {
        using lightbin::DepthTest;
        if (footprint == lightbin::Footprint::silhouette && !meets_pyramid(light, tile_x, tile_y))
            return false;
        if (test == DepthTest::none) return true;
        const std::size_t tile = std::size_t(tile_y * view_.tiles_x + tile_x);
        const double min = double(bounds_.min[tile]), max = double(bounds_.max[tile]);
        const double z = -double(light.z), r = double(light.w);
        if (z + r < min || z - r > max) return false;
        if (test == DepthTest::interval) return true;
        const double gap_min = double(bounds_.gap_min[tile]), gap_max = double(bounds_.gap_max[tile]);
        if (test == DepthTest::box || !(gap_min < gap_max)) return meets_box(light, tile_x, tile_y, min, max);
        return meets_box(light, tile_x, tile_y, min, gap_min) ||
               meets_box(light, tile_x, tile_y, gap_max, max);
    }

private:
    struct Slopes {
        double low, high;
    };
    Slopes slopes(int tile, double side) const {
        return {(tile - side / 2) / view_.scale, (std::min(tile + 1.0, side) - side / 2) / view_.scale};
    }
    Slopes columns(int x) const { return slopes(x, view_.width); }
    Slopes rows(int y) const { return slopes(y, view_.height); }

    const FlatView& view_;
    const lightbin::ZBounds& bounds_;
};
