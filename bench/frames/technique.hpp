// SPDX-License-Identifier: MIT
// The ways to draw a frame, a file each.
#pragma once

#include "stage.hpp"

#include <functional>
#include <string>
#include <vector>

/// Draws one frame on a stage, pass by pass, so that its picture is in Stage::shown().
struct Technique {
    std::string name;
    std::function<void(Stage&)> draw;
    int tolerance = 0;         ///< by which a colour may differ from the reference's, of 255, without MSAA
    int g_buffer_bits = 0;     ///< a component; 0: it has no G-buffer
    bool multisampled = true;  ///< can draw more than one sample a pixel
    int glsl = 330;            ///< the version that it needs at least
};

Technique forward_every_light();  ///< the reference
Technique tiled_forward();
Technique tiled_forward_gpu();  ///< its lists made on the GPU

enum class ZEnds { none, min, max, both };
enum class Reduction { cpu, gpu };
Technique tiled_forward_pre_z(ZEnds ends, Reduction reduction);
Technique tiled_forward_box();  ///< both, and the library's box test

Technique tiled_deferred(int g_buffer_bits);         ///< the grid made on the CPU
Technique tiled_deferred_passes(int g_buffer_bits);  ///< by compute passes
Technique tiled_deferred_kernel(int g_buffer_bits);  ///< in the kernel that shades
Technique tiled_deferred_planes(int g_buffer_bits);  ///< the same as the paper has it, without footprints
Technique deferred(int g_buffer_bits);
Technique deferred_stencil(int g_buffer_bits);

Technique light_indexed(int id_bits);
Technique clustered_forward();
Technique clustered_forward_gpu();  ///< its lists made on the GPU, without the box test
Technique z_binned_forward();

/// How the lists for transparent geometry are bounded.
enum class TransparentLists {
    max_only,  ///< by the opaque maximum, beside lists for opaque geometry with both
    shared,    ///< the same, for opaque geometry too
    own_min    ///< also by the transparent geometry's own minimum
};
Technique transparent_forward(TransparentLists lists);

/// All that draw opaque surfaces, but the reference.
std::vector<Technique> every_technique();
