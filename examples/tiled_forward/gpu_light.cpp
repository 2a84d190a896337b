// SPDX-License-Identifier: MIT
#include "gpu_light.hpp"

#include <algorithm>
#include <cmath>

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

GpuBox gpu_box(const SceneBox& box, const glm::dmat4& world_to_view) {
    const glm::dmat3 half_axes = glm::dmat3(world_to_view) * glm::dmat3(box.half_axes);
    const glm::dvec3 centre(world_to_view * glm::dvec4(box.centre, 1));
    const glm::dmat3 rows = glm::transpose(glm::inverse(half_axes));
    GpuBox gpu{};
    for (int i = 0; i < 3; ++i)
        gpu.rows[i] = glm::vec4(glm::dvec4(rows[i], -glm::dot(rows[i], centre)));
    gpu.colour = glm::vec4(box.colour, static_cast<float>(box.kind));
    const double taper = static_cast<double>(box.taper), to_eye = taper < 1 ? (1 + taper) / (1 - taper) : 0;
    gpu.eye_taper = glm::vec4(glm::vec3(centre - to_eye * half_axes[2]), box.taper);
    return gpu;
}

// The box is made of the very floats that the shader reads, by the inverse of their matrix, and is enlarged by what the
// shader's rounding can add. Each coordinate in the box is a sum of four products; `size` is what their absolute values
// add up to at most. The rounding of the coordinate is below 4 * 2^-24 of `size`, and that of centre and half axes to
// floats, here, below 2 * 2^-24. The width of a frustum at the coordinate z is rounded by half of z's error and by
// 3 * 2^-24. Enlarging all half axes by a factor 1 + m widens a frustum by m / 2 at least, at every z, so m is
// 2 * (6 + 3) * 2^-24 of `size`, which is 1 or more, and 2 * 3 * 2^-24: together below 2^-19 of `size`.
lightbin::Box box_of(const GpuBox& box) {
    glm::dmat3 rows;
    glm::dvec3 offset;
    for (int i = 0; i < 3; ++i) {
        rows[i] = glm::dvec3(box.rows[i]);
        offset[i] = static_cast<double>(box.rows[i].w);
    }
    const glm::dmat3 half_axes = glm::inverse(glm::transpose(rows));
    const glm::dvec3 centre = half_axes * -offset;
    const glm::dvec3 farthest =
        glm::abs(centre) + glm::abs(half_axes[0]) + glm::abs(half_axes[1]) + glm::abs(half_axes[2]);
    double size = 0;
    for (int i = 0; i < 3; ++i)
        size = std::max(size, glm::dot(glm::abs(rows[i]), farthest) + std::abs(offset[i]));
    const glm::dmat3 large = (1 + 0x1p-19 * size) * half_axes;

    const double taper = static_cast<double>(box.eye_taper.w);
    if (taper == 1) return lightbin::oriented_box(centre, large[0], large[1], large[2]);
    const glm::dvec3 forward = 2 / (1 - taper) * large[2];
    return lightbin::projector_box(centre + large[2] - forward, forward, large[0], large[1], taper);
}

GpuLight entry_of(const GpuBox& box, std::size_t number) {
    const lightbin::Sphere sphere = bounding_sphere(box_of(box));
    return {{sphere.x, sphere.y, sphere.z, sphere.radius},
            {0, 0, 0, static_cast<float>(number + 1)},
            {0, 0, 0, 1}};
}
