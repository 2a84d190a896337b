// SPDX-License-Identifier: MIT
#include "geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace {

// Returns a mesh that encloses the unit sphere: an icosahedron with each triangle divided into four, twice.
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
    // The middles of triangles lie inside the sphere: the mesh is enlarged until they do not.
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

template <class T> void fill(const std::vector<T>& data) {
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(),
                 GL_STATIC_DRAW);
}

}  // namespace

Geometry::Geometry(const Scene& scene) {
    GLuint buffer = 0;
    opaque_array_ = new_vertex_array(buffer);
    opaque_size_ = static_cast<GLsizei>(scene.triangles.size());
    fill(scene.triangles);
    static_assert(sizeof(Vertex) == 3 * sizeof(glm::vec3));
    for (const GLuint i : {0u, 1u, 2u}) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(i * sizeof(glm::vec3)));
    }

    const std::vector<glm::vec3> sides = ball();
    ball_size_ = static_cast<GLsizei>(sides.size());
    ball_array_ = new_vertex_array(buffer);
    fill(sides);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Geometry::draw_opaque() const {
    glBindVertexArray(opaque_array_);
    glDrawArrays(GL_TRIANGLES, 0, opaque_size_);
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
