// SPDX-License-Identifier: MIT
// Lists that compute shaders make of the frame's lights, by shader_cull: the CPU has no part in them.
#pragma once

#include "stage.hpp"

#include <lightbin/shader_cull.hpp>

#include <cstdint>
#include <vector>

/// What a technique keeps of them from frame to frame. Needs OpenGL 4.3.
class GpuLists {
public:
    /// options  but for the language and the layout, which are set here; the same ones in each frame
    explicit GpuLists(const lightbin::CullShaderOptions& options);

    /// Makes the lists, for the shaders of listed_lights(), in laps named "build". With a depth test the stage's memory
    /// has a buffer "z_bounds", and with clusters "slices", as lightbin::plan_cull() says. Where the frame has other
    /// lights than the one before, this waits and reads how long the lists are, and makes them again if they had no
    /// room; a renderer would read that some frames later.
    void build(Stage& stage, const lightbin::Slices* slices = nullptr);

private:
    lightbin::CullShaderOptions options_;
    std::vector<lightbin::ShaderText> texts_;
    std::uint32_t room_ = 1024;
    std::vector<lightbin::Sphere> seen_;
};
