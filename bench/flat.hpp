// SPDX-License-Identifier: MIT
// The baseline that all times are given as a ratio to: the plain loop that a renderer's author would write.
#pragma once

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// A symmetric perspective view in tiles, looking down -z: tile coordinate = scale * (c / depth) + half the
/// viewport.
struct FlatView {
    int tiles_x, tiles_y;
    double width, height;  ///< of the viewport in tiles, the last ones counted as far as they reach
    double scale, near_depth;
};

/// Flat two-pass binning, scalar. Per light the tangent rectangle, counting into the tile table in the same
/// pass; a prefix sum; a fill pass over the stored rectangles; 32-bit ids; vectors reused. With Z bounds
/// every pair is tested in both passes. Lights that cross the near plane get the whole screen.
template <class Real> class Flat {
public:
    struct Rect {
        int x0, y0, x1, y1;
        Real z_min, z_max;
    };

    template <bool with_depth>
    void build(const FlatView& view, const std::vector<glm::vec4>& lights, const float* tile_min,
               const float* tile_max) {
        const std::size_t tiles =
            static_cast<std::size_t>(view.tiles_x) * static_cast<std::size_t>(view.tiles_y);
        offsets.assign(tiles + 1, 0);
        rects.resize(lights.size());
        const auto each_tile = [&](const Rect& rect, auto visit) {
            for (int y = rect.y0; y <= rect.y1; ++y)
                for (int x = rect.x0; x <= rect.x1; ++x) {
                    const std::size_t tile = static_cast<std::size_t>(y * view.tiles_x + x);
                    if constexpr (with_depth)
                        if (rect.z_max < Real(tile_min[tile]) || rect.z_min > Real(tile_max[tile])) continue;
                    visit(tile);
                }
        };
        for (std::size_t i = 0; i < lights.size(); ++i) {
            rects[i] = project(view, lights[i]);
            each_tile(rects[i], [&](std::size_t tile) { ++offsets[tile]; });
        }
        std::uint32_t sum = 0;
        for (std::uint32_t& offset : offsets) {
            const std::uint32_t count = offset;
            offset = sum;
            sum += count;
        }
        indices.resize(sum);
        cursors.assign(offsets.begin(), offsets.end() - 1);
        for (std::size_t i = 0; i < lights.size(); ++i)
            each_tile(rects[i],
                      [&](std::size_t tile) { indices[cursors[tile]++] = static_cast<std::uint32_t>(i); });
    }

    std::vector<std::uint32_t> offsets, indices;
    std::vector<Rect> rects;

private:
    static Rect project(const FlatView& view, const glm::vec4& light) {
        const Real x = Real(light.x), y = Real(light.y), z = -Real(light.z), r = Real(light.w);
        Rect rect = {0, 0, -1, -1, z - r, z + r};
        if (z + r < Real(view.near_depth)) return rect;
        const Real width = Real(view.width), height = Real(view.height);
        Real x0 = 0, x1 = width, y0 = 0, y1 = height;
        if (z - r >= Real(view.near_depth)) {
            const Real scale = Real(view.scale), e = (z - r) * (z + r), over = 1 / e;
            const Real tx = r * std::sqrt(x * x + e), ty = r * std::sqrt(y * y + e);
            x0 = scale * (x * z - tx) * over + width / 2;
            x1 = scale * (x * z + tx) * over + width / 2;
            y0 = scale * (y * z - ty) * over + height / 2;
            y1 = scale * (y * z + ty) * over + height / 2;
        }
        if (x1 < 0 || y1 < 0 || x0 >= width || y0 >= height) return rect;
        rect.x0 = static_cast<int>(std::max(x0, Real(0)));
        rect.y0 = static_cast<int>(std::max(y0, Real(0)));
        rect.x1 = static_cast<int>(std::min(x1, Real(view.tiles_x - 1)));
        rect.y1 = static_cast<int>(std::min(y1, Real(view.tiles_y - 1)));
        return rect;
    }

    std::vector<std::uint32_t> cursors;
};
