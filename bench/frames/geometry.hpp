// SPDX-License-Identifier: MIT
// A scene's triangles on the GPU.
#pragma once

#include <scene.hpp>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

/// Attributes: 0 position, 1 normal, 2 colour. Needs a current OpenGL context, and leaves its
/// objects to it.
class Geometry {
public:
    explicit Geometry(const Scene& scene);

    void draw_opaque() const;
    void draw_everywhere() const;              ///< a triangle over the picture, made of vertex numbers
    void draw_quads(std::size_t count) const;  ///< so many instances of four vertices, made of their numbers
    void draw_ball() const;                    ///< holds the unit ball, which fills most of it; attribute 0

private:
    GLuint opaque_array_ = 0, ball_array_ = 0;
    GLsizei opaque_size_ = 0;
    GLsizei ball_size_ = 0;
};
