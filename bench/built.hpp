// SPDX-License-Identifier: MIT
// What a build made, in one form for all options: lists, z-bins or masks.
#pragma once

#include "raster.hpp"
#include "scenes.hpp"
#include "tiled_view.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

/// What a build made. The memory is the Binner's.
struct Built {
    std::span<const lightbin::ListRange> ranges;
    std::size_t bytes;  ///< size of all that a shader reads except the lights: tiles or cells, ids, bins
    const lightbin::Slices* slices = nullptr;       ///< with slices
    std::span<const std::uint32_t> ids = {};        ///< 32-bit ids, or with z-bins ranks in depth
    std::span<const lightbin::BinRange> bins = {};  ///< with z-bins
    std::span<const std::uint32_t> order = {};      ///< with z-bins: the light of each rank in depth
    std::optional<lightbin::LightMasks> masks = {};  ///< without lists
};

/// Builds lists with the depth slices that the view has for these options. Clusters get Z bounds only if `bounded`.
template <bool bounded = false, lightbin::Options options, class Any>
Built build(lightbin::Binner<options>& binner, const TiledView& view, const std::vector<Any>& lights,
            const lightbin::ZBounds& bounds) {
    constexpr bool z_bins = options.slicing == lightbin::Slicing::z_bins;
    const lightbin::Slices& slices = z_bins ? view.z_bins : view.clusters;
    const auto inputs = [&]() -> typename lightbin::Binner<options>::Inputs {
        if constexpr (bounded)
            return {.slices = slices, .bounds = bounds};
        else
            return lightbin::inputs_for<options>(bounds, slices);
    };
    const auto grid = *binner.bin(view.view, lights, inputs());
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

template <bool bounded = false, lightbin::Options options>
Built build(lightbin::Binner<options>& binner, const TiledView& view, const LightSet& lights,
            const lightbin::ZBounds& bounds) {
    return std::visit([&](const auto& any) { return build<bounded>(binner, view, any, bounds); }, lights);
}

/// Lists of lights made from masks, as ranks in order of depth.
class MaskLists {
public:
    explicit MaskLists(const Built& of) : built_(of) {
        for (int y = 0; y < of.masks->tiles_y(); ++y)
            for (int x = 0; x < of.masks->tiles_x(); ++x)
                add(of.masks->column(x), of.masks->row(y));
        built_.ranges = ranges_;
        built_.ids = ranks_;
        built_.bins = of.masks->bins();
        built_.order = of.masks->ids();
    }
    MaskLists(const MaskLists&) = delete;  // the spans would be of the other's memory

    const Built& built() const { return built_; }

private:
    void add(std::span<const std::uint32_t> column, std::span<const std::uint32_t> row) {
        const auto offset = static_cast<std::uint32_t>(ranks_.size());
        for (std::uint32_t w = 0; w < column.size(); ++w)
            for (std::uint32_t bits = column[w] & row[w]; bits != 0; bits &= bits - 1)
                ranks_.push_back(32 * w + static_cast<std::uint32_t>(std::countr_zero(bits)));
        ranges_.push_back({offset, static_cast<std::uint32_t>(ranks_.size()) - offset});
    }

    Built built_;
    std::vector<lightbin::ListRange> ranges_;
    std::vector<std::uint32_t> ranks_;
};

using BuildLists = std::function<Built(const TiledView&, const LightSet&)>;

/// Returns a function that builds with its own Binner, and with the view's Z bounds if the options need them or clusters
/// are `bounded` by them.
template <lightbin::Options options, bool bounded = false> BuildLists builder() {
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    return [=](const TiledView& view, const LightSet& lights) {
        return build<bounded>(*binner, view, lights, view.bounds());
    };
}
