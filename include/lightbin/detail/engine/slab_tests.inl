// SPDX-License-Identifier: MIT
// Tests a sphere against the cells of a depth slice, all of which lie between the same two depths. Included once per
// tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/engine/cell_tests.inl>
#include <lightbin/detail/engine/lists.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The boxes around the cells of a depth slice in one block of 8x8 tiles.
///
/// These boxes differ only by column and by row, so the squared distance of a sphere from a box is the sum of x2, which
/// depends on the column, y2, which depends on the row, and z2. These are 17 numbers for 64 tiles, each of which then
/// takes one comparison: a box is missed if  reach2 - z2 - y2 < x2;  cell_boxes.hpp derives the rounding. Where reach2
/// and a distance are infinite the difference is NaN, and the box counts as met.
struct SlabCells {
    static constexpr unsigned vectors = lanes < 8 ? 8 / lanes : 1;

    /// slab    the boxes around all cells of the depth slice
    /// x, top  the block of 8x8 tiles begins at tile column 8 * x and tile row `top`
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
/// Stores in Scratch::met_boxes for each row of tiles a byte for each sphere, with a bit for each of the row's 8 boxes
/// that it meets. Rows are list.padded_count() bytes apart. Builds of clusters of spheres take 1.3 times as long with a
/// 64-bit word for each light instead, as mask_lights() stores it.
inline void store_met_boxes(const BinJob& job, Scratch& scratch, const SlabCells& slab, const BlockList& list) {
    const SlabCells boxes = slab;  // a local copy, so that compilers need not reload it after each store
    const std::uint32_t padded = list.padded_count();
    const std::uint32_t* const ids = scratch.list_ids.data() + list.begin;
    std::uint8_t* const met = scratch.met_boxes.reserve(std::uint64_t{8} * padded + widest_vector);
    for (std::uint32_t i = 0; i < list.count; ++i)
        boxes.meet(TestedLight(*job.camera, load_sphere(job.lights.view_lights.spheres + ids[i])),
                   [=](unsigned row, unsigned bits) { met[row * padded + i] = static_cast<std::uint8_t>(bits); });
}

}}}}  // namespace lightbin::detail
