// SPDX-License-Identifier: MIT
// Generated sets of spots for the camera of sets.hpp, and lights of simpler kinds whose lists are as long.
#pragma once

#include "lens.hpp"
#include "sets.hpp"

#include <dice.hpp>

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

/// Returns spots with the spheres of field() in sets.hpp, random directions, half angles of 10 to 80 degrees.
inline Spots spot_field(std::size_t count, float median_range, std::uint32_t seed) {
    Dice dice(seed);
    Spots spots;
    for (const glm::vec4& sphere : field(count, median_range, seed))
        spots.push_back(spot_in(sphere, dice, dice.between(10, 80)));
    return spots;
}

/// Median ranges at which a spot in view meets 4 and 20 tiles of 32 pixels on average.
inline constexpr float spots4_median = 2.95f, spots20_median = 10.3f;

/// Returns spots of one half angle with lengths of 0.05 to 0.25 of their depth and apexes in view.
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

/// The spots or boxes of a frame, and simpler kinds of lights around the same centres.
template <class Light> struct KindFrame {
    std::vector<Light> lights;
    Lights spheres;
    Spots spots = {};  ///< only if the lights are boxes
};
using SpotFrame = KindFrame<lightbin::Spot>;

inline float& radius_of(glm::vec4& sphere) {
    return sphere.w;
}
inline float& radius_of(lightbin::Spot& spot) {
    return spot.radius;
}

/// Scales the radii of the frames' simpler lights `others` until their lists have as many entries as those of the
/// frames' own lights. entries(lights) counts them.
template <class Light, class Others, class Entries>
void match_entries(std::vector<KindFrame<Light>>& frames, Others KindFrame<Light>::*others, Entries entries) {
    std::size_t wanted = 0;
    for (const KindFrame<Light>& frame : frames)
        wanted += entries(frame.lights);
    double low = 0.01, high = 16, last = 1;
    for (int step = 0; step < 20; ++step) {
        const double scale = std::sqrt(low * high);
        std::size_t made = 0;
        for (KindFrame<Light>& frame : frames) {
            for (auto& light : frame.*others)
                radius_of(light) *= float(scale / last);
            made += entries(frame.*others);
        }
        last = scale;
        if (std::abs(double(made) - double(wanted)) < 0.005 * double(wanted)) break;
        (made < wanted ? low : high) = scale;
    }
}

/// Scales the frames' spheres, and spots if they have any, until they make as many entries as the lights.
template <class Light, class Entries>
std::vector<KindFrame<Light>> matched_frames(std::vector<KindFrame<Light>> frames, Entries entries) {
    match_entries(frames, &KindFrame<Light>::spheres, entries);
    if (!frames[0].spots.empty()) match_entries(frames, &KindFrame<Light>::spots, entries);
    return frames;
}
