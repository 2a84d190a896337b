// SPDX-License-Identifier: MIT
// Which pixels a light reaches.
#pragma once

#include "tiled_view.hpp"

#include <lightbin/spot.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Points of a tile's drawn pixels, in view space.
struct Points {
    std::vector<float> x, y, z;

    Points(const SeenScene& seen, const lightbin::View& view, int tile_x, int tile_y) {
        const Frustum frustum(seen.scene.projection);
        const lightbin::Extent size = seen.picture.size;
        const int t = view.tile_size();
        for (int py = tile_y * t; py < std::min((tile_y + 1) * t, size.height); ++py)
            for (int px = tile_x * t; px < std::min((tile_x + 1) * t, size.width); ++px) {
                const std::size_t pixel =
                    static_cast<std::size_t>(py) * static_cast<std::size_t>(size.width) +
                    static_cast<std::size_t>(px);
                if (seen.picture.triangle[pixel] == Picture::nothing) continue;
                const glm::vec3 point = point_at(frustum, size, px, py, seen.picture.view_depth[pixel]);
                x.push_back(point.x), y.push_back(point.y), z.push_back(point.z);
            }
    }

    std::uint32_t inside(const glm::vec4& light) const {
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const float dx = x[i] - light.x, dy = y[i] - light.y, dz = z[i] - light.z;
            count += dx * dx + dy * dy + dz * dz <= light.w * light.w;
        }
        return count;
    }

    std::uint32_t inside(const lightbin::Spot& s) const {
        const float edge = s.cos_half_angle * glm::length(glm::vec3(s.axis_x, s.axis_y, s.axis_z));
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const float dx = x[i] - s.x, dy = y[i] - s.y, dz = z[i] - s.z,
                        square = dx * dx + dy * dy + dz * dz;
            count += square <= s.radius * s.radius &&
                     (s.cos_half_angle <= 0 ||
                      dx * s.axis_x + dy * s.axis_y + dz * s.axis_z >= edge * std::sqrt(square));
        }
        return count;
    }
};
