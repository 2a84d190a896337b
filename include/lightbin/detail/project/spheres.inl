// SPDX-License-Identifier: MIT
// The projection of spheres to tile rectangles, a vector of lights at a time. All tiers do the same operations in the
// same order, so they give the same bytes. Included once per tier (instruction set).
//
// Each image axis is a problem in two dimensions: the edges of tiles are planes  x = s z  through the eye with the
// slope s, and a sphere appears as a disc with the centre (c, z), where c is x or y and z the view depth. Its bounds
// are the slopes of the two tangents from the eye (Mara and McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere", JCGT 2(2), 2013).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/project/world_to_view.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Projects lights of one kind to footprints. Specialised here for spheres, and in kinds/ for spots and boxes, which
/// programs have that include spot.hpp or box.hpp.
template <LightKind>
void project_lights(const Camera& camera, const LightSource& source, std::uint32_t first, std::uint32_t count,
                    const FootprintArrays& out, ProjectCounts& counts);

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
    low = select(negative, -outer, inner);
    high = select(negative, -inner, outer);
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
/// whose bit in `fallback` is set are left to the double-precision path. `valid` has a bit for each lane
/// that holds a light of the chunk.
template <class Mask>
LIGHTBIN_INLINE void put_vector(const Camera& camera, const ImageBounds<Floats>& bounds, Mask float_safe,
                                unsigned fallback, unsigned valid, std::uint32_t i, ProjectedChunk& chunk) {
    chunk.in_double |= std::uint64_t{fallback} << i;
    chunk.visible |= std::uint64_t{movemask(tile_rects<float>(camera, bounds, float_safe, chunk.rects, i)) & valid}
                     << i;
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

/// Returns bounds of spheres, whose view depths are z - r to z + r: with a perspective projection on slopes, for
/// spheres wholly in front of the eye, and with an orthographic one on view-space x and y.
LIGHTBIN_INLINE ImageBounds<Floats> sphere_bounds(const Camera& camera, Floats x, Floats y, Floats z, Floats r) {
    ImageBounds<Floats> bounds = {{x - r, y - r}, {x + r, y + r}};
    if (!camera.orthographic) {
        const Floats e = mul(z - r, z + r), per_e = 1.0f / e;
        tangent_slopes(x, z, r, e, per_e, bounds.low[0], bounds.high[0]);
        tangent_slopes(y, z, r, e, per_e, bounds.low[1], bounds.high[1]);
    }
    return bounds;
}

/// Appends the footprints of the spheres first..first + count - 1 that are in view. Spheres are projected in float
/// where the error bounds of tangent_slopes() hold: where nothing overflows or underflows and the whole sphere lies
/// beyond the near plane. All other spheres, and those with a NaN, are projected in double.
template <>
inline void project_lights<LightKind::sphere>(const Camera& camera, const LightSource& source, std::uint32_t first,
                                              std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts) {
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
        const Sphere* const given = source.array != nullptr ? static_cast<const Sphere*>(source.array) + first : own;
        if (source.copy != nullptr) source.copy(source.lights, first, here, own);
        chunk.visible = chunk.in_double = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            const std::uint32_t used = min_of(lanes, here - i);
            Floats x, y, z, r;
            load_spheres(whole_vector(given + i, used, padded), x, y, z, r);
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
            if (!camera.orthographic) in_float = both(in_float, less(broadcast(camera.min_float_depth), nearest));
            const ImageBounds<Floats> bounds = sphere_bounds(camera, x, y, z, r);
            const unsigned fallback = ~movemask(either(in_float, culled)) & valid;
            if (transformed && (source.out_spheres != nullptr || fallback != 0))
                store_spheres(own + i, centre[0], centre[1], centre[2], r);
            put_vector(camera, bounds, in_float, fallback, valid, i, chunk);
        }
        const Sphere* const spheres = transformed ? own : given;
        for (std::uint64_t rest = chunk.in_double; rest != 0; rest &= rest - 1) {
            const std::uint32_t i = static_cast<std::uint32_t>(std::countr_zero(rest));
            const bool visible = project_in_double(camera, load_sphere(spheres + i), i, chunk.rects, counts);
            chunk.visible |= std::uint64_t{visible} << i;
        }
        append_chunk(chunk, source.first_id + first, here, out, counts);
    }
}

}}}}  // namespace lightbin::detail
