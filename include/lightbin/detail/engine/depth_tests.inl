// SPDX-License-Identifier: MIT
// Step 2 of binning: finds in which of a block's 8x8 tiles each of its lights is listed. Included once per tier (ISA).
//
// The depth test works on a word for each light, with a bit for each tile: the tiles of the light's rectangle, and-ed
// with the tiles whose cells it meets.
//
//     bit  0  1 ..  7      . . . . . . . .      rows that the rectangle covers     0 1 1 1 0 0 0 0
//          8  9 .. 15      . . # # # # . .      columns                            0 0 1 1 1 1 0 0
//          :               . . # # # # . .
//         56 57 .. 63      . . # # # # . .      Each pair of a light and a tile is tested once.
//                          . . . . . . . .
//
// The result is the table that Scratch::row_columns_of() describes, from which emit.inl emits the tiles.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/cells.inl>
#include <lightbin/detail/engine/lists.inl>
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

/// Adds to the mask `missed` those of a vector of cells that lie outside of one of the half spaces `around` a light, by
/// the formula in cell_planes.hpp, and returns it. Always inlined: GCC 12 loses half of a mask that a call returns.
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
    auto missed = less(Floats{}, Floats{});  // none
    if (!std::is_same_v<Shape, ViewBox> || shape.ball.radius < infinity)
        missed = less(broadcast(reach2_of(shape.ball.radius)),
                      distance2(cells, shape.ball.x, shape.ball.y, shape.ball.z));
    return or_outside<orthographic>(missed, cells, x_edges, y_edges, shape.around);
}

/// The cells of a block's tiles, with which the depth test compares the block's lights.
struct BlockCells {
    float boxes[6 * 64];   ///< the boxes around the cells, as store_boxes() lays them out
    TileEdges edges;       ///< the edges of the cells' tiles
    std::uint64_t drawn;   ///< a bit for each tile whose Z bounds are not empty
    DepthInterval depths;  ///< an interval that holds the view depths of the cells of all tiles in `drawn`
};

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

/// Returns the interval of the view depths of all cells that share a vector with a tile whose bit in `drawn` is set.
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

/// The boxes around the cells of a depth slice in one block of 8x8 tiles.
///
/// These boxes differ only by column and by row, so the squared distance of a sphere from a box is the sum of x2, which
/// depends on the column, y2, which depends on the row, and z2. These are 17 numbers for 64 tiles, each of which then
/// takes one comparison: a box is missed if  reach2 - z2 - y2 < x2;  cell_boxes.hpp derives the rounding. Where reach2
/// and a distance are infinite the difference is NaN, and the box counts as met.
struct SlabCells {
    static constexpr unsigned vectors = lanes < 8 ? 8 / lanes : 1;

    /// The block begins at column 8 * x and row `top`.
    SlabCells(const SlabBoxes& slab, unsigned x, unsigned top) : z0(slab.z0), z1(slab.z1) {
        for (unsigned i = 0; i < vectors; ++i) {
            x0[i] = load_floats(slab.ends[0] + 8 * x + i * lanes);
            x1[i] = load_floats(slab.ends[1] + 8 * x + i * lanes);
            y0[i] = load_floats(slab.ends[2] + top + i * lanes);
            y1[i] = load_floats(slab.ends[3] + top + i * lanes);
        }
    }

    /// Calls store(row, bits) for each row of tiles, where bits 0 to 7 of `bits` say which cells' boxes a sphere meets.
    template <class Store> LIGHTBIN_INLINE void meet(const TestedLight& light, const Store& store) const {
        const float z_distance = max_of(max_of(z0 - light.z, light.z - z1), 0.0f);
        const Floats left = broadcast(light.reach2 - rounded(z_distance * z_distance));
        Floats x2[vectors];
        float left_by_row[vectors * lanes];
        for (unsigned k = 0; k < vectors; ++k) {
            const Floats along_x = distance(broadcast(light.x), x0[k], x1[k]),
                         along_y = distance(broadcast(light.y), y0[k], y1[k]);
            x2[k] = mul(along_x, along_x);
            store_floats(left_by_row + k * lanes, left - mul(along_y, along_y));
        }
        for (unsigned row = 0; row < 8; ++row) {
            unsigned missed = 0;
            for (unsigned k = 0; k < vectors; ++k)
                missed |= movemask(less(broadcast(left_by_row[row]), x2[k])) << k * lanes;
            store(row, ~missed);
        }
    }

    Floats x0[vectors], x1[vectors], y0[vectors], y1[vectors];
    float z0, z1;
};

/// Finds which boxes around a depth slice's cells each sphere of a block's list meets; the list has no other lights.
/// Stores for each row of tiles a byte for each sphere, with a bit for each of the row's 8 boxes that it meets, in the
/// memory of Scratch::tile_masks. Rows are list.padded_count() bytes apart. Builds of clusters of spheres take 1.3
/// times as long with a 64-bit word for each light instead, as mask_lights() stores it.
inline void store_met_boxes(const BinJob& job, Scratch& scratch, const SlabCells& slab, const BlockList& list) {
    const SlabCells boxes = slab;  // a local copy, so that compilers need not reload it after each store
    const std::uint32_t padded = list.padded_count();
    const std::uint32_t* const ids = scratch.list_ids.data() + list.begin;
    std::uint8_t* const met = reinterpret_cast<std::uint8_t*>(scratch.tile_masks.reserve(padded + std::uint64_t{64}));
    for (std::uint32_t i = 0; i < list.count; ++i)
        boxes.meet(TestedLight(*job.camera, load_sphere(job.lights.view_lights.spheres + ids[i])),
                   [=](unsigned row, unsigned bits) { met[row * padded + i] = static_cast<std::uint8_t>(bits); });
}

/// Takes the place of SlabCells, the boxes around the cells of a depth slice, where no light is tested against them.
struct NoSlab {
    NoSlab(const SlabBoxes&, unsigned, unsigned) {}
};

/// Up to 64 consecutive lights of a block's list, of which lights[i] is set if light i is tested as the type Light.
template <class Light> struct TestedLights {
    Light lights[64];
    std::uint64_t in_range = 0;  ///< bit i: lights[i] was set by add(), and meets the view depths that add() was given

    /// Constructs lights[i] from `from`, in place, as copying an object just stored in parts would stall on store
    /// forwarding. Sets its bit in in_range if it meets `depths`, the interval of the view depths of all the block's
    /// cells: this cheap test excludes most lights that miss all of the cells.
    template <class... From>
    LIGHTBIN_INLINE void add(std::uint32_t i, const DepthInterval& depths, const From&... from) {
        const Light& light = *std::construct_at(lights + i, from...);
        const bool missed = (light.farthest < depths.min) | (depths.max < light.nearest);
        in_range |= std::uint64_t{!missed} << i;
    }
};

/// Tests up to 64 lights of a block's list against the cells of the block's tiles. Stores in met[i] a bit for each tile
/// whose cell light i meets. Spots that are whole spheres are tested as spheres.
///
/// slab           with by_slab, the boxes around the block's cells in a depth slice, which spheres are tested against
/// indices        the lights' indices in the footprint arrays
/// columns, rows  for each light a byte, with a bit for each tile column, or tile row, that its rectangle meets
template <bool by_slab, LightKind kind, class Slab>
void meet_64_lights(const BinJob& job, const BlockCells& cells, const Slab& slab,
                    const std::uint32_t* indices, const std::uint8_t* columns, const std::uint8_t* rows,
                    std::uint32_t count, std::uint64_t* met) {
    const ViewLights lights = job.lights.view_lights;
    const Slab boxes_of_slab = slab;  // a local copy, so that compilers need not reload it after each store
    [[maybe_unused]] TestedLights<TestedLight> spheres;
    const auto add_sphere = [&](std::uint32_t j, const auto&... from) {
        if constexpr (by_slab)
            boxes_of_slab.meet(TestedLight(from...), [&](unsigned row, unsigned bits) {
                met[j] |= std::uint64_t{bits & 0xff} << 8 * row;
            });
        else
            spheres.add(j, cells.depths, from...);
    };
    [[maybe_unused]] TestedLights<TestedShape<ViewSpot>> spots;
    [[maybe_unused]] TestedLights<TestedShape<ViewBox>> boxes;
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t id = job.lights.light_ids[indices[j]];
        const LightKind own_kind = kind == LightKind::mixed ? lights.kind_of(id) : kind;
        met[j] = 0;
        if (own_kind == LightKind::sphere) {
            add_sphere(j, *job.camera, load_sphere(lights.spheres + id));
        } else if (own_kind == LightKind::spot) {
            const ViewSpot& spot = lights.template shape<LightKind::spot>(id);
            if (spot.tolerance > 0)
                spots.add(j, cells.depths, spot);
            else
                add_sphere(j, spot.ball);
        } else {
            boxes.add(j, cells.depths, lights.template shape<LightKind::box>(id));
        }
    }
    const auto meet = [&]<class Light>(const TestedLights<Light>& tested) {
        if (tested.in_range == 0) return;
        if constexpr (!std::is_same_v<Light, TestedLight>)
            if (job.camera->orthographic)
                return meet_tiles<true>(cells, tested.lights, columns, rows, tested.in_range, met);
        meet_tiles<false>(cells, tested.lights, columns, rows, tested.in_range, met);
    };
    if constexpr (!by_slab && kind != LightKind::box) meet(spheres);
    if constexpr (kind == LightKind::spot || kind == LightKind::mixed) meet(spots);
    if constexpr (kind == LightKind::box || kind == LightKind::mixed) meet(boxes);
}

/// Fills the table of Scratch::row_columns_of(), which has for each row of tiles a byte for each light, with a bit for
/// each tile that it is listed in. These are all tiles of its rectangle or, with by_slab, those whose boxes it meets:
/// store_met_boxes(), called before, stored a bit for each met box in Scratch::tile_masks.
template <bool by_slab> void store_rectangles(Scratch& scratch, const BlockList& list) {
    const std::uint32_t padded = list.padded_count();
    std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* const rows = scratch.list_rows.data() + list.begin;
    [[maybe_unused]] const auto* const met = reinterpret_cast<const std::uint8_t*>(scratch.tile_masks.data());
    std::uint8_t* to = scratch.row_columns_of(list);
    std::memset(columns + list.count, 0, 16);
    for (unsigned row = 0; row < 8; ++row, to += padded)
        for (std::uint32_t i = 0; i < padded; i += byte_lanes) {
            const Bytes in_row = load_bytes(rows + i) & broadcast_byte(1u << row);
            Bytes in_columns = load_bytes(columns + i);
            if constexpr (by_slab) in_columns = in_columns & load_bytes(met + row * padded + i);
            store_bytes(to + i, keep_where(in_columns, in_row));
        }
}

/// Fills the table of Scratch::row_columns_of(), which has for each row of tiles a byte for each light, with a bit for
/// each tile that it is listed in. Scratch::tile_masks has a word for each light, with a byte for each row, so the
/// words of 8 lights at a time are transposed as 8x8 bytes.
inline void store_masks(Scratch& scratch, const BlockList& list) {
    const std::uint32_t padded = list.padded_count();
    std::uint64_t* const masks = scratch.tile_masks.data();
    std::memset(masks + list.count, 0, 16 * sizeof *masks);
    std::uint8_t* const row_columns = scratch.row_columns_of(list);
    for (std::uint32_t i = 0; i < padded; i += 8) {
        std::uint64_t rows[8];
        std::memcpy(rows, masks + i, sizeof rows);
        transpose_bytes(rows);
        for (unsigned row = 0; row < 8; ++row)
            store_8_bytes(row_columns + row * padded + i, rows[row]);
    }
}

/// Stores in Scratch::tile_masks the tiles of each light of a list, for the block that begins at column 8 x and row
/// `top`. Removes lights that are in none of its tiles from the list, and replaces the others' indices by ids.
template <bool by_slab, LightKind kind>
void mask_lights(const BinJob& job, Scratch& scratch, const SlabBoxes& slab, unsigned x, unsigned top,
                 BlockList& list) {
    BlockCells cells;
    cells.drawn = arrange_cells(job, x, top, cells.boxes, cells.edges);
    cells.depths = depth_range(cells.boxes, cells.drawn);
    std::conditional_t<by_slab, SlabCells, NoSlab> slab_cells(slab, x, top);
    const std::uint8_t *const columns = scratch.list_columns.data() + list.begin,
                       *const rows = scratch.list_rows.data() + list.begin;
    std::uint32_t* const indices = scratch.list_ids.data() + list.begin;
    std::uint64_t* const masks = scratch.tile_masks.reserve(list.count + std::uint64_t{64});
    std::uint32_t kept = 0;
    for (std::uint32_t begin = 0; begin < list.count; begin += 64) {
        const std::uint32_t count = min_of(list.count - begin, 64u);
        std::uint64_t met[64];
        meet_64_lights<by_slab, kind>(job, cells, slab_cells, indices + begin, columns + begin, rows + begin, count,
                                      met);
        for (std::uint32_t i = begin; i < begin + count; ++i) {
            const std::uint32_t light = indices[i];
            const std::uint64_t tiles = spread_bits(rows[i]) & columns[i] * std::uint64_t{0x0101010101010101} &
                                        met[i - begin] & cells.drawn;
            indices[kept] = job.lights.ids[light];
            masks[kept] = tiles;
            kept += tiles != 0;
        }
    }
    list.count = kept;
}

/// Lists the lights of the blocks of 8x8 tiles in the 8 rows from `top` on, and fills the table of
/// Scratch::row_columns_of() with a bit for each tile that a light is in. Returns the lists, or null if all are empty.
///
/// slab   with by_slab, the boxes around the depth slice's cells, which lights are tested against
/// bands  the lists of several bands of 8 tile rows, kept for the calls for the next bands
/// end    the end of the tile rows that the caller will ask for
template <bool depth_test, bool by_slab, LightKind kind>
const BlockList* list_lights(const BinJob& job, Scratch& scratch, const SlabBoxes& slab, BandLists& bands,
                             unsigned top, unsigned end) {
    constexpr bool slab_alone = by_slab && kind == LightKind::sphere;
    constexpr bool masked = depth_test && !slab_alone;
    const unsigned width = (static_cast<unsigned>(job.camera->x.tiles) + 7) / 8;
    if (top >= bands.end) list_bands<masked>(job, scratch, top, end, bands);
    BlockList* const lists = scratch.lists.reserve(width);
    std::uint32_t used = 0;
    if (band_size(bands, (top - bands.begin) / 8) == 0) return nullptr;
    for (unsigned x = 0; x < width; ++x) {
        BlockList& list = lists[x];
        list = {used, list_block(scratch, bands, (top - bands.begin) / 8, x, used)};
        if constexpr (masked)
            if (list.count > 0) mask_lights<by_slab, kind>(job, scratch, slab, x, top, list);
        if (list.count == 0) continue;
        const std::uint32_t padded = list.padded_count();
        scratch.row_columns.reserve(std::uint64_t{8} * (used + padded) + 64, std::size_t{8} * used);
        if constexpr (masked)
            store_masks(scratch, list);
        else if constexpr (slab_alone)
            store_met_boxes(job, scratch, SlabCells(slab, x, top), list);
        if constexpr (!masked) store_rectangles<slab_alone>(scratch, list);
        used += padded;
    }
    return used == 0 ? nullptr : lists;
}

}}}}  // namespace lightbin::detail
