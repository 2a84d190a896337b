// SPDX-License-Identifier: MIT
// A light as the shaders read it, and where they give its light.
#pragma once

#include "scene.hpp"

#include <lightbin/spot.hpp>

#include <glm/glm.hpp>

// In view space: three texels.
struct GpuLight {
    glm::vec4 sphere;  // centre, range; a sun: the way to it
    glm::vec4 colour;  // candela; a sun: lux
    glm::vec4 cone;    // angular falloff = (dot(cone.xyz, direction to the light) + cone.w) squared, in 0..1
};

// In world space: a little of its light, so that nothing is all black.
inline const glm::vec3 way_to_moon = glm::normalize(glm::vec3(0.3f, 0.8f, 0.5f));

GpuLight gpu_light(const Light& light, const glm::dmat4& world_to_view);

// Holds every point, but for how its own position is rounded, that the shader gives light to; a light without a cone is a
// whole sphere.
lightbin::Spot spot_of(const GpuLight& light);
