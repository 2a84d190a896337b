// SPDX-License-Identifier: MIT
// What is wanted of a frame.
#pragma once

struct Settings {
    int width = 480, height = 270;
    int tile_size = 16;
    int samples = 1;             ///< a pixel
    bool wide = true;            ///< G-buffers have 32 bits a component, not 16
    bool transparent = false;    ///< draw the scene's panes, too
    bool three_shaders = false;  ///< objects have one of three materials, each with a shader of its own
    bool count = false;          ///< count light evaluations, which takes time
    float exposure = 1;
};
