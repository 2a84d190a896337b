// SPDX-License-Identifier: MIT
#include "cpu_depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace {

// A convex polygon of at most four corners, in clip space and then in pixels and window depth.
struct Polygon {
    glm::dvec4 corners[4];
    std::size_t count = 0;
};

// The part of a triangle that is not before the near plane.
Polygon clipped(const glm::dvec4 (&triangle)[3]) {
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec4 &a = triangle[i], &b = triangle[(i + 1) % 3];
        const double at_a = a.z + a.w, at_b = b.z + b.w;
        if (at_a >= 0) polygon.corners[polygon.count++] = a;
        if ((at_a < 0) != (at_b < 0)) polygon.corners[polygon.count++] = a + (b - a) * (at_a / (at_a - at_b));
    }
    return polygon;
}

}  // namespace

CpuDepth draw_depth_on_cpu(const Scene& scene, const glm::dmat4& projection_times_view,
                           lightbin::ImageSize size) {
    const auto width = static_cast<std::size_t>(size.width);
    CpuDepth picture{std::vector<float>(width * static_cast<std::size_t>(size.height), 1.0f)};
    std::uint64_t shaded = 0;
    const auto draw = [&](const glm::dvec4& a, glm::dvec4 b, glm::dvec4 c) {
        const auto cross = [](const glm::dvec4& u, const glm::dvec4& v) { return u.x * v.y - u.y * v.x; };
        double area = cross(b - a, c - a);
        if (area < 0) std::swap(b, c), area = -area;
        if (!(area > 0) || !std::isfinite(area)) return;
        const glm::dvec2 slope = {((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) / area,
                                  ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) / area};
        // The first pixel whose centre, at a half, is at a number or beyond it: a pixel whose centre is on the edge of
        // two triangles is of one of them.
        const auto first = [](double number, int end) {
            return static_cast<int>(std::ceil(std::clamp(number, 0.0, end + 0.5) - 0.5));
        };
        const int rows_end = first(std::max({a.y, b.y, c.y}), size.height);
        for (int y = first(std::min({a.y, b.y, c.y}), size.height); y < rows_end; ++y) {
            double left = std::min({a.x, b.x, c.x}), right = std::max({a.x, b.x, c.x});
            for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
                // From the lower end, so that it is the same number for the triangle on the other side.
                const glm::dvec4 &low = p.y < q.y ? p : q, &high = p.y < q.y ? q : p;
                const double crossing = low.x + (y + 0.5 - low.y) * ((high.x - low.x) / (high.y - low.y));
                if (p.y > q.y) left = std::max(left, crossing);
                if (p.y < q.y) right = std::min(right, crossing);
            }
            const int columns_end = first(right, size.width);
            for (int x = first(left, size.width); x < columns_end; ++x) {
                const double z = a.z + slope.x * (x + 0.5 - a.x) + slope.y * (y + 0.5 - a.y);
                float& nearest =
                    picture.depth[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
                if (!(z >= 0 && z < static_cast<double>(nearest))) continue;
                nearest = std::min(static_cast<float>(z), std::nextafter(1.0f, 0.0f));
                ++shaded;
            }
        }
    };

    for (std::size_t i = 0; i < scene.triangles.size(); i += 3) {
        glm::dvec4 triangle[3];
        for (std::size_t k = 0; k < 3; ++k)
            triangle[k] = projection_times_view * glm::dvec4(glm::dvec3(scene.triangles[i + k].position), 1);
        Polygon polygon = clipped(triangle);
        for (glm::dvec4& p : std::span(polygon.corners, polygon.count))
            p = {(p.x / p.w + 1) * size.width / 2, (p.y / p.w + 1) * size.height / 2, (p.z / p.w + 1) / 2, 1};
        for (std::size_t k = 2; k < polygon.count; ++k)
            draw(polygon.corners[0], polygon.corners[k - 1], polygon.corners[k]);
    }
    const auto drawn =
        std::count_if(picture.depth.begin(), picture.depth.end(), [](float z) { return z < 1; });
    if (drawn > 0) picture.overdraw = static_cast<double>(shaded) / static_cast<double>(drawn);
    return picture;
}
