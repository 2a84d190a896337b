// SPDX-License-Identifier: MIT
#include "gpu_memory.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace {

struct Format {
    std::size_t bytes;  // of a texel
    GLenum layout, type, attachment;
};

Format format_of(GLenum format) {
    switch (format) {
    case GL_DEPTH_COMPONENT32F:
        return {4, GL_DEPTH_COMPONENT, GL_FLOAT, GL_DEPTH_ATTACHMENT};
    case GL_DEPTH32F_STENCIL8:
        return {8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, GL_DEPTH_STENCIL_ATTACHMENT};
    case GL_RGBA32F:
        return {16, GL_RGBA, GL_FLOAT, 0};
    case GL_RGBA16F:
        return {8, GL_RGBA, GL_FLOAT, 0};
    case GL_RG32F:
        return {8, GL_RG, GL_FLOAT, 0};
    case GL_RGBA8:
        return {4, GL_RGBA, GL_UNSIGNED_BYTE, 0};
    default:
        throw std::runtime_error("a target of an unknown format");
    }
}

std::size_t texel_bytes(GLenum format) {
    switch (format) {
    case GL_R16UI:
        return 2;
    case GL_R32UI:
        return 4;
    case GL_RG32UI:
        return 8;
    default:
        return 16;
    }
}

}  // namespace

void set_samplers(GLuint program) {
    static constexpr std::pair<const char*, Unit> samplers[] = {
        {"lightbin_tiles", unit_tiles},
        {"lightbin_lists", unit_lists},
        {"lightbin_masks", unit_lists},
        {"lightbin_slices", unit_slices},
        {"lightbin_bins", unit_bins},
        {"lights", unit_lights},
        {"footprints", unit_footprints},
        {"depth_texture", unit_depth},
        {"lightbin_depth", unit_depth},
        {"diffuse_texture", unit_diffuse},
        {"specular_texture", unit_specular},
        {"ambient_texture", unit_ambient},
        {"normal_texture", unit_normal},
        {"radiance_texture", unit_radiance},
    };
    glUseProgram(program);
    for (const auto& [name, unit] : samplers)
        glUniform1i(glGetUniformLocation(program, name), static_cast<GLint>(unit));  // -1 sets nothing
}

void GpuMemory::clear() {
    for (const auto& [name, target] : targets_)
        glDeleteTextures(1, &target.texture);
    for (const auto& [name, buffer] : buffers_)
        glDeleteBuffers(1, &buffer.name);
    for (const auto& [attached, framebuffer] : framebuffers_)
        glDeleteFramebuffers(1, &framebuffer);
    targets_.clear();
    buffers_.clear();
    framebuffers_.clear();
}

std::size_t GpuMemory::bytes() const {
    std::size_t sum = 0;
    for (const auto& [name, target] : targets_)
        sum += target.bytes;
    for (const auto& [name, buffer] : buffers_)
        sum += buffer.bytes;
    return sum;
}

GLuint GpuMemory::target(const std::string& name, GLenum format, int width, int height) {
    Target& target = targets_[name];
    if (target.texture != 0) return target.texture;
    const Format texels = format_of(format);
    target.format = format;
    target.bytes = texels.bytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    glGenTextures(1, &target.texture);
    read_from(unit_count, target.texture);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, texels.layout, texels.type,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("there is no target of " + std::to_string(width) + " x " +
                                 std::to_string(height) + " pixels for " + name + ", " +
                                 std::to_string(target.bytes >> 20) + " MiB");
    return target.texture;
}

void GpuMemory::read_from(Unit unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

GLuint GpuMemory::framebuffer(std::initializer_list<GLuint> colours, GLuint depth) {
    std::vector<GLuint> attached(colours);
    attached.push_back(depth);
    GLuint& made = framebuffers_[attached];
    if (made != 0) return made;
    glGenFramebuffers(1, &made);
    glBindFramebuffer(GL_FRAMEBUFFER, made);
    std::vector<GLenum> drawn;
    for (const GLuint colour : colours) {
        drawn.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(drawn.size()));
        glFramebufferTexture(GL_FRAMEBUFFER, drawn.back(), colour, 0);
    }
    for (const auto& [name, target] : targets_)
        if (depth != 0 && target.texture == depth)
            glFramebufferTexture(GL_FRAMEBUFFER, format_of(target.format).attachment, depth, 0);
    if (drawn.empty()) {
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    } else {
        glDrawBuffers(static_cast<GLsizei>(drawn.size()), drawn.data());
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("this OpenGL cannot draw to the targets");
    return made;
}

void GpuMemory::draw_to(std::initializer_list<GLuint> colours, GLuint depth) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer(colours, depth));
}

GLuint GpuMemory::buffer(const std::string& name, std::size_t bytes, const void* data) {
    Buffer& buffer = buffers_[name];
    if (buffer.name == 0) glGenBuffers(1, &buffer.name);
    buffer.bytes = std::max<std::size_t>(bytes, 16);  // none is empty
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.name);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(buffer.bytes),
                 bytes == buffer.bytes ? data : nullptr, GL_STREAM_DRAW);
    if (data && bytes > 0 && bytes < buffer.bytes)
        glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("there is no memory for " + name + ", " + std::to_string(bytes >> 20) +
                                 " MiB");
    return buffer.name;
}

void GpuMemory::read_texels(Unit unit, GLenum format, GLuint buffer) {
    if (texels_[unit] == 0) glGenTextures(1, &texels_[unit]);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_BUFFER, texels_[unit]);
    const auto found = std::ranges::find(buffers_, buffer, [](const auto& b) { return b.second.name; });
    GLint most = 0;  // what lies beyond is read as if it were nothing
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (found->second.bytes / texel_bytes(format) > static_cast<std::size_t>(most))
        throw std::runtime_error(found->first + " take " + std::to_string(found->second.bytes >> 20) +
                                 " MiB, and this OpenGL reads at most " + std::to_string(most) + " texels");
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
}
