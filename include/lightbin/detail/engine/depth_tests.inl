// SPDX-License-Identifier: MIT
// Step 2 of binning, with a depth test: finds in which of a block's 8x8 tiles each of its lights is listed. Included
// once per tier (instruction set).
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
#include <lightbin/detail/engine/slab_tests.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Takes the place of SlabCells, the boxes around the cells of a depth slice, where spheres are tested against a box
/// for each cell, too, as spots and boxes always are.
struct NoSlab {
    NoSlab(const SlabBoxes&, unsigned, unsigned) {}
};

/// Up to 64 consecutive lights of a block's list: lights[i] is set if light i is tested as an object of the type Light.
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
/// slab           SlabCells, the boxes around the block's cells in a depth slice, which spheres are tested against; or
///                NoSlab
/// ids            the lights' ids in FootprintArrays
/// columns, rows  for each light a byte, with a bit for each tile column, or tile row, that its rectangle meets
template <LightKind kind, class Slab>
void meet_64_lights(const BinJob& job, const BlockCells& cells, const Slab& slab, const std::uint32_t* ids,
                    const std::uint8_t* columns, const std::uint8_t* rows, std::uint32_t count, std::uint64_t* met) {
    constexpr bool by_slab = std::is_same_v<Slab, SlabCells>;
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
        const std::uint32_t id = job.lights.light_of(ids[j]);
        const LightKind own_kind = kind == LightKind::mixed ? lights.kind_of(id) : kind;
        met[j] = 0;
        if (own_kind == LightKind::sphere) {
            add_sphere(j, *job.camera, load_sphere(lights.spheres + id));
        } else if (own_kind == LightKind::spot) {
            const ViewSpot& spot = lights.template shape<LightKind::spot>(id);
            if (spot.tolerance > 0)
                spots.add(j, cells.depths, spot);
            else
                add_sphere(j, Sphere{spot.x, spot.y, spot.z, spot.radius});
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
/// each tile that it is listed in, with the bytes of the words in Scratch::tile_masks.
inline void store_masks(Scratch& scratch, const BlockList& list) {
    const std::uint32_t padded = list.padded_count();
    std::uint8_t* const row_columns = scratch.reserve_row_columns(list);
    const std::uint64_t* const masks = scratch.tile_masks.data();
    std::memset(row_columns, 0, std::size_t{8} * padded);
    for (std::uint32_t i = 0; i < list.count; ++i)
        for (unsigned row = 0; row < 8; ++row)
            row_columns[row * padded + i] = static_cast<std::uint8_t>(masks[i] >> 8 * row);
}

/// Stores in Scratch::tile_masks the tiles of each light of a list, for the block that begins at column 8 x and row
/// `top`. Removes lights that are in none of its tiles from the list.
template <LightKind kind, class Slab>
void mask_lights(const BinJob& job, Scratch& scratch, const Slab& slab, unsigned x, unsigned top, BlockList& list) {
    BlockCells cells;
    arrange_cells(job, x, top, cells);
    const std::uint8_t *const columns = scratch.list_columns.data() + list.begin,
                       *const rows = scratch.list_rows.data() + list.begin;
    std::uint32_t* const ids = scratch.list_ids.data() + list.begin;
    std::uint64_t* const masks = scratch.tile_masks.reserve(list.count);
    std::uint32_t kept = 0;
    for (std::uint32_t begin = 0; begin < list.count; begin += 64) {
        const std::uint32_t count = min_of(list.count - begin, 64u);
        std::uint64_t met[64];
        meet_64_lights<kind>(job, cells, slab, ids + begin, columns + begin, rows + begin, count, met);
        for (std::uint32_t i = begin; i < begin + count; ++i) {
            const std::uint64_t tiles = spread_bits(rows[i]) & columns[i] * std::uint64_t{0x0101010101010101} &
                                        met[i - begin] & cells.drawn;
            ids[kept] = ids[i];
            masks[kept] = tiles;
            kept += tiles != 0;
        }
    }
    list.count = kept;
}

/// Finds the tiles in which the lights of a list are listed if there is a depth test, for the block that begins at tile
/// column 8 x and tile row `top`: removes from the list the lights that meet no cell, and fills the table of
/// Scratch::row_columns_of() with the tiles of the others.
template <Tested tested, LightKind kind>
void find_tested_tiles(const BinJob& job, Scratch& scratch, const SlabBoxes& slab, unsigned x, unsigned top,
                       BlockList& list) {
    if constexpr (slab_alone<tested, kind>) {
        store_met_boxes(job, scratch, SlabCells(slab, x, top), list);
        const std::uint8_t* const met = scratch.met_boxes.data();
        store_rectangles(scratch, list, [met](Bytes columns, std::size_t at) {
            return static_cast<Bytes>(columns & load_bytes(met + at));
        });
    } else {
        const std::conditional_t<tested == Tested::slab, SlabCells, NoSlab> slab_cells(slab, x, top);
        mask_lights<kind>(job, scratch, slab_cells, x, top, list);
        if (list.count > 0) store_masks(scratch, list);
    }
}

}}}}  // namespace lightbin::detail
