// SPDX-License-Identifier: MIT
// Random minimum and maximum depths of tiles for tests of the depth test, and depth slices.
#pragma once

#include "spheres.hpp"

#include <lightbin/slices.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace oracle {

struct Bounds {
    std::vector<float> min, max;
};

enum class BoundsShape {
    random,
    plane,  ///< depth grows from tile to tile, like ground seen at an angle
    tips,   ///< minimum and maximum at the depth of a light's nearest or farthest point, give or take an ulp
};

/// Makes depth bounds for every tile; a few are infinite, have the minimum above the maximum, or stand for an empty
/// tile.
inline Bounds make_bounds(const Camera& camera, const Aim& aim, const std::vector<Light>& lights,
                          BoundsShape shape, Random& random) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const int nx = camera.tiles(0), ny = camera.tiles(1);
    const double first = aim.depth(random), across = aim.depth(random) / nx, up = aim.depth(random) / ny;
    Bounds bounds;
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            double low = aim.depth(random), high = low + std::abs(aim.depth(random)) * random.uniform();
            if (shape == BoundsShape::plane) {
                low = first + across * x + up * y;
                high = low + across + up;
            }
            float min = static_cast<float>(low), max = static_cast<float>(high);
            const int odd = random.integer(0, 24);
            if (odd == 0) std::swap(min, max);
            if (odd == 1) min = -inf;
            if (odd == 2) max = inf;
            if (odd == 3) min = inf, max = -inf;  // nothing drawn
            bounds.min.push_back(min);
            bounds.max.push_back(max);
        }
    if (shape != BoundsShape::tips) return bounds;
    for (const Light& light : lights)
        for (const float r : {light.w, -light.w}) {
            float tip = aim.depth_of(light) + r;
            if (is_bad(light) || !std::isfinite(tip) || tip < static_cast<float>(aim.near_plane)) continue;
            const double x = aim.pixel_of(0, aim.coordinate(0, light), static_cast<double>(tip));
            const double y = aim.pixel_of(1, aim.coordinate(1, light), static_cast<double>(tip));
            if (!(x >= 0 && x < camera.width && y >= 0 && y < camera.height)) continue;
            const std::size_t tile = static_cast<std::size_t>(camera.tile_of(1, static_cast<int>(y)) * nx +
                                                              camera.tile_of(0, static_cast<int>(x)));
            const int ulps = random.integer(-1, 1);
            if (ulps != 0) tip = std::nextafter(tip, ulps < 0 ? -inf : inf);
            bounds.min[tile] = bounds.max[tile] = tip;
        }
    return bounds;
}

/// Makes slices. Every second boundary is at or just beside a depth where a light begins or ends; the others are
/// random.
inline lightbin::Slices slices_at_ends(const Aim& aim, const std::vector<Light>& lights, Random& random) {
    std::vector<float> boundaries;
    for (std::size_t i = 0; i < 5 && !lights.empty(); ++i) {
        const Light& light = lights[random.bits() % lights.size()];
        float end = aim.depth_of(light) + (random.chance(0.5) ? light.w : -light.w);
        if (random.chance(0.3)) end = std::nextafter(end, random.chance(0.5) ? 1e38f : -1e38f);
        if (i % 2 == 1) end = static_cast<float>(random.sign() * random.power_of_two(-12, 12));
        if (std::isfinite(end)) boundaries.push_back(end);
    }
    std::sort(boundaries.begin(), boundaries.end());
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    return *lightbin::Slices::from_boundaries(boundaries);
}

}  // namespace oracle
