// SPDX-License-Identifier: MIT
// Lights as programs store them: in world space, as vec4s or in structs of the program's own.
#pragma once

#include "lens.hpp"
#include "scenes.hpp"
#include "sets.hpp"

#include <lightbin/lights.hpp>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// A struct of a program's own with a light: 64 bytes, of which binning needs 16.
struct UserLight {
    glm::vec3 position;
    glm::vec3 colour;
    float intensity;
    float radius;
    glm::vec3 direction;
    float inner_cosine, outer_cosine;
    std::uint32_t flags, layers;
    std::int32_t shadow_map;
};
static_assert(sizeof(UserLight) == 64);

/// A lambda, as users write it: a function passed by its address would be called instead of inlined.
inline constexpr auto sphere_of = [](const UserLight& light) -> lightbin::Sphere {
    return {light.position.x, light.position.y, light.position.z, light.radius};
};

inline std::vector<UserLight> structs_of(const Lights& lights) {
    std::vector<UserLight> structs(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        structs[i].position = glm::vec3(lights[i]);
        structs[i].radius = lights[i].w;
    }
    return structs;
}

/// The same lights in view space and in world space. Each frame has its own arrays, so that none is in the cache more
/// often than another.
struct WorldFrame {
    Frame view;  ///< the lights in view space, rounded to float
    glm::mat4 view_matrix;
    Lights lights;
    std::vector<UserLight> view_structs, structs;  ///< in view and in world space; may be empty
};

inline WorldFrame world_frame(const Lens& lens, const glm::mat4& view_matrix, Lights lights) {
    WorldFrame frame = {{lens, lights}, view_matrix, std::move(lights), {}, {}};
    for (glm::vec4& light : frame.view.lights)
        light = {glm::vec3(glm::dmat4(view_matrix) * glm::dvec4(glm::dvec3(light), 1)), light.w};
    return frame;
}

/// Sets of a field's lights, each seen by a camera of its own, some hundreds of units from the origin. Eight of 10,000
/// are as many as the branch predictor takes for 48 (it begins to learn five), in 13 MB for all forms of them: more
/// would time the memory, not the build.
inline std::vector<WorldFrame> world_frames(std::size_t count, float median_radius) {
    std::vector<WorldFrame> frames;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        Dice dice(seed);
        const glm::vec3 eye = dice.between({-500, 20, -500}, {500, 200, 500});
        const float turn = dice.between(0, 6.28f), pitch = dice.between(-0.5f, 0.5f);
        const glm::mat4 view_matrix =
            glm::lookAt(eye, eye + glm::vec3(std::sin(turn), pitch, std::cos(turn)), glm::vec3(0, 1, 0));
        const glm::dmat4 to_world = glm::inverse(glm::dmat4(view_matrix));
        Lights lights = field(count, median_radius, seed);
        for (glm::vec4& light : lights)
            light = {glm::vec3(to_world * glm::dvec4(glm::dvec3(light), 1)), light.w};
        frames.push_back(world_frame({}, view_matrix, lights));
        frames.back().view_structs = structs_of(frames.back().view.lights);
        frames.back().structs = structs_of(lights);
    }
    return frames;
}

/// Returns frames of Bevy's stress test many_lights: 100,000 small lights on a sphere around the eye, which turns by
/// 0.15 radians a second at 60 frames a second.
inline std::vector<WorldFrame> many_lights_frames() {
    constexpr std::size_t count = 100000;
    const double golden_ratio = (1 + std::sqrt(5.0)) / 2, pi = std::acos(-1.0);
    Lights lights(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = 2 * pi * double(i) / golden_ratio,
                     cosine = 1 - 2 * (double(i) + 0.36) / (double(count) - 0.28),
                     sine = std::sqrt(1 - cosine * cosine);
        lights[i] = {glm::vec3(glm::dvec3(std::cos(angle) * sine, std::sin(angle) * sine, cosine) * 50.0),
                     0.3f};
    }
    Lens lens;
    lens.tan_half_height = std::tan(pi / 8);
    std::vector<WorldFrame> frames;
    for (std::size_t i = 0; i < rotation(count); ++i)
        frames.push_back(
            world_frame(lens, glm::rotate(glm::mat4(1), float(i) * 0.15f / 60, glm::vec3(0, 1, 0)), lights));
    return frames;
}
