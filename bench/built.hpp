// SPDX-License-Identifier: MIT
// A grid of any options, as the reports read it.
#pragma once

#include "raster.hpp"
#include "scenes.hpp"
#include "tiled_view.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <variant>
#include <vector>

/// What a build gave, in its Binner's memory.
struct Built {
    std::span<const lightbin::ListRange> ranges;
    std::size_t bytes;  ///< of all that a shader reads, but the lights: tiles or cells, ids, bins
    const lightbin::Slices* slices = nullptr;       ///< with slices
    std::span<const std::uint32_t> ids = {};        ///< where they are of 32 bits; with z-bins ranks
    std::span<const lightbin::BinRange> bins = {};  ///< with z-bins
    std::span<const std::uint32_t> order = {};      ///< with z-bins, the light of each rank
};

/// Builds with the slices that the view has for them.
template <lightbin::Options options, class Any>
Built build(lightbin::Binner<options>& binner, const TiledView& view, const std::vector<Any>& lights,
            const lightbin::ZBounds& bounds) {
    constexpr bool z_bins = options.slicing == lightbin::Slicing::z_bins;
    const lightbin::Slices& slices = z_bins ? view.z_bins : view.clusters;
    const auto grid = *binner.bin(view.view, lights, lightbin::inputs_for<options>(bounds, slices));
    Built built = {grid.ranges(), grid.ranges().size_bytes() + grid.ids().size_bytes()};
    if constexpr (options.slicing != lightbin::Slicing::none) built.slices = &slices;
    if constexpr (options.ids == lightbin::IdWidth::u32) built.ids = grid.ids();
    if constexpr (z_bins) {
        built.bins = grid.ranks().bins;
        built.order = grid.ranks().order;
        built.bytes += built.bins.size_bytes();
    }
    return built;
}

template <lightbin::Options options>
Built build(lightbin::Binner<options>& binner, const TiledView& view, const LightSet& lights,
            const lightbin::ZBounds& bounds) {
    return std::visit([&](const auto& any) { return build(binner, view, any, bounds); }, lights);
}

using BuildLists = std::function<Built(const TiledView&, const LightSet&)>;

/// Builds with a Binner of its own, and the view's Z bounds where the options take them.
template <lightbin::Options options> BuildLists builder() {
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    return [=](const TiledView& view, const LightSet& lights) {
        return build(*binner, view, lights, view.bounds());
    };
}
