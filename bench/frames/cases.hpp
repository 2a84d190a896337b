// SPDX-License-Identifier: MIT
// Scenes and the places they are seen from.
#pragma once

#include <scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// Returns a camera that looks straight down: from under the ceiling over one of the places, the highest over its floor, so
/// that no roof is between it and what is lit; 90 degrees high. If most places have no ceiling, from above all lights.
Camera camera_from_above(const Scene& scene, const std::vector<Camera>& places);

/// Returns a flight over the made scene's roofs and down into its streets.
std::vector<Camera> made_flight(std::size_t views);

/// Returns the scene with other lights: so many of one range anywhere in its space, where triangles are; the same every
/// time, and of fewer the first ones.
Scene with_random_lights(Scene scene, std::size_t count);

/// Returns eleven lights, 3.2 times as far-reaching as the scene's: in Tiled Shading, the many have a range of 12.5, and
/// the few, one a robot, of 40. Each stands where one of the scene's does, evenly spread over their order; `time`, from 0 to
/// 1, takes each through its eleventh of that order, and so along a path if the lights are in the order of paths.
std::vector<Light> few_lights(const std::vector<Light>& lights, double time = 0);

/// Returns the number that a camera's name ends in, or -1: of a path, the frame.
int frame_of(const std::string& name);
