// SPDX-License-Identifier: MIT
// What the example bins a light as holds every point that its shader gives light to: the shader's falloff again, in
// floats and with the worst roots that GLSL allows, at points all around the cone's edge.
#include "gpu_light.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace {

class Dice {
public:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
    }
    glm::dvec3 direction() {
        glm::dvec3 v;
        do
            v = {between(-1, 1), between(-1, 1), between(-1, 1)};
        while (glm::length(v) < 0.1 || glm::length(v) > 1);
        return glm::normalize(v);
    }

private:
    std::mt19937 engine_{5};
};

bool is_lit(const GpuLight& light, const glm::vec3& point, int ulps) {
    const glm::vec3 to_light = glm::vec3(light.sphere) - point;
    float root = static_cast<float>(
        1 / std::sqrt(static_cast<double>(std::max(glm::dot(to_light, to_light), 1e-20f))));
    for (int i = 0; i < std::abs(ulps); ++i)
        root = std::nextafter(root, ulps > 0 ? std::numeric_limits<float>::max() : 0.0f);
    return glm::dot(glm::vec3(light.cone), to_light * root) + light.cone.w > 0;
}

// By how much the cosine at the point is above the spot's.
double above(const lightbin::Spot& spot, const glm::vec3& point) {
    const glm::dvec3 way = glm::dvec3(point) - glm::dvec3(spot.x, spot.y, spot.z),
                     axis(spot.axis_x, spot.axis_y, spot.axis_z);
    return glm::dot(way, axis) / (glm::length(way) * glm::length(axis)) -
           static_cast<double>(spot.cos_half_angle);
}

}  // namespace

TEST_CASE("every lit point lies in the spot") {
    Dice dice;
    int lit = 0, outside = 0, outside_without_margin = 0;
    for (int round = 0; round < 3000; ++round) {
        Light light;
        light.spot = true;
        light.position = glm::vec3(100.0 * dice.direction());
        light.range = 50;
        light.direction = glm::vec3(dice.direction());
        const double angle = round % 7 == 0 ? 0 : dice.between(0, round % 2 == 0 ? 0.1 : 1.5);
        light.cos_outer = static_cast<float>(std::cos(angle));
        light.cos_inner = static_cast<float>(std::cos(angle * dice.between(0, 1)));
        const GpuLight gpu = gpu_light(light, glm::dmat4(1));
        const lightbin::Spot spot = spot_of(gpu);
        CHECK(spot.cos_half_angle < light.cos_outer);
        CHECK(light.cos_outer - spot.cos_half_angle < 0x1p-19f);

        const glm::dvec3 axis(light.direction), aside = glm::normalize(glm::cross(axis, dice.direction()));
        for (int i = 0; i < 100; ++i) {
            const double off = angle + dice.between(-1, 1) * std::pow(2, -dice.between(8, 24));
            const glm::vec3 point(glm::dvec3(light.position) +
                                  dice.between(0.1, 50) * (std::cos(off) * axis + std::sin(off) * aside));
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
    const lightbin::Sphere sphere = spot_of(gpu_light(light, glm::dmat4(1)));
    CHECK(sphere.y == 2);
    CHECK(sphere.radius == 4);
}
