// SPDX-License-Identifier: MIT
// Runs jobs on OpenGL or OpenGL ES.
#pragma once

#include "job.hpp"

#include "gl_context.hpp"
#include "gl_program.hpp"

#include <epoxy/gl.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

class GlDevice {
public:
    /// glsl  330, 430, or ES: 300, 310
    explicit GlDevice(int glsl) : context_(glsl), glsl_(glsl) {
        GLuint vertex_array = 0;
        glGenVertexArrays(1, &vertex_array);
        glBindVertexArray(vertex_array);
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    }

    /// Compiles and links the program of a job. The caller deletes it.
    GLuint program(const Job& job) const {
        const std::string version = "#version " + std::to_string(glsl_) + (glsl_ < 330 ? " es\n" : " core\n");
        return job.stage == Stage::compute ? link_compute_program(job.text)
                                           : link_program(version + full_triangle, job.text);
    }

    /// Returns what the job wrote: compute: its result; fragment: the words of each pixel, 4 uints or 2 floats.
    std::vector<std::uint32_t> run(const Job& job) {
        const GLuint program = this->program(job);
        glUseProgram(program);
        std::vector<GLuint> buffers, textures;
        for (const Input& input : job.inputs)
            bind(program, input, buffers, textures);
        std::vector<std::uint32_t> words;
        if (job.stage == Stage::compute)
            words = dispatch(job, buffers[job.result]);
        else
            words = draw(job);
        glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
        glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
        glDeleteProgram(program);
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            throw std::runtime_error("OpenGL error " + std::to_string(error) + " in " + job.name);
        return words;
    }

private:
    static std::vector<std::uint32_t> dispatch(const Job& job, GLuint result) {
        glDispatchCompute(job.groups[0], job.groups[1], 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        const std::size_t bytes = job.inputs[job.result].bytes.size();
        std::vector<std::uint32_t> words(bytes / 4);
        glBindBuffer(GL_COPY_READ_BUFFER, result);
        const void* written =
            glMapBufferRange(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT);
        std::memcpy(words.data(), written, words.size() * 4);
        glUnmapBuffer(GL_COPY_READ_BUFFER);
        return words;
    }

    std::vector<std::uint32_t> draw(const Job& job) {
        const bool floats = !job.within.empty();
        GLuint picture = 0;
        glGenTextures(1, &picture);
        glActiveTexture(GL_TEXTURE15);
        glBindTexture(GL_TEXTURE_2D, picture);
        const auto x = static_cast<GLint>(job.corner[0]), y = static_cast<GLint>(job.corner[1]);
        const auto width = static_cast<GLsizei>(job.width), height = static_cast<GLsizei>(job.height);
        glTexStorage2D(GL_TEXTURE_2D, 1, floats ? GL_RG32F : GL_RGBA32UI, x + width, y + height);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture, 0);
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("the target of " + job.name + " is not complete");
        glViewport(x, y, width, height);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        std::vector<std::uint32_t> words(std::size_t{floats ? 2u : 4u} * job.width * job.height);
        glReadPixels(x, y, width, height, floats ? GL_RG : GL_RGBA_INTEGER,
                     floats ? GL_FLOAT : GL_UNSIGNED_INT, words.data());
        glDeleteTextures(1, &picture);
        return words;
    }

    void bind(GLuint program, const Input& input, std::vector<GLuint>& buffers,
              std::vector<GLuint>& textures) const {
        using lightbin::ShaderResource;
        const char* name = input.binding.name.c_str();
        const auto slot = static_cast<GLuint>(input.binding.slot.binding);
        const auto size = static_cast<GLsizeiptr>(input.bytes.size());
        const GLint place = glGetUniformLocation(program, name);
        buffers.push_back(0);
        textures.push_back(0);
        const auto fill = [&](GLenum target) {
            glGenBuffers(1, &buffers.back());
            glBindBuffer(target, buffers.back());
            glBufferData(target, size, input.bytes.data(), GL_STATIC_DRAW);
        };
        switch (input.binding.resource) {
        case ShaderResource::uniform_vector:
            set_uniform(place, name, input.bytes);
            return;
        case ShaderResource::uniform_block: {
            const GLuint index = glGetUniformBlockIndex(program, name);
            if (index == GL_INVALID_INDEX) throw std::runtime_error(std::string("no block ") + name);
            if (glsl_ == 330 || glsl_ == 300) glUniformBlockBinding(program, index, slot);
            fill(GL_UNIFORM_BUFFER);
            glBindBufferBase(GL_UNIFORM_BUFFER, slot, buffers.back());
            return;
        }
        case ShaderResource::storage_buffer:
        case ShaderResource::writable_buffer:
            fill(GL_SHADER_STORAGE_BUFFER);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, slot, buffers.back());
            return;
        default:
            break;
        }
        const lightbin::GlFormat form = lightbin::gl_format(input.binding.format);
        glGenTextures(1, &textures.back());
        glActiveTexture(GL_TEXTURE0 + slot);
        if (input.binding.resource == ShaderResource::texel_buffer) {
            fill(GL_TEXTURE_BUFFER);
            glBindTexture(GL_TEXTURE_BUFFER, textures.back());
            glTexBuffer(GL_TEXTURE_BUFFER, form.internal, buffers.back());
        } else {
            glBindTexture(GL_TEXTURE_2D, textures.back());
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
            glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(form.internal),
                         static_cast<GLsizei>(input.width), static_cast<GLsizei>(input.height), 0,
                         form.layout, form.type, input.bytes.data());
        }
        if (glsl_ == 330 || glsl_ == 300) glUniform1i(place, static_cast<GLint>(slot));
    }

    static constexpr const char* full_triangle = R"(
void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)";

    /// Sets a uniform, whose type its name tells. A uniform that the program does not read has no location.
    static void set_uniform(GLint place, const std::string& name, const std::vector<std::byte>& data) {
        if (name.ends_with("corner"))
            glUniform2iv(place, 1, reinterpret_cast<const GLint*>(data.data()));
        else if (name.ends_with("grid"))
            glUniform4uiv(place, 1, reinterpret_cast<const GLuint*>(data.data()));
        else
            glUniform4fv(place, static_cast<GLsizei>(data.size() / 16),
                         reinterpret_cast<const GLfloat*>(data.data()));
    }

    OffscreenContext context_;
    int glsl_;
    GLuint framebuffer_ = 0;
};
