// SPDX-License-Identifier: MIT
// Runs compute shaders by OpenGL 4.3 on named buffers, and reads the GPU's clock.
#pragma once

#include <gl_context.hpp>

#include <lightbin/shader_text.hpp>

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

/// A compute shader without its `#version` line, and the number of work groups to dispatch.
struct ComputePass {
    std::string name;
    lightbin::ShaderText shader;
    std::uint32_t groups_x = 1, groups_y = 1;
};

/// All functions throw std::runtime_error with one line if this device can't do what they need.
class GpuDevice {
public:
    GpuDevice();

    const std::string& name() const { return name_; }
    /// Returns whether the CPU stands in for a GPU, so that times say little.
    bool is_software() const { return software_; }

    /// Makes a buffer of this size with undefined content. It replaces a buffer of the same name.
    void make_buffer(const std::string& name, std::size_t bytes);
    /// Writes the buffer from its beginning. Returns the milliseconds by the GPU's clock, which runs on while the GPU
    /// waits for the bytes.
    double write(const std::string& name, std::span<const std::byte> bytes);
    std::vector<std::uint32_t> read(const std::string& name, std::size_t words);

    /// Sets the passes that run() runs, in this order. A binding is for the buffer whose name is the binding's name
    /// without `lightbin_` and `_block`.
    void set_passes(const std::vector<ComputePass>& passes);
    /// Runs the passes one after another and waits for them. Returns the milliseconds of all together or of each pass,
    /// by the GPU's clock.
    std::vector<double> run(bool each_pass);

private:
    void clock(std::size_t i);
    double between(std::size_t from, std::size_t to) const;

    OffscreenContext context_;
    std::string name_;
    bool software_;
    std::map<std::string, GLuint> buffers_, made_;
    std::vector<ComputePass> passes_;
    std::vector<GLuint> programs_, clocks_;
};
