// SPDX-License-Identifier: MIT
// How many engines cull: each tile holds each light against the planes of its frustum. They do it in a compute shader;
// here it is one core's loop, which the compiler makes vectors of.
#pragma once

#include "flat.hpp"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

class Planes {
public:
    template <bool with_depth>
    void build(const FlatView view, std::span<const glm::vec4> lights, const float* tile_min,
               const float* tile_max) {
        const std::size_t count = lights.size();
        for (std::vector<float>* side : {&x_, &y_, &depth_, &radius_})
            side->resize(count);
        for (std::size_t i = 0; i < count; ++i)
            x_[i] = lights[i].x, y_[i] = lights[i].y, depth_[i] = -lights[i].z, radius_[i] = lights[i].w;
        inside_.resize(count);
        offsets.assign(1, 0);
        indices.clear();
        for (int y = 0; y < view.tiles_y; ++y)
            for (int x = 0; x < view.tiles_x; ++x) {
                const Plane left(view, x, view.width), right(view, x + 1, view.width),
                    below(view, y, view.height), above(view, y + 1, view.height);
                const std::size_t tile = offsets.size() - 1;
                const float near_depth = with_depth ? tile_min[tile] : static_cast<float>(view.near_depth),
                            far_depth = with_depth ? tile_max[tile] : static_cast<float>(view.far_depth);
                for (std::size_t i = 0; i < count; ++i) {
                    const float r = radius_[i], z = depth_[i];
                    const float across = std::min(left.side(x_[i], z), -right.side(x_[i], z)),
                                up = std::min(below.side(y_[i], z), -above.side(y_[i], z)),
                                along = std::min(z - near_depth, far_depth - z);
                    inside_[i] = std::min(std::min(across, up), along) >= -r;
                }
                for (std::size_t i = 0; i < count; ++i)
                    if (inside_[i]) indices.push_back(static_cast<std::uint32_t>(i));
                offsets.push_back(static_cast<std::uint32_t>(indices.size()));
            }
    }

    std::vector<std::uint32_t> offsets, indices;

private:
    /// Through the eye and an edge between tiles; `side` is the signed distance to it, positive to the right or above.
    struct Plane {
        float across, along;

        Plane(const FlatView& view, int edge, double tiles) {
            const double slope = (edge - tiles / 2) / view.scale, length = std::sqrt(1 + slope * slope);
            across = static_cast<float>(1 / length), along = static_cast<float>(-slope / length);
        }
        float side(float c, float depth) const { return across * c + along * depth; }
    };

    std::vector<float> x_, y_, depth_, radius_;
    std::vector<unsigned char> inside_;
};
