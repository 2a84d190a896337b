// SPDX-License-Identifier: MIT
// A view's depth buffer without a graphics driver.
#pragma once

#include "scene.hpp"

#include <lightbin/view.hpp>

#include <glm/glm.hpp>

#include <vector>

struct CpuDepth {
    std::vector<float>
        depth;  // window depth of each pixel's centre, the lowest row first; 1 where nothing is drawn
    // Fragments that are nearer than all that was drawn before them, in the file's order, for each pixel that shows
    // something: what a renderer without a depth pre-pass shades. 1 where nothing is drawn.
    double overdraw = 1;
};

// Draws the opaque triangles, both sides, clipped at the near plane, where window depth is 0, and at the far plane.
CpuDepth draw_depth_on_cpu(const Scene& scene, const glm::dmat4& projection_times_view,
                           lightbin::ImageSize size);
