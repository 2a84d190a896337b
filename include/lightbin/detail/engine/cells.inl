// SPDX-License-Identifier: MIT
// Prepares what the depth tests compare lights with: the Z bounds of a block's 64 tiles, and the boxes around their
// cells, whose rounding cell_boxes.hpp derives. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
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

/// Stores a vector of boxes in six arrays of 64 floats: the depths z0 and z1, low x, high x, low y and high y.
inline void store_box(const Camera& camera, float* box, Floats x0, Floats x1, Floats y0, Floats y1, Floats z0,
                      Floats z1) {
    const Floats front = camera.orthographic ? broadcast(1.0f) : z0, back = camera.orthographic ? broadcast(1.0f) : z1;
    store_floats(box, z0);
    store_floats(box + 64, z1);
    store_floats(box + 128, low_ends(x0, front, back));
    store_floats(box + 192, high_ends(x1, front, back));
    store_floats(box + 256, low_ends(y0, front, back));
    store_floats(box + 320, high_ends(y1, front, back));
}

/// Stores the boxes around a vector of cells. With split_box each tile has two cells, before and behind its gap.
///
/// Boxes are clamped to the near and the far plane. That loses no light: one that is in view meets a cell's depths if
/// and only if it meets the clamped depths.
///
/// x0, x1, y0, y1  the tiles' low and high edges along x and y
/// bounds          the cells' Z bounds: minimum, maximum and, with split_box, gap_min and gap_max
template <DepthTest depth_test>
inline void store_boxes(const Camera& camera, float* boxes, Floats x0, Floats x1, Floats y0, Floats y1,
                        const Floats (&bounds)[4]) {
    const Floats front = broadcast(camera.near_depth), back = broadcast(camera.far_depth);
    const Floats largest = broadcast(FLT_MAX);  // an edge of 0 times an infinite depth would be NaN
    const Floats z0 = minimum(select(less(front, bounds[0]), bounds[0], front), largest);
    const Floats z1 = select(less(bounds[1], back), bounds[1], back);
    if constexpr (depth_test == DepthTest::box) {
        store_box(camera, boxes, x0, x1, y0, y1, z0, z1);
    } else {
        const Floats gap_min = bounds[2], gap_max = bounds[3];
        const auto gap = less(gap_min, gap_max);
        const Floats end = select(both(gap, less(gap_min, z1)), gap_min, z1);
        const Floats begin = minimum(select(both(gap, less(z0, gap_max)), gap_max, z0), largest);
        store_box(camera, boxes, x0, x1, y0, y1, z0, end);
        store_box(camera, boxes + next_cell, x0, x1, y0, y1, begin, z1);
    }
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

/// Stores what a depth test compares lights with, for the block that begins at tile column 8 * x and tile row `top`, in
/// arrays of one float for each of its 64 tiles. With DepthTest::interval these are the minimum and maximum depths.
/// With DepthTest::box they are the depths z0 and z1, low x, high x, low y and high y of the box around each tile's
/// cell. With split_box they are these six for the cells in front of the tiles' depth gaps (see ZBounds), then six for
/// the cells behind the gaps. With box and split_box the edges of the tiles themselves are stored in `edges`. Returns a
/// bit for each tile whose Z bounds are not empty.
template <DepthTest depth_test, class Id>
std::uint64_t arrange_cells(const BinJob<Id>& job, unsigned x, unsigned top, float* cells, TileEdges& edges) {
    constexpr bool boxes = with_boxes<depth_test>;
    constexpr unsigned sides = depth_test == DepthTest::split_box ? 4 : 2;
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const unsigned rows = min_of(8u, static_cast<unsigned>(job.camera->y.tiles) - top);
    const unsigned columns = min_of(8u, static_cast<unsigned>(width) - 8 * x);
    const float absent[] = {job.slab[0], job.slab[1], infinity, -infinity};
    float bounds[sides][64 + lanes];
    if constexpr (boxes)
        for (unsigned side = 0; side < 2; ++side) {
            float* const to = edges.x + edges.high_x * side;
            copy_8_floats(job.edges[side] + 8 * x, columns, to);
            copy_8_floats(to, 8, to + 8);
        }
    for (unsigned row = 0; row < 8; ++row) {
        const unsigned first = 8 * row, y = top + min_of(row, rows - 1);  // rows below the grid repeat its last row
        for (unsigned side = 0; side < sides; ++side)
            if (job.bounds[side] != nullptr)
                copy_8_floats(job.bounds[side] + y * width + 8 * x, columns, bounds[side] + first);
            else
                fill_8_floats(bounds[side] + first, absent[side]);
        if constexpr (boxes)
            for (unsigned side = 0; side < 2; ++side)
                fill_8_floats(edges.y + edges.high_y * side + first, job.edges[2 + side][y]);
    }
    std::uint64_t drawn = 0;
    for (unsigned tile = 0; tile < 64; tile += lanes) {
        Floats of_tiles[4];
        for (unsigned side = 0; side < sides; ++side)
            of_tiles[side] = load_floats(bounds[side] + tile);
        drawn |= (~std::uint64_t{movemask(less(of_tiles[1], of_tiles[0]))} & every_lane) << tile;
        if constexpr (boxes) {
            const float *const of_x = edges.x + tile % 8, *const of_y = edges.y + tile;
            store_boxes<depth_test>(*job.camera, cells + tile, load_floats(of_x), load_floats(of_x + edges.high_x),
                                    load_floats(of_y), load_floats(of_y + edges.high_y), of_tiles);
        } else {
            store_floats(cells + tile, maximum(of_tiles[0], broadcast(-infinity)));  // so that NaN excludes no light
            store_floats(cells + 64 + tile, minimum(of_tiles[1], broadcast(infinity)));
        }
    }
    return drawn & ~std::uint64_t{0} >> 8 * (8 - rows);
}

/// Returns the boxes of a slice's cells. They are the boxes that store_boxes() would store for these cells.
template <class Id> SlabBoxes arrange_slab(const BinJob<Id>& job, Scratch& scratch) {
    const Camera& camera = *job.camera;
    SlabBoxes slab;
    slab.z0 = min_of(max_of(job.slab[0], camera.near_depth), FLT_MAX);
    slab.z1 = min_of(job.slab[1], camera.far_depth);
    const Floats front = broadcast(camera.orthographic ? 1.0f : slab.z0),
                 back = broadcast(camera.orthographic ? 1.0f : slab.z1);
    const std::size_t tiles[] = {static_cast<std::size_t>(camera.x.tiles), static_cast<std::size_t>(camera.y.tiles)};
    float* ends = scratch.slab_ends.reserve(2 * (tiles[0] + std::uint64_t{tiles[1]} + 2 * SlabBoxes::padding));
    for (unsigned side = 0; side < 4; ++side) {
        const std::size_t count = tiles[side / 2];
        for (std::size_t i = 0; i < count; i += lanes) {
            const Floats edges = load_floats(job.edges[side] + i);
            store_floats(ends + i, side % 2 == 0 ? low_ends(edges, front, back) : high_ends(edges, front, back));
        }
        slab.ends[side] = ends;
        ends += count + SlabBoxes::padding;
    }
    return slab;
}

}}}}  // namespace lightbin::detail
