// SPDX-License-Identifier: MIT
// What is drawn: scenes, the views of each, and the techniques for each view.
#pragma once

#include "settings.hpp"
#include "technique.hpp"

#include <scene.hpp>

#include <string>
#include <vector>

/// A view of a scene.
struct Job {
    std::string table;
    Camera camera;
    std::vector<Technique> techniques;
    Settings settings;
    std::vector<Light> lights = {};  ///< in place of the scene's, where there are any
};

/// The table of lists and masks by number of lights.
inline constexpr const char* lists_and_masks = "lists and masks";

struct SceneJobs {
    Scene scene;
    std::vector<Job> jobs;
};

/// Returns the made scene's views and those of the files', of some of them only if it is to be quick. Spot lights become
/// points, directional lights and orthographic views are left out. Throws
/// std::runtime_error with one line if a file can't be read.
std::vector<SceneJobs> make_plan(const std::vector<std::string>& files, bool quick);
