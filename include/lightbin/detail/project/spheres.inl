// SPDX-License-Identifier: MIT
// The projection of spheres to tile rectangles, a vector of lights at a time. All tiers do the same operations in the
// same order, so they give the same bytes. Included once per tier (instruction set).
//
// Each image axis is a problem in two dimensions: the edges of tiles are planes  x = s z  through the eye with the
// slope s, and a sphere appears as a disc with the centre (c, z), where c is x or y and z the view depth. Its bounds
// are the slopes of the two tangents from the eye (Mara and McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere", JCGT 2(2), 2013).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/world_to_view.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A chunk of lights while they are projected. A light's index is counted from the chunk's first light.
struct ProjectedChunk {
    ChunkRects rects;
    std::uint64_t visible;                       ///< a mask of the chunk's lights that are in view
    std::uint32_t fallback[ChunkRects::size];    ///< the indices of the lights to be projected in double precision
    std::uint32_t fallback_count;
};

/// Bounds of a vector of lights on the slopes x / depth and y / depth (orthographic: on view-space x and y).
template <class Reals> struct ImageBounds { Reals low[2], high[2]; };

/// Finds the slopes of the tangents from the eye, the origin, to discs with the centre (c, z) and the radius r, which
/// lie wholly in front of the eye: z - r > 0.
///
/// e, per_e  (z - r) (z + r) and its reciprocal
///
/// The outer tangent is the one farther from the view axis. Its slope is q / e with  q = |c| z + r sqrt(c^2 + e).  The
/// inner slope is (c^2 - r^2) / q, as the product of both is (c^2 - r^2) / e. Both come from sums whose terms have one
/// sign, so that relative errors never grow by cancellation. With the unit roundoff u, e has a relative error of at
/// most 3u, c^2 + e of 4u, sqrt(c^2 + e) of 3u, q of 5u, the outer slope of 10u and the inner one of 9u.
template <class Reals>
inline void tangent_slopes(Reals c, Reals z, Reals r, Reals e, Reals per_e, Reals& low, Reals& high) {
    const Reals a = abs(c);
    const Reals q = mul(a, z) + mul(r, sqrt(mul(a, a) + e));
    const Reals outer = mul(q, per_e), inner = mul(a - r, a + r) / q;
    const auto negative = less(c, Reals{});
    // Lights lie on either side of the view axis at random, which no branch predictor could guess.
    low = select_unpredicted(negative, -outer, inner);
    high = select_unpredicted(negative, -inner, outer);
}

/// Finds bounds on c / z over that part of discs with the centre (c, z) and the radius r whose depth is at least
/// near_depth. A bound is infinite where double precision can't decide. For discs that meet the near plane:
/// z - r <= near_depth <= z + r. The arguments are floats that were converted to double: their products are exact, and
/// none overflows.
///
/// The part is convex, so the largest slope c / z is at the point where the tangent touches the circle, if that lies
/// beyond the near plane, and else at the corner where circle and near plane meet. The tangent's slope bounds the whole
/// disc, so it is a correct bound wherever there is a tangent; the corner's is taken only where it is certain to be the
/// largest. The smallest slope is the negative of the largest one of the mirrored disc with the centre (-c, z).
inline void clipped_slopes(Doubles c, Doubles z, Doubles r, double near_depth, Doubles& low, Doubles& high) {
    const Doubles near_z = broadcast(near_depth), zero = broadcast(0.0),
                  infinite = broadcast(static_cast<double>(infinity));
    const Doubles a = abs(c);
    const Doubles h2 =
        mul(r - (near_z - z), r + (near_z - z));  // squared half of the chord that the near plane cuts off
    const Doubles h2_error = mul(r, r) * 0x1p-50;
    const Doubles h = sqrt(maximum(h2, zero) + h2_error);  // rounded up
    const Doubles h_low = sqrt(maximum(h2 - h2_error, zero));

    // The circle around (c, z) meets the near plane in the corner (c + h, near_z). There it leads beyond the plane in
    // the direction (z - near_z, h), in which the slope, coordinate / depth, grows
    // as  (near_z, -(c + h)) . (z - near_z, h).  So the tangent of the largest slope touches beyond the near plane if
    // and only if  near_z (z - near_z) > h (c + h),  where the outer tangent has c = |c| = a and the inner one c = -a.
    const Doubles doubt = (mul(h, h) + mul(a, h) + mul(near_z, abs(z) + near_z)) * 0x1p-48;
    const Doubles tangent_side = mul(near_z, z - near_z) + doubt, square = mul(h_low, h_low);
    const auto outer_cut = less(tangent_side, square + mul(a, h_low));
    const auto inner_cut = less(tangent_side, square - mul(a, h));
    const Doubles corner_error = (a + h) * 0x1p-48;
    const Doubles outer_corner = (h + a + corner_error) / near_z;
    const Doubles inner_corner = (h - a + corner_error) / near_z;

    // The squared length t2 of the tangent from eye to sphere is not positive if the eye is on the sphere or inside.
    const Doubles squares = mul(a, a) + mul(z, z), t2 = squares - mul(r, r);
    const Doubles error = (squares + mul(r, r)) * 0x1p-50 / t2 + 0x1p-48;  // relative error of a tangent's slope
    const auto has_tangent = both(less(zero, t2), less_equal(error, broadcast(0x1p-20)));
    // Each sum has terms of one sign, so that none cancels. If the sphere reaches behind the eye, z <= r, the outer
    // tangent points backward and bounds nothing.
    const Doubles az = mul(a, z), rt = mul(r, sqrt(t2)), e = mul(z - r, z + r);
    const auto behind = less(z, zero);
    const Doubles outer = (az + rt) / e;
    const Doubles inner = select(behind, rt - az, mul(r - a, r + a)) / select(behind, e, rt + az);
    const Doubles high_outer = select(outer_cut, outer_corner,
                                      select(both(has_tangent, less(r, z)), outer + mul(abs(outer), error), infinite));
    const Doubles high_inner =
        select(inner_cut, inner_corner, select(has_tangent, inner + mul(abs(inner), error), infinite));
    const auto negative = less(c, zero);
    low = -select(negative, high_outer, high_inner);
    high = select(negative, high_inner, high_outer);
}

/// Stores the first and the last tile, along an image axis, that the bounds low..high of each light touch, enlarged by
/// the axis' margin. Returns `visible` without the lights that lie outside the viewport.
template <class Real, class Reals, class Mask>
inline Mask tile_span(const ImageAxis& axis, Reals low, Reals high, Mask visible, std::uint32_t* first,
                      std::uint32_t* last) {
    const Real scale = static_cast<Real>(axis.scale), offset = static_cast<Real>(axis.offset),
               margin = static_cast<Real>(axis.margin);
    low = mul(low, broadcast(scale)) + offset - margin;
    high = mul(high, broadcast(scale)) + offset + margin;
    const Reals zero = Reals{}, last_tile = broadcast(static_cast<Real>(axis.last_tile_centre));
    store_tiles(first, minimum(maximum(low, zero), last_tile));
    store_tiles(last, minimum(maximum(high, zero), last_tile));
    return both(visible, both(less_equal(zero, high), less_equal(low, broadcast(static_cast<Real>(axis.limit)))));
}

/// Stores the tile rectangles of a vector of lights, from element i of `rects` on. Returns `visible` without the
/// lights that lie outside the viewport.
template <class Real, class Reals, class Mask>
LIGHTBIN_INLINE Mask tile_rects(const Camera& camera, const ImageBounds<Reals>& bounds, Mask visible, ChunkRects& rects,
                                std::uint32_t i) {
    visible = tile_span<Real>(camera.x, bounds.low[0], bounds.high[0], visible, rects.x0 + i, rects.x1 + i);
    return tile_span<Real>(camera.y, bounds.low[1], bounds.high[1], visible, rects.y0 + i, rects.y1 + i);
}

/// Stores the tile rectangles of a vector of lights of a chunk, from index i on, and which of them are in view. Lights
/// whose bit in `fallback` is set are listed for the double-precision path instead. `valid` has a bit for each lane
/// that holds a light of the chunk.
template <class Mask>
LIGHTBIN_INLINE void put_vector(const Camera& camera, const ImageBounds<Floats>& bounds, Mask float_safe,
                                unsigned fallback, unsigned valid, std::uint32_t i, ProjectedChunk& chunk) {
    for (; fallback != 0; fallback &= fallback - 1)
        chunk.fallback[chunk.fallback_count++] =
            i + static_cast<std::uint32_t>(std::countr_zero(fallback));
    chunk.visible |= std::uint64_t{movemask(tile_rects<float>(camera, bounds, float_safe, chunk.rects, i)) & valid} << i;
}

/// Appends the footprints of the lights of a chunk that are in view. The chunk has `here` lights from id `first` on.
inline void append_chunk(const ProjectedChunk& chunk, std::uint32_t first, std::uint32_t here,
                         const FootprintArrays& out, ProjectCounts& counts) {
    std::uint32_t ids[ChunkRects::size], end = counts.visible;
    for (std::uint32_t i = 0; i < ChunkRects::size; ++i)
        ids[i] = first + i;
    for (std::uint32_t i = 0; i < here; i += 16) {
        const unsigned visible = static_cast<unsigned>(chunk.visible >> i & 0xffff);
        if (visible == 0) continue;
        append_16(out.ids + end, ids + i, visible);
        append_16(out.x0 + end, chunk.rects.x0 + i, visible);
        append_16(out.y0 + end, chunk.rects.y0 + i, visible);
        append_16(out.x1 + end, chunk.rects.x1 + i, visible);
        append_16(out.y1 + end, chunk.rects.y1 + i, visible);
        end += static_cast<std::uint32_t>(std::popcount(visible));
    }
    for (; counts.visible < end; ++counts.visible) {
        const std::uint32_t i = counts.visible;
        counts.area += (out.x1[i] - out.x0[i] + std::uint64_t{1}) * (out.y1[i] - out.y0[i] + 1u);
    }
}

/// Returns bounds along the image axes of the parts of spheres beyond the near plane. The centres (x, y, z) are signed
/// so that tile indices grow with x and y, and z is the view depth. All arguments are floats converted to double.
inline ImageBounds<Doubles> bounds_in_double(const Camera& camera, Doubles x, Doubles y, Doubles z, Doubles radius) {
    // A radius of 0 is enlarged to much less than any float's rounding error, so that no square root is taken of 0.
    const Doubles r = maximum(radius, broadcast(0x1p-400));
    ImageBounds<Doubles> bounds = {{x - r, y - r}, {x + r, y + r}};
    if (camera.orthographic) return bounds;
    const double near_depth = static_cast<double>(camera.near_depth);
    const Doubles nearest = z - radius, farthest = z + radius;
    const auto whole = less(broadcast(near_depth), nearest);
    const Doubles centre[] = {x, y}, e = mul(nearest, farthest), per_e = 1.0 / e;
    for (unsigned axis = 0; axis < 2; ++axis) {
        Doubles low, high;
        clipped_slopes(centre[axis], z, r, near_depth, bounds.low[axis], bounds.high[axis]);
        tangent_slopes(centre[axis], z, r, e, per_e, low, high);
        bounds.low[axis] = select(whole, low, bounds.low[axis]);
        bounds.high[axis] = select(whole, high, bounds.high[axis]);
    }
    return bounds;
}

/// Projects in double the lights of a chunk that are listed in chunk.fallback: those that cross the near plane or
/// contain the eye, tiny, huge and infinite ones, and bad input, which it counts. Sets the bits in chunk.visible of
/// the listed lights that are in view.
///
/// spheres  the spheres of all lights of the chunk, in view space
inline void project_in_double(const Camera& camera, const Sphere* spheres, ProjectedChunk& chunk,
                              ProjectCounts& counts) {
    for (std::uint32_t begin = 0, used; begin < chunk.fallback_count; begin += used) {
        used = min_of(chunk.fallback_count - begin, double_lanes);
        const std::uint32_t* const indices = chunk.fallback + begin;
        Floats floats[4];
        load_listed_spheres(spheres, indices, used, floats[0], floats[1], floats[2], floats[3]);
        const Doubles x = widened(floats[0], 0) * static_cast<double>(camera.x.sign);
        const Doubles y = widened(floats[1], 0) * static_cast<double>(camera.y.sign);
        const Doubles z = widened(floats[2], 0) * static_cast<double>(camera.z_sign);
        const Doubles radius = widened(floats[3], 0), largest = broadcast(static_cast<double>(FLT_MAX));
        const double near_depth = static_cast<double>(camera.near_depth);
        const auto good = both(both(less_equal(abs(x), largest), less_equal(abs(y), largest)),
                               both(less_equal(abs(z), largest), less_equal(broadcast(0.0), radius)));
        const Doubles nearest = z - radius, farthest = z + radius;
        auto visible = and_not(good, either(less(farthest, broadcast(near_depth)),
                                            less(broadcast(static_cast<double>(camera.far_depth)), nearest)));
        ChunkRects rects;
        const unsigned in_view =
            movemask(tile_rects<double>(camera, bounds_in_double(camera, x, y, z, radius), visible, rects, 0));
        counts.rejected += used - static_cast<std::uint32_t>(std::popcount(movemask(good) & ((1u << used) - 1)));
        for (std::uint32_t i = 0; i < used; ++i) {
            const std::uint32_t to = indices[i];
            chunk.rects.x0[to] = rects.x0[i];
            chunk.rects.y0[to] = rects.y0[i];
            chunk.rects.x1[to] = rects.x1[i];
            chunk.rects.y1[to] = rects.y1[i];
            chunk.visible |= std::uint64_t{in_view >> i & 1} << to;
        }
    }
}

/// The camera's numbers that cull lights, each broadcast to a vector once: with narrow vectors, broadcasting them for
/// every vector of lights would take as long as the culling.
struct ViewLanes {
    explicit ViewLanes(const Camera& camera)
        : sign_x(broadcast(camera.x.sign)), sign_y(broadcast(camera.y.sign)), sign_z(broadcast(camera.z_sign)),
          normal_x(broadcast(camera.x.normal)), normal_xz(broadcast(camera.x.normal_z)),
          normal_y(broadcast(camera.y.normal)), normal_yz(broadcast(camera.y.normal_z)),
          front(broadcast(camera.near_depth)), back(broadcast(camera.far_depth)) {}

    Floats sign_x, sign_y, sign_z, normal_x, normal_xz, normal_y, normal_yz, front, back;
};

/// Returns a mask of the lights in a vector that are certain to lie outside the view frustum. The result only holds for
/// lights that safe_in_float() accepts.
///
/// x, y, z, r         the lights' spheres, signed so that tile indices grow with x and y, and z is the view depth
/// nearest, farthest  the lights' view depths
/// size               |x| + |y| + |z| + r
///
/// Rounding is monotone and the depths of the near and far plane are floats, so comparing rounded sums with these is
/// exact. The computed distance to a side plane has an error of at most 4u `size`, with u = 2^-24; 8u are allowed.
LIGHTBIN_INLINE auto out_of_view(const ViewLanes& view, Floats x, Floats y, Floats z, Floats r, Floats nearest,
                                 Floats farthest, Floats size) {
    const Floats outside = maximum(mul(abs(x), view.normal_x) + mul(z, view.normal_xz),
                                   mul(abs(y), view.normal_y) + mul(z, view.normal_yz));
    return either(either(less(farthest, view.front), less(view.back, nearest)), less(size * 0x1p-21f, outside - r));
}

/// Returns which lights of a vector, with size = |x| + |y| + |z| + r, can be projected in float without overflow and
/// underflow. False for NaN.
LIGHTBIN_INLINE auto safe_in_float(Floats size, Floats r) {
    return both(less_equal(size, broadcast(float_safe_max)), less_equal(broadcast(float_safe_min), r));
}

/// Appends the footprints of the spheres first..first + count - 1 that are in view. Spheres are projected in float
/// where the error bounds of tangent_slopes() hold: where nothing overflows or underflows and the whole sphere lies
/// beyond the near plane. All other spheres, and those with a NaN, are projected in double.
inline void project(const Camera& camera, const LightSource& source, std::uint32_t first, std::uint32_t count,
                    const FootprintArrays& out, ProjectCounts& counts) {
    ProjectedChunk chunk;
    Sphere buffer[ChunkRects::size], padded[lanes];
    const TransformLanes transform(source.to_view);
    const ViewLanes view(camera);
    const bool transformed = source.to_view != nullptr;
    // Few lights are copied at a time, so that the next ones are fetched from memory while these are projected.
    const std::uint32_t batch = source.copy != nullptr ? 32 : ChunkRects::size;
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, batch);
        // `own` is where spheres that `copy` writes, or that are transformed to view space, are stored.
        Sphere* const own = source.out_spheres != nullptr ? source.out_spheres + first : buffer;
        const Sphere* const given = source.spheres != nullptr ? source.spheres + first : own;
        if (source.copy != nullptr) source.copy(source.lights, first, here, own, nullptr);
        chunk.visible = chunk.fallback_count = 0;
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
            if (transformed) transform_spheres(transform, x, y, z, r);
            const Floats centre[] = {x, y, z};
            x = x * view.sign_x;
            y = y * view.sign_y;
            z = z * view.sign_z;
            const Floats nearest = z - r, farthest = z + r, size = abs(x) + abs(y) + abs(z) + r;
            const auto safe = safe_in_float(size, r);
            const auto culled = both(safe, out_of_view(view, x, y, z, r, nearest, farthest, size));
            const unsigned valid = (1u << used) - 1;
            if ((~movemask(culled) & valid) == 0) continue;
            auto in_float = and_not(safe, culled);
            ImageBounds<Floats> bounds = {{x - r, y - r}, {x + r, y + r}};
            if (!camera.orthographic) {
                in_float = both(in_float, less(broadcast(camera.min_float_depth), nearest));
                const Floats e = mul(nearest, farthest), per_e = 1.0f / e;
                tangent_slopes(x, z, r, e, per_e, bounds.low[0], bounds.high[0]);
                tangent_slopes(y, z, r, e, per_e, bounds.low[1], bounds.high[1]);
            }
            const unsigned fallback = ~movemask(either(in_float, culled)) & valid;
            if (transformed && (source.out_spheres != nullptr || fallback != 0))
                store_spheres(own + i, centre[0], centre[1], centre[2], r);
            put_vector(camera, bounds, in_float, fallback, valid, i, chunk);
        }
        project_in_double(camera, transformed ? own : given, chunk, counts);
        append_chunk(chunk, source.first_id + first, here, out, counts);
    }
}

}}}}  // namespace lightbin::detail
