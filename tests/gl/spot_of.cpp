// SPDX-License-Identifier: MIT
// What the example bins a light or a box as holds every point that its shader changes. The light: the shader's falloff
// again, in floats and with the worst roots that GLSL allows, at points all around the cone's edge. The box: the shader's
// coordinates again, in floats, at points beside the faces.
#include "gpu_light.hpp"

#include <doctest/doctest.h>
#include <glm/gtc/random.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using glm::linearRand, glm::sphericalRand;  // the same numbers in each run

bool is_lit(const GpuLight& light, const glm::vec3& point, int ulps) {
    const glm::vec3 to_light = glm::vec3(light.sphere) - point;
    float root = static_cast<float>(
        1 / std::sqrt(static_cast<double>(std::max(glm::dot(to_light, to_light), 1e-20f))));
    for (int i = 0; i < std::abs(ulps); ++i)
        root = std::nextafter(root, ulps > 0 ? std::numeric_limits<float>::max() : 0.0f);
    return glm::dot(glm::vec3(light.cone), to_light * root) + light.cone.w > 0;
}

// Returns how much the cosine at the point exceeds the cosine of the spot's half angle.
double above(const lightbin::Spot& spot, const glm::vec3& point) {
    const glm::dvec3 way = glm::dvec3(point) - glm::dvec3(spot.x, spot.y, spot.z),
                     axis(spot.axis_x, spot.axis_y, spot.axis_z);
    return glm::dot(way, axis) / (glm::length(way) * glm::length(axis)) -
           static_cast<double>(spot.cos_half_angle);
}

// Returns whether the shader's function apply_box changes the point. GLSL may add up its products in any order.
bool is_changed(const GpuBox& box, const glm::vec3& point, bool backwards) {
    glm::vec3 place;
    for (int i = 0; i < 3; ++i) {
        const glm::vec4 product = box.rows[i] * glm::vec4(point, 1);
        place[i] = backwards ? product.w + product.z + product.y + product.x
                             : product.x + product.y + product.z + product.w;
    }
    const float taper = box.eye_taper.w, width = 0.5f * (1 + taper + place.z * (1 - taper));
    return std::abs(place.x) < width && std::abs(place.y) < width && std::abs(place.z) < 1;
}

// Returns a point's place between a box's middle (0) and its faces (1). `rows` are those of a GpuBox.
double outwards(const glm::dmat4& rows, double taper, const glm::vec3& point) {
    const glm::dvec3 place(glm::dvec4(glm::dvec3(point), 1) * rows);
    const double width = (1 + taper + place.z * (1 - taper)) / 2;
    return std::max({std::abs(place.z), std::abs(place.x) / width, std::abs(place.y) / width});
}

// The rows of a Box, from its contract.
glm::dmat4 rows_of(const lightbin::Box& box) {
    glm::dmat4 axes(1);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            axes[i][k] = static_cast<double>(box.half_axes[i][k]);
    axes[3] = {box.box_x, box.box_y, box.box_z, 1};
    return glm::transpose(glm::inverse(axes));
}

}  // namespace

TEST_CASE("every point that a box changes lies in what it is binned as") {
    int changed = 0, outside = 0, outside_without_margin = 0;
    for (int round = 0; round < 3000; ++round) {
        const glm::dvec3 z = sphericalRand(1.0), x = glm::normalize(glm::cross(z, sphericalRand(1.0))),
                         y = glm::cross(z, x);
        const double taper = round % 2 == 0 ? 1 : linearRand(0.02, 0.9);
        SceneBox scene_box;
        scene_box.centre = glm::vec3(linearRand(1.0, 100.0) * sphericalRand(1.0));
        scene_box.half_axes =
            glm::mat3(linearRand(0.1, 5.0) * x, linearRand(0.1, 5.0) * y, linearRand(0.1, 5.0) * z);
        scene_box.taper = static_cast<float>(taper);
        const GpuBox gpu = gpu_box(scene_box, glm::dmat4(1));
        const lightbin::Box box = box_of(gpu);
        const glm::dmat4 rows = rows_of(box);
        glm::dmat4 read(1);  // what the shader reads
        for (int i = 0; i < 3; ++i)
            read[i] = glm::dvec4(gpu.rows[i]);

        for (int i = 0; i < 100; ++i) {
            glm::dvec3 place = {linearRand(-1.0, 1.0), linearRand(-1.0, 1.0), linearRand(-1.0, 1.0)};
            place[i % 3] =
                (i % 2 == 0 ? 1 : -1) * (1 + linearRand(-1.0, 1.0) * std::pow(2, -linearRand(12.0, 24.0)));
            const double width = (1 + taper + place.z * (1 - taper)) / 2;
            const glm::vec3 point(glm::dvec3(scene_box.centre) +
                                  glm::dmat3(scene_box.half_axes) * (place * glm::dvec3(width, width, 1)));
            for (const bool backwards : {false, true}) {
                if (!is_changed(gpu, point, backwards)) continue;
                ++changed;
                const double apart = glm::length(glm::dvec3(point) - glm::dvec3(box.x, box.y, box.z));
                outside += outwards(rows, static_cast<double>(box.taper), point) > 1 ||
                           apart > static_cast<double>(box.radius);
                outside_without_margin += outwards(read, static_cast<double>(gpu.eye_taper.w), point) > 1;
            }
        }
    }
    CHECK(changed > 100000);
    CHECK(outside == 0);
    CHECK(outside_without_margin > 100);
}

TEST_CASE("every lit point lies in the spot") {
    int lit = 0, outside = 0, outside_without_margin = 0;
    for (int round = 0; round < 3000; ++round) {
        Light light;
        light.spot = true;
        light.position = glm::vec3(100.0 * sphericalRand(1.0));
        light.range = 50;
        light.direction = glm::vec3(sphericalRand(1.0));
        const double angle = round % 7 == 0 ? 0 : linearRand(0.0, round % 2 == 0 ? 0.1 : 1.5);
        light.cos_outer = static_cast<float>(std::cos(angle));
        light.cos_inner = static_cast<float>(std::cos(angle * linearRand(0.0, 1.0)));
        const GpuLight gpu = gpu_light(light, glm::dmat4(1));
        const lightbin::Spot spot = spot_of(gpu);
        CHECK(spot.cos_half_angle < light.cos_outer);
        CHECK(light.cos_outer - spot.cos_half_angle < 0x1p-19f);

        const glm::dvec3 axis(light.direction), aside = glm::normalize(glm::cross(axis, sphericalRand(1.0)));
        for (int i = 0; i < 100; ++i) {
            const double off = angle + linearRand(-1.0, 1.0) * std::pow(2, -linearRand(8.0, 24.0));
            const glm::vec3 point(glm::dvec3(light.position) +
                                  linearRand(0.1, 50.0) * (std::cos(off) * axis + std::sin(off) * aside));
            for (const int ulps : {-2, 0, 2}) {
                if (!is_lit(gpu, point, ulps)) continue;
                ++lit;
                outside += above(spot, point) < 0;
                outside_without_margin += above(spot, point) < 0x1p-20;
            }
        }
    }
    CHECK(lit > 100000);
    CHECK(outside == 0);
    CHECK(outside_without_margin > 100);
}

TEST_CASE("a light without a cone is a whole sphere, and so is one of 90 degrees") {
    Light light;
    light.position = {1, 2, -3};
    light.range = 4;
    CHECK(spot_of(gpu_light(light, glm::dmat4(1))).cos_half_angle == -1);
    light.spot = true;
    light.direction = {0, -1, 0};
    light.cos_outer = 0;
    const lightbin::Sphere sphere = bounding_sphere(spot_of(gpu_light(light, glm::dmat4(1))));
    CHECK(sphere.y == 2);
    CHECK(sphere.radius == 4);
}
