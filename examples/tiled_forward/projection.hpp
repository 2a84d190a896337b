// SPDX-License-Identifier: MIT
// What a camera makes of view space.
#pragma once

#include "scene.hpp"

#include <lightbin/view.hpp>

// `aspect`: width / height of the picture.
glm::mat4 projection_of(const Camera& camera, double aspect,
                        lightbin::ClipDepth clip_depth = lightbin::ClipDepth::minus_one_to_one);
