// SPDX-License-Identifier: MIT
// Deferred shading in one compute kernel: a group of threads a tile, and a thread a pixel.
#pragma once

#include "shading.hpp"
#include "stage.hpp"

#include <epoxy/gl.h>

#include <functional>
#include <string>

/// Fills the G-buffer and lights it. The group finds between which depths the tile's surfaces lie, calls `list_lights`, and
/// then each thread lights its pixel by what that has listed.
///   lookup       declares the list in shared memory, and how it is gone through
///   list_lights  defines void clear_list(uint thread) and void list_lights(uint thread, uvec2 tile, float z_min, float
///                z_max), in which all threads of the group take part. It has the constants TILE, pixels a side, THREADS, and
///                LIGHTS, how many are in the scene
///   set          binds what list_lights reads to the program
/// Throws std::runtime_error if this OpenGL has fewer threads than a tile has pixels.
void shade_in_one_kernel(Stage& stage, const LightLookup& lookup, const std::string& list_lights,
                         const std::function<void(GLuint program)>& set);
