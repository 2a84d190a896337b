// SPDX-License-Identifier: MIT
#include "geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace {

// What stands on one square of a board is an object; their materials are mixed up.
int material_of(glm::vec3 middle, float square) {
    const auto x = static_cast<int>(std::floor(middle.x / square)),
               z = static_cast<int>(std::floor(middle.z / square));
    return ((x + 2 * z) % 3 + 3) % 3;
}

float side_of(const std::vector<Vertex>& triangles) {
    glm::vec2 low(std::numeric_limits<float>::max()), high(-low);
    for (const Vertex& vertex : triangles) {
        const glm::vec2 place(vertex.position.x, vertex.position.z);
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    return std::max(high.x - low.x, high.y - low.y);
}

// A ball of triangles that holds the unit ball: an icosahedron, each triangle cut in four twice.
std::vector<glm::vec3> ball() {
    const float golden = (1 + std::sqrt(5.0f)) / 2;
    std::vector<glm::vec3> tops;
    for (const float a : {-1.0f, 1.0f})
        for (const float b : {-golden, golden})
            for (const glm::vec3& top : {glm::vec3(0, a, b), glm::vec3(a, b, 0), glm::vec3(b, 0, a)})
                tops.push_back(glm::normalize(top));
    const float edge = 2.1f / std::hypot(1.0f, golden);
    const auto meet = [&](std::size_t i, std::size_t j) { return glm::distance(tops[i], tops[j]) < edge; };
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i < tops.size(); ++i)
        for (std::size_t j = i + 1; j < tops.size(); ++j)
            for (std::size_t k = j + 1; k < tops.size(); ++k) {
                if (!meet(i, j) || !meet(j, k) || !meet(k, i)) continue;
                const glm::vec3 a = tops[i], b = tops[j], c = tops[k];
                const bool outward = glm::dot(glm::cross(b - a, c - a), a) > 0;
                corners.insert(corners.end(), {a, outward ? b : c, outward ? c : b});
            }
    for (int cut = 0; cut < 2; ++cut) {
        const std::vector<glm::vec3> whole = std::exchange(corners, {});
        for (std::size_t i = 0; i < whole.size(); i += 3) {
            const glm::vec3 a = whole[i], b = whole[i + 1], c = whole[i + 2], ab = glm::normalize(a + b),
                            bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            corners.insert(corners.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
    }
    // The triangles cut into the ball: make it larger until they don't.
    float inside = 1;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const glm::vec3 normal = glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]);
        inside = std::min(inside, glm::dot(corners[i], glm::normalize(normal)));
    }
    for (glm::vec3& corner : corners)
        corner /= 0.9999f * inside;
    return corners;
}

GLuint new_vertex_array(GLuint& buffer) {
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    return array;
}

template <class T> void fill(const std::vector<T>& data, GLenum use) {
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), use);
}

}  // namespace

Geometry::Geometry(const Scene& scene) {
    const float square = side_of(scene.triangles) / 20;
    const auto corners_of = [&](const std::vector<Vertex>& triangles) {
        std::vector<Corner> corners;
        for (std::size_t i = 0; i + 3 <= triangles.size(); i += 3) {
            const glm::vec3 sum =
                triangles[i].position + triangles[i + 1].position + triangles[i + 2].position;
            for (std::size_t k = i; k < i + 3; ++k)
                corners.push_back({triangles[k], static_cast<float>(material_of(sum / 3.0f, square))});
        }
        return corners;
    };
    const auto set_attributes = [] {
        for (const GLuint i : {0u, 1u, 2u, 3u}) {  // the three vec3 of a Vertex, and the material
            glEnableVertexAttribArray(i);
            glVertexAttribPointer(i, i < 3 ? 3 : 1, GL_FLOAT, GL_FALSE, sizeof(Corner),
                                  reinterpret_cast<const void*>(i * sizeof(glm::vec3)));
        }
    };
    static_assert(sizeof(Corner) == 40);

    const std::vector<Corner> corners = corners_of(scene.triangles);
    std::vector<Corner> sorted;
    for (int material = 0; material < 3; ++material) {
        first_[material] = static_cast<GLsizei>(sorted.size());
        std::ranges::copy_if(corners, std::back_inserter(sorted), [&](const Corner& corner) {
            return static_cast<int>(corner.material) == material;
        });
    }
    first_[3] = static_cast<GLsizei>(sorted.size());
    GLuint buffer = 0;
    opaque_array_ = new_vertex_array(buffer);
    fill(sorted, GL_STATIC_DRAW);
    set_attributes();

    panes_ = corners_of(scene.transparent);
    pane_array_ = new_vertex_array(pane_buffer_);
    set_attributes();

    const std::vector<glm::vec3> sides = ball();
    ball_size_ = static_cast<GLsizei>(sides.size());
    ball_array_ = new_vertex_array(buffer);
    fill(sides, GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Geometry::draw_opaque() const {
    glBindVertexArray(opaque_array_);
    glDrawArrays(GL_TRIANGLES, 0, first_[3]);
}

void Geometry::draw_opaque(int material) const {
    glBindVertexArray(opaque_array_);
    glDrawArrays(GL_TRIANGLES, first_[material], first_[material + 1] - first_[material]);
}

void Geometry::sort_panes(const glm::mat4& to_view) {
    const auto depth = [&](std::size_t pane) {
        const auto z = [&](std::size_t k) {
            const glm::vec3& p = panes_[3 * pane + k].vertex.position;
            return to_view[0][2] * p.x + to_view[1][2] * p.y + to_view[2][2] * p.z;
        };
        return z(0) + z(1) + z(2);
    };
    std::vector<std::size_t> order(panes_.size() / 3);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, depth);
    std::vector<Corner> sorted;
    for (const std::size_t pane : order)
        sorted.insert(sorted.end(), {panes_[3 * pane], panes_[3 * pane + 1], panes_[3 * pane + 2]});
    glBindBuffer(GL_ARRAY_BUFFER, pane_buffer_);
    fill(sorted, GL_STREAM_DRAW);
}

void Geometry::draw_panes() const {
    glBindVertexArray(pane_array_);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(panes_.size()));
}

void Geometry::draw_everywhere() const {
    glBindVertexArray(ball_array_);  // of which nothing is read
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Geometry::draw_quads(std::size_t count) const {
    glBindVertexArray(ball_array_);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
}

void Geometry::draw_ball() const {
    glBindVertexArray(ball_array_);
    glDrawArrays(GL_TRIANGLES, 0, ball_size_);
}
