// SPDX-License-Identifier: MIT
// A scene's triangles on the GPU.
#pragma once

#include <scene.hpp>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

/// Attributes: 0 position, 1 normal, 2 colour, 3 material (0, 1 or 2). Needs a current OpenGL context, and leaves its
/// objects to it.
class Geometry {
public:
    explicit Geometry(const Scene& scene);

    void draw_opaque() const;
    void draw_opaque(int material) const;  ///< those of one material
    /// Panes are drawn from the farthest to the nearest.
    void sort_panes(const glm::mat4& to_view);
    void draw_panes() const;
    void draw_everywhere() const;              ///< a triangle over the picture, made of vertex numbers
    void draw_quads(std::size_t count) const;  ///< so many instances of four vertices, made of their numbers
    void draw_ball() const;                    ///< holds the unit ball, which fills most of it; attribute 0

private:
    struct Corner {
        Vertex vertex;
        float material;
    };

    std::vector<Corner> panes_;
    GLuint opaque_array_ = 0, pane_array_ = 0, ball_array_ = 0, pane_buffer_ = 0;
    GLsizei first_[4] = {};  ///< of each material's corners
    GLsizei ball_size_ = 0;
};
