// SPDX-License-Identifier: MIT
// Lights that move a little, for a window to show that the lists are made anew for each frame.
#pragma once

#include "scene.hpp"

#include <span>

// The farthest that a light gets from its place, as a part of its range.
constexpr double light_leeway = 0.125;

// Writes where the lights at these places are some seconds later: each on a level circle through its place,
// with a start and a speed of its own. A light without an end stays: its range says nothing of the scene's
// size.
void move_lights(std::span<const Light> places, double seconds, std::span<Light> lights);
