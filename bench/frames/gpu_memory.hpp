// SPDX-License-Identifier: MIT
// The textures and buffers of a technique, by name, and how many bytes they take.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

/// Texture units of the shaders. set_samplers() sets each sampler with one of these names to its unit.
enum Unit : GLuint {
    unit_tiles,
    unit_lists,
    unit_slices,
    unit_bins,
    unit_lights,
    unit_footprints,
    unit_depth,
    unit_diffuse,
    unit_specular,
    unit_ambient,
    unit_normal,
    unit_radiance,
    unit_count
};
void set_samplers(GLuint program);

/// Throws std::runtime_error with one line if OpenGL cannot make a texture to draw to.
class GpuMemory {
public:
    /// Frees everything.
    void clear();
    std::size_t bytes() const;

    /// Returns a texture of this name to draw to and read from. It is made if there is none since clear().
    GLuint target(const std::string& name, GLenum format, int width, int height);
    void read_from(Unit unit, GLuint target);
    /// Binds a framebuffer with these textures for drawing and reading; depth 0 means no depth buffer.
    void draw_to(std::initializer_list<GLuint> colours, GLuint depth);
    GLuint framebuffer(std::initializer_list<GLuint> colours, GLuint depth);

    /// Returns a buffer of this name with these bytes, which replace what it held.
    GLuint buffer(const std::string& name, std::size_t bytes, const void* data);
    template <class Range> GLuint buffer(const std::string& name, const Range& range) {
        const std::span data(range);
        return buffer(name, data.size_bytes(), data.data());
    }
    /// Binds a buffer() as a buffer texture of this format to a texture unit.
    void read_texels(Unit unit, GLenum format, GLuint buffer);

private:
    struct Target {
        GLuint texture = 0;
        GLenum format = 0;
        std::size_t bytes = 0;
    };
    struct Buffer {
        GLuint name = 0;
        std::size_t bytes = 0;
    };

    std::map<std::string, Target> targets_;
    std::map<std::string, Buffer> buffers_;
    std::map<std::vector<GLuint>, GLuint> framebuffers_;
    GLuint texels_[unit_count] = {};
};
