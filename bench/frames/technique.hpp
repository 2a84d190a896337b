// SPDX-License-Identifier: MIT
// The ways to draw a frame, a file each.
#pragma once

#include "stage.hpp"

#include <functional>
#include <string>
#include <vector>

/// Draws one frame on a stage, pass by pass, so that its picture is in Stage::drawn().
struct Technique {
    std::string name;
    std::function<void(Stage&)> draw;
    int tolerance = 0;      ///< by which a colour may differ from the reference's, of 255
    int g_buffer_bits = 0;  ///< a component; 0: it has no G-buffer
};

Technique forward_every_light();  ///< the reference
Technique tiled_forward();

enum class ZEnds { none, min, max, both };
Technique tiled_forward_pre_z(ZEnds ends);
Technique tiled_forward_box();  ///< both, and the library's box test

Technique tiled_deferred(int g_buffer_bits);
Technique deferred(int g_buffer_bits);
Technique deferred_stencil(int g_buffer_bits);

Technique clustered_forward();
Technique z_binned_forward();
Technique masked_forward(lightbin::Slicing slicing);  ///< none, z_bins

/// Plain tiles, and what needs no depth before it shades either.
std::vector<Technique> without_pre_pass();
/// All that draw opaque surfaces, but the reference.
std::vector<Technique> every_technique();
