// SPDX-License-Identifier: MIT
// Draws a scene's depth buffer on the CPU, so that the reports need no graphics driver.
#pragma once

#include "scenes.hpp"

#include <lightbin/view.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// What the centre of each pixel shows. Rows begin at the bottom, as in OpenGL.
struct Picture {
    lightbin::ImageSize size;
    std::vector<float> depth;             ///< window depth, 1 where nothing is drawn
    std::vector<float> view_depth;        ///< along the viewing direction; the far plane if nothing is drawn
    std::vector<std::uint32_t> triangle;  ///< its number in the scene, `nothing` if none is drawn
    static constexpr std::uint32_t nothing = ~std::uint32_t{0};
};

/// Half the extent of what is seen at view depth 1, and the near and far plane, of a symmetric perspective matrix.
struct Frustum {
    double x, y, near_depth, far_depth;

    explicit Frustum(const glm::mat4& projection)
        : x(1 / static_cast<double>(projection[0][0])), y(1 / static_cast<double>(projection[1][1])),
          near_depth(static_cast<double>(projection[3][2]) / (static_cast<double>(projection[2][2]) - 1)),
          far_depth(static_cast<double>(projection[3][2]) / (static_cast<double>(projection[2][2]) + 1)) {}
};

/// Returns the view-space point at a pixel's centre and this view depth.
inline glm::vec3 point_at(const Frustum& frustum, lightbin::ImageSize size, int x, int y, float view_depth) {
    const double depth = static_cast<double>(view_depth);
    return glm::vec3(glm::dvec3(((x + 0.5) / size.width * 2 - 1) * frustum.x * depth,
                                ((y + 0.5) / size.height * 2 - 1) * frustum.y * depth, -depth));
}

/// Draws the scene's triangles, both sides, one sample a pixel. A pixel's ray hits a triangle where its
/// volumes with the three edges have one sign (homogeneous edge functions: Olano and Greer, 1997), so that
/// nothing needs clipping; they are linear in the pixel.
inline Picture rasterise(const BenchScene& scene, lightbin::ImageSize size) {
    const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const Frustum frustum(scene.projection);
    Picture picture{size,
                    {},
                    std::vector<float>(pixels, static_cast<float>(frustum.far_depth)),
                    std::vector<std::uint32_t>(pixels, Picture::nothing)};

    const glm::dvec3 left(2 * frustum.x / size.width, 0, 0), up(0, 2 * frustum.y / size.height, 0);
    const glm::dvec3 first = point_at(frustum, size, 0, 0, 1);
    for (std::size_t i = 0; i < scene.triangles.size(); i += 3) {
        const glm::dvec3 a(scene.triangles[i]), b(scene.triangles[i + 1]), c(scene.triangles[i + 2]);
        if (std::max({-a.z, -b.z, -c.z}) < frustum.near_depth) continue;
        int x0 = 0, y0 = 0, x1 = size.width - 1, y1 = size.height - 1;
        if (std::min({-a.z, -b.z, -c.z}) > 0) {
            const auto pixel_x = [&](const glm::dvec3& p) {
                return std::clamp((p.x / -p.z - first.x) / left.x, -1.0, size.width + 0.0);
            };
            const auto pixel_y = [&](const glm::dvec3& p) {
                return std::clamp((p.y / -p.z - first.y) / up.y, -1.0, size.height + 0.0);
            };
            x0 = std::max(x0, static_cast<int>(std::ceil(std::min({pixel_x(a), pixel_x(b), pixel_x(c)}))));
            x1 = std::min(x1, static_cast<int>(std::floor(std::max({pixel_x(a), pixel_x(b), pixel_x(c)}))));
            y0 = std::max(y0, static_cast<int>(std::ceil(std::min({pixel_y(a), pixel_y(b), pixel_y(c)}))));
            y1 = std::min(y1, static_cast<int>(std::floor(std::max({pixel_y(a), pixel_y(b), pixel_y(c)}))));
            if (x0 > x1 || y0 > y1) continue;
        }
        const double volume = glm::dot(a, glm::cross(b, c)), sign = volume < 0 ? -1 : 1;
        const glm::dvec3 edges[3] = {sign * glm::cross(b, c), sign * glm::cross(c, a),
                                     sign * glm::cross(a, b)};
        const glm::dvec3 sum = edges[0] + edges[1] + edges[2];
        for (int y = y0; y <= y1; ++y) {
            const glm::dvec3 row = first + static_cast<double>(y) * up;
            double from = x0, to = x1;
            for (const glm::dvec3& edge : edges) {
                const double at_0 = glm::dot(edge, row), step = edge.x * left.x;
                if (step > 0) from = std::max(from, -at_0 / step);
                if (step < 0) to = std::min(to, -at_0 / step);
                if (step == 0 && at_0 < 0) to = -1;
            }
            if (!(from <= to)) continue;
            for (int x = static_cast<int>(std::ceil(from)); x <= to; ++x) {
                const double depth = std::fabs(volume) / glm::dot(sum, row + static_cast<double>(x) * left);
                const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                          static_cast<std::size_t>(x);
                if (depth >= frustum.near_depth && static_cast<float>(depth) < picture.view_depth[pixel]) {
                    picture.view_depth[pixel] = static_cast<float>(depth);
                    picture.triangle[pixel] = static_cast<std::uint32_t>(i / 3);
                }
            }
        }
    }

    picture.depth.reserve(pixels);
    const double scale = static_cast<double>(scene.projection[2][2]),
                 offset = static_cast<double>(scene.projection[3][2]);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const double depth = static_cast<double>(picture.view_depth[pixel]);
        picture.depth.push_back(picture.triangle[pixel] == Picture::nothing
                                    ? 1.0f
                                    : static_cast<float>(0.5 + 0.5 * (offset / depth - scale)));
    }
    return picture;
}
