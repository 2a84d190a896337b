// SPDX-License-Identifier: MIT
// The generated light sets, for a camera 60 degrees high at 1920x1080, near 0.1, far 1000, looking down -z.
#pragma once

#include <glm/vec4.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

using Lights = std::vector<glm::vec4>;

inline constexpr float tan_half_fov = 0.57735027f, aspect = 16.0f / 9.0f;

/// Returns lights: 80 % uniform in the frustum's volume from depth 1 to 200, 20 % outside in a box of +-260 x +-160 x
/// -50..250; radii lognormal, sigma 0.5. The median radius sets how many tiles a light covers.
inline Lights field(std::size_t count, float median_radius, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1), side(-1, 1);
    std::lognormal_distribution<float> radius(std::log(median_radius), 0.5f);
    Lights lights(count);
    for (glm::vec4& light : lights) {
        float x, y, z;
        if (unit(random) < 0.8f) {
            z = std::cbrt(1 + (200.0f * 200.0f * 200.0f - 1) * unit(random));
            x = side(random) * z * tan_half_fov * aspect;
            y = side(random) * z * tan_half_fov;
        } else {
            do {
                x = 260 * side(random);
                y = 160 * side(random);
                z = -50 + 300 * unit(random);
            } while (z > 1 && z < 200 && std::fabs(y) < z * tan_half_fov &&
                     std::fabs(x) < z * tan_half_fov * aspect);
        }
        light = {x, y, -z, radius(random)};
    }
    return lights;
}

/// Median radii at which a light in view covers 4, 11, 20 and 200 tiles of 32 pixels on average, counted as a disc.
inline constexpr float field4_median = 1.72f, field11_median = 4.1f, field20_median = 6.1154f, field200_median = 27.9f;

/// Returns lights around the eye, which is inside many: z in -3..30, |x| <= 3 + 1.2 |z|, |y| <= 3 + 0.8 |z|, radii
/// lognormal with median 2 and sigma 0.7.
inline Lights near_eye(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> depth(-3, 30), side(-1, 1);
    std::lognormal_distribution<float> radius(std::log(2.0f), 0.7f);
    Lights lights(count);
    for (glm::vec4& light : lights) {
        const float z = depth(random), reach = std::fabs(z);
        light = {side(random) * (3 + 1.2f * reach), side(random) * (3 + 0.8f * reach), -z, radius(random)};
    }
    return lights;
}
