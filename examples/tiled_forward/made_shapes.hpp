// SPDX-License-Identifier: MIT
// What the made scenes are built of.
#pragma once

#include "dice.hpp"
#include "scene.hpp"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace made {

inline void add_quad(std::vector<Vertex>& triangles, const std::array<glm::vec3, 4>& corners,
                     glm::vec3 normal, glm::vec3 colour) {
    for (const std::size_t k : {0u, 1u, 2u, 0u, 2u, 3u})
        triangles.push_back({corners[k], normal, colour});
}

// The five sides of a block that can be seen.
inline void add_block(Scene& scene, glm::vec3 low, glm::vec3 high, glm::vec3 colour) {
    const float x0 = low.x, y0 = low.y, z0 = low.z, x1 = high.x, y1 = high.y, z1 = high.z;
    add_quad(scene.triangles, {{{x0, y1, z1}, {x1, y1, z1}, {x1, y1, z0}, {x0, y1, z0}}}, {0, 1, 0}, colour);
    add_quad(scene.triangles, {{{x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}}}, {0, 0, 1}, colour);
    add_quad(scene.triangles, {{{x1, y0, z0}, {x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0}}}, {0, 0, -1}, colour);
    add_quad(scene.triangles, {{{x1, y0, z1}, {x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}}}, {1, 0, 0}, colour);
    add_quad(scene.triangles, {{{x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}, {x0, y1, z0}}}, {-1, 0, 0}, colour);
}

// An upright pane of glass over the line from `a` to `b`.
inline void add_pane(Scene& scene, glm::vec3 a, glm::vec3 b, float height, glm::vec3 colour) {
    const glm::vec3 up(0, height, 0);
    add_quad(scene.transparent, {{a, b, b + up, a + up}}, glm::normalize(glm::cross(b - a, up)), colour);
}

inline void add_dome(Scene& scene, glm::vec3 centre, float radius, glm::vec3 colour) {
    constexpr int around = 32, up = 8;
    const auto point = [&](int i, int j) {
        const float a = glm::two_pi<float>() * static_cast<float>(i) / around;
        const float b = glm::half_pi<float>() * static_cast<float>(j) / up;
        return glm::vec3(std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b));
    };
    for (int j = 0; j < up; ++j)
        for (int i = 0; i < around; ++i) {
            const std::array<glm::vec3, 4> n{point(i, j), point(i + 1, j), point(i + 1, j + 1),
                                             point(i, j + 1)};
            for (const std::size_t k : {0u, 1u, 2u, 0u, 2u, 3u})
                scene.triangles.push_back({centre + radius * n[k], n[k], colour});
        }
}

inline glm::vec3 rainbow(float hue) {
    const auto channel = [&](float shift) {
        return 0.5f + 0.5f * std::cos(glm::two_pi<float>() * (hue + shift));
    };
    return {channel(0.0f), channel(0.667f), channel(0.333f)};
}

// A round sign painted on what is level, at this height and a little above and below.
inline void add_decal(Scene& scene, glm::vec3 middle, float radius, glm::vec3 colour) {
    const glm::mat3 half_axes(radius, 0, 0, 0, 0, -radius, 0, 0.3f, 0);
    scene.boxes.push_back({SceneBox::Kind::decal, colour, middle, half_axes});
}

// An upright box between two corners. Surfaces inside reflect the light of what is around.
inline void add_probe(Scene& scene, glm::vec3 low, glm::vec3 high, glm::vec3 lux) {
    const glm::vec3 half = (high - low) / 2.0f;
    const glm::mat3 half_axes(half.x, 0, 0, 0, 0, -half.z, 0, half.y, 0);
    scene.boxes.push_back({SceneBox::Kind::probe, lux, (low + high) / 2.0f, half_axes});
}

// A frustum whose far face has its middle at eye + forward, and this half width and half height. The first twentieth of
// the way from the eye is not lit.
inline void add_projector(Scene& scene, glm::vec3 eye, glm::vec3 forward, float half_width, float half_height,
                          glm::vec3 candela) {
    constexpr float begin = 0.05f;
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::normalize(glm::cross(right, forward));
    const glm::mat3 half_axes(half_width * right, half_height * up, (1 - begin) / 2 * forward);
    scene.boxes.push_back(
        {SceneBox::Kind::projector, candela, eye + (1 + begin) / 2 * forward, half_axes, begin});
}

inline Camera look(const char* name, glm::dvec3 from, glm::dvec3 to, double fov_degrees) {
    Camera camera;
    camera.name = name;
    camera.to_world = glm::inverse(glm::lookAt(from, to, glm::dvec3(0, 1, 0)));
    camera.height = glm::radians(fov_degrees);
    camera.near = 0.2;
    camera.far = 500;
    return camera;
}

}  // namespace made
