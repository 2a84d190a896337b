// SPDX-License-Identifier: MIT
// Prepares what the depth test compares lights with: the Z bounds of a block's 64 tiles, and the boxes around their
// cells, whose rounding cell_boxes.hpp derives. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/vectors/common.inl>
#include <lightbin/detail/view/cell_planes.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Returns the least view-space x (or y) of the boxes around cells: the tiles' low edges, which are slopes with a
/// perspective projection, times the depth at which the product is least; less a margin for underflow.
///
/// edges        the tiles' low edges, see tile_edges()
/// front, back  the boxes' nearest and farthest depths with a perspective projection, 1 with an orthographic one
inline Floats low_ends(Floats edges, Floats front, Floats back) {
    return mul(edges, select(less(edges, broadcast(0.0f)), back, front)) - broadcast(flushed);
}
/// Returns the greatest view-space x (or y) of the boxes around cells: the tiles' high edges times the depth, `front`
/// or `back`, at which the product is greatest; plus a margin for underflow. See low_ends() for the arguments.
inline Floats high_ends(Floats edges, Floats front, Floats back) {
    return mul(edges, select(less(broadcast(0.0f), edges), back, front)) + broadcast(flushed);
}

/// Stores the boxes around a vector of cells in six arrays of 64 floats: the depths z0 and z1, low x, high x, low y and
/// high y. Boxes are clamped to the near and the far plane. That loses no light: one that is in view meets a cell's
/// depths if and only if it meets the clamped depths.
///
/// x0, x1, y0, y1  the tiles' low and high edges along x and y
/// min, max        the cells' Z bounds
inline void store_boxes(const Camera& camera, float* boxes, Floats x0, Floats x1, Floats y0, Floats y1, Floats min,
                        Floats max) {
    const Floats nearest = broadcast(camera.near_depth), farthest = broadcast(camera.far_depth);
    const Floats largest = broadcast(FLT_MAX);  // an edge of 0 times an infinite depth would be NaN
    const Floats z0 = minimum(select(less(nearest, min), min, nearest), largest);
    const Floats z1 = select(less(max, farthest), max, farthest);
    const Floats front = camera.orthographic ? broadcast(1.0f) : z0, back = camera.orthographic ? broadcast(1.0f) : z1;
    store_floats(boxes, z0);
    store_floats(boxes + 64, z1);
    store_floats(boxes + 128, low_ends(x0, front, back));
    store_floats(boxes + 192, high_ends(x1, front, back));
    store_floats(boxes + 256, low_ends(y0, front, back));
    store_floats(boxes + 320, high_ends(y1, front, back));
}

/// Copies `count` floats, 1 to 8, and pads them to 8 with copies of the last one.
inline void copy_8_floats(const float* from, unsigned count, float* to) {
    if (count == 8) return static_cast<void>(std::memcpy(to, from, 8 * sizeof *to));
    for (unsigned i = 0; i < 8; ++i)
        to[i] = from[min_of(i, count - 1)];
}

/// Stores `value` in 8 floats at `to` or, with vectors of sixteen floats, in 16.
inline void fill_8_floats(float* to, float value) {
    for (unsigned i = 0; i < 8; i += lanes)
        store_floats(to + i, broadcast(value));
}

/// The cells of a block's tiles, with which the depth test compares the block's lights.
struct BlockCells {
    float boxes[6 * 64];   ///< the view-space boxes around the tiles' cells, as store_boxes() lays them out
    TileEdges edges;       ///< the edges of the cells' tiles
    std::uint64_t drawn;   ///< a bit for each tile whose Z bounds are not empty
    DepthInterval depths;  ///< an interval that holds the view depths of the cells of all tiles in `drawn`
};

/// Returns an interval that has the view depths of the cells of all tiles whose bit in `drawn` is set. Cells are read a
/// vector at a time, so the depths of others in the same vectors count, too.
inline DepthInterval depth_range(const float* boxes, std::uint64_t drawn) {
    float min[lanes], max[lanes];
    Floats nearest = broadcast(infinity), farthest = broadcast(-infinity);
    for (unsigned tile = 0; tile < 64; tile += lanes)
        if ((drawn >> tile & every_lane) != 0) {
            nearest = minimum(load_floats(boxes + tile), nearest);
            farthest = maximum(load_floats(boxes + 64 + tile), farthest);
        }
    store_floats(min, nearest);
    store_floats(max, farthest);
    DepthInterval range = {min[0], max[0]};
    for (std::uint32_t lane = 1; lane < lanes; ++lane)
        range = {min_of(range.min, min[lane]), max_of(range.max, max[lane])};
    return range;
}

/// Fills `cells` for the block that begins at tile column 8 * x and tile row `top`.
inline void arrange_cells(const BinJob& job, unsigned x, unsigned top, BlockCells& cells) {
    TileEdges& edges = cells.edges;
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const unsigned rows = min_of(8u, static_cast<unsigned>(job.camera->y.tiles) - top);
    const unsigned columns = min_of(8u, static_cast<unsigned>(width) - 8 * x);
    float bounds[2][64 + lanes];
    for (unsigned side = 0; side < 2; ++side) {
        float* const to = edges.x + edges.high_x * side;
        copy_8_floats(job.edges[side] + 8 * x, columns, to);
        copy_8_floats(to, 8, to + 8);
    }
    for (unsigned row = 0; row < 8; ++row) {
        const unsigned first = 8 * row, y = top + min_of(row, rows - 1);  // rows below the grid repeat its last row
        for (unsigned side = 0; side < 2; ++side) {
            if (job.bounds[side] != nullptr)
                copy_8_floats(job.bounds[side] + y * width + 8 * x, columns, bounds[side] + first);
            else
                fill_8_floats(bounds[side] + first, job.slab[side]);
            fill_8_floats(edges.y + edges.high_y * side + first, job.edges[2 + side][y]);
        }
    }
    std::uint64_t drawn = 0;
    for (unsigned tile = 0; tile < 64; tile += lanes) {
        const Floats min = load_floats(bounds[0] + tile), max = load_floats(bounds[1] + tile);
        drawn |= (~std::uint64_t{movemask(less(max, min))} & every_lane) << tile;
        const float *const of_x = edges.x + tile % 8, *const of_y = edges.y + tile;
        store_boxes(*job.camera, cells.boxes + tile, load_floats(of_x), load_floats(of_x + edges.high_x),
                    load_floats(of_y), load_floats(of_y + edges.high_y), min, max);
    }
    cells.drawn = drawn & ~std::uint64_t{0} >> 8 * (8 - rows);
    cells.depths = depth_range(cells.boxes, cells.drawn);
}

/// Returns the boxes of a slice's cells. They are the boxes that store_boxes() would store for these cells.
inline SlabBoxes arrange_slab(const BinJob& job, Scratch& scratch) {
    const Camera& camera = *job.camera;
    SlabBoxes slab;
    slab.z0 = min_of(max_of(job.slab[0], camera.near_depth), FLT_MAX);
    slab.z1 = min_of(job.slab[1], camera.far_depth);
    const Floats front = broadcast(camera.orthographic ? 1.0f : slab.z0),
                 back = broadcast(camera.orthographic ? 1.0f : slab.z1);
    const std::size_t tiles[] = {static_cast<std::size_t>(camera.x.tiles), static_cast<std::size_t>(camera.y.tiles)};
    float* ends = scratch.slab_ends.reserve(2 * (tiles[0] + std::uint64_t{tiles[1]} + 2 * widest_lanes));
    for (unsigned side = 0; side < 4; ++side) {
        const std::size_t count = tiles[side / 2];
        for (std::size_t i = 0; i < count; i += lanes) {
            const Floats edges = load_floats(job.edges[side] + i);
            store_floats(ends + i, side % 2 == 0 ? low_ends(edges, front, back) : high_ends(edges, front, back));
        }
        slab.ends[side] = ends;
        ends += count + widest_lanes;
    }
    return slab;
}

}}}}  // namespace lightbin::detail
