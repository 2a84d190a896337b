// SPDX-License-Identifier: MIT
// Random numbers for made scenes.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <random>

/// Random numbers that are the same on every platform, which those of the standard distributions need not be.
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
    /// Returns a number from middle / factor^1.5 to middle * factor^1.5, more often near `middle`: like a lognormal, but
    /// bounded.
    float about(float middle, float factor) {
        return middle * std::pow(factor, between(-1, 1) + between(-1, 1) / 2);
    }

private:
    std::mt19937 engine_;
};
