// SPDX-License-Identifier: MIT
// Stability: settled.
// The options of a Binner. They are template arguments, so an option that is off leaves no code in the program.
#pragma once

#include <lightbin/light_grid.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How the Slices given to bin() narrow the lights of a tile by depth. No depth buffer is needed.
enum class Slicing : std::uint8_t {
    none,
    /// Each tile has one list per slice. The depth test is against the box around the tile in that slice.
    clusters,
    /// Each tile has one list, whose ids are ranks: positions of the lights in order of depth. Each slice is a bin that
    /// stores the least and greatest rank of its lights, so a shader skips the ids outside of its pixel's bin (Drobot,
    /// "Improved Culling for Tiled and Clustered Rendering", SIGGRAPH 2017).
    z_bins,
};

constexpr const char* to_string(Slicing slicing) {
    return detail::name_at(slicing, {"none", "clusters", "z_bins"});
}

/// What a Binner does: its template argument.
struct Options {
    IdWidth ids = IdWidth::u32;  ///< u16 or u32
    /// Lists a light in a tile of its footprint only if it meets the tile's Z bounds and the view-space box around the
    /// tile's frustum between them. Needs Z bounds, or clusters, whose cells lie between the depths of a slice.
    bool depth_test = false;
    Slicing slicing = Slicing::none;
};

namespace detail {

/// Calls body(name, member...) for each of the options, with the member of that name of each of the structs. So whoever
/// copies options to a struct of another language, as lightbin.h does, needs no list of them.
template <class Body, class... Structs> constexpr void for_each_option(const Body& body, Structs&... structs) {
    body("options.ids", structs.ids...);
    body("options.depth_test", structs.depth_test...);
    body("options.slicing", structs.slicing...);
}

}  // namespace detail

}}  // namespace lightbin
