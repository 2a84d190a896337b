// SPDX-License-Identifier: MIT
// The ways to draw a frame, a file each.
#pragma once

#include "stage.hpp"

#include <functional>
#include <string>
#include <vector>

/// Draws one frame on a stage, pass by pass. Afterwards Stage::drawn() is the picture.
struct Technique {
    std::string name;
    std::function<void(Stage&)> draw;
    int tolerance = 0;      ///< allowed difference of a colour component from the reference, of 255
    int g_buffer_bits = 0;  ///< for each component; 0 if it has no G-buffer
};

Technique forward_every_light();  ///< every fragment by every light: the reference picture
Technique tiled_forward();

enum class ZEnds { none, min, max, both };
Technique tiled_forward_pre_z(ZEnds ends);
Technique tiled_forward_box();  ///< minimum and maximum depth, and the library's box test

Technique tiled_deferred(int g_buffer_bits);
Technique deferred(int g_buffer_bits);
Technique deferred_stencil(int g_buffer_bits);

Technique clustered_forward();
Technique z_binned_forward();
Technique masked_forward(lightbin::Slicing slicing);  ///< without depth slices, or with z-bins

/// Returns plain tiles, and the techniques that need no depth before they shade, either.
std::vector<Technique> without_pre_pass();
/// Returns all techniques that draw opaque surfaces, except the reference.
std::vector<Technique> every_technique();
