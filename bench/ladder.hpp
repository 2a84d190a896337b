// SPDX-License-Identifier: MIT
// The rungs of the ladder, and the scenes they are measured on, ready to be binned.
#pragma once

#include "frames.hpp"
#include "raster.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using lightbin::DepthTest;
using lightbin::Footprint;

inline constexpr lightbin::Extent screen = {1920, 1080};

/// A footprint and a depth test.
struct Method {
    Footprint footprint;
    DepthTest depth_test;
};

constexpr const char* name_of(Footprint footprint) {
    return footprint == Footprint::rectangle ? "rectangle" : "silhouette";
}
constexpr const char* name_of(DepthTest test) {
    constexpr const char* names[] = {"none", "interval", "box", "split_box"};
    return names[static_cast<int>(test)];
}

inline constexpr Method ladder[] = {
    {Footprint::rectangle, DepthTest::none},
    {Footprint::rectangle, DepthTest::interval},
};

template <class Work> double seconds(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// A view of a scene on a tile grid, with its Z bounds.
struct TiledView {
    lightbin::View view;
    FlatView flat;
    std::vector<float> min, max, gap_min, gap_max;
    double reduce_seconds = 0;  ///< what making the Z bounds took

    TiledView(const BenchScene& scene, const Picture& picture, int tile_size)
        : view(*lightbin::View::from_projection(scene.projection, picture.size, {.tile_size = tile_size})),
          flat(lens_of(Frustum(scene.projection), picture.size).flat_view(tile_size)), min(view.tile_count()),
          max(view.tile_count()) {
        reduce_seconds = seconds([&] {
            if (!lightbin::reduce_depth(view, {.depth = picture.depth, .skip_background = true}, min, max))
                std::abort();
        });
    }

    lightbin::ZBounds bounds() const { return {min, max, gap_min, gap_max}; }

private:
    static Lens lens_of(const Frustum& frustum, lightbin::Extent size) {
        return {frustum.y, frustum.near_depth, frustum.far_depth, size};
    }
};

/// Bins with some method; the grid is valid until the next call.
template <Method method, lightbin::Index index = lightbin::Index::u32> class Bin {
public:
    auto operator()(const TiledView& view, const Lights& lights) {
        if constexpr (method.depth_test == DepthTest::none)
            return *binner_.bin(view.view, lights);
        else
            return *binner_.bin(view.view, lights, view.bounds());
    }

private:
    lightbin::Binner<lightbin::Options{
        .index = index, .footprint = method.footprint, .depth_test = method.depth_test}>
        binner_;
};

/// Calls visit.template operator()<i>() for each rung ladder[i].
template <class Visit> void for_each_rung(Visit visit) {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        (visit.template operator()<i>(), ...);
    }
    (std::make_index_sequence<std::size(ladder)>{});
}

inline std::FILE* open_report(const char* path, const char* header) {
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) {
        std::perror(path);
        std::exit(EXIT_FAILURE);
    }
    std::fprintf(file, "%s\n", header);
    return file;
}
