// SPDX-License-Identifier: MIT
// The baseline that all times are given as a ratio to: the plain loop that a renderer's author would write.
#pragma once

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// A symmetric perspective view in tiles, looking down -z: tile coordinate = scale * (c / depth) + half the
/// viewport.
struct FlatView {
    int tiles_x, tiles_y;
    double width, height;  ///< of the viewport in tiles: fractions where the last tile is partial
    double scale, near_depth, far_depth;
};

/// The plain loop: for each light it finds the rectangle of tiles and counts it in the table of tiles; a prefix sum;
/// then a second pass writes 32-bit ids. Vectors are reused. If tiles have Z bounds (minimum and maximum depth), both
/// passes test them.
template <class Real> class Flat {
public:
    struct Rect {
        int x0, y0, x1, y1;
        Real z_min, z_max;
    };

    /// Not inlined, and with a copy of the view, which no store can change: so compilers make it fast, and the same
    /// code everywhere.
    template <bool with_depth>
    [[gnu::noinline]] void build(const FlatView view, std::span<const glm::vec4> lights,
                                 const float* tile_min, const float* tile_max) {
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
        const Real near_depth = Real(view.near_depth), scale = Real(view.scale);
        Rect rect = {0, 0, -1, -1, z - r, z + r};
        if (z + r < near_depth || z - r > Real(view.far_depth)) return rect;
        const Real width = Real(view.width), height = Real(view.height);
        Real x0, x1, y0, y1;
        if (z - r > near_depth) {
            const Real e = (z - r) * (z + r), over = 1 / e;
            const Real tx = r * std::sqrt(x * x + e), ty = r * std::sqrt(y * y + e);
            x0 = (x * z - tx) * over;
            x1 = (x * z + tx) * over;
            y0 = (y * z - ty) * over;
            y1 = (y * z + ty) * over;
        } else {
            const Real h = std::sqrt(std::max(r * r - (near_depth - z) * (near_depth - z), Real(0)));
            x0 = -clipped_slope(-x, z, r, h, near_depth);
            x1 = clipped_slope(x, z, r, h, near_depth);
            y0 = -clipped_slope(-y, z, r, h, near_depth);
            y1 = clipped_slope(y, z, r, h, near_depth);
        }
        x0 = scale * x0 + width / 2;
        x1 = scale * x1 + width / 2;
        y0 = scale * y0 + height / 2;
        y1 = scale * y1 + height / 2;
        if (x1 < 0 || y1 < 0 || x0 >= width || y0 >= height) return rect;
        rect.x0 = static_cast<int>(std::max(x0, Real(0)));
        rect.y0 = static_cast<int>(std::max(y0, Real(0)));
        rect.x1 = static_cast<int>(std::min(x1, Real(view.tiles_x - 1)));
        rect.y1 = static_cast<int>(std::min(y1, Real(view.tiles_y - 1)));
        return rect;
    }

    /// Largest slope of the part of a disc (c, z, r) beyond the near plane, which cuts it at c - h and c + h: at the
    /// tangent point if that is beyond the plane, else at the corner (Mara and McGuire, JCGT 2(2), 2013).
    static Real clipped_slope(Real c, Real z, Real r, Real h, Real near_depth) {
        if (near_depth * (z - near_depth) <= h * (c + h)) return (c + h) / near_depth;
        const Real t = std::sqrt(std::max(c * c + z * z - r * r, Real(0)));
        return (t * c + r * z) / (t * z - r * c);
    }

    std::vector<std::uint32_t> cursors;
};
