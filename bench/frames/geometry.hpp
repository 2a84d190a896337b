// SPDX-License-Identifier: MIT
// A scene's triangles on the GPU.
#pragma once

#include <scene.hpp>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

/// Vertex attribute 0 is the position, 1 the normal, 2 the colour. Needs a current OpenGL context, which owns the
/// objects that it makes.
class Geometry {
public:
    explicit Geometry(const Scene& scene);

    void draw_opaque() const;
    void draw_everywhere() const;              ///< one triangle over the whole picture, without vertex data
    void draw_quads(std::size_t count) const;  ///< `count` instances of four vertices, without vertex data
    void draw_ball() const;                    ///< a mesh around the unit sphere, as attribute 0

private:
    GLuint opaque_array_ = 0, ball_array_ = 0;
    GLsizei opaque_size_ = 0;
    GLsizei ball_size_ = 0;
};
