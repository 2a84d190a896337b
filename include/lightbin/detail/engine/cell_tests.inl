// SPDX-License-Identifier: MIT
// Tests a light against the cells of a block's 64 tiles, a vector of cells at a time. Included once per tier
// (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/cells.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Returns the distances of coordinates from the intervals low to high. They are 0 inside an interval.
inline Floats distance(Floats coordinate, Floats low, Floats high) {
    return maximum(maximum(low - coordinate, coordinate - high), broadcast(0.0f));
}

/// Returns the squared distances of a point from a vector of boxes, whose arrays store_boxes() lays out.
inline Floats distance2(const float* boxes, float x, float y, float z) {
    const Floats along_z = distance(broadcast(z), load_floats(boxes), load_floats(boxes + 64)),
                 along_x = distance(broadcast(x), load_floats(boxes + 128), load_floats(boxes + 192)),
                 along_y = distance(broadcast(y), load_floats(boxes + 256), load_floats(boxes + 320));
    return mul(along_x, along_x) + mul(along_y, along_y) + mul(along_z, along_z);
}

/// Returns a mask of the boxes in a vector that a sphere misses. It is always inlined because GCC 12 loses half of such
/// a mask when a call returns it.
template <bool orthographic>
LIGHTBIN_INLINE auto boxes_missed(const float* boxes, const float*, const float*, const TestedLight& light) {
    return less(broadcast(light.reach2), distance2(boxes, light.x, light.y, light.z));
}

/// Returns the mask `missed` of cells in a vector, to which the cells are added that lie outside of one of the half
/// spaces `around` a light, by the formula in cell_planes.hpp. Always inlined: GCC 12 loses half of a mask that a call
/// returns.
///
/// cells             the depths z0 and z1 of the cells, in the arrays that store_boxes() fills
/// x_edges, y_edges  the edges of the cells' tiles in TileEdges::x and TileEdges::y
template <bool orthographic, std::size_t count, class Mask>
LIGHTBIN_INLINE Mask or_outside(Mask missed, const float* cells, const float* x_edges, const float* y_edges,
                                const CellPlane (&around)[count]) {
    LIGHTBIN_UNROLL for (const CellPlane& plane : around) {
        const std::int32_t depths = offset_if_negative(orthographic ? plane.z : plane.most, 64);
        const Floats x = load_floats(x_edges + offset_if_negative(plane.x, TileEdges::high_x)),
                     y = load_floats(y_edges + offset_if_negative(plane.y, TileEdges::high_y)),
                     z = load_floats(cells + depths), n_z = broadcast(plane.z);
        const Floats across = mul(x, broadcast(plane.x)) + mul(y, broadcast(plane.y));
        const Floats least = orthographic ? across + mul(z, n_z) : mul(across + n_z, z);
        missed = either(missed, less(broadcast(plane.most), least));
    }
    return missed;
}

/// Returns a mask of the cells in a vector that a spot or a Box misses. These are the cells whose boxes, stored by
/// store_boxes(), do not meet its ball, the sphere that it is a part of, and the cells outside of one of the half
/// spaces around it: four around a spot, six around a Box. The ball of a Box that its sphere does not cut has an
/// infinite radius and is not tested. (Unreal tests one such half space, chosen for each cell.) Arguments: see
/// or_outside().
template <bool orthographic, class Shape>
LIGHTBIN_INLINE auto boxes_missed(const float* cells, const float* x_edges, const float* y_edges,
                                  const TestedShape<Shape>& light) {
    const Shape& shape = *light.shape;
    auto missed = less(Floats{}, Floats{});  // an empty mask
    if (!std::is_same_v<Shape, ViewBox> || shape.radius < infinity)
        missed = less(broadcast(reach2_of(shape.radius)), distance2(cells, shape.x, shape.y, shape.z));
    return or_outside<orthographic>(missed, cells, x_edges, y_edges, shape.around);
}

/// Returns a word whose bit i says whether a light meets the cell of tile `tile` + i, for each lane i of a vector.
///
/// orthographic  whether the projection is orthographic, which only the half spaces around spots and Boxes depend on
template <bool orthographic, class Light>
std::uint64_t tiles_met(const BlockCells& cells, unsigned tile, const Light& light) {
    const float* const boxes = cells.boxes + tile;
    const auto apart = either(less(broadcast(light.farthest), load_floats(boxes)),
                              less(load_floats(boxes + 64), broadcast(light.nearest)));
    const auto missed = boxes_missed<orthographic>(boxes, cells.edges.x + tile % 8, cells.edges.y + tile, light);
    return ~movemask(either(apart, missed)) & every_lane;
}

/// Sets in met[i] the bits of the tiles whose cells light i meets, for each of up to 64 lights whose bit in `chosen` is
/// set. A light is tested against a vector of tiles only if one of them is in its rectangle. The outer loop runs over
/// vectors of tiles: the cells stay in registers, and no short loop over a light's vectors has a mispredicted end.
///
/// columns, rows  for each light a byte, with a bit for each tile column, or tile row, that its rectangle meets
template <bool orthographic, class Light>
void meet_tiles(const BlockCells& cells, const Light* lights, const std::uint8_t* columns,
                const std::uint8_t* rows, std::uint64_t chosen, std::uint64_t* met) {
    std::uint64_t in_column[8], in_row[8];
    split_bits(columns, in_column);
    split_bits(rows, in_row);
    for (unsigned tile = 0; tile < 64; tile += lanes) {
        if ((cells.drawn >> tile & every_lane) == 0) continue;
        std::uint64_t in_rows = 0, in_columns = 0;
        for (unsigned lane = 0; lane < lanes; lane += 8)
            in_rows |= in_row[(tile + lane) / 8];
        for (unsigned lane = 0; lane < lanes && lane < 8; ++lane)
            in_columns |= in_column[tile % 8 + lane];
        for (std::uint64_t rest = in_rows & in_columns & chosen; rest != 0; rest &= rest - 1) {
            const unsigned light = static_cast<unsigned>(std::countr_zero(rest));
            met[light] |= tiles_met<orthographic>(cells, tile, lights[light]) << tile;
        }
    }
}

}}}}  // namespace lightbin::detail
