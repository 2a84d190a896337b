// SPDX-License-Identifier: MIT
// What the two deferred techniques that draw one light after another have in common.
#pragma once

#include "passes.hpp"

/// Binds the sum of light with the ambient light in it, and blending that adds. `test_depth`: 0, or a target with the same
/// depths, which is not the one that surfaces are read from: a target can't be both.
void begin_radiance(Stage& stage, GLuint surface_depth, GLuint test_depth);
void show_radiance(Stage& stage);
