// SPDX-License-Identifier: MIT
// What a scene does not need: every part of binning, weighed on the scene and on this machine.
#pragma once

#include "scene.hpp"

#include <string>

struct AdviseSettings {
    int width = 1280, height = 720;
    int glsl = 0;   // as for OffscreenContext
    int view = -1;  // which camera; -1: the one whose pixels have the longest lists
};

// Measures, and returns what was found as a page of text of at most 40 lines of 100 columns, which ends with the lines of
// C++ that do as is advised. Needs no OpenGL: without one it says what it assumes in place of what it would have measured.
// Throws std::runtime_error with one line of text.
std::string advise_scene(const Scene& scene, const AdviseSettings& settings);
