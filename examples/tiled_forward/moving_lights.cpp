// SPDX-License-Identifier: MIT
#include "moving_lights.hpp"

#include <cmath>
#include <cstddef>

void move_lights(std::span<const Light> places, double seconds, std::span<Light> lights) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double range = static_cast<double>(places[i].range);
        const double radius = std::isfinite(range) ? light_leeway / 2 * range : 0;
        // Multiples of the golden ratio: no two lights in step, and their speeds evenly spread.
        const double spread = static_cast<double>(i) * 0.6180339887498949;
        const double start = 6.283185307179586 * spread;
        const double now = start + (0.4 + spread - std::floor(spread)) * seconds;  // radians
        const glm::dvec3 way(std::cos(now) - std::cos(start), 0, std::sin(now) - std::sin(start));
        lights[i].position = glm::vec3(glm::dvec3(places[i].position) + radius * way);
    }
}
