// SPDX-License-Identifier: MIT
// The transform from world space to view space, a vector of spheres at a time; world_to_view.hpp derives its error
// bounds. Included once per tier (instruction set).
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/vectors/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The transform from world space to view space in float, with each number broadcast to a vector.
struct TransformLanes {
    explicit TransformLanes(const WorldToView* from) : to_view(from) {
        if (from == nullptr) return;
        const FloatTransform& all = from->in_float();
        for (unsigned row = 0; row < 3; ++row) {
            origin[row] = broadcast(all.origin[row]);
            origin_image[row] = broadcast(all.origin_image[row]);
            for (unsigned column = 0; column < 3; ++column)
                columns[column][row] = broadcast(all.columns[column][row]);
        }
        stretch = broadcast(all.stretch);
        error_rate = broadcast(all.error_rate);
        error_at_origin = broadcast(all.error_at_origin);
        cone_error = broadcast(all.cone_error);
        max_distance = broadcast(all.max_distance);
    }

    const WorldToView* to_view;  ///< null if lights are given in view space: the members below are then uninitialized
    Floats origin[3], columns[3][3], origin_image[3], stretch, error_rate, error_at_origin, cone_error, max_distance;
};

/// Replaces the view-space spheres `images` of a vector, where a bit in `which` is set, by ones computed in double.
LIGHTBIN_NOINLINE inline void transform_in_double(const WorldToView& to_view, unsigned which, const Floats (&given)[4],
                                                  Floats (&images)[4]) {
    Sphere before[lanes], after[lanes];
    store_spheres(before, given[0], given[1], given[2], given[3]);
    store_spheres(after, images[0], images[1], images[2], images[3]);
    for (; which != 0; which &= which - 1)
        after[std::countr_zero(which)] = to_view(before[std::countr_zero(which)]);
    load_spheres(after, images[0], images[1], images[2], images[3]);
}

/// Returns |x| + |y| + |z| of vectors (x, y, z).
LIGHTBIN_INLINE Floats manhattan_length(const Floats (&v)[3]) {
    return abs(v[0]) + abs(v[1]) + abs(v[2]);
}

/// Replaces vectors by their images: the transform's linear part times (v[0], v[1], v[2]).
LIGHTBIN_INLINE void transform_vectors(const TransformLanes& transform, Floats (&v)[3]) {
    const Floats x = v[0], y = v[1], z = v[2];
    LIGHTBIN_UNROLL for (unsigned row = 0; row < 3; ++row)
        v[row] = mul(x, transform.columns[0][row]) + mul(y, transform.columns[1][row]) +
                 mul(z, transform.columns[2][row]);
}

/// Transforms a vector of spheres. Always inlined, because a call would pass the vectors through memory.
LIGHTBIN_INLINE void transform_spheres(const TransformLanes& transform, Floats& x, Floats& y, Floats& z,
                                       Floats& radius) {
    Floats place[] = {x - transform.origin[0], y - transform.origin[1], z - transform.origin[2]};
    const Floats distance = manhattan_length(place);
    const auto float_safe =
        both(less_equal(distance, transform.max_distance),
             both(less_equal(broadcast(float_safe_min), radius), less_equal(radius, broadcast(float_safe_max))));
    const Floats given[] = {x, y, z, radius};
    transform_vectors(transform, place);
    x = place[0] + transform.origin_image[0];
    y = place[1] + transform.origin_image[1];
    z = place[2] + transform.origin_image[2];
    radius = mul(radius, transform.stretch) + (mul(distance, transform.error_rate) + transform.error_at_origin);
    const unsigned fallback = ~movemask(float_safe) & static_cast<unsigned>(every_lane);
    if (fallback == 0) return;
    Floats images[] = {x, y, z, radius};
    transform_in_double(*transform.to_view, fallback, given, images);
    x = images[0];
    y = images[1];
    z = images[2];
    radius = images[3];
}

}}}}  // namespace lightbin::detail
