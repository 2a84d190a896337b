// SPDX-License-Identifier: MIT
// The structs that the stages and their kernels hand to each other.
#pragma once

#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/project/view_spot.hpp>
#include <lightbin/detail/project/world_to_view.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Where a projection kernel reads lights from, and where it writes what later stages need of them in view space.
/// Arrays are indexed by a light's id.
struct LightSource {
    const Sphere* spheres;  ///< the caller's own array, to be read with load_sphere(); null: `copy` is called
    const void* lights;     ///< the caller's lights, a Lights object that `copy` reads
    /// Writes lights first..first + count - 1 to `to` as spheres. Of spots it writes the spheres that their cones
    /// cut, and to `cones` vec4s with the axes and the cosines of the half angles.
    void (*copy)(const void* lights, std::size_t first, std::size_t count, Sphere* to, Sphere* cones) = nullptr;
    const WorldToView* to_view;  ///< the transform to view space; null: the lights are given in view space
    bool with_planes;            ///< store each spot's planes for the depth tests, too: ViewSpot::planes and corners
    /// Where copied or transformed spheres, and all spots, are stored if not null. Kernels store whole vectors, so each
    /// array is padded.
    Sphere* out_spheres = nullptr;
    ViewSpot* out_spots = nullptr;
};

/// The tiles first..last of one tile row that a light's silhouette touches; none if first > last.
struct RowSpan {
    std::uint16_t first, last;
};

/// A run of footprints: the elements begin..end-1 of FootprintArrays.
struct FootprintRun {
    std::uint32_t begin, end;
};

/// The footprints of the lights in view, as parallel arrays: tile columns x0..x1 and tile rows y0..y1, ends included.
/// The footprints lie in one or more runs; ids ascend in each run and from run to run. `padding` elements past the end
/// can be read and written, as kernels load and store whole vectors.
struct FootprintArrays {
    static constexpr std::size_t padding = 64;
    static constexpr std::uint32_t whole_rectangle = 0xffffffff;  ///< span_begin of a footprint without row spans

    std::uint32_t* ids;
    std::uint16_t *x0, *y0, *x1, *y1;

    /// With Footprint::silhouette, for each footprint: the index in `spans` of the span of tile row y0, which the spans
    /// of the rows up to y1 follow; or whole_rectangle, if the footprint has no spans and covers its whole rectangle.
    std::uint32_t* span_begin = nullptr;
    const RowSpan* spans = nullptr;

    /// With silhouettes or a depth test, all lights in view space, by id: spots, or spheres, read with load_sphere().
    const Sphere* spheres = nullptr;
    const ViewSpot* spots = nullptr;

    /// Returns the arrays of the footprints (lights' tile rectangles) from `begin` on, without silhouettes' row spans.
    FootprintArrays from(std::size_t begin) const {
        return {ids + begin, x0 + begin, y0 + begin, x1 + begin, y1 + begin, nullptr, nullptr, spheres, spots};
    }
};

class FootprintBuffers {
public:
    /// Returns arrays of ids, rectangles and, with `with_spans`, span_begin, for `count` footprints and the padding.
    FootprintArrays reserve(std::uint64_t count, bool with_spans) {
        const std::uint64_t capacity = count + FootprintArrays::padding;
        return {.ids = ids_.reserve(capacity),
                .x0 = x0_.reserve(capacity),
                .y0 = y0_.reserve(capacity),
                .x1 = x1_.reserve(capacity),
                .y1 = y1_.reserve(capacity),
                .span_begin = with_spans ? span_begin_.reserve(capacity) : nullptr};
    }

private:
    Buffer<std::uint32_t> ids_, span_begin_;
    Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
};

/// A rectangle of a depth buffer: rows of samples, from one row to the next `pitch` floats apart.
struct DepthRows {
    const float* samples;
    std::size_t pitch, rows, columns;
};

/// Sums over the lights that were projected.
struct ProjectCounts {
    std::uint32_t visible = 0;   ///< the number of lights in view
    std::uint32_t rejected = 0;  ///< the number of lights that are bad input, see Sphere
    std::uint64_t area = 0;      ///< the number of tiles in all rectangles: an upper bound on the length of all lists
    std::uint64_t rows = 0;      ///< the number of tile rows in all rectangles; counted for silhouettes only
};

/// The tile rectangles of a chunk of lights: `size` lights are projected first, then the ones out of view are dropped.
struct ChunkRects {
    static constexpr std::uint32_t size = 64;
    std::uint32_t x0[size], y0[size], x1[size], y1[size];
};

/// The footprints of all lights in view, or of the lights in view that intersect one depth slice.
struct FootprintSlice {
    FootprintArrays lights;
    Items<const FootprintRun> runs;
    std::uint32_t visible;                  ///< the number of footprints in all runs
    std::uint64_t area;                     ///< the number of tiles in all these footprints' rectangles
    float slab[2] = {-infinity, infinity};  ///< the slice's depths, which depth tests use in place of absent Z bounds
};

/// What the binning kernels read, and the table that they write.
template <class Id> struct BinJob : FootprintSlice {
    const Camera* camera;
    const float* bounds[4];  ///< the tiles' depths ZBounds::min, max, gap_min, gap_max; null for absent ones
    const float* edges[4];   ///< the tiles' edges for boxes around cells: low x, high x, low y, high y, by tile_edges()
    ListRange* tiles;        ///< where to write the offset and count of each tile's list, for the whole grid
};

/// The tile rows begin..end-1, which one call of a binning kernel bins in bands of 8 rows that count from `begin`.
template <class Id> struct BinShare {
    /// Kernels store whole vectors, and so may write up to this many elements past the end of their index list.
    static constexpr std::size_t slack = 64;

    unsigned begin, end;
    Id* out;               ///< where the index list of these rows begins in memory
    std::uint32_t offset;  ///< where the index list of these rows begins in the whole grid's
};

}}}  // namespace lightbin::detail
