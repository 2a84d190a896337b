// SPDX-License-Identifier: MIT
// Scenes, and the cameras that see them.
#pragma once

#include <scene.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// Returns a camera, 90 degrees high, that looks straight down from under the highest ceiling over one of the places,
/// so that no roof hides the floor. If most places have no ceiling, it looks from above all lights.
Camera camera_from_above(const Scene& scene, const std::vector<Camera>& places);

/// Returns a camera flight over the roofs of the generated scene and down into its streets.
std::vector<Camera> made_flight(std::size_t views);

/// Returns the scene with `count` random lights of one range in place of its own, in the space of its triangles. The
/// lights are the same every time, and fewer lights are the first of many.
Scene with_random_lights(Scene scene, std::size_t count);

/// Returns eleven lights, 3.2 times as far-reaching as the scene's: in Tiled Shading, the many have a range of 12.5, and
/// the few, one a robot, of 40. Each stands where one of the scene's does, evenly spread over their order; `time`, from 0 to
/// 1, takes each through its eleventh of that order, and so along a path if the lights are in the order of paths.
std::vector<Light> few_lights(const std::vector<Light>& lights, double time = 0);

/// Returns the number at the end of a camera's name, which in a path is the frame; -1 if there is none.
int frame_of(const std::string& name);
