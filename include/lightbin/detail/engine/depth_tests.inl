// SPDX-License-Identifier: MIT
// Step 2 of bin.inl: which of a supertile's 8x8 tiles each of its lights is in. With row spans or a depth test, as
// one word a light with a bit per tile: its rectangle, and-ed with its silhouette's row spans and with the tiles
// whose Z bounds it meets. Included once a tier, after step 3, which says in what form it takes the words, and makes
// those of a slice's boxes (slab.inl).
//
//     bit  0  1 ..  7      . . . . . . . .      rows that the rectangle covers     0 1 1 1 0 0 0 0
//          8  9 .. 15      . . # # # # . .      columns                            0 0 1 1 1 1 0 0
//          :               . . # # # # . .
//         56 57 .. 63      . . # # # # . .      Each pair of a light and a tile is tested once.
//                          . . . . . . . .
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The squared distances of a point from `lanes` boxes.
inline Floats distance2(const float* cell, float x, float y, float z) {
    const Floats along_z = distance(broadcast(z), load_floats(cell), load_floats(cell + 64)),
                 along_x = distance(broadcast(x), load_floats(cell + 128), load_floats(cell + 192)),
                 along_y = distance(broadcast(y), load_floats(cell + 256), load_floats(cell + 320));
    return mul(along_x, along_x) + mul(along_y, along_y) + mul(along_z, along_z);
}

/// Of `lanes` boxes, those that a sphere misses. Always inline: returned by a call, GCC 12 drops half of such a mask.
LIGHTBIN_INLINE auto boxes_missed(const float* cell, const TestedLight& light) {
    return less(broadcast(light.reach2), distance2(cell, light.x, light.y, light.z));
}

/// Those beyond the ball or beside the cone of a spot: a box is if its corner that is deepest in one of the half spaces
/// around the cone is not in it. (Unreal tests one such plane, chosen for each box.)
LIGHTBIN_INLINE auto boxes_missed(const float* cell, const TestedSpot& light) {
    const ViewSpot& spot = *light.spot;
    auto missed =
        less(reach2_of(broadcast(spot.ball.radius)), distance2(cell, spot.ball.x, spot.ball.y, spot.ball.z));
    for (unsigned i = 0; i < 4; ++i) {
        const SpotPlane& plane = spot.planes[i];
        const Floats deepest = mul(load_floats(cell + spot.corners[i][0]), broadcast(plane.x)) +
                               mul(load_floats(cell + spot.corners[i][1]), broadcast(plane.y)) +
                               mul(load_floats(cell + spot.corners[i][2]), broadcast(plane.z));
        missed = either(missed, less(broadcast(plane.most), deepest));
    }
    return missed;
}

/// Of the first `lanes` tiles of `cells`, those whose Z bounds or boxes the light meets.
template <DepthTest depth_test, class Light>
inline std::uint64_t tiles_met(const float* cells, const Light& light) {
    const Floats nearest = broadcast(light.nearest), farthest = broadcast(light.farthest);
    std::uint64_t met = 0;
    for (const float* cell = cells; cell < cells + 64 * cell_planes<depth_test>; cell += next_box) {
        auto missed = either(less(farthest, load_floats(cell)), less(load_floats(cell + 64), nearest));
        if constexpr (depth_test != DepthTest::interval) missed = either(missed, boxes_missed(cell, light));
        met |= ~movemask(missed) & every_lane;
    }
    return met;
}

/// What a depth test has to know of a supertile's tiles, see arrange_cells().
template <DepthTest depth_test> struct TestedTiles {
    float cells[64 * cell_planes<depth_test>];
    std::uint64_t lit;     ///< a bit for each tile that has anything to light
    DepthInterval depths;  ///< of all boxes
};

/// The depths of all boxes of the vectors of tiles of which any is `lit`.
template <DepthTest depth_test>
inline DepthInterval depth_range(const float* cells, std::uint64_t lit) {
    float min[lanes], max[lanes];
    Floats least = broadcast(infinity), most = broadcast(-infinity);
    for (unsigned place = 0; place < 64; place += lanes)
        if ((lit >> place & every_lane) != 0)
            for (unsigned plane = 0; plane < 64 * cell_planes<depth_test>; plane += next_box) {
                least = minimum(load_floats(cells + plane + place), least);
                most = maximum(load_floats(cells + plane + 64 + place), most);
            }
    store_floats(min, least);
    store_floats(max, most);
    DepthInterval range = {min[0], max[0]};
    for (std::uint32_t lane = 1; lane < lanes; ++lane)
        range = {min_of(range.min, min[lane]), max_of(range.max, max[lane])};
    return range;
}

/// Adds the tiles that they meet to the words of some of 64 lights with these bytes of columns and rows; the tiles of
/// a vector count if any of them is in the rectangle. A vector of tiles stays in registers while its lights pass: loops
/// over a light's few vectors would be mispredicted once a light.
template <DepthTest depth_test, class Light>
inline void meet_tiles(const TestedTiles<depth_test>& tiles, const Light* lights,
                                       const std::uint8_t* columns, const std::uint8_t* rows,
                                       std::uint64_t some, std::uint64_t* met) {
    std::uint64_t in_column[8], in_row[8];
    split_bits(columns, in_column);
    split_bits(rows, in_row);
    for (unsigned place = 0; place < 64; place += lanes) {
        if ((tiles.lit >> place & every_lane) == 0) continue;
        std::uint64_t in_rows = 0, in_columns = 0;
        for (unsigned lane = 0; lane < lanes; lane += 8)
            in_rows |= in_row[(place + lane) / 8];
        for (unsigned lane = 0; lane < lanes && lane < 8; ++lane)
            in_columns |= in_column[place % 8 + lane];
        for (std::uint64_t rest = in_rows & in_columns & some; rest != 0; rest &= rest - 1) {
            const unsigned light = static_cast<unsigned>(std::countr_zero(rest));
            met[light] |= tiles_met<depth_test>(tiles.cells + place, lights[light]) << place;
        }
    }
}

/// Of the tiles of a supertile, from column 8 x and row `top` on, those within the row spans of visible light i.
inline std::uint64_t silhouette_tiles(const FootprintArrays& lights, std::uint32_t i,
                                                      unsigned x, unsigned top, std::uint64_t tiles) {
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

/// Makes the words of up to 64 lights of a supertile, given by visible index, counted from `first`, with the columns
/// and rows that they cover; and ids of their indices. Lights that are in none of the tiles are dropped. Returns how
/// many are left. `ids` may be `lights`, or before it.
template <Footprint footprint, DepthTest depth_test, bool spots, class Id>
inline std::uint32_t mask_64_lights(const BinJob<Id>& job, unsigned x, unsigned top,
                                                    [[maybe_unused]] const TestedTiles<depth_test>& cells,
                                                    const ListId* lights, std::uint32_t first,
                                                    const std::uint8_t* columns, const std::uint8_t* rows,
                                                    std::uint32_t count, ListId* ids, std::uint64_t* words) {
    std::uint64_t met[64];
    if constexpr (depth_test != DepthTest::none) {
        Tested<spots> tested[64];
        std::uint64_t in_range = 0;
        for (std::uint32_t j = 0; j < count; ++j) {
            const std::uint32_t id = job.lights.ids[first + lights[j]];
            // In its place, as a copy of what was written in parts has to wait for them.
            if constexpr (spots)
                std::construct_at(tested + j, *job.camera, job.lights.spots[id]);
            else
                std::construct_at(tested + j, *job.camera, load_sphere(job.lights.spheres + id));
            met[j] = 0;
            // Most lights that miss all tiles are beyond all of them.
            const bool missed =
                (tested[j].farthest < cells.depths.min) | (cells.depths.max < tested[j].nearest);
            in_range |= std::uint64_t{!missed} << j;
        }
        if (in_range != 0) meet_tiles(cells, tested, columns, rows, in_range, met);
    }
    std::uint32_t left = 0;
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t light = first + lights[j];
        std::uint64_t tiles = spread_rows(rows[j]) & columns[j] * std::uint64_t{0x0101010101010101};
        if constexpr (depth_test != DepthTest::none) tiles &= met[j] & cells.lit;
        if constexpr (footprint == Footprint::silhouette)
            tiles = silhouette_tiles(job.lights, light, x, top, tiles);
        ids[left] = static_cast<ListId>(job.lights.ids[light]);
        words[left] = tiles;
        left += tiles != 0;
    }
    return left;
}

/// Of a list in blocks of ids, whose lights before `begin` were masked so that `left` of them are left: lets those
/// that follow begin at a multiple of 64 if they are of another block, and notes of which one. Returns what their
/// visible indices are counted from.
inline std::uint32_t begin_group(const Scratch& scratch, const SupertileList& list, std::uint32_t begin,
                                 std::uint32_t& left, std::uint64_t* masks) {
    std::uint32_t* const groups = scratch.group_blocks.data() + list.begin / 64;
    const std::uint32_t block = groups[begin / 64];
    if (left % 64 != 0 && groups[left / 64] != block)
        while (left % 64 != 0)
            masks[left++] = 0;
    groups[left / 64] = groups[(left + 63) / 64] = block;
    return scratch.blocks.data()[block].begin;
}

/// Makes the words of a supertile's lights in scratch.masks, and ids of their visible indices. Lights that are in
/// none of the tiles are dropped. Returns how many are left.
template <Footprint footprint, DepthTest depth_test, bool spots, class Id>
std::uint32_t mask_lights(const BinJob<Id>& job, Scratch& scratch, unsigned x, unsigned top,
                                          const SupertileList& list, ListId* all_lights) {
    TestedTiles<depth_test> cells;
    if constexpr (depth_test != DepthTest::none) {
        cells.lit = arrange_cells<depth_test>(job, x, top, cells.cells);
        cells.depths = depth_range<depth_test>(cells.cells, cells.lit);
    }
    const std::uint8_t* columns = scratch.list_columns.data() + list.begin;
    const std::uint8_t* rows = scratch.list_rows.data() + list.begin;
    ListId* lights = all_lights + list.begin;
    std::uint64_t* masks = scratch.masks.reserve(std::uint64_t{list.count} + 64);
    std::uint32_t left = 0;
    for (std::uint32_t begin = 0; begin < list.count; begin += 64) {
        const std::uint32_t count = min_of(list.count - begin, 64u);
        std::uint32_t first = 0;
        if constexpr (sizeof(ListId) == 2) first = begin_group(scratch, list, begin, left, masks);
        left += mask_64_lights<footprint, depth_test, spots>(job, x, top, cells, lights + begin, first,
                                                             columns + begin, rows + begin, count,
                                                             lights + left, masks + left);
    }
    return left;
}

/// Makes the words of a band's supertiles, in the form that step 3 takes. Lights in no tile of a list are taken out of
/// it, where that is known of each by itself: by mask_lights(). Returns where the words end, 0 if no light is left.
template <Footprint footprint, DepthTest depth_test, bool by_slab, bool spots, class Id>
std::uint32_t make_words(const BinJob<Id>& job, Scratch& scratch, unsigned top,
                                         const BandLists<ListId>& band, unsigned width) {
    constexpr bool worded = with_words<footprint, depth_test>;
    const std::uint32_t begin = store_no_words(scratch);
    std::uint32_t used = begin;
    for (unsigned x = 0; x < width; ++x) {
        SupertileList& list = band.lists[x];
        if constexpr (worded && !by_slab)
            if (list.count > 0)
                list.count = mask_lights<footprint, depth_test, spots>(job, scratch, x, top, list, band.ids);
        if (list.count == 0) {
            list = {band.lists->begin, 0, 0};
            continue;
        }
        list.words = used;
        if constexpr (by_slab)
            used = store_slab_words<spots>(job, scratch, x, top, band, list);
        else
            used = store_words<worded, Id>(scratch, band, list);
    }
    return used > begin ? used : 0;
}

}}}}  // namespace lightbin::detail
