// SPDX-License-Identifier: MIT
// The types that pass between the stages' kernels, apart from the kernels themselves.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/project/view_spot.hpp>
#include <lightbin/detail/project/world_to_view.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/sphere.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Where the projection finds the lights, by id: `spheres` as they are, or null and `copy`, which makes spheres of some
/// of `lights`, or of spots their balls, and as vec4s their axes and cosines. They are moved by `to_view`, if not null.
/// Those that are copied or moved stay in `kept`, spots in `kept_spots`, if not null, which have some more places behind
/// them.
struct LightSource {
    const Sphere* spheres;  ///< to be read with load_sphere
    const void* lights;
    void (*copy)(const void* lights, std::size_t first, std::size_t count, Sphere* to, Sphere* cones);
    const WorldToView* to_view;
    Sphere* kept;
    ViewSpot* kept_spots;
    bool with_planes;  ///< of those
};

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

    /// With silhouettes or a depth test, by id, of all lights here: view space as the caller has it. To be read with
    /// load_sphere.
    const Sphere* spheres;
    /// Or, of lights that are spots, these.
    const ViewSpot* spots;

    /// The same arrays with their first `begin` elements left out, for writing rectangles.
    FootprintArrays from(std::size_t begin) const {
        return {ids + begin, x0 + begin, y0 + begin, x1 + begin, y1 + begin,
                nullptr,     nullptr,    spheres,    spots};
    }
};

/// Memory of footprint arrays, kept from call to call.
class FootprintBuffers {
public:
    /// Returns arrays for `count` lights and the padding, with nothing yet that `ids` number.
    FootprintArrays reserve(std::uint64_t count, bool with_spans) {
        const std::uint64_t capacity = count + FootprintArrays::padding;
        return {.ids = ids_.reserve(capacity),
                .x0 = x0_.reserve(capacity),
                .y0 = y0_.reserve(capacity),
                .x1 = x1_.reserve(capacity),
                .y1 = y1_.reserve(capacity),
                .span_begin = with_spans ? span_begin_.reserve(capacity) : nullptr,
                .spans = nullptr,
                .spheres = nullptr,
                .spots = nullptr};
    }

private:
    Buffer<std::uint32_t> ids_, span_begin_;
    Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
};

/// Samples of a depth buffer, rows by columns.
struct DepthRows {
    const float* samples;
    std::size_t pitch, rows, columns;
};

/// What the projection of some lights came to.
struct ProjectCounts {
    std::uint32_t visible = 0, rejected = 0;
    std::uint64_t area = 0;  ///< sum of the rectangles' tiles: the most entries there can be
    std::uint64_t rows = 0;  ///< sum of the rectangles' heights, counted for silhouettes only
};

/// The tiles of as many lights as are projected at a time, before those out of view are dropped.
struct ChunkRects {
    static constexpr std::uint32_t size = 64;
    alignas(64) std::uint16_t x0[size], y0[size], x1[size], y1[size];
};

/// The lights in view, or those of them that meet a slice.
struct FootprintSlice {
    FootprintArrays lights;
    Items<const FootprintRun> runs;
    std::uint32_t visible;                  ///< lights in all runs
    std::uint64_t area;                     ///< sum of their rectangles' tiles
    float slab[2] = {-infinity, infinity};  ///< the slice's depths: they take the place of absent min and max
};

/// What the binning kernels read, and the table that they write.
template <class Id> struct BinJob : FootprintSlice {
    const Camera* camera;
    const float* bounds[4];  ///< of ZBounds: min, max, gap_min, gap_max; null for an absent one
    const float* edges[4];   ///< of the tiles, for boxes: low x, high x, low y, high y; see cell_boxes.hpp
    ListRange* tiles;        ///< of the whole grid
};

/// The share of one call of a binning kernel: the tile rows begin..end-1, whose bands of 8 rows count from `begin`.
template <class Id> struct BinShare {
    /// Kernels store whole vectors, and so may write up to this many elements past the end of their index list.
    static constexpr std::size_t slack = 64;

    unsigned begin, end;
    Id* out;               ///< where their index list begins in memory
    std::uint32_t offset;  ///< and in the whole grid's index list
};

}}}  // namespace lightbin::detail
