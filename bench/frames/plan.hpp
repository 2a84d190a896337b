// SPDX-License-Identifier: MIT
// What is drawn: scenes, their cameras, and the techniques for each camera.
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
    std::vector<Light> lights = {};  ///< if not empty, they replace the scene's lights
};

/// Name of the table that compares lists and masks by number of lights.
inline constexpr const char* lists_and_masks = "lists and masks";

struct SceneJobs {
    Scene scene;
    std::vector<Job> jobs;
};

/// Returns the jobs of the generated scene and of the files; `quick` takes fewer views. Spots become points;
/// directional lights and orthographic cameras are left out. Throws std::runtime_error with one line if a file can't be
/// read.
std::vector<SceneJobs> make_plan(const std::vector<std::string>& files, bool quick);
