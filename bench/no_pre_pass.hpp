// SPDX-License-Identifier: MIT
// What lists can do before depth is known, or for what has no one depth, beside the box lists of a pre-pass.
#pragma once

#include "built.hpp"
#include "measure.hpp"

#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Options on a tile size, and what they gave in a scene, of all its views together.
struct Way {
    const char* name;
    int tile_size;
    std::function<Built(const TiledView&, const LightSet&)> build;
    double evaluations = 0, bytes = 0;
    std::vector<double> times = {};
};

template <lightbin::Options options> Way way(const char* name, int tile_size) {
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    return {name, tile_size, [=](const TiledView& view, const LightSet& lights) {
                return build<options>(*binner, view, lights, view.bounds());
            }};
}

inline std::vector<Way> ways() {
    using lightbin::DepthTest, lightbin::Footprint, lightbin::Options, lightbin::Slicing;
    constexpr Options plain, silhouettes = {.footprint = Footprint::silhouette},
                             box = {.depth_test = DepthTest::box}, z_bins = {.slicing = Slicing::z_bins},
                             both = {.footprint = Footprint::silhouette, .slicing = Slicing::z_bins},
                             clusters = {.slicing = Slicing::clusters},
                             boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters};
    return {way<plain>("plain", 16),           way<silhouettes>("silhouettes", 16),
            way<z_bins>("1024 z-bins", 16),    way<both>("the same + silhouettes", 16),
            way<z_bins>("1024 z-bins", 32),    way<clusters>("24 slices", 64),
            way<boxes>("24 slices + box", 64), way<boxes>("24 slices + box", 32),
            way<box>("pre-pass: box", 16)};
}

/// Writes and prints a scene's rows.
///
/// needed  evaluations a drawn pixel of lights that reach its point
inline void report_ways(std::FILE* csv, const std::string& name, std::span<const SeenScene> scenes,
                        double needed, bool quick) {
    std::vector<Way> all = ways();
    std::vector<Views> views;
    double drawn = 0;
    for (const SeenScene& seen : scenes) {
        views.emplace_back(seen.scene, seen.picture);
        const LightSet lights = seen.scene.light_set(0);
        for (Way& way : all) {
            const TiledView& view = views.back().of(way.tile_size);
            const Built built = way.build(view, lights);
            way.evaluations += all_evaluations(view, seen.picture, built);
            way.bytes += static_cast<double>(built.bytes) / static_cast<double>(scenes.size());
        }
        drawn += static_cast<double>(views.back().of(16).all_drawn);
    }

    const std::size_t turns =
        quick ? 12 : std::min<std::size_t>(rotation(scenes[0].scene.lights(0).size()), 200);
    for (std::size_t turn = 0; turn < turns; ++turn) {
        const std::size_t place = turn % scenes.size();
        const LightSet set = scenes[place].scene.light_set(static_cast<std::uint32_t>(turn));
        // The first finds no light in the cache: each one in turn.
        for (std::size_t i = 0; i < all.size(); ++i) {
            Way& way = all[(turn + i) % all.size()];
            way.times.push_back(seconds([&] { way.build(views[place].of(way.tile_size), set); }));
        }
    }
    for (const Way& way : all) {
        const double evaluations = way.evaluations / drawn, us = 1e6 * median(way.times);
        std::fprintf(csv, "%s,%s,%d,%.3f,%.3f,%.0f,%.1f\n", name.c_str(), way.name, way.tile_size,
                     evaluations, evaluations - needed, way.bytes, us);
        std::printf("%-12s %2d px  %-24s evals %6.2f of %6.2f  %8.1f KB  %8.1f us\n", name.c_str(),
                    way.tile_size, way.name, evaluations, needed, 1e-3 * way.bytes, us);
    }
    std::fflush(csv);
    std::fflush(stdout);
}
