// SPDX-License-Identifier: MIT
// The types that pass between the stages' kernels, apart from the kernels themselves.
#pragma once

#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin::detail {

/// The tiles first..last of one tile row that a light's silhouette reaches; none if first > last.
struct RowSpan {
    std::uint16_t first, last;
};

/// A part of the footprint arrays: elements begin..end-1.
struct FootprintRun {
    std::uint32_t begin, end;
};

/// The lights in view, as parallel arrays: tiles x0..x1, y0..y1, both ends included. They lie in one or more
/// runs; ids ascend within a run and from run to run. Readable (not meaningful) up to `padding` elements past
/// the end.
struct FootprintArrays {
    static constexpr std::size_t padding = 64;
    static constexpr std::uint32_t whole_rectangle = 0xffffffff;

    std::uint32_t* ids;
    std::uint16_t *x0, *y0, *x1, *y1;

    /// With Footprint::silhouette, as the arrays above: the place in `spans` of the light's first row, y0;
    /// one span a row up to y1. Or whole_rectangle.
    std::uint32_t* span_begin;
    const RowSpan* spans;

    /// With a depth test, by id, of all lights: view space as the caller has it. To be read with load_sphere.
    const Sphere* spheres;

    /// The same arrays with their first `begin` elements left out.
    FootprintArrays from(std::size_t begin) const {
        return {ids + begin, x0 + begin, y0 + begin, x1 + begin, y1 + begin, span_begin, spans, spheres};
    }
};

/// What the projection of some lights came to.
struct ProjectCounts {
    std::uint32_t visible = 0, rejected = 0;
    std::uint64_t area = 0;  ///< sum of the rectangles' tiles: the most entries there can be
};

/// The tiles of as many lights as are projected at a time, before those out of view are dropped.
struct ChunkRects {
    static constexpr std::uint32_t size = 256;
    alignas(64) std::uint16_t x0[size], y0[size], x1[size], y1[size];
};

/// Z bounds in a form without branches: an absent side reads the one element of a constant.
struct TileDepths {
    const float* min;
    const float* max;
    std::size_t min_mask, max_mask;  ///< 0 for an absent side, all ones otherwise
    float z_sign;                    ///< see Camera

    /// z - r to z + r in float: rounding is monotone, so comparing them with float bounds never loses a light.
    DepthInterval of(const Sphere& light) const {
        return {z_sign * light.z - light.radius, z_sign * light.z + light.radius};
    }

    /// True unless the interval is surely out of the tile's bounds or the tile is empty. NaN tests nothing.
    bool meets(std::size_t tile, DepthInterval light) const {
        const float low = min[tile & min_mask], high = max[tile & max_mask];
        return !(light.max < low) && !(light.min > high) && !(low > high);
    }
};

/// What a binning kernel works on and writes.
template <class Id> struct BinJob {
    /// Elements that a kernel may write past the end of `offsets` and `indices`: full vectors are stored.
    static constexpr std::size_t slack = 64;

    FootprintArrays lights;
    std::span<const FootprintRun> runs;
    std::uint32_t count;  ///< of lights, in all runs
    int tiles_x, tiles_y;
    TileDepths bounds;
    std::uint32_t* offsets;  ///< one a tile, row-major
    Id* indices;             ///< room for ProjectCounts::area
};

}  // namespace lightbin::detail
