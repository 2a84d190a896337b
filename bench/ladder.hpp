// SPDX-License-Identifier: MIT
// The rungs of the ladder, and the scenes they are measured on, ready to be binned.
#pragma once

#include "frames.hpp"
#include "measure.hpp"
#include "names.hpp"
#include "raster.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using lightbin::DepthTest;
using lightbin::Footprint;

inline constexpr lightbin::Extent screen = {1920, 1080};

/// A footprint and a depth test.
struct Method {
    Footprint footprint;
    DepthTest depth_test;
};

inline constexpr Method ladder[] = {
    {Footprint::rectangle, DepthTest::none},  {Footprint::rectangle, DepthTest::interval},
    {Footprint::rectangle, DepthTest::box},   {Footprint::rectangle, DepthTest::split_box},
    {Footprint::silhouette, DepthTest::none}, {Footprint::silhouette, DepthTest::interval},
    {Footprint::silhouette, DepthTest::box},  {Footprint::silhouette, DepthTest::split_box},
};

/// A view of a scene on a tile grid, with its Z bounds and how much is drawn in its tiles.
struct TiledView {
    lightbin::View view;
    FlatView flat;
    std::vector<float> min, max, gap_min, gap_max;
    std::vector<std::uint32_t> drawn;  ///< pixels a tile that show something
    std::uint64_t all_drawn = 0;
    double reduce_seconds = 0;  ///< what making minimum and maximum takes

    TiledView(const BenchScene& scene, const Picture& picture, int tile_size)
        : view(*lightbin::View::from_projection(scene.projection, picture.size, {.tile_size = tile_size})),
          flat(lens_of(Frustum(scene.projection), picture.size).flat_view(tile_size)), min(view.tile_count()),
          max(min), gap_min(min), gap_max(min), drawn(view.tile_count()) {
        const lightbin::DepthBuffer buffer = {.depth = picture.depth, .skip_background = true};
        if (!lightbin::reduce_depth(view, buffer, min, max, gap_min, gap_max)) std::abort();
        std::vector<float> again_min(min), again_max(max);
        reduce_seconds = seconds([&] { (void)lightbin::reduce_depth(view, buffer, again_min, again_max); });
        count_drawn(picture);
    }

    /// Light evaluations a drawn pixel: the mean length of its list.
    double evaluations(std::span<const lightbin::Tile> lists) const {
        double sum = 0;
        for (std::size_t tile = 0; tile < lists.size(); ++tile)
            sum += static_cast<double>(drawn[tile]) * static_cast<double>(lists[tile].count);
        return sum / static_cast<double>(all_drawn);
    }

    lightbin::ZBounds bounds() const { return {min, max, gap_min, gap_max}; }

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

    static Lens lens_of(const Frustum& frustum, lightbin::Extent size) {
        return {frustum.y, frustum.near_depth, frustum.far_depth, size};
    }
};

/// Bins by one rung; the grid is valid until the next call.
template <Method method, lightbin::Index index = lightbin::Index::u32,
          lightbin::Isa isa = lightbin::Options{}.isa>
class Bin {
public:
    auto operator()(const TiledView& view, const Lights& lights) {
        if constexpr (method.depth_test == DepthTest::none)
            return *binner_.bin(view.view, lights);
        else
            return *binner_.bin(view.view, lights, view.bounds());
    }

private:
    lightbin::Binner<lightbin::Options{
        .index = index, .footprint = method.footprint, .depth_test = method.depth_test, .isa = isa}>
        binner_;
};

/// One binner for each rung. Calls visit(i, bin) for ladder[i] and its own Bin.
class Ladder {
public:
    template <class Visit> void for_each(Visit visit) { visit_all(visit, std::make_index_sequence<rungs>{}); }

private:
    static constexpr std::size_t rungs = std::size(ladder);

    template <std::size_t... i>
    static auto bins_of(std::index_sequence<i...>) -> std::tuple<Bin<ladder[i]>...>;
    template <class Visit, std::size_t... i> void visit_all(Visit& visit, std::index_sequence<i...>) {
        (visit(i, std::get<i>(bins_)), ...);
    }

    decltype(bins_of(std::make_index_sequence<rungs>{})) bins_;
};
