// SPDX-License-Identifier: MIT
// The synthetic sets of spots, seen by the camera of sets.hpp, and spheres whose lists are as long.
#pragma once

#include "dice.hpp"
#include "lens.hpp"
#include "sets.hpp"

#include <lightbin/spot.hpp>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Any direction, each as likely as another.
inline glm::vec3 any_direction(Dice& dice) {
    for (;;) {
        const glm::vec3 v = dice.between(glm::vec3(-1), glm::vec3(1));
        const float length = glm::length(v);
        if (length > 0.01f && length <= 1) return v / length;
    }
}

/// A spot in a sphere of its range.
inline lightbin::Spot spot_in(const glm::vec4& sphere, Dice& dice, float half_angle_in_degrees) {
    const glm::vec3 axis = any_direction(dice);
    return {sphere.x, sphere.y, sphere.z, sphere.w,
            axis.x,   axis.y,   axis.z,   std::cos(glm::radians(half_angle_in_degrees))};
}

/// The field's spheres as ranges of spots: any direction, half angles of 10 to 80 degrees.
inline Spots spot_field(std::size_t count, float median_range, std::uint32_t seed) {
    Dice dice(seed);
    Spots spots;
    for (const glm::vec4& sphere : field(count, median_range, seed))
        spots.push_back(spot_in(sphere, dice, dice.between(10, 80)));
    return spots;
}

/// Medians at which a spot in view meets 4 and 20 tiles of 32 pixels in the mean.
inline constexpr float spots4_median = 2.95f, spots20_median = 10.3f;

/// Spots of one half angle, of sides .05 to .25 of their depth, with apexes in view.
inline Spots spots_of_angle(std::size_t count, float half_angle_in_degrees, std::uint32_t seed) {
    Dice dice(seed);
    Spots spots;
    while (spots.size() < count) {
        const float depth = 5 * std::pow(30.0f, dice.between(0, 1)),
                    x = dice.between(-1, 1) * tan_half_fov * aspect, y = dice.between(-1, 1) * tan_half_fov;
        const float range = dice.between(0.05f, 0.25f) * depth;
        spots.push_back(spot_in({x * depth, y * depth, -depth, range}, dice, half_angle_in_degrees));
    }
    return spots;
}

struct SpotFrame {
    Spots lights;
    Lights spheres;  ///< around the same centres
};

/// Frames of a set of spots, met in turn. The spheres are scaled until they make as many entries as the spots:
/// entries(lights) of each.
template <class Entries>
std::vector<SpotFrame> matched_frames(std::size_t count, float median_range, Entries entries) {
    std::vector<SpotFrame> frames = frames_in_turn(count, [&](std::uint32_t seed) {
        return SpotFrame{spot_field(count, median_range, seed), field(count, median_range, seed)};
    });
    std::size_t wanted = 0;
    for (const SpotFrame& frame : frames)
        wanted += entries(frame.lights);
    double low = 0.01, high = 4;
    for (int step = 0; step < 20; ++step) {
        const double scale = std::sqrt(low * high);
        std::size_t made = 0;
        for (SpotFrame& frame : frames) {
            for (std::size_t i = 0; i < count; ++i)
                frame.spheres[i].w = float(scale) * frame.lights[i].radius;
            made += entries(frame.spheres);
        }
        if (std::abs(double(made) - double(wanted)) < 0.005 * double(wanted)) break;
        (made < wanted ? low : high) = scale;
    }
    return frames;
}
