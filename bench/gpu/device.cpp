// SPDX-License-Identifier: MIT
#include "device.hpp"

#include <gl_program.hpp>

#include <stdexcept>

namespace {

void check(const std::string& what) {
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL reports error " + std::to_string(error) + " at " + what);
}

std::string buffer_of(const lightbin::ShaderBinding& binding) {
    std::string name = binding.name.substr(std::string("lightbin_").size());
    if (name.ends_with("_block")) name.erase(name.rfind('_'));
    return name;
}

}  // namespace

GpuDevice::GpuDevice()
    : context_(430),
      name_(std::string("OpenGL on ") + reinterpret_cast<const char*>(glGetString(GL_RENDERER))),
      software_(name_.find("llvmpipe") != std::string::npos || name_.find("softpipe") != std::string::npos) {}

void GpuDevice::make_buffer(const std::string& name, std::size_t bytes) {
    GLuint& buffer = buffers_[name];
    glDeleteBuffers(1, &buffer);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_DRAW);
    check("a buffer of " + std::to_string(bytes) + " bytes");
}

double GpuDevice::write(const std::string& name, std::span<const std::byte> bytes) {
    glFinish();
    clock(0);
    glFlush();  // the first clock is read now, not when the bytes are there
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffers_.at(name));
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    clock(1);
    return between(0, 1);
}

std::vector<std::uint32_t> GpuDevice::read(const std::string& name, std::size_t words) {
    // Reads by way of a copy: some drivers move a buffer that is read to the processor's memory, where it then stays.
    const auto size = static_cast<GLsizeiptr>(4 * words);
    std::vector<std::uint32_t> read(words);
    GLuint copy = 0;
    glGenBuffers(1, &copy);
    glBindBuffer(GL_COPY_WRITE_BUFFER, copy);
    glBufferData(GL_COPY_WRITE_BUFFER, size, nullptr, GL_STREAM_READ);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, buffers_.at(name));
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, size);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, size, read.data());
    glDeleteBuffers(1, &copy);
    check("reading " + name);
    return read;
}

void GpuDevice::set_passes(const std::vector<ComputePass>& passes) {
    passes_ = passes;
    programs_.clear();
    for (const ComputePass& pass : passes) {
        GLuint& program = made_["#version 430 core\n" + pass.shader.text];
        if (program == 0) program = link_compute_program("#version 430 core\n" + pass.shader.text);
        programs_.push_back(program);
    }
}

std::vector<double> GpuDevice::run(bool each_pass) {
    glFinish();
    clock(0);
    for (std::size_t i = 0; i < passes_.size(); ++i) {
        glUseProgram(programs_[i]);
        for (const lightbin::ShaderBinding& binding : passes_[i].shader.bindings) {
            const bool block = binding.resource == lightbin::ShaderResource::uniform_block;
            glBindBufferBase(block ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER,
                             static_cast<GLuint>(binding.slot.binding), buffers_.at(buffer_of(binding)));
        }
        glDispatchCompute(passes_[i].groups_x, passes_[i].groups_y, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        if (each_pass || i + 1 == passes_.size()) clock(i + 1);
    }
    glFinish();
    check("a build");
    if (!each_pass) return {between(0, passes_.size())};
    std::vector<double> milliseconds;
    for (std::size_t i = 0; i < passes_.size(); ++i)
        milliseconds.push_back(between(i, i + 1));
    return milliseconds;
}

/// Has the GPU note the time when the work before this call is done. A software renderer notes it too early, so it is
/// waited for.
void GpuDevice::clock(std::size_t i) {
    while (clocks_.size() <= i)
        glGenQueries(1, &clocks_.emplace_back());
    if (software_) glFinish();
    glQueryCounter(clocks_[i], GL_TIMESTAMP);
}

double GpuDevice::between(std::size_t from, std::size_t to) const {
    GLuint64 begin = 0, end = 0;
    glGetQueryObjectui64v(clocks_[from], GL_QUERY_RESULT, &begin);
    glGetQueryObjectui64v(clocks_[to], GL_QUERY_RESULT, &end);
    return static_cast<double>(end - begin) * 1e-6;
}
