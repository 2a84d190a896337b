// SPDX-License-Identifier: MIT
// A scene's view, ready to be binned.
#pragma once

#include "lens.hpp"
#include "measure.hpp"
#include "raster.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

inline constexpr lightbin::ImageSize screen = {1920, 1080};

struct SeenScene {
    BenchScene scene;
    Picture picture;
};

inline SeenScene see(BenchScene scene) {
    Picture picture = rasterise(scene, screen);
    return {std::move(scene), std::move(picture)};
}

/// A view of a scene with its tiles: each tile's least and greatest depth, and how many of its pixels are drawn.
struct TiledView {
    lightbin::View view;
    FlatView flat;
    std::vector<float> min, max;
    std::vector<std::uint32_t> drawn;  ///< number of drawn pixels in each tile
    std::uint64_t all_drawn = 0;
    double reduce_seconds = 0;          ///< seconds to find each tile's least and greatest depth
    lightbin::Slices clusters, z_bins;  ///< slices up to where the lights reach

    TiledView(const BenchScene& scene, const Picture& picture, int tile_size)
        : view(*lightbin::View::from_projection(scene.projection, picture.size, {.tile_size = tile_size})),
          flat(lens_of(Frustum(scene.projection), picture.size).flat_view(tile_size)), min(view.tile_count()),
          max(min), drawn(view.tile_count()),
          clusters(cluster_slices(reach_of(scene))), z_bins(z_bin_slices(reach_of(scene))) {
        std::vector<double> times;
        for (int turn = 0; turn < 5; ++turn)
            times.push_back(reduce(picture));
        reduce_seconds = median(times);
        count_drawn(picture);
    }

    /// Finds each tile's least and greatest depth again, and returns the seconds.
    double reduce(const Picture& picture) {
        return seconds([&] {
            if (!lightbin::reduce_depth(view, {.depth = picture.depth, .skip_background = true}, {min, max}))
                std::abort();
        });
    }

    /// Light evaluations of all drawn pixels.
    double all_evaluations(std::span<const lightbin::ListRange> lists) const {
        double sum = 0;
        for (std::size_t tile = 0; tile < lists.size(); ++tile)
            sum += static_cast<double>(drawn[tile]) * static_cast<double>(lists[tile].count);
        return sum;
    }

    /// Returns the mean number of light evaluations for a drawn pixel: the length of its tile's list.
    double evaluations(std::span<const lightbin::ListRange> lists) const {
        return all_evaluations(lists) / static_cast<double>(all_drawn);
    }

    lightbin::ZBounds bounds() const { return {min, max}; }

private:
    void count_drawn(const Picture& picture) {
        const std::size_t width = static_cast<std::size_t>(picture.size.width),
                          t = static_cast<std::size_t>(view.tile_size());
        for (std::size_t i = 0; i < picture.triangle.size(); ++i) {
            if (picture.triangle[i] == Picture::nothing) continue;
            ++drawn[i / width / t * static_cast<std::size_t>(view.tiles_x()) + i % width / t];
            ++all_drawn;
        }
    }

    /// Returns the depth up to which lights in view reach. A renderer knows it from the last frame.
    static float reach_of(const BenchScene& scene) {
        const Frustum frustum(scene.projection);
        double reach = 2 * frustum.near_depth;
        for (const glm::vec4& light : scene.lights(0))
            reach = std::max(reach, static_cast<double>(light.w) - static_cast<double>(light.z));
        return static_cast<float>(std::min(reach, frustum.far_depth));
    }

    static Lens lens_of(const Frustum& frustum, lightbin::ImageSize size) {
        return {frustum.y, frustum.near_depth, frustum.far_depth, size};
    }
};

/// A scene's views by tile size.
class Views {
public:
    Views(const BenchScene& scene, const Picture& picture) {
        for (const int tile_size : {8, 16, 32, 64})
            views_.emplace_back(scene, picture, tile_size);
    }

    TiledView& of(int tile_size) {
        return *std::ranges::find_if(views_,
                                     [&](const TiledView& v) { return v.view.tile_size() == tile_size; });
    }
    const TiledView& of(int tile_size) const { return const_cast<Views*>(this)->of(tile_size); }

private:
    std::vector<TiledView> views_;
};
