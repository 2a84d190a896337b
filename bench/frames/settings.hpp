// SPDX-License-Identifier: MIT
// What is wanted of a frame.
#pragma once

struct Settings {
    int width = 480, height = 270;
    int tile_size = 16;
    bool wide = true;    ///< G-buffers have 32 bits for each component, not 16
    bool count = false;  ///< shaders count light evaluations, which slows them down
    float exposure = 1;
};
