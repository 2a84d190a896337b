// SPDX-License-Identifier: MIT
// Step 2 of binning: finds in which of a block's 8x8 tiles each of its lights is listed. Included once per tier (ISA).
//
// A silhouette and a depth test work on a word for each light, with a bit for each tile: the tiles of the light's
// rectangle, and-ed with the tiles in its silhouette's row spans and with the tiles whose cells it meets.
//
//     bit  0  1 ..  7      . . . . . . . .      rows that the rectangle covers     0 1 1 1 0 0 0 0
//          8  9 .. 15      . . # # # # . .      columns                            0 0 1 1 1 1 0 0
//          :               . . # # # # . .
//         56 57 .. 63      . . # # # # . .      Each pair of a light and a tile is tested once.
//                          . . . . . . . .
//
// The result is the table that Scratch::row_columns_of() describes, from which emit.inl emits the tiles.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/engine/cells.inl>
#include <lightbin/detail/engine/lists.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Returns the distances of coordinates from the intervals low to high. They are 0 inside an interval.
inline Floats distance(Floats coordinate, Floats low, Floats high) {
    return maximum(maximum(low - coordinate, coordinate - high), broadcast(0.0f));
}

/// Returns the squared distances of a point from a vector of boxes, whose arrays store_box() lays out.
inline Floats distance2(const float* boxes, float x, float y, float z) {
    const Floats along_z = distance(broadcast(z), load_floats(boxes), load_floats(boxes + 64)),
                 along_x = distance(broadcast(x), load_floats(boxes + 128), load_floats(boxes + 192)),
                 along_y = distance(broadcast(y), load_floats(boxes + 256), load_floats(boxes + 320));
    return mul(along_x, along_x) + mul(along_y, along_y) + mul(along_z, along_z);
}

/// Returns a mask of the boxes in a vector that a sphere misses. Always inlined: GCC 12 loses half of a returned mask.
LIGHTBIN_INLINE auto boxes_missed(const float* boxes, const TestedLight& light) {
    return less(broadcast(light.reach2), distance2(boxes, light.x, light.y, light.z));
}

/// Returns a mask of the boxes in a vector that a spot misses: boxes that its ball misses, or that lie outside one of
/// the four planes around its cone. A box lies outside a plane if its deepest corner does, the corner farthest along
/// the plane's inner side. (Unreal tests one such plane, chosen for each box.)
LIGHTBIN_INLINE auto boxes_missed(const float* boxes, const TestedSpot& light) {
    const ViewSpot& spot = *light.spot;
    auto missed = less(broadcast(reach2_of(spot.ball.radius)), distance2(boxes, spot.ball.x, spot.ball.y, spot.ball.z));
    for (unsigned i = 0; i < 4; ++i) {
        const SpotPlane& plane = spot.planes[i];
        const Floats deepest = mul(load_floats(boxes + spot.corners[i][0]), broadcast(plane.x)) +
                               mul(load_floats(boxes + spot.corners[i][1]), broadcast(plane.y)) +
                               mul(load_floats(boxes + spot.corners[i][2]), broadcast(plane.z));
        missed = either(missed, less(broadcast(plane.offset), deepest));
    }
    return missed;
}

/// Returns a bit for each tile in a vector whose cell a light meets.
///
/// cells  the arrays of arrange_cells(), from the vector's first tile on
template <DepthTest depth_test, class Light> std::uint64_t tiles_met(const float* cells, const Light& light) {
    const Floats nearest = broadcast(light.nearest), farthest = broadcast(light.farthest);
    std::uint64_t met = 0;
    for (const float* cell = cells; cell < cells + 64 * cell_planes<depth_test>; cell += next_box) {
        auto missed = either(less(farthest, load_floats(cell)), less(load_floats(cell + 64), nearest));
        if constexpr (depth_test != DepthTest::interval) missed = either(missed, boxes_missed(cell, light));
        met |= ~movemask(missed) & every_lane;
    }
    return met;
}

/// The cells of a block's tiles, with which a depth test compares the block's lights.
template <DepthTest depth_test> struct BlockCells {
    float planes[64 * cell_planes<depth_test>];
    std::uint64_t drawn;   ///< a bit for each drawn tile, that is, each with Z bounds that are not empty
    DepthInterval depths;  ///< encloses the view depths of drawn tiles' cells, and of tiles in a SIMD vector with one
};

/// Returns an interval that encloses the view depths of the cells of all tiles with a bit in `drawn`.
template <DepthTest depth_test> DepthInterval depth_range(const float* cells, std::uint64_t drawn) {
    float min[lanes], max[lanes];
    Floats nearest = broadcast(infinity), farthest = broadcast(-infinity);
    for (unsigned tile = 0; tile < 64; tile += lanes)
        if ((drawn >> tile & every_lane) != 0)
            for (unsigned box = 0; box < 64 * cell_planes<depth_test>; box += next_box) {
                nearest = minimum(load_floats(cells + box + tile), nearest);
                farthest = maximum(load_floats(cells + box + 64 + tile), farthest);
            }
    store_floats(min, nearest);
    store_floats(max, farthest);
    DepthInterval range = {min[0], max[0]};
    for (std::uint32_t lane = 1; lane < lanes; ++lane)
        range = {min_of(range.min, min[lane]), max_of(range.max, max[lane])};
    return range;
}

/// Sets in met[i] the bits of the tiles whose cells light i meets, for each of 64 lights whose bit in `chosen` is set.
/// A light is tested against a vector of tiles only if one of them is in its rectangle. The outer loop runs over
/// vectors of tiles: the cells stay in registers, and no short loop over a light's vectors has a mispredicted end.
///
/// columns, rows  a byte for each light: a bit for each tile column (or row) of the block that its rectangle meets
template <DepthTest depth_test, class Light>
void meet_tiles(const BlockCells<depth_test>& cells, const Light* lights, const std::uint8_t* columns,
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
            met[light] |= tiles_met<depth_test>(cells.planes + tile, lights[light]) << tile;
        }
    }
}

/// Returns the bits of `tiles` whose tiles lie within the row spans of a light's silhouette.
///
/// i       the light's index in the footprint arrays
/// x, top  the block begins at tile column 8 * x and tile row `top`
inline std::uint64_t silhouette_tiles(const FootprintArrays& lights, std::uint32_t i, unsigned x, unsigned top,
                                      std::uint64_t tiles) {
    if (tiles == 0 || lights.span_begin[i] == FootprintArrays::whole_rectangle) return tiles;
    std::uint64_t spanned = 0;
    for (unsigned row = static_cast<unsigned>(std::countr_zero(tiles)) / 8,
                  last = 7 - static_cast<unsigned>(std::countl_zero(tiles)) / 8;
         row <= last; ++row) {
        const RowSpan span = lights.spans[lights.span_begin[i] + (top + row - lights.y0[i])];
        const bool here = span.first <= span.last && span.first < 8 * x + 8 && span.last >= 8 * x;
        spanned |= std::uint64_t{here ? covered(span.first, span.last, 8 * x) & 0xff : 0} << 8 * row;
    }
    return tiles & spanned;
}

/// Tests up to 64 lights of a block against its tiles' cells, the parts of the view frustum that the tiles show between
/// their Z bounds. Stores in met[i] a bit for each tile whose cell light i meets.
///
/// indices        the lights' indices in the footprint arrays
/// columns, rows  a byte for each light: a bit for each tile column (or row) of the block that its rectangle meets
template <DepthTest depth_test, bool spots, class Id>
void meet_64_lights(const BinJob<Id>& job, const BlockCells<depth_test>& cells, const std::uint32_t* indices,
                    const std::uint8_t* columns, const std::uint8_t* rows, std::uint32_t count, std::uint64_t* met) {
    Tested<spots> tested[64];
    std::uint64_t in_range = 0;
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t id = job.lights.ids[indices[j]];
        // Constructed in place: copying what was just stored in parts would stall on store forwarding.
        if constexpr (spots)
            std::construct_at(tested + j, *job.camera, job.lights.spots[id]);
        else
            std::construct_at(tested + j, *job.camera, load_sphere(job.lights.spheres + id));
        met[j] = 0;
        // Most lights that miss all of the block's cells lie outside the depths of all cells together.
        const bool missed = (tested[j].farthest < cells.depths.min) | (cells.depths.max < tested[j].nearest);
        in_range |= std::uint64_t{!missed} << j;
    }
    if (in_range != 0) meet_tiles(cells, tested, columns, rows, in_range, met);
}

/// Fills the table of Scratch::row_columns_of(): each light of a list is in all tiles of its rectangle in the block.
///
/// by_slab  each light is only in the tiles of its rectangle whose boxes it meets; store_met_boxes(), called before,
///          stored a bit for each met box in Scratch::tile_masks
template <bool by_slab> void store_rectangles(Scratch& scratch, const BlockList& list) {
    const std::uint32_t padded = list.padded_count();
    std::uint8_t* const columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* const rows = scratch.list_rows.data() + list.begin;
    const std::uint8_t* met = reinterpret_cast<const std::uint8_t*>(scratch.tile_masks.data());
    std::uint8_t* to = scratch.row_columns_of(list);
    std::memset(columns + list.count, 0, 16);
    for (unsigned row = 0; row < 8; ++row, to += padded, met += padded)
        for (std::uint32_t i = 0; i < padded; i += byte_lanes) {
            const Bytes in_row = load_bytes(rows + i) & broadcast_byte(1u << row);
            const Bytes in_columns = by_slab ? load_bytes(columns + i) & load_bytes(met + i) : load_bytes(columns + i);
            store_bytes(to + i, keep_where(in_columns, in_row));
        }
}

/// Stores the table of Scratch::row_columns_of() out of the list's words in Scratch::tile_masks. A word has a byte for
/// each row, so the words of 8 lights are transposed as 8x8 bytes.
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

/// Tests a list's spheres against the boxes of a slice, for the block that begins at tile column 8 * x and tile row
/// `top`. Stores a bit for each box that is met in Scratch::tile_masks, laid out as Scratch::row_columns_of() is.
///
/// The boxes of a slice differ only by column and by row, so the squared distance of a sphere from a box is the sum of
/// x2, which depends on the column, y2, which depends on the row, and z2. These are 17 numbers for 64 tiles, each of
/// which then takes one comparison: a box is missed if  reach2 - z2 - y2 < x2;  cell_boxes.hpp derives the rounding.
/// Where reach2 and a distance are infinite the difference is NaN, and the box counts as met. Depths need no test of
/// their own: a slice's lists hold only lights that meet its depths.
template <class Id>
void store_met_boxes(const BinJob<Id>& job, Scratch& scratch, const SlabBoxes& slab, unsigned x, unsigned top,
                     const BlockList& list) {
    constexpr unsigned vectors = lanes < 8 ? 8 / lanes : 1;
    Floats x0[vectors], x1[vectors], y0[vectors], y1[vectors];
    for (unsigned i = 0; i < vectors; ++i) {
        x0[i] = load_floats(slab.ends[0] + 8 * x + i * lanes);
        x1[i] = load_floats(slab.ends[1] + 8 * x + i * lanes);
        y0[i] = load_floats(slab.ends[2] + top + i * lanes);
        y1[i] = load_floats(slab.ends[3] + top + i * lanes);
    }
    const std::uint32_t padded = list.padded_count();
    const std::uint32_t* const ids = scratch.list_ids.data() + list.begin;
    std::uint8_t* const met = reinterpret_cast<std::uint8_t*>(scratch.tile_masks.reserve(padded + std::uint64_t{64}));
    for (std::uint32_t i = 0; i < list.count; ++i) {
        const TestedLight light(*job.camera, load_sphere(job.lights.spheres + ids[i]));
        const float z_distance = max_of(max_of(slab.z0 - light.z, light.z - slab.z1), 0.0f);
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
            met[row * padded + i] = static_cast<std::uint8_t>(~missed);
        }
    }
}

/// Stores in Scratch::tile_masks the tiles of each light of a list, for the block that begins at tile column 8 * x and
/// tile row `top`. Removes lights that are in no tile of the block, and replaces the remaining lights' indices by ids.
template <Footprint footprint, DepthTest depth_test, bool spots, class Id>
void mask_lights(const BinJob<Id>& job, Scratch& scratch, unsigned x, unsigned top, BlockList& list) {
    [[maybe_unused]] BlockCells<depth_test> cells;
    if constexpr (depth_test != DepthTest::none) {
        cells.drawn = arrange_cells<depth_test>(job, x, top, cells.planes);
        cells.depths = depth_range<depth_test>(cells.planes, cells.drawn);
    }
    const std::uint8_t *const columns = scratch.list_columns.data() + list.begin,
                       *const rows = scratch.list_rows.data() + list.begin;
    std::uint32_t* const indices = scratch.list_ids.data() + list.begin;
    std::uint64_t* const masks = scratch.tile_masks.reserve(list.count + std::uint64_t{64});
    std::uint32_t left = 0;
    for (std::uint32_t begin = 0; begin < list.count; begin += 64) {
        const std::uint32_t count = min_of(list.count - begin, 64u);
        [[maybe_unused]] std::uint64_t met[64];
        if constexpr (depth_test != DepthTest::none)
            meet_64_lights<depth_test, spots>(job, cells, indices + begin, columns + begin, rows + begin, count, met);
        for (std::uint32_t i = begin; i < begin + count; ++i) {
            const std::uint32_t light = indices[i];
            std::uint64_t tiles = spread_bits(rows[i]) & columns[i] * std::uint64_t{0x0101010101010101};
            if constexpr (depth_test != DepthTest::none)
                tiles &= met[i - begin] & cells.drawn;
            if constexpr (footprint == Footprint::silhouette) tiles = silhouette_tiles(job.lights, light, x, top, tiles);
            indices[left] = job.lights.ids[light];
            masks[left] = tiles;
            left += tiles != 0;
        }
    }
    list.count = left;
}

/// Lists the lights of each block in the band (row of blocks) that begins at tile row `top`, and fills the table of
/// Scratch::row_columns_of() with the tiles of each. Returns the lists of the blocks, or null if all are empty.
///
/// slab   the boxes around the depth slice's cells; only read with by_slab, when lights are tested against these boxes
/// bands  the lists of several bands at a time, kept for the calls for the next bands
/// end    the end of the tile rows that the caller will ask for
template <Footprint footprint, DepthTest depth_test, bool by_slab, bool spots, class Id>
const BlockList* list_lights(const BinJob<Id>& job, Scratch& scratch, const SlabBoxes& slab, BandLists& bands,
                             unsigned top, unsigned end) {
    constexpr bool masked = has_tests<footprint, depth_test> && !by_slab;
    const unsigned width = (static_cast<unsigned>(job.camera->x.tiles) + 7) / 8;
    if (top >= bands.end) list_bands<masked>(job, scratch, top, end, bands);
    BlockList* const lists = scratch.lists.reserve(width);
    std::uint32_t used = 0;
    if (band_size(bands, (top - bands.begin) / 8) == 0) return nullptr;
    for (unsigned x = 0; x < width; ++x) {
        BlockList& list = lists[x];
        list = {used, list_block(scratch, bands, (top - bands.begin) / 8, x, used)};
        if constexpr (masked)
            if (list.count > 0) mask_lights<footprint, depth_test, spots>(job, scratch, x, top, list);
        if (list.count == 0) continue;
        const std::uint32_t padded = list.padded_count();
        scratch.row_columns.reserve(std::uint64_t{8} * (used + padded) + 64, std::size_t{8} * used);
        if constexpr (masked)
            store_masks(scratch, list);
        else if constexpr (by_slab)
            store_met_boxes(job, scratch, slab, x, top, list);
        if constexpr (!masked) store_rectangles<by_slab>(scratch, list);
        used += padded;
    }
    return used == 0 ? nullptr : lists;
}

}}}}  // namespace lightbin::detail
