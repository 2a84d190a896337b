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

/// Places that shaders read from; set_samplers() binds each sampler of that name to one.
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

/// Throws std::runtime_error with one line where a target can't be had.
class GpuMemory {
public:
    /// Frees everything.
    void clear();
    std::size_t bytes() const;

    /// A texture to draw to and read from; made if there is none of that name since clear().
    GLuint target(const std::string& name, GLenum format, int width, int height);
    void read_from(Unit unit, GLuint target);
    /// Binds a framebuffer of these for drawing and reading; depth 0: none.
    void draw_to(std::initializer_list<GLuint> colours, GLuint depth);
    GLuint framebuffer(std::initializer_list<GLuint> colours, GLuint depth);

    /// A buffer of these bytes; in place of what it held, if there is one of that name.
    GLuint buffer(const std::string& name, std::size_t bytes, const void* data);
    template <class Range> GLuint buffer(const std::string& name, const Range& range) {
        const std::span data(range);
        return buffer(name, data.size_bytes(), data.data());
    }
    /// Shaders read the bytes of a buffer() at the unit, as texels of that format.
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
