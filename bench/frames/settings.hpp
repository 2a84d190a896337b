// SPDX-License-Identifier: MIT
// What is wanted of a frame.
#pragma once

struct Settings {
    int width = 480, height = 270;
    int tile_size = 16;
    bool wide = true;    ///< G-buffers have 32 bits a component, not 16
    bool count = false;  ///< count light evaluations, which takes time
    float exposure = 1;
};
