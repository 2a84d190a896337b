// SPDX-License-Identifier: MIT
// The structs that the stages and their kernels hand to each other.
#pragma once

#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/project/view_box.hpp>
#include <lightbin/detail/project/world_to_view.hpp>

#include <span>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Where a projection kernel reads lights from, and where it writes what later stages need of them in view space.
/// Arrays are indexed by a light's id.
struct LightSource {
    /// The caller's own array if it has the layout of Spheres, Spots or Boxes; null: `copy` is called. It may be an
    /// array of another type, so its bytes are to be copied, as by load_sphere().
    const void* array;
    const void* lights;  ///< the caller's lights, an object of the class template Lights that `copy` reads
    /// Writes lights first..first + count - 1, as Spheres, Spots or Boxes, to an array at `to`.
    void (*copy)(const void* lights, std::size_t first, std::size_t count, void* to) = nullptr;
    std::uint32_t first_id;      ///< the id of the first one of the lights in `array` or `lights`
    const WorldToView* to_view;  ///< the transform to view space; null: the lights are given in view space
    /// Store the half spaces around each spot or box for the depth tests, too: `around` in ViewSpot and ViewBox.
    bool with_planes;
    /// Where copied or transformed spheres, and all spots and boxes, are stored if not null, in whole vectors.
    Sphere* out_spheres = nullptr;
    ViewSpot* out_spots = nullptr;
    ViewBox* out_boxes = nullptr;
};

/// A run of footprints: the elements begin..end-1 of FootprintArrays.
struct FootprintRun {
    std::uint32_t begin, end;
};

/// All lights in view space. They are complete only if depth tests, slices or coverage() read them. Ids number the
/// arrays that lights() joined: first all spheres, then all spots, then all boxes.
struct ViewLights {
    const Sphere* spheres = nullptr;  ///< to be read with load_sphere()
    const ViewSpot* spots = nullptr;
    const ViewBox* boxes = nullptr;
    std::uint32_t first_spot = 0, first_box = 0;  ///< the ids of the first spot and of the first box

    /// Returns the kind of the light with an id, if the lights are of mixed kinds.
    LightKind kind_of(std::uint32_t id) const {
        if (id < first_spot) return LightKind::sphere;
        if constexpr (!kinds_have_spots) return LightKind::box;
        if constexpr (!kinds_have_boxes) return LightKind::spot;
        return id < first_box ? LightKind::spot : LightKind::box;
    }
    /// Returns the light with an id, which is of the kind spot or box.
    template <LightKind kind> const auto& shape(std::uint32_t id) const {
        if constexpr (kind == LightKind::spot)
            return spots[id - first_spot];
        else
            return boxes[id - first_box];
    }
};

/// The footprints of the lights in view, as parallel arrays: tile columns x0..x1 and tile rows y0..y1, ends included.
/// The footprints lie in one or more runs; ids ascend in each run and from run to run. `widest_vector` elements
/// past the end can be read and written.
struct FootprintArrays {
    std::uint32_t* ids;
    std::uint16_t *x0, *y0, *x1, *y1;

    /// With z-bins, the ids of the lights by rank: then `ids` holds ranks, which are positions in order of depth. Else
    /// null.
    const std::uint32_t* by_rank = nullptr;
    ViewLights view_lights = {};

    /// Returns the light's position in the caller's arrays, by which view_lights is indexed, of an element of `ids`.
    std::uint32_t light_of(std::uint32_t id) const { return by_rank != nullptr ? by_rank[id] : id; }

    /// Returns the arrays of the footprints (lights' tile rectangles) from `begin` on.
    FootprintArrays from(std::size_t begin) const {
        return {ids + begin, x0 + begin, y0 + begin, x1 + begin, y1 + begin, by_rank, view_lights};
    }
};

class FootprintBuffers {
public:
    /// Returns arrays for `count` footprints and widest_vector elements more.
    FootprintArrays reserve(std::uint64_t count) {
        const std::uint64_t capacity = count + widest_vector;
        return {.ids = ids_.reserve(capacity),
                .x0 = x0_.reserve(capacity),
                .y0 = y0_.reserve(capacity),
                .x1 = x1_.reserve(capacity),
                .y1 = y1_.reserve(capacity)};
    }

private:
    Buffer<std::uint32_t> ids_;
    Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
};

/// A rectangle of a depth buffer: rows of samples, from one row to the next `pitch` floats apart.
struct DepthRows {
    const float* samples;
    std::size_t pitch, rows, columns;
};

/// How many lights were projected, and how many tiles and tile rows the rectangles of those in view have in sum.
struct ProjectCounts {
    std::uint32_t visible = 0;   ///< the number of lights in view
    std::uint32_t rejected = 0;  ///< the number of lights that are bad input, see Sphere
    std::uint64_t area = 0;      ///< the number of tiles in all rectangles: an upper bound on the length of all lists
};

/// The tile rectangles of a chunk of lights: `size` lights are projected first, then the ones out of view are dropped.
struct ChunkRects {
    static constexpr std::uint32_t size = 64;
    std::uint32_t x0[size], y0[size], x1[size], y1[size];
};

/// A chunk of lights while they are projected. A light's index is counted from the chunk's first light.
struct ProjectedChunk {
    ChunkRects rects;
    std::uint64_t visible;    ///< a mask of the chunk's lights that are in view
    std::uint64_t in_double;  ///< a mask of the chunk's lights to be projected in double precision
};

/// Projects in double light i of a chunk, a sphere for which float has no error bound: one that crosses the near plane
/// or contains the eye, a tiny, huge or infinite one, or bad input, which it counts. Stores its rectangle, and returns
/// whether it is in view. No tier has vectors for these few lights: see project/spheres_in_double.inl.
///
/// sphere  the light in view space
bool project_in_double(const Camera& camera, const Sphere& sphere, std::uint32_t i, ChunkRects& rects,
                       ProjectCounts& counts);

/// Projects in double light i of a chunk, a box for which float has no error bound. Sets the light's bit in
/// chunk.visible if it is in view.
///
/// ball   the sphere that cuts the box, in view space after the camera's signs
/// given  the box as it is given
/// to     where to store the box in view space, but for ViewBox::around; may be null
void project_box_in_double(const Camera& camera, const WorldToView* to_view, const Sphere& ball, const Box& given,
                           std::uint32_t i, ProjectedChunk& chunk, ViewBox* to);

/// The footprints of all lights in view, or of the lights in view that intersect one depth slice.
struct FootprintSlice {
    FootprintArrays lights;
    std::span<const FootprintRun> runs;
    std::uint32_t visible;                  ///< the number of footprints in all FootprintRuns of `runs` together
    std::uint64_t area;                     ///< the number of tiles in the rectangles of all footprints of `runs`
    float slab[2] = {-infinity, infinity};  ///< the slice's depths, which depth tests use in place of absent Z bounds
};

/// What the binning kernels read, and where they write each tile's ListRange, the offset and count of its list.
struct BinJob : FootprintSlice {
    const Camera* camera;
    const float* bounds[2];  ///< the tiles' depths ZBounds::min and max; null for absent ones
    const float* edges[4];   ///< the tiles' edges for boxes around cells: low x, high x, low y, high y, by tile_edges()
    ListRange* tiles;        ///< where to write the offset and count of each tile's list, for the whole grid
    /// With clusters and Z bounds, for each block of 8x8 tiles a bit for each tile that lists lights; null: all list
    /// them.
    const std::uint64_t* drawn = nullptr;
};

/// The tile rows begin..end-1, which one call of a binning kernel bins in bands of 8 rows that count from `begin`.
template <class Id> struct BinShare {
    unsigned begin, end;
    /// Where in memory the light index list of tile rows begin..end-1 begins. Kernels store whole vectors of ids, and
    /// so may write up to `widest_vector` elements past its end.
    Id* out;
    std::uint32_t offset;  ///< the element of the whole grid's light index list at which tile row `begin` begins
};

}}}  // namespace lightbin::detail
