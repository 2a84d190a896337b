// SPDX-License-Identifier: MIT
// What this machine's OpenGL takes for one light at one pixel, for a depth pre-pass and for an upload.
#pragma once

#include "scene.hpp"

#include <string>

// Medians of several frames of the example's own shaders. 0: too short to be told from the noise of the clock.
struct DrawTimes {
    std::string renderer;         // as OpenGL names it
    int glsl = 0;                 // see OffscreenContext::glsl()
    double evaluation_ns = 0;     // one light evaluated at one pixel, as the whole device does it
    double depth_pass_ns = 0;     // the scene drawn to depth alone
    double read_back_ns = 0;      // that depth copied to main memory; OpenGL ES has no way to
    double gpu_reduction_ns = 0;  // Z bounds of 16-pixel tiles, made of that depth by a shader and read back
    double upload_byte_ns = 0;    // one byte of the lists, of this scene in 8-pixel tiles
};

// Draws a view of a scene a few dozen times in an OpenGL context of its own, without a window. The glass is left out,
// and of the lights all but the first 10,000. Throws std::runtime_error with one line if there is no usable OpenGL.
//
// wanted_glsl  as for OffscreenContext
DrawTimes draw_times(const Scene& scene, const Camera& camera, int width, int height, int wanted_glsl);
