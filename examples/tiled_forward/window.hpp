// SPDX-License-Identifier: MIT
// A window with a free camera.
#pragma once

#include "renderer.hpp"

// Opens a window and draws the scene in it, its lights moving, until it is closed. Does nothing where there
// is no display. Throws std::runtime_error if there is a display without a usable OpenGL.
void show_in_window(Scene scene, int wanted_glsl, int view, FrameSettings settings, float exposure_stops,
                    bool heat_map);
