// SPDX-License-Identifier: MIT
// A GPU as far as builds need it: compute passes over named buffers, and its clock.
#pragma once

#include <lightbin/shader_text.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
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
    virtual ~GpuDevice() = default;

    virtual std::string name() const = 0;  ///< the API's and the device's
    virtual bool is_software() const = 0;  ///< whether it is the CPU: its times say little about a GPU's
    virtual lightbin::ShaderLanguage language() const = 0;

    /// A buffer of so many bytes, with no particular content; in place of the one that had the name.
    virtual void make_buffer(const std::string& name, std::size_t bytes) = 0;
    /// Writes the buffer from its beginning. Returns the milliseconds by the GPU's clock, which runs on while the GPU
    /// waits for the bytes.
    virtual double write(const std::string& name, std::span<const std::byte> bytes) = 0;
    virtual std::vector<std::uint32_t> read(const std::string& name, std::size_t words) = 0;

    /// The passes that run() runs, in this order. Bindings are buffers by name: a binding's name is that of its buffer
    /// between `lightbin_` and `_block`.
    virtual void set_passes(const std::vector<ComputePass>& passes) = 0;
    /// Runs the passes, each after the one before is done, and waits for them. Returns the milliseconds of the whole,
    /// or of each pass; both by the GPU's clock.
    virtual std::vector<double> run(bool each_pass) = 0;
};

std::unique_ptr<GpuDevice> open_gl_device();
std::unique_ptr<GpuDevice> open_vulkan_device();
