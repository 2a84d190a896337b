// SPDX-License-Identifier: MIT
// What a Binner does, fixed at compile time: an option that is off leaves no code.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/light_grid.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The tiles that a light's projection is taken to cover.
enum class Footprint : std::uint8_t {
    rectangle,   ///< its bounding rectangle (the papers' method)
    silhouette,  ///< one exact span of tiles a tile row: drops the rectangle's corners
};

/// What keeps a light out of a tile beside its footprint. All but `none` need Z bounds.
enum class DepthTest : std::uint8_t {
    none,       ///< nothing
    interval,   ///< its depths z - r to z + r must meet the tile's Z bounds (Tiled Shading, section 6.3)
    box,        ///< its sphere must also meet the view-space box around the tile's cell
    split_box,  ///< the same with two boxes, before and behind the tile's gap (see ZBounds)
};

/// How depth is cut without a depth buffer, by the Slices that bin() is given.
enum class Slicing : std::uint8_t {
    none,
    /// Lists for each tile in each slice. The depth test, none or box, is then of those cells.
    clusters,
    /// Each slice is a bin: ids are ranks in order of depth, and each bin has the least and greatest rank of the lights in
    /// it (Drobot, "Improved Culling for Tiled and Clustered Rendering", SIGGRAPH 2017).
    z_bins,
};

constexpr const char* to_string(Footprint footprint) {
    return detail::name_at(footprint, {"rectangle", "silhouette"});
}

constexpr const char* to_string(DepthTest test) {
    return detail::name_at(test, {"none", "interval", "box", "split_box"});
}

constexpr const char* to_string(Slicing slicing) {
    return detail::name_at(slicing, {"none", "clusters", "z_bins"});
}

/// What a Binner does.
struct Options {
    IdWidth ids = IdWidth::u32;  ///< u16 or u32
    Footprint footprint = Footprint::rectangle;
    DepthTest depth_test = DepthTest::none;
    Slicing slicing = Slicing::none;
    /// Use no wider instructions than these, even where the machine has them. The result is the same.
    Isa isa = compiled_isa;
};

}}  // namespace lightbin
