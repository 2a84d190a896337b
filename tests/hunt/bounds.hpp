// SPDX-License-Identifier: MIT
// Z bounds: of the caller's own making, as tight as the points allow, or from a depth buffer that points are drawn to.
#pragma once

#include "scene.hpp"

#include <cstddef>
#include <vector>

namespace hunt {

inline constexpr const char* bounds_kinds[] = {"absent", "minimum", "maximum",      "both",
                                               "tight",  "gaps",    "nasty bounds", "depth buffer"};

/// A point of a light that is surely seen, and surely in one tile.
struct Placed {
    Inside inside;
    Seen seen;
    std::size_t tile;
    int pixel_x, pixel_y;  ///< -1 where it may be in two
};

struct Bounds {
    lightbin::ZBounds spans() const { return {sides[0], sides[1], sides[2], sides[3]}; }

    std::vector<float> sides[4];  ///< minimum, maximum, and those of the gap
};

/// Whether something at a point's depth is, beyond doubt, what the bounds say may be there.
bool surely_within(const Bounds& bounds, bool with_gaps, std::size_t tile, Real depth);

/// Makes bounds of all tiles, and looks for faults of reduce_depth. Returns what is wrong; empty: nothing.
std::string make_bounds(int kind, const Camera& camera, const lightbin::View& view,
                        const std::vector<Placed>& points, Random& random, Tally& tally, Bounds& bounds);

}  // namespace hunt
