// SPDX-License-Identifier: MIT
// What a depth test needs to know of a supertile's tiles: their depths and the boxes around their cells, see
// cell_boxes.hpp. Included once a tier whose vectors are no longer than a supertile's row, 8 floats.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The ends of boxes along an axis, from the edges of tiles. See cell_boxes.hpp.
inline Floats low_ends(Floats edges, Floats front, Floats back) {
    return mul(edges, select(less(edges, broadcast(0.0f)), back, front)) - broadcast(flushed);
}
inline Floats high_ends(Floats edges, Floats front, Floats back) {
    return mul(edges, select(less(broadcast(0.0f), edges), back, front)) + broadcast(flushed);
}

/// See cell_boxes.hpp.
inline void store_box(const Camera& camera, float* box, Floats x0, Floats x1, Floats y0,
                                      Floats y1, Floats z0, Floats z1) {
    const Floats front = camera.orthographic ? broadcast(1.0f) : z0, back = camera.orthographic ? broadcast(1.0f) : z1;
    store_floats(box, z0);
    store_floats(box + 64, z1);
    store_floats(box + 128, low_ends(x0, front, back));
    store_floats(box + 192, high_ends(x1, front, back));
    store_floats(box + 256, low_ends(y0, front, back));
    store_floats(box + 320, high_ends(y1, front, back));
}

/// Writes the boxes of some tiles' cells, or for split_box the two before and behind each one's gap. The tiles' Z
/// bounds (minima, maxima, gap_min, gap_max) lie at place `at`.
///
/// Boxes are clamped to the near and far plane: lights in view meet the clamped depths just as the given ones.
template <DepthTest depth_test>
inline void store_boxes(const Camera& camera, float* boxes, Floats x0, Floats x1, Floats y0,
                                        Floats y1, const float* const (&bounds)[4], std::size_t at) {
    const Floats front = broadcast(camera.near_depth), back = broadcast(camera.far_depth);
    const Floats min = load_floats(bounds[0] + at), max = load_floats(bounds[1] + at);
    const Floats largest = broadcast(FLT_MAX);  // 0 * infinity is to be avoided
    const Floats z0 = minimum(select(less(front, min), min, front), largest);
    const Floats z1 = select(less(max, back), max, back);
    if constexpr (depth_test == DepthTest::box) {
        store_box(camera, boxes, x0, x1, y0, y1, z0, z1);
    } else {
        const Floats gap_min = load_floats(bounds[2] + at), gap_max = load_floats(bounds[3] + at);
        const auto gap = less(gap_min, gap_max);
        const Floats end = select(both(gap, less(gap_min, z1)), gap_min, z1);
        const Floats begin = minimum(select(both(gap, less(z0, gap_max)), gap_max, z0), largest);
        store_box(camera, boxes, x0, x1, y0, y1, z0, end);
        store_box(camera, boxes + next_box, x0, x1, y0, y1, begin, z1);
    }
}

/// Writes what a depth test needs to know of a supertile's tiles, from column 8 x and row `top` on, in planes
/// of 64 floats: the minimum and maximum depth, for boxes followed by the ends along x and y; split_box has a
/// second box. Returns a bit for each tile that has anything to light.
template <DepthTest depth_test, class Id>
std::uint64_t arrange_cells(const BinJob<Id>& job, unsigned x, unsigned top, float* cells) {
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles);
    const unsigned rows = min_of(8u, static_cast<unsigned>(job.camera->y.tiles) - top);
    const unsigned columns = min_of(8u, static_cast<unsigned>(width) - 8 * x);
    const float absent[] = {job.slab[0], job.slab[1], infinity, -infinity};
    std::uint64_t lit = 0;
    for (unsigned row = 0; row < rows; ++row) {
        float padded[4][8];
        const float* sides[4];
        for (unsigned side = 0; side < (depth_test == DepthTest::split_box ? 4 : 2); ++side) {
            const float* given = job.bounds[side];
            if (given != nullptr) given += (top + row) * width + 8 * x;
            sides[side] = given;
            if (given != nullptr && columns == 8) continue;
            for (unsigned column = 0; column < 8; ++column)
                padded[side][column] =
                    given != nullptr ? given[min_of(column, columns - 1)] : absent[side];
            sides[side] = padded[side];
        }
        for (unsigned column = 0; column < 8; column += lanes) {
            const unsigned place = 8 * row + column;
            const Floats min = load_floats(sides[0] + column), max = load_floats(sides[1] + column);
            lit |= (~std::uint64_t{movemask(less(max, min))} & ((1u << lanes) - 1)) << place;
            if constexpr (depth_test == DepthTest::interval) {
                store_floats(cells + place, maximum(min, broadcast(-infinity)));  // NaN tests nothing
                store_floats(cells + 64 + place, minimum(max, broadcast(infinity)));
            } else {
                const unsigned at_x = 8 * x + column, at_y = top + row;
                store_boxes<depth_test>(*job.camera, cells + place, load_floats(job.edges[0] + at_x),
                                        load_floats(job.edges[1] + at_x), broadcast(job.edges[2][at_y]),
                                        broadcast(job.edges[3][at_y]), sides, column);
            }
        }
    }
    return lit;
}

/// Fills scratch.slab with the boxes of a slice's cells: those of store_boxes(), which differ by column and by row.
template <class Id> void arrange_slab(const BinJob<Id>& job, Scratch& scratch) {
    const Camera& camera = *job.camera;
    SlabBoxes& slab = scratch.slab;
    slab.z0 = min_of(max_of(job.slab[0], camera.near_depth), FLT_MAX);
    slab.z1 = min_of(job.slab[1], camera.far_depth);
    const Floats front = broadcast(camera.orthographic ? 1.0f : slab.z0),
                 back = broadcast(camera.orthographic ? 1.0f : slab.z1);
    const std::size_t tiles[] = {static_cast<std::size_t>(camera.x.tiles),
                                 static_cast<std::size_t>(camera.y.tiles)};
    float* ends =
        scratch.slab_ends.reserve(2 * (tiles[0] + std::uint64_t{tiles[1]} + 2 * SlabBoxes::padding));
    for (unsigned side = 0; side < 4; ++side) {
        const std::size_t count = tiles[side / 2];
        for (std::size_t i = 0; i < count; i += lanes) {
            // The last vector overlaps the one before it: what follows the edges may be numbers that take long.
            const std::size_t place = i + lanes <= count || count < lanes ? i : count - lanes;
            const Floats edges = load_floats(job.edges[side] + place);
            store_floats(ends + place,
                         side % 2 == 0 ? low_ends(edges, front, back) : high_ends(edges, front, back));
        }
        slab.ends[side] = ends;
        ends += count + SlabBoxes::padding;
    }
}

/// As load_spheres(), of the spheres at `count` places, or as many as a vector has; if those are fewer, others are
/// the last of them.
template <class Place>
inline void load_listed_spheres(const Sphere* spheres, const Place* places,
                                                std::uint32_t count, Floats& x, Floats& y, Floats& z,
                                                Floats& radius) {
    Sphere some[lanes];
    for (std::uint32_t i = 0; i < lanes; ++i)
        some[i] = load_sphere(spheres + places[min_of(i, count - 1)]);
    load_spheres(some, x, y, z, radius);
}

}}}}  // namespace lightbin::detail
