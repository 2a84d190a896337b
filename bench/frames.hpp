// SPDX-License-Identifier: MIT
// What is timed: light sets that are met in turn, each seen through its own lens.
#pragma once

#include "flat.hpp"
#include "sets.hpp"

#include <lightbin/view.hpp>

#include <scene.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

/// A symmetric perspective camera's lens and picture.
struct Lens {
    double tan_half_height = double(tan_half_fov), near_depth = 0.1, far_depth = 1000;
    lightbin::Extent screen = {1920, 1080};

    lightbin::View view(int tile_size) const {
        const double aspect_ratio = double(screen.width) / screen.height;
        const glm::dmat4 projection =
            glm::perspectiveRH_NO(2 * std::atan(tan_half_height), aspect_ratio, near_depth, far_depth);
        return *lightbin::View::from_projection(projection, screen, {.tile_size = tile_size});
    }

    FlatView flat_view(int tile_size) const {
        return {.tiles_x = (screen.width + tile_size - 1) / tile_size,
                .tiles_y = (screen.height + tile_size - 1) / tile_size,
                .width = double(screen.width) / tile_size,
                .height = double(screen.height) / tile_size,
                .scale = 0.5 * screen.height / tan_half_height / tile_size,
                .near_depth = near_depth,
                .far_depth = far_depth};
    }
};

struct Frame {
    Lens lens;
    Lights lights;  ///< in view space
};

/// A set that is met again and again is learnt by the branch predictor: 48 sets or 50,000 lights, whichever
/// is more, as far as they stay small.
inline std::size_t rotation(std::size_t lights) {
    if (lights > 20000) return lights > 200000 ? 1 : 4;
    return std::max<std::size_t>(48, 50000 / std::max<std::size_t>(lights, 1));
}

/// The lights of a scene from its cameras in turn, each moved and turned a little at random.
inline std::vector<Frame> scene_frames(const Scene& scene) {
    std::mt19937 random(2011);
    std::uniform_real_distribution<double> some(-1, 1);
    std::vector<float> ranges;
    for (const Light& light : scene.lights)
        ranges.push_back(light.range);
    std::nth_element(ranges.begin(), ranges.begin() + std::ptrdiff_t(ranges.size() / 2), ranges.end());
    const double step = 0.1 * double(ranges[ranges.size() / 2]);

    std::vector<Frame> frames;
    for (std::size_t i = 0; i < rotation(scene.lights.size()); ++i) {
        const Camera& camera = scene.cameras[i % scene.cameras.size()];
        if (camera.orthographic) continue;  // not for the baseline
        glm::dmat4 to_world =
            glm::translate(camera.to_world, step * glm::dvec3(some(random), some(random), some(random)));
        to_world = glm::rotate(to_world, 0.1 * some(random), glm::dvec3(0, 1, 0));
        to_world = glm::rotate(to_world, 0.1 * some(random), glm::dvec3(1, 0, 0));
        const glm::dmat4 to_view = glm::inverse(to_world);
        Frame frame = {{std::tan(camera.height / 2), camera.near, std::min(camera.far, 1e6)}, {}};
        for (const Light& light : scene.lights)
            frame.lights.emplace_back(glm::vec3(to_view * glm::dvec4(light.position, 1)), light.range);
        frames.push_back(std::move(frame));
    }
    return frames;
}

/// Window depth of every pixel of a made scene for the field sets: the ground 12 below the eye, blocks that
/// stand on it, a wall far behind.
inline std::vector<float> made_depth(const Lens& lens) {
    const int width = lens.screen.width, height = lens.screen.height;
    const double pixels = 0.5 * height / lens.tan_half_height, ground = -12, wall = 190;  // pixels at depth 1
    std::vector<double> depth(std::size_t(width) * std::size_t(height), wall);
    for (int y = 0; y < height / 2; ++y)
        for (int x = 0; x < width; ++x)
            depth[std::size_t(y * width + x)] = std::min(wall, ground * pixels / (y + 0.5 - 0.5 * height));

    // Faces straight on: a rectangle of one depth.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int block = 0; block < 80; ++block) {
        const double z = 15 + 170 * std::sqrt(unit(random)), x = (2 * unit(random) - 1) * z;
        const double half = 2 + 5 * unit(random), top = ground + 4 + 50 * unit(random) * unit(random);
        const auto pixel = [&](double c, int side) {
            return int(std::clamp(pixels * c / z + 0.5 * side, 0.0, double(side)));
        };
        for (int py = pixel(ground, height); py < pixel(top, height); ++py)
            for (int px = pixel(x - half, width); px < pixel(x + half, width); ++px) {
                double& nearest = depth[std::size_t(py * width + px)];
                nearest = std::min(nearest, z);
            }
    }

    const double n = lens.near_depth, f = lens.far_depth;
    std::vector<float> window_depth;
    for (const double z : depth)
        window_depth.push_back(float(f * (z - n) / (z * (f - n))));
    return window_depth;
}
