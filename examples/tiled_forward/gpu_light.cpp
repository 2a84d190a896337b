// SPDX-License-Identifier: MIT
#include "gpu_light.hpp"

#include <algorithm>

GpuLight gpu_light(const Light& light, const glm::dmat4& world_to_view) {
    GpuLight gpu{glm::vec4(glm::vec3(world_to_view * glm::dvec4(light.position, 1.0)), light.range),
                 glm::vec4(light.intensity, 0), glm::vec4(0, 0, 0, 1)};
    if (light.spot) {
        const glm::vec3 axis(glm::dmat3(world_to_view) * glm::dvec3(light.direction));
        const float scale = 1 / std::max(light.cos_inner - light.cos_outer, 0.001f);
        gpu.cone = glm::vec4(-scale * axis, -scale * light.cos_outer);
    }
    return gpu;
}

// The shader gives light where  dot(cone.xyz, direction) + cone.w  comes out above 0. The cone is made of the very
// floats that it reads, so that no rounding of angles counts: the axis is -cone.xyz, and the cosine -cone.w / |cone.xyz|.
// What remains is how the shader rounds, in units of 2^-24 |cone.xyz|: 1 for the difference to the light, 3 for its
// squared length, of which the root takes half, 4 for the root (GLSL grants two units of the last place), 1 for the unit
// vector, 3 for products and sums; and 1 for the cosine as a float. 2^-20 is 16. The last sum, with cone.w, is not
// rounded to the other side of 0.
lightbin::Spot spot_of(const GpuLight& light) {
    const glm::vec4& s = light.sphere;
    const glm::vec3 axis(-light.cone);
    if (axis == glm::vec3(0)) return lightbin::Spot::whole({s.x, s.y, s.z, s.w});
    const double cosine = -static_cast<double>(light.cone.w) / glm::length(glm::dvec3(axis)) - 0x1p-20;
    return {s.x, s.y, s.z, s.w, axis.x, axis.y, axis.z, static_cast<float>(std::clamp(cosine, -1.0, 1.0))};
}
