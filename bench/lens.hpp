// SPDX-License-Identifier: MIT
// What is timed: light sets that are met in turn, each seen through its own lens.
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

/// A symmetric perspective camera's lens and picture. As it stands, that of the field sets.
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

/// The slices of clusters and of z-bins, for lights that reach so far. As they stand, those of the field sets.
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

/// A set that is met again and again is learnt by the branch predictor: 48 sets or 50,000 lights, whichever
/// is more, as far as they stay small.
inline std::size_t rotation(std::size_t lights) {
    if (lights > 20000) return lights > 200000 ? 1 : 4;
    return std::max<std::size_t>(48, 50000 / std::max<std::size_t>(lights, 1));
}

/// What is met in turn of a set of so many lights: make(seed) of each seed.
template <class MakeFrame> auto frames_in_turn(std::size_t lights, MakeFrame make) {
    std::vector<decltype(make(std::uint32_t{}))> frames;
    for (std::uint32_t seed = 0; seed < rotation(lights); ++seed)
        frames.push_back(make(seed));
    return frames;
}

/// The lights of a .glb file from its cameras in turn, each moved and turned a little.
inline std::vector<Frame> scene_frames(const std::vector<BenchScene>& views, std::size_t lights) {
    return frames_in_turn(lights, [&](std::uint32_t seed) -> Frame {
        const BenchScene& view = views[seed % views.size()];
        const Frustum frustum(view.projection);
        return {{frustum.y, frustum.near_depth, frustum.far_depth}, view.lights(seed)};
    });
}

/// What the field sets' lights fall on, as Lens() sees it: ground 12 below the eye, boxes on it, a wall far
/// behind. Window depth.
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

/// Z bounds of the made depth buffer, which all field sets have in common.
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
