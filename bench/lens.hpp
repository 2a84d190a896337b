// SPDX-License-Identifier: MIT
// What is timed: frames with different lights, built in turns, each seen by a camera of its own.
#pragma once

#include "flat.hpp"
#include "raster.hpp"
#include "scenes.hpp"
#include "sets.hpp"

#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The lens of a symmetric perspective camera, and the size of its picture. The defaults are those of sets.hpp.
struct Lens {
    double tan_half_height = double(tan_half_fov), near_depth = 0.1, far_depth = 1000;
    lightbin::ImageSize screen = {1920, 1080};

    bool same(const Lens& other) const {
        return tan_half_height == other.tan_half_height && near_depth == other.near_depth &&
               far_depth == other.far_depth && screen.width == other.screen.width &&
               screen.height == other.screen.height;
    }

    glm::dmat4 projection() const {
        const double aspect_ratio = double(screen.width) / screen.height;
        return glm::perspectiveRH_NO(2 * std::atan(tan_half_height), aspect_ratio, near_depth, far_depth);
    }

    lightbin::View view(int tile_size) const {
        return *lightbin::View::from_projection(projection(), screen, {.tile_size = tile_size});
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

/// Returns depth slices for clusters and z-bins, up to the depth `reach`. The default fits the lights of sets.hpp.
inline lightbin::Slices cluster_slices(float reach = 200) {
    return *lightbin::Slices::exponential(24, reach / 40, reach);
}
inline lightbin::Slices z_bin_slices(float reach = 200) {
    return *lightbin::Slices::linear(1024, 0, reach);
}

struct Frame {
    Lens lens;
    Lights lights;  ///< in view space
};

/// Returns how many different frames take turns, so that the branch predictor does not learn the lights: 48, or more if
/// they have fewer than 50,000 lights together.
inline std::size_t rotation(std::size_t lights) {
    if (lights > 20000) return lights > 200000 ? 1 : 4;
    return std::max<std::size_t>(48, 50000 / std::max<std::size_t>(lights, 1));
}

/// Returns the frames that take turns if each has this many lights: make(seed) for each seed.
template <class MakeFrame> auto frames_in_turn(std::size_t lights, MakeFrame make) {
    std::vector<decltype(make(std::uint32_t{}))> frames;
    for (std::uint32_t seed = 0; seed < rotation(lights); ++seed)
        frames.push_back(make(seed));
    return frames;
}

/// Returns frames with the lights of a .glb file, seen by its cameras in turn, each moved and turned a little.
inline std::vector<Frame> scene_frames(const std::vector<BenchScene>& views, std::size_t lights) {
    return frames_in_turn(lights, [&](std::uint32_t seed) -> Frame {
        const BenchScene& view = views[seed % views.size()];
        const Frustum frustum(view.projection);
        return {{frustum.y, frustum.near_depth, frustum.far_depth}, view.lights(seed)};
    });
}

/// Returns a depth buffer for the generated lights: ground 12 below the eye, boxes on it, a wall far behind.
inline std::vector<float> made_depth() {
    SceneBuilder world({0, 12, 0}, {0, 12, -1});
    world.quad({-500, 0, -190}, {1000, 0, 0}, {0, 500, 0});
    Dice dice(7);
    for (int i = 0; i < 60; ++i) {
        const float z = -190 * std::sqrt(dice.between(0.02f, 0.9f));
        const glm::vec3 at = dice.between({z, 0, z}, {-z, 0, z});
        world.box(at, at + dice.between({3, 3, 3}, {10, 25, 10}));
    }
    return rasterise(std::move(world).scene("", 0, [](Dice&, std::size_t) { return glm::vec4(); }),
                     Lens().screen)
        .depth;
}

/// Each tile's least and greatest depth in the depth buffer of made_depth(), the same for all generated lights.
struct MadeBounds {
    std::vector<float> min, max;
    lightbin::ZBounds bounds;

    explicit MadeBounds(int tile_size) {
        static const std::vector<float> depth = made_depth();
        const lightbin::View view = Lens().view(tile_size);
        for (auto* side : {&min, &max})
            side->resize(view.tile_count());
        bounds = *lightbin::reduce_depth(view, {.depth = depth}, {min, max});
    }
};
