// SPDX-License-Identifier: MIT
// Generated boxes of several shapes, and sets of them in front of the camera of sets.hpp.
#pragma once

#include "spots_sets.hpp"

#include <dice.hpp>

#include <lightbin/box.hpp>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

using Boxes = std::vector<lightbin::Box>;

/// Makes boxes of one shape around a centre. `size` is their longest half axis or radius (for rooms a quarter of it);
/// the columns of `frame` are the directions of their axes.
struct BoxFamily {
    const char* name;
    lightbin::Box (*one)(const glm::vec3& middle, float size, const glm::mat3& frame, Dice& dice);
};

inline lightbin::Box whole_box_of(const glm::vec3& middle, const glm::mat3& frame, float x, float y,
                                  float z) {
    return lightbin::oriented_box(middle, frame[0] * x, frame[1] * y, frame[2] * z);
}

inline const std::vector<BoxFamily>& box_families() {
    using glm::mat3, glm::vec3, lightbin::Box, lightbin::Sphere;
    static const std::vector<BoxFamily> families = {
        {"decal 4:4:1",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s / 4); }},
        {"card 32:32:1",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s / 32); }},
        {"card 1:1:0",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, 0); }},
        {"cube", [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s); }},
        {"rod 8:1:1",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s / 8, s / 8); }},
        {"room",
         [](const vec3& c, float s, const mat3&, Dice& dice) {
             const float turn = dice.between(0, 6.2831853f), x = std::cos(turn), z = std::sin(turn);
             return whole_box_of(c, {{x, 0, z}, {0, 1, 0}, {-z, 0, x}}, 4 * s, 1.6f * s, 3 * s);
         }},
        {"half ball",
         [](const vec3& c, float s, const mat3& f, Dice&) {
             return half_sphere(Sphere{c.x, c.y, c.z, s}, f[0]);
         }},
        {"ball in a room",
         [](const vec3& c, float s, const mat3& f, Dice& dice) {
             const vec3 half =
                 s * vec3(dice.between(0.3f, 1.2f), dice.between(0.2f, 0.6f), dice.between(0.3f, 1.2f));
             const vec3 off = half * dice.between(vec3(-0.9f), vec3(0.9f));
             return clipped_sphere(Sphere{c.x, c.y, c.z, s},
                                   whole_box_of(c + f * off, f, half.x, half.y, half.z));
         }},
        {"projector",
         [](const vec3& c, float s, const mat3& f, Dice&) {
             return lightbin::projector_box(c, f[2] * (2 * s), f[0] * (0.72794f * s), f[1] * (0.42511f * s),
                                            0.05);
         }},
        {"tube 4:1", [](const vec3& c, float s, const mat3& f, Dice&) {
             return lightbin::tube_box(c - f[0] * (2 * s / 3), c + f[0] * (2 * s / 3), s / 3);
         }}};
    return families;
}

/// Returns a box of a shape with the centre and the size of a sphere, turned in a random direction.
inline lightbin::Box box_in(const glm::vec4& sphere, const BoxFamily& family, Dice& dice) {
    const glm::vec3 first = any_direction(dice),
                    second = glm::normalize(glm::cross(first, any_direction(dice)));
    return family.one(glm::vec3(sphere), sphere.w, {first, second, glm::cross(first, second)}, dice);
}

/// The shapes that box_field() makes timed sets of: boxes from cubes to cards and rods, and spheres cut by a box.
inline std::span<const BoxFamily> timed_boxes() {
    return std::span(box_families()).first(5);
}
inline std::span<const BoxFamily> timed_clipped() {
    return std::span(box_families()).subspan(6, 2);
}

/// Returns boxes with the centres and sizes of the spheres of field() in sets.hpp, the shapes taking turns.
inline Boxes box_field(std::size_t count, float median_size, std::uint32_t seed,
                       std::span<const BoxFamily> families) {
    Dice dice(seed);
    Boxes boxes;
    for (const glm::vec4& sphere : field(count, median_size, seed))
        boxes.push_back(box_in(sphere, families[boxes.size() % families.size()], dice));
    return boxes;
}

/// Median sizes at which a box, or a sphere cut by a box, covers 20 tiles of 32 pixels on average if it is in view.
inline constexpr float boxes20_median = 6.1f, clipped20_median = 7.5f;
