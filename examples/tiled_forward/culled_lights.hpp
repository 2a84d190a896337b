// SPDX-License-Identifier: MIT
// The lists of a frame, made by compute shaders: OpenGL 4.3 or ES 3.1. Nothing of them passes through the CPU, but what the
// program says of them.
#pragma once

#include "frame_buffer.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader_cull.hpp>

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

class CulledLights {
public:
    struct Lists {
        bool depth_test = false;                   // without slices: with the Z bounds of the last reduce()
        bool max_only = false;                     // with the greater Z bound alone
        const lightbin::Slices* slices = nullptr;  // of clusters
    };
    // What was made, for the program to say.
    struct Made {
        lightbin::CullTotals totals;
        std::vector<lightbin::ListRange> ranges;
    };

    // `glsl`: as OffscreenContext::glsl(), 430 or 310
    CulledLights(int glsl, bool has_spots) : glsl_(glsl), has_spots_(has_spots) {}

    // Lights in view space. Those of a program that moves them on the GPU would be there already.
    void upload(std::span<const lightbin::Spot> lights);

    // Z bounds from the depths of what is drawn; with skip_background not of where nothing is.
    void reduce(const lightbin::View& view, const FrameBuffer& drawn, bool skip_background);

    // Makes the lists in these two buffers, as shaders read them. Waits for their total, and makes them again where they
    // had no room; a renderer would read the total some frames later.
    Made build(const lightbin::View& view, const Lists& wanted, GLuint tiles, GLuint lists);

private:
    struct Pass {
        lightbin::CullPass which;
        std::vector<lightbin::ShaderBinding> bindings;
        GLuint program;
    };
    using Key = std::tuple<bool, bool, bool, bool>;  // depth_test, max_only, clusters, orthographic

    const std::vector<Pass>& passes(const lightbin::CullOptions& options);
    GLuint buffer(const char* name, std::size_t bytes, const void* data = nullptr);

    int glsl_;
    bool has_spots_;
    std::uint32_t light_count_ = 0, room_ = 4096;
    std::map<Key, std::vector<Pass>> passes_;
    std::map<std::tuple<int, bool, bool>, GLuint> reduce_programs_;  // [samples, orthographic, skip]
    std::map<std::string, GLuint> buffers_;                          // by the names that bindings have
};
