// SPDX-License-Identifier: MIT
// A GPU as far as builds need it, by OpenGL 4.3: compute passes over named buffers, and its clock.
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

/// A compute shader without its `#version`, and the work groups that it is dispatched with.
struct ComputePass {
    std::string name;
    lightbin::ShaderText shader;
    std::uint32_t groups_x = 1, groups_y = 1;
};

/// Everything throws std::runtime_error with one line on what this device can't do.
class GpuDevice {
public:
    GpuDevice();

    const std::string& name() const { return name_; }
    /// Whether the device is the CPU: its times say little about a GPU's.
    bool is_software() const { return software_; }

    /// A buffer of so many bytes, with no particular content; in place of the one that had the name.
    void make_buffer(const std::string& name, std::size_t bytes);
    /// Writes the buffer from its beginning. Returns the milliseconds by the GPU's clock, which runs on while the GPU
    /// waits for the bytes.
    double write(const std::string& name, std::span<const std::byte> bytes);
    std::vector<std::uint32_t> read(const std::string& name, std::size_t words);

    /// The passes that run() runs, in this order. Bindings are buffers by name: a binding's name is that of its buffer
    /// between `lightbin_` and `_block`.
    void set_passes(const std::vector<ComputePass>& passes);
    /// Runs the passes, each after the one before is done, and waits for them. Returns the milliseconds of the whole,
    /// or of each pass; both by the GPU's clock.
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
