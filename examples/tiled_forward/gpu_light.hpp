// SPDX-License-Identifier: MIT
// A light as the shaders read it, and where they give its light.
#pragma once

#include "scene.hpp"

#include <lightbin/box.hpp>
#include <lightbin/spot.hpp>

#include <glm/glm.hpp>

#include <cstddef>

// In view space: three texels.
struct GpuLight {
    glm::vec4 sphere;  // centre, range; a sun: the way to it
    glm::vec4 colour;  // candela; a sun: lux. w: 0, or for the entry of a box its number, from 1 on
    glm::vec4 cone;    // angular falloff = (dot(cone.xyz, direction to the light) + cone.w) squared, in 0..1
};

// In view space: five texels.
struct GpuBox {
    glm::vec4 rows[3];    // dot(rows[i], vec4(point, 1)): -1 at one face of the box and 1 at the opposite one
    glm::vec4 colour;     // and the SceneBox::Kind
    glm::vec4 eye_taper;  // where a projector's rays meet, and the taper
};

// In world space: a little of its light, so that nothing is all black.
inline const glm::vec3 way_to_moon = glm::normalize(glm::vec3(0.3f, 0.8f, 0.5f));

GpuLight gpu_light(const Light& light, const glm::dmat4& world_to_view);

// Holds every point, but for how its own position is rounded, that the shader gives light to; a light without a cone is a
// whole sphere.
lightbin::Spot spot_of(const GpuLight& light);

GpuBox gpu_box(const SceneBox& box, const glm::dmat4& world_to_view);

// Holds every point, but for how its own position is rounded, that the shader finds in the box.
lightbin::Box box_of(const GpuBox& box);

// What the array of lights holds in the place of a box: a sphere around it, and its number, from 0 on.
GpuLight entry_of(const GpuBox& box, std::size_t number);
