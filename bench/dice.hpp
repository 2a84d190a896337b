// SPDX-License-Identifier: MIT
// Random numbers for made scenes.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <random>

/// The same numbers everywhere, which the standard distributions do not promise.
class Dice {
public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8) / 16777216.0f;
    }
    glm::vec3 between(glm::vec3 low, glm::vec3 high) {
        const float x = between(low.x, high.x), y = between(low.y, high.y);
        return {x, y, between(low.z, high.z)};
    }
    /// Spread by a factor either way, small ones more often: the shape of a lognormal, with bounds.
    float about(float middle, float factor) {
        return middle * std::pow(factor, between(-1, 1) + between(-1, 1) / 2);
    }

private:
    std::mt19937 engine_;
};
