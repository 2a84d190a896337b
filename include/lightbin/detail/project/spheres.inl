// SPDX-License-Identifier: MIT
// Spheres to tile rectangles, a vector of lights at a time. Included once a tier, after its vectors; the
// scalar tier's hold one light. All do the same operations in the same order, so they give the same bytes.
//
// Everything is a 2-D problem in slope space: tile edges are planes x = s z through the eye, so along each
// image axis a sphere becomes a disc of centre (c, z), c being x or y, and its bounds are the slopes of two
// tangents (Mara and McGuire, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere", JCGT
// 2(2), 2013).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/world_to_view.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Slopes of the tangents from the origin to the discs (c, z, r), for z - r > 0, where `e` = (z - r)(z + r) and
/// `per_e` = 1 / e.
///
/// Each sum is of terms of one sign, so errors only add up: with u the unit roundoff, e is within 3u, c^2 + e
/// within 4u, its root 3u, q 5u, the outer slope 10u and the inner 9u of the truth, each relative to itself.
/// (The roots' product is (c^2 - r^2) / e.)
template <class Reals>
inline void tangent_slopes(Reals c, Reals z, Reals r, Reals e, Reals per_e, Reals& low,
                                           Reals& high) {
    const Reals a = abs(c);
    const Reals q = mul(a, z) + mul(r, sqrt(mul(a, a) + e));
    const Reals outer = mul(q, per_e), inner = mul(a - r, a + r) / q;
    const auto negative = less(c, Reals{});
    low = select_unpredicted(negative, -outer, inner);  // on which side of the view axis a light is
    high = select_unpredicted(negative, -inner, outer);
}

/// Bounds on c / z over the part of the discs (c, z, r) at depth near_z or more; infinite where double
/// precision can't tell. For discs that cross the near plane, z - r <= near_z <= z + r. Doubles that hold
/// floats: their products are exact, none overflows.
///
/// That part is convex, so its largest slope is at the tangent point if that lies beyond the near plane, else
/// at the corner where the circle meets the plane. The tangent bounds the whole disc, so it is right whenever
/// it exists: the corner is taken only when it is beyond doubt. The smallest slope is the largest of -c.
inline void clipped_slopes(Doubles c, Doubles z, Doubles r, double near_depth, Doubles& low,
                                           Doubles& high) {
    const Doubles near_z = broadcast(near_depth), zero = broadcast(0.0), infinite = broadcast(static_cast<double>(infinity));
    const Doubles a = abs(c);
    const Doubles h2 = mul(r - (near_z - z), r + (near_z - z));  // half chord, squared
    const Doubles h2_error = mul(r, r) * 0x1p-50;
    const Doubles h = sqrt(maximum(h2, zero) + h2_error);  // rounded up
    const Doubles h_low = sqrt(maximum(h2 - h2_error, zero));

    // Along the circle into the region the corner (c + h, near_z) moves by (z - near_z, h), and c / z grows by
    // (near_z, -(c + h)) a step: the tangent point lies beyond the plane iff  near_z (z - near_z) > h (c +
    // h). Here for c = a (outer) and c = -a (inner).
    const Doubles doubt = (mul(h, h) + mul(a, h) + mul(near_z, abs(z) + near_z)) * 0x1p-48;
    const Doubles tangent_side = mul(near_z, z - near_z) + doubt, square = mul(h_low, h_low);
    const auto outer_cut = less(tangent_side, square + mul(a, h_low));
    const auto inner_cut = less(tangent_side, square - mul(a, h));
    const Doubles corner_error = (a + h) * 0x1p-48;
    const Doubles outer_corner = (h + a + corner_error) / near_z;
    const Doubles inner_corner = (h - a + corner_error) / near_z;

    // Tangent length, squared: not positive with the eye on the surface or inside.
    const Doubles squares = mul(a, a) + mul(z, z), t2 = squares - mul(r, r);
    const Doubles error = (squares + mul(r, r)) * 0x1p-50 / t2 + 0x1p-48;  // relative, of a slope
    const auto sure = both(less(zero, t2), less_equal(error, broadcast(0x1p-20)));
    // As in tangent_slopes: of the two forms of the same root, the one whose sums are of one sign. With the
    // eye beside the centre's far side the outer tangent points backward.
    const Doubles az = mul(a, z), rt = mul(r, sqrt(t2)), e = mul(z - r, z + r);
    const auto behind = less(z, zero);
    const Doubles outer = (az + rt) / e;
    const Doubles inner = select(behind, rt - az, mul(r - a, r + a)) / select(behind, e, rt + az);
    const Doubles high_outer = select(
        outer_cut, outer_corner, select(both(sure, less(r, z)), outer + mul(abs(outer), error), infinite));
    const Doubles high_inner =
        select(inner_cut, inner_corner, select(sure, inner + mul(abs(inner), error), infinite));
    const auto negative = less(c, zero);
    low = -select(negative, high_outer, high_inner);
    high = select(negative, high_inner, high_outer);
}

/// Writes the tiles that the extents low..high touch, slopes (perspective) or view-space coordinates
/// (orthographic), grown by the axis' margin. Takes those out of the viewport out of `visible`.
template <class Real, class Reals, class Mask>
inline Mask tile_span(const ImageAxis& axis, Reals low, Reals high, Mask visible,
                                      std::uint16_t* first, std::uint16_t* last) {
    const Real scale = static_cast<Real>(axis.scale), offset = static_cast<Real>(axis.offset),
               margin = static_cast<Real>(axis.margin);
    low = mul(low, broadcast(scale)) + offset - margin;
    high = mul(high, broadcast(scale)) + offset + margin;
    const Reals zero = Reals{}, inside = broadcast(static_cast<Real>(axis.last_tile_centre));
    store_tiles(first, minimum(maximum(low, zero), inside));
    store_tiles(last, minimum(maximum(high, zero), inside));
    return both(visible, both(less_equal(zero, high), less_equal(low, broadcast(static_cast<Real>(axis.limit)))));
}

/// The general case, in double, for some of a chunk's lights: near-plane straddlers, eye inside, tiny, huge and infinite
/// spheres, bad input. Sets the bits of those in view in `visible`.
inline void project_carefully(const Camera& camera, const Sphere* spheres,
                                              const std::uint8_t* places, std::uint32_t count,
                                              ChunkRects& rects, unsigned* visible, ProjectCounts& counts) {
    for (std::uint32_t used; count > 0; count -= used, places += used) {
        used = min_of(count, double_lanes);
        Sphere gathered[lanes];
        for (std::uint32_t i = 0; i < lanes; ++i)
            gathered[i] = load_sphere(spheres + places[i < used ? i : 0]);
        Floats floats[4];
        load_spheres(gathered, floats[0], floats[1], floats[2], floats[3]);
        const Doubles x = widened(floats[0], 0) * static_cast<double>(camera.x.sign);
        const Doubles y = widened(floats[1], 0) * static_cast<double>(camera.y.sign);
        const Doubles z = widened(floats[2], 0) * static_cast<double>(camera.z_sign);
        const Doubles radius = widened(floats[3], 0), most = broadcast(static_cast<double>(FLT_MAX));
        const double near_depth = static_cast<double>(camera.near_depth);
        const auto good = both(both(less_equal(abs(x), most), less_equal(abs(y), most)),
                               both(less_equal(abs(z), most), less_equal(broadcast(0.0), radius)));
        const Doubles nearest = z - radius, farthest = z + radius;
        auto seen = and_not(good, either(less(farthest, broadcast(near_depth)),
                                         less(broadcast(static_cast<double>(camera.far_depth)), nearest)));
        // Not 0, so that no root is: much less than the rounding of any float.
        const Doubles r = maximum(radius, broadcast(0x1p-400));
        Doubles left = x - r, right = x + r, bottom = y - r, top = y + r;
        if (!camera.orthographic) {
            const auto whole = less(broadcast(near_depth), nearest);
            const Doubles e = mul(nearest, farthest), per_e = 1.0 / e;
            Doubles low, high;
            tangent_slopes(x, z, r, e, per_e, low, high);
            clipped_slopes(x, z, r, near_depth, left, right);
            left = select(whole, low, left);
            right = select(whole, high, right);
            tangent_slopes(y, z, r, e, per_e, low, high);
            clipped_slopes(y, z, r, near_depth, bottom, top);
            bottom = select(whole, low, bottom);
            top = select(whole, high, top);
        }
        alignas(64) std::uint16_t x0[double_lanes], y0[double_lanes], x1[double_lanes], y1[double_lanes];
        seen = tile_span<double>(camera.x, left, right, seen, x0, x1);
        seen = tile_span<double>(camera.y, bottom, top, seen, y0, y1);
        counts.rejected += used - static_cast<std::uint32_t>(std::popcount(movemask(good) & ((1u << used) - 1)));
        const unsigned in_view = movemask(seen);
        for (std::uint32_t i = 0; i < used; ++i) {
            const std::uint32_t place = places[i];
            rects.x0[place] = x0[i];
            rects.y0[place] = y0[i];
            rects.x1[place] = x1[i];
            rects.y1[place] = y1[i];
            visible[place / lanes] |= (in_view >> i & 1) << place % lanes;
        }
    }
}

/// What each vector of lights is asked first, in every lane: broadcasting it again would take narrow vectors as long as
/// asking.
struct ViewLanes {
    explicit ViewLanes(const Camera& camera)
        : sign_x(broadcast(camera.x.sign)), sign_y(broadcast(camera.y.sign)), sign_z(broadcast(camera.z_sign)),
          side_x(broadcast(camera.x.normal)), side_xz(broadcast(camera.x.normal_z)), side_y(broadcast(camera.y.normal)),
          side_yz(broadcast(camera.y.normal_z)), front(broadcast(camera.near_depth)), back(broadcast(camera.far_depth)) {}

    Floats sign_x, sign_y, sign_z, side_x, side_xz, side_y, side_yz, front, back;
};

/// Which of a vector's lights are out of view beyond doubt, if floats hold them; x and y are as in an ImageAxis and z is
/// the view depth, of their balls, whose `size` is |x| + |y| + |z| + r.
///
/// Rounding is monotone and near and far are floats, so comparing rounded sums with them is exact. The distance to a side
/// plane is within 4u of the sizes that it is made of.
LIGHTBIN_INLINE auto out_of_view(const ViewLanes& view, Floats x, Floats y, Floats z, Floats r,
                                                 Floats nearest, Floats farthest, Floats size) {
    const Floats aside = maximum(mul(abs(x), view.side_x) + mul(z, view.side_xz),
                                 mul(abs(y), view.side_y) + mul(z, view.side_yz));
    return either(either(less(farthest, view.front), less(view.back, nearest)),
                  less(size * 0x1p-21f, aside - r));
}

/// Appends the footprints of those of the lights first..first + count - 1 that are in view.
///
/// In float where the error bound of tangent_slopes holds: no over- or underflow (sizes of 2^-40 to 2^40) and
/// the whole sphere beyond the near plane. Comparisons are arranged so that NaN goes the careful way.
inline void project(const Camera& camera, const LightSource& source, std::uint32_t first,
                                    std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts) {
    ChunkRects rects;
    unsigned visible[ChunkRects::size / lanes];
    std::uint8_t careful[ChunkRects::size];
    Sphere chunk[ChunkRects::size], padded[lanes];
    const MoveLanes move(source.to_view);
    const ViewLanes view(camera);
    const bool moved = source.to_view != nullptr;
    // Copies are made a few at a time, so that the next lights are fetched while these are projected.
    const std::uint32_t batch = source.copy != nullptr ? 32 : ChunkRects::size;
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, batch);
        // Where spheres come from, and where they are in view space.
        Sphere* const own = source.kept != nullptr ? source.kept + first : chunk;
        const Sphere* const given = source.spheres != nullptr ? source.spheres + first : own;
        const Sphere* const spheres = moved ? own : given;
        if (source.copy != nullptr) source.copy(source.lights, first, here, own, nullptr);
        std::uint32_t careful_count = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            const Sphere* from = given + i;
            const std::uint32_t used = min_of(lanes, here - i);
            if (used < lanes) {
                for (std::uint32_t lane = 0; lane < lanes; ++lane)
                    padded[lane] = load_sphere(from + (lane < used ? lane : 0));
                from = padded;
            }
            Floats x, y, z, r;
            load_spheres(from, x, y, z, r);
            if (moved) move_spheres(move, x, y, z, r);
            const Floats at[] = {x, y, z};
            x = x * view.sign_x;
            y = y * view.sign_y;
            z = z * view.sign_z;
            const Floats nearest = z - r, farthest = z + r, size = abs(x) + abs(y) + abs(z) + r;
            const auto usable = both(less_equal(size, broadcast(float_safe_max)), less_equal(broadcast(float_safe_min), r));
            const auto culled = both(usable, out_of_view(view, x, y, z, r, nearest, farthest, size));
            const unsigned valid = used < 32 ? (1u << used) - 1 : ~0u;
            unsigned& in_view = visible[i / lanes] = 0;
            if ((~movemask(culled) & valid) == 0) continue;
            auto plain = and_not(usable, culled);
            Floats left = x - r, right = x + r, bottom = y - r, top = y + r;
            if (!camera.orthographic) {
                plain = both(plain, less(broadcast(camera.min_float_depth), nearest));
                const Floats e = mul(nearest, farthest), per_e = 1.0f / e;
                tangent_slopes(x, z, r, e, per_e, left, right);
                tangent_slopes(y, z, r, e, per_e, bottom, top);
            }
            unsigned rest = ~movemask(either(plain, culled)) & valid;
            if (moved && (source.kept != nullptr || rest != 0))
                store_spheres(own + i, at[0], at[1], at[2], r);
            for (; rest != 0; rest &= rest - 1)
                careful[careful_count++] =
                    static_cast<std::uint8_t>(i + static_cast<unsigned>(std::countr_zero(rest)));
            plain = tile_span<float>(camera.x, left, right, plain, rects.x0 + i, rects.x1 + i);
            plain = tile_span<float>(camera.y, bottom, top, plain, rects.y0 + i, rects.y1 + i);
            in_view = movemask(plain) & valid;
        }
        project_carefully(camera, spheres, careful, careful_count, rects, visible, counts);
        for (std::uint32_t i = 0; i < here; i += lanes)
            if (visible[i / lanes] != 0) append_visible(out, counts, first, visible[i / lanes], rects, i);
    }
}

}}}}  // namespace lightbin::detail
