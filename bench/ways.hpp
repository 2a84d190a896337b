// SPDX-License-Identifier: MIT
// All methods of making lists that the report compares.
#pragma once

#include "built.hpp"
#include "flat.hpp"
#include "tiled_view.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/spot.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

/// What lights are handed over as.
enum class Form { as_they_are, least_spheres, whole_spheres };

/// A method at a tile size.
struct Way {
    const char* method;
    int tile_size;
    bool depth_test;
    lightbin::Slicing slicing;
    bool needs_bounds;  ///< each tile's least and greatest depth must be found first
    bool ours;          ///< lightbin's; otherwise the plain loop of flat.hpp
    bool variant;       ///< only measures what a part of another method gains
    Form form;
    BuildLists build;
    bool masks = false;
};

inline LightSet lights_of(const BenchScene& scene, Form form, std::uint32_t seed) {
    if (form == Form::as_they_are) return scene.light_set(seed);
    return form == Form::whole_spheres ? scene.lights(seed) : least_spheres(scene.spots(seed));
}

class Ways {
public:
    /// Returns all methods for a scene. With spots, some list spheres around the spots.
    static std::vector<Way> all(bool with_spots) {
        using lightbin::Options, lightbin::Slicing;
        constexpr Options box = {.depth_test = true},
                          boxes = {.depth_test = true, .slicing = Slicing::clusters};
        Ways ways;
        ways.add<Options{}>("plain");
        ways.add<box>("box");
        ways.add<Options{.slicing = Slicing::clusters}>("clusters");
        ways.add<boxes>("clusters+box");
        ways.add<boxes, true>("clusters+box+Z");
        ways.add<Options{.slicing = Slicing::z_bins}>("z-bins");
        if (with_spots) {
            ways.add<box>("box of least spheres", true, Form::least_spheres);
            ways.add<box>("box of whole spheres", true, Form::whole_spheres);
        }
        ways.add_masks<Slicing::none>("masks");
        ways.add_masks<Slicing::z_bins>("masks+z-bins");
        ways.add_flat_loop<false>("flat loop");
        ways.add_flat_loop<true>("flat loop+Z");
        return std::move(ways.all_);
    }

private:
    template <lightbin::Options options, bool bounded = false>
    void add(const char* method, bool variant = false, Form form = Form::as_they_are) {
        constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
        for (const int tile_size : {8, 16, 32, 64})
            if (tile_size > 8 || !clusters)  // of 8 pixels they would be 777,600 cells
                all_.push_back({method, tile_size, options.depth_test, options.slicing,
                                (options.depth_test && !clusters) || bounded, true, variant, form,
                                builder<options, bounded>()});
    }

    template <lightbin::Slicing slicing> void add_masks(const char* method) {
        const auto binner = std::make_shared<lightbin::MaskBinner>();
        const BuildLists build = [=](const TiledView& view, const LightSet& set) -> Built {
            constexpr bool binned = slicing == lightbin::Slicing::z_bins;
            const lightbin::LightMasks masks = std::visit(
                [&](const auto& lights) {
                    if constexpr (binned) return *binner->bin(view.view, lights, view.z_bins);
                    return *binner->bin(view.view, lights);
                },
                set);
            return {.bytes = masks.words().size_bytes(),
                    .slices = binned ? &view.z_bins : nullptr,
                    .masks = masks};
        };
        for (const int tile_size : {8, 16, 32, 64})
            all_.push_back(
                {method, tile_size, false, slicing, false, true, false, Form::as_they_are, build, true});
    }

    template <bool with_bounds> void add_flat_loop(const char* method) {
        const auto loop = std::make_shared<Flat<float>>();
        const auto ranges = std::make_shared<std::vector<lightbin::ListRange>>();
        for (const int tile_size : {8, 16, 32, 64})
            all_.push_back(
                {method, tile_size, with_bounds, lightbin::Slicing::none, with_bounds, false, false,
                 Form::whole_spheres, [=](const TiledView& view, const LightSet& lights) -> Built {
                     loop->build<with_bounds>(view.flat, std::get<Lights>(lights), view.min.data(),
                                              view.max.data());
                     ranges->resize(loop->offsets.size() - 1);  // as shaders read them
                     for (std::size_t i = 0; i < ranges->size(); ++i)
                         (*ranges)[i] = {loop->offsets[i], loop->offsets[i + 1] - loop->offsets[i]};
                     return {*ranges, 8 * ranges->size() + 4 * loop->indices.size(), nullptr, loop->indices};
                 }});
    }

    std::vector<Way> all_;
};
