// SPDX-License-Identifier: MIT
// Which cells a spot meets, by certificates: exact/spot.hpp.
#pragma once

#include "exact/spot.hpp"
#include "exact/truth.hpp"
#include "reference.hpp"

#include <lightbin/spot.hpp>

#include <algorithm>
#include <limits>
#include <optional>

/// Depths between two floats, infinite where there is none.
struct DepthRange {
    float min = -std::numeric_limits<float>::infinity(), max = std::numeric_limits<float>::infinity();
};

class SpotDecider {
public:
    SpotDecider(const Lens& lens, int tile_size) : truth_(exact_camera(lens, tile_size)) {}

    int tiles_x() const { return truth_.oracle.tiles_x(); }
    int tiles_y() const { return truth_.oracle.tiles_y(); }

    /// Whether a spot meets the part of tile (x, y) between these depths; nothing: there is no certificate. Double precision
    /// answers for the ball of its range where that is enough.
    std::optional<bool> meets(int x, int y, const DepthRange& range, const lightbin::Spot& spot) {
        const oracle::FlatBall ball = {double(spot.x), double(spot.y), -double(spot.z), double(spot.radius)};
        const oracle::FlatDepths flat = {std::max(double(range.min), truth_.range.min),
                                         std::min(double(range.max), truth_.range.max)};
        if (truth_.filter.apart(x, x + 1, y, y + 1, flat, ball)) return false;
        const oracle::Oracle& oracle = truth_.oracle;
        const oracle::Depths depths = oracle.depths(range.min, range.max);
        if (depths.contains_none()) return false;
        return oracle::meets(oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), depths),
                             oracle::exact_spot(spot.x, spot.y, spot.z, spot.radius, spot.axis_x, spot.axis_y,
                                                spot.axis_z, spot.cos_half_angle));
    }

private:
    oracle::Truth truth_;
};
