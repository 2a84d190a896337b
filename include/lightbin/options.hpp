// SPDX-License-Identifier: MIT
// The options of a Binner. They are template arguments, so an option that is off leaves no code in the program.
#pragma once

#include <lightbin/isa.hpp>
#include <lightbin/light_grid.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How a light's footprint is computed: the tiles that its projection covers.
enum class Footprint : std::uint8_t {
    rectangle,   ///< the tiles of the projection's bounding rectangle (as in Tiled Shading)
    silhouette,  ///< one exact span of tiles per tile row, without the corners of the bounding rectangle
};

/// The test that keeps a light out of tiles of its footprint by depth. All but `none` need Z bounds or clusters.
enum class DepthTest : std::uint8_t {
    none,       ///< no test: a light is listed in all tiles of its footprint
    interval,   ///< the light's depths, z - r to z + r, must meet the tile's Z bounds (Tiled Shading, section 6.3)
    box,        ///< the light must meet the Z bounds, and the view-space box around the tile's frustum between them
    split_box,  ///< `box` with two boxes, one in front of and one behind the tile's depth gap (see ZBounds)
};

/// How the Slices given to bin() narrow the lights of a tile by depth. No depth buffer is needed.
enum class Slicing : std::uint8_t {
    none,
    /// Each tile has one list per slice. DepthTest::box tests the box around the tile in that slice, without Z bounds.
    clusters,
    /// Each tile has one list, whose ids are ranks: positions of the lights in order of depth. Each slice is a bin that
    /// stores the least and greatest rank of its lights, so a shader skips the ids outside of its pixel's bin (Drobot,
    /// "Improved Culling for Tiled and Clustered Rendering", SIGGRAPH 2017).
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

/// What a Binner does: its template argument.
struct Options {
    IdWidth ids = IdWidth::u32;  ///< u16 or u32
    Footprint footprint = Footprint::rectangle;
    DepthTest depth_test = DepthTest::none;
    Slicing slicing = Slicing::none;
    /// The widest instruction set to use, even where the machine has a wider one. The result is the same.
    Isa isa = compiled_isa;
    bool coverage = false;  ///< find what each light in view covers, for Binner::coverage()
};

}}  // namespace lightbin
