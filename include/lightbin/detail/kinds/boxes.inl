// SPDX-License-Identifier: MIT
// The projection of boxes, and of the parts of spheres in boxes, to tile rectangles, a vector of lights at a time.
// Included once per tier.
//
// A light's rectangle is the intersection of two rectangles: around its box, and around the sphere that cuts the box,
// here called its ball. With a perspective projection, the rectangle around the box is the one around its corners
// beyond the near plane and the points where its edges cross that plane. Each corner is a sum of coordinates of the
// centre and the half axes, whose absolute values add up to S for all three coordinates together.
//
// Rounding in float, with the unit roundoff u = 2^-24: such sums have errors of at most 5u S, together for the three
// coordinates of a corner. BoxLanes::error is 16u S, and the error of the transform from world space is added. By
// world_to_view.hpp the centre is within error_rate (|x| + |y| + |z|) + error_at_origin of the exact one, where x, y
// and z are relative to the origin; the half axes are transformed by the same products and sums. In the sum of the
// three coordinates' differences this is less than twice as much.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, with the scalar tier
#pragma once
#include <lightbin/detail/kinds/box_vectors.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Finds 1 / a and 1 / b from the reciprocal of a b, as divisions take long.
LIGHTBIN_INLINE void reciprocals(Floats a, Floats b, Floats& per_a, Floats& per_b) {
    const Floats per_both = 1.0f / mul(a, b);
    per_a = mul(b, per_both);
    per_b = mul(a, per_both);
}

/// Finds a coordinate of the corners of boxes, in the order of binary numbers: bits 0, 1 and 2 are set on the side that
/// half axis 0, 1 or 2 points to.
template <class Reals>
LIGHTBIN_INLINE void find_corners(const BoxLanes<Reals>& box, unsigned axis, Reals (&corners)[8]) {
    const Reals sum = box.half_axes[0][axis] + box.half_axes[1][axis],
                difference = box.half_axes[1][axis] - box.half_axes[0][axis];
    const Reals wide = box.centre[axis] + box.half_axes[2][axis], narrow = box.centre[axis] - box.half_axes[2][axis];
    const Reals small_sum = mul(sum, box.taper), small_difference = mul(difference, box.taper);
    corners[0] = narrow - small_sum;
    corners[1] = narrow - small_difference;
    corners[2] = narrow + small_difference;
    corners[3] = narrow + small_sum;
    corners[4] = wide - sum;
    corners[5] = wide - difference;
    corners[6] = wide + difference;
    corners[7] = wide + sum;
}

/// Moves bounds on the slopes of boxes outward, with a perspective projection.
///
/// least  D: the view depth from which on the boxes' points are bounded; at least twice BoxLanes::error
///
/// Let E be BoxLanes::error. Each exact point q of a box with q_z >= D is within E of a point p of the computed box,
/// where p_z is at least D - E. The slopes of q and p differ by at most  E (1 + |p_x / p_z|) / D.  Rounding in the
/// point where an edge crosses a depth, in quotients and in products moves p by less than 10u S, with u and S as at the
/// top of this file, and so by less than E. For both together bounds are moved outward by  2 E (1 + |s|) / D,  where s
/// is the bound. That holds for the slopes s of all points of the computed box, as the factor 2 E / D is at most 1 and
/// so the moved slope grows with s.
template <class Reals>
LIGHTBIN_INLINE void move_outward(Reals error, Reals least, ImageBounds<Reals>& bounds) {
    const Reals blur = mul(error, all<Reals>(2)) / least;
    for (unsigned axis = 0; axis < 2; ++axis) {
        bounds.low[axis] = bounds.low[axis] - mul(blur, all<Reals>(1) + abs(bounds.low[axis]));
        bounds.high[axis] = bounds.high[axis] + mul(blur, all<Reals>(1) + abs(bounds.high[axis]));
    }
}

/// Finds bounds on the slopes of boxes wholly beyond the near plane, with a perspective projection.
///
/// nearest  a lower bound on the boxes' view depths; at least twice BoxLanes::error
LIGHTBIN_INLINE void corner_slopes(const BoxLanes<Floats>& box, Floats nearest, ImageBounds<Floats>& bounds) {
    Floats corners[8], per_depth[8];
    find_corners(box, 2, corners);
    LIGHTBIN_UNROLL for (unsigned i = 0; i < 8; i += 2)
        reciprocals(corners[i], corners[i + 1], per_depth[i], per_depth[i + 1]);
    LIGHTBIN_UNROLL for (unsigned axis = 0; axis < 2; ++axis) {
        find_corners(box, axis, corners);
        LIGHTBIN_UNROLL for (unsigned i = 0; i < 8; ++i) {
            const Floats slope = mul(corners[i], per_depth[i]);
            bounds.low[axis] = i == 0 ? slope : minimum(slope, bounds.low[axis]);
            bounds.high[axis] = i == 0 ? slope : maximum(slope, bounds.high[axis]);
        }
    }
    move_outward(box.error, nearest, bounds);
}

/// Finds bounds on the slopes of the parts of boxes beyond the near plane, with a perspective projection. The computed
/// boxes are cut at the depth D - E of move_outward().
///
/// least  the greater one of the near plane's view depth and of a lower bound on the boxes' view depths; at least twice
///        BoxLanes::error
template <class Reals>
LIGHTBIN_NOINLINE void clipped_corner_slopes(const BoxLanes<Reals>& box, Reals least, ImageBounds<Reals>& bounds) {
    const Reals cut = least - box.error, per_cut = all<Reals>(1) / cut,
                infinite = all<Reals>(static_cast<double>(infinity));
    Reals corners[3][8];
    for (unsigned axis = 0; axis < 3; ++axis)
        find_corners(box, axis, corners[axis]);
    bounds = {{infinite, infinite}, {-infinite, -infinite}};
    const auto hold = [&](auto where, unsigned axis, Reals slope) {
        bounds.low[axis] = select(where, minimum(slope, bounds.low[axis]), bounds.low[axis]);
        bounds.high[axis] = select(where, maximum(slope, bounds.high[axis]), bounds.high[axis]);
    };
    for (unsigned from = 0; from < 8; ++from) {
        const Reals a_z = corners[2][from], per_z = all<Reals>(1) / a_z;
        const auto a_beyond = less_equal(cut, a_z);
        for (unsigned axis = 0; axis < 2; ++axis)
            hold(a_beyond, axis, mul(corners[axis][from], per_z));
        for (unsigned bit = 1; bit < 8; bit *= 2) {
            if ((from & bit) != 0) continue;
            const Reals b_z = corners[2][from | bit], part = (cut - a_z) / (b_z - a_z);
            const auto b_beyond = less_equal(cut, b_z);
            for (unsigned axis = 0; axis < 2; ++axis) {
                const Reals a = corners[axis][from], b = corners[axis][from | bit];
                hold(either(and_not(a_beyond, b_beyond), and_not(b_beyond, a_beyond)), axis,
                     mul(a + mul(part, b - a), per_cut));
            }
        }
    }
    move_outward(box.error, least, bounds);
}

/// Bounds of a vector of boxes, and of the parts of them in their balls.
template <class Reals> struct BoxBounds {
    ImageBounds<Reals> image;
    Reals box_nearest;        ///< a lower bound on the boxes' view depths
    Reals nearest, farthest;  ///< bounds on the lights' view depths
    Reals radius;             ///< the balls' radii; +inf where a ball cuts nothing off its box
};

/// Finds bounds of boxes, except for bounds.image with a perspective projection. Returns a mask of the lights between
/// the near and the far plane.
///
/// ball  the centres and radii of the balls
///
/// Rounding is monotone, and the depths of the near and far plane are floats, so comparing rounded sums with these is
/// exact.
template <class Reals>
LIGHTBIN_INLINE auto find_box_depths(const Camera& camera, const BoxLanes<Reals>& box, const Reals (&ball)[4],
                                     BoxBounds<Reals>& bounds) {
    // The corners of the two faces along half axis 2 lie at  way +- k h_0 +- k h_1  from the ball's centre, where `way`
    // leads to the face's middle and k is 1 or the taper. Such a squared distance is at most the sum of the squared
    // lengths of all three and of the absolute values of twice their scalar products. In boxes with half axes at right
    // angles, and their ball's centre on half axis 2, these products are 0. A ball that holds all corners, up to
    // rounding, cuts nothing off. It is forgotten, which loses no light.
    const Reals(&h)[3][3] = box.half_axes;
    const Reals squares = dot(h[0], h[0]) + dot(h[1], h[1]), product = abs(dot(h[0], h[1]));
    const auto face_reach2 = [&](const Reals(&way)[3], Reals k) {
        const Reals products = abs(dot(way, h[0])) + abs(dot(way, h[1])) + mul(k, product);
        return dot(way, way) + mul(k, mul(k, squares) + (products + products));
    };
    Reals wide[3], narrow[3];
    LIGHTBIN_UNROLL for (unsigned i = 0; i < 3; ++i) {
        const Reals way = box.centre[i] - ball[i];
        wide[i] = way + h[2][i];
        narrow[i] = way - h[2][i];
    }
    const Reals farthest2 = maximum(face_reach2(wide, all<Reals>(1)), face_reach2(narrow, box.taper));
    // An infinite error, of a box that bounds nothing, leaves each ball but infinite ones.
    const auto ball_cuts =
        less(mul(mul(ball[3], ball[3]), all<Reals>(1 + 0x1p-16)), farthest2 + mul(box.error, all<Reals>(0x1p-100)));
    bounds.radius = select(ball_cuts, ball[3], all<Reals>(static_cast<double>(infinity)));

    Reals low[3] = {}, high[3] = {};
    LIGHTBIN_UNROLL for (unsigned axis = 0; axis < 3; ++axis) {
        if (axis < 2 && !camera.orthographic) continue;
        const Reals along = h[2][axis], across = abs(h[0][axis]) + abs(h[1][axis]), tapered = mul(across, box.taper);
        low[axis] = box.centre[axis] - maximum(across - along, tapered + along) - box.error;
        high[axis] = box.centre[axis] + maximum(across + along, tapered - along) + box.error;
    }
    if (camera.orthographic) bounds.image = {{low[0], low[1]}, {high[0], high[1]}};
    bounds.box_nearest = low[2];
    bounds.nearest = maximum(ball[2] - bounds.radius, low[2]);
    bounds.farthest = minimum(ball[2] + bounds.radius, high[2]);
    const auto inside = both(less_equal(all<Reals>(static_cast<double>(camera.near_depth)), bounds.farthest),
                             less_equal(bounds.nearest, all<Reals>(static_cast<double>(camera.far_depth))));
    return both(inside, less_equal(bounds.nearest, bounds.farthest));
}

/// Narrows the image bounds of boxes to the bounds `balls` of their balls (the spheres that cut them), where a ball
/// cuts its box. Returns `visible` without the lights whose two bounds do not intersect, in the numbers from which
/// tile_span() finds tiles.
template <class Real, class Reals, class Mask>
LIGHTBIN_INLINE Mask narrow_to_balls(const Camera& camera, const ImageBounds<Reals>& balls, Reals radius,
                                     ImageBounds<Reals>& bounds, Mask visible) {
    const auto ball_cuts = less(radius, all<Reals>(static_cast<double>(infinity)));
    const ImageAxis* const axes[] = {&camera.x, &camera.y};
    for (unsigned i = 0; i < 2; ++i) {
        Reals &low = bounds.low[i], &high = bounds.high[i];
        low = select(ball_cuts, maximum(balls.low[i], low), low);
        high = select(ball_cuts, minimum(balls.high[i], high), high);
        const Reals scale = broadcast(static_cast<Real>(axes[i]->scale));
        const Real offset = static_cast<Real>(axes[i]->offset), margin = static_cast<Real>(axes[i]->margin);
        visible = both(visible, less_equal(mul(low, scale) + offset - margin, mul(high, scale) + offset + margin));
    }
    return visible;
}

/// Finds and stores the half spaces of the six faces of boxes, whose BoxLanes::error is the ViewBox's tolerance. The
/// normals are of any lengths.
///
/// Rounding, with u = 2^-24, S = size_of(box) and L = |n_x| + |n_y| + |n_z|: the greatest n.p of a box is computed with
/// an error of at most 8u L S, which the tolerance covers, see ViewBox. For the 4u L S that cell_planes.hpp asks for,
/// 8u L S = 2^-21 L S is added, and its 2^-100 for underflow. Faces with L up to 2^-50 are left out.
inline void store_box_planes(ViewBox* to, const BoxLanes<Floats>& box) {
    Floats normals[6][3];
    find_normals(box, normals);
    const Floats slack = box.error + mul(size_of(box), broadcast(0x1p-21f));
    // Without tapers, opposite faces have opposite normals, for which the numbers below are the same but for signs.
    const bool tapered = movemask(less(box.taper, broadcast(1.0f))) != 0;
    for (unsigned face = 0; face < 6; face += tapered ? 1 : 2) {
        Floats(&n)[3] = normals[face];
        const Floats size = manhattan_length(n), at_centre = dot(n, box.centre);
        const Floats reach = reach_from_centre(box, n) + (mul(size, slack) + 0x1p-100f),
                     from_centre = select(less(broadcast(0x1p-50f), size), reach, broadcast(infinity));
        store_vec4s(to->around + face, sizeof *to, n[0], n[1], n[2], from_centre + at_centre);
        if (tapered) continue;
        store_vec4s(to->around + face + 1, sizeof *to, -n[0], -n[1], -n[2], from_centre - at_centre);
    }
}

/// Loads the numbers of a vector of Boxes, in the order in which a Box has them in memory.
LIGHTBIN_INLINE void load_boxes(const Box* from, Floats (&given)[17]) {
    static_assert(sizeof(Box) == sizeof(float) * 17);
    LIGHTBIN_UNROLL for (unsigned k = 0; k < 16; k += 4)
        load_vec4s(&from->x + k, sizeof *from, given[k], given[k + 1], given[k + 2], given[k + 3]);
    load_vec4s(&from->x + 13, sizeof *from, given[13], given[14], given[15], given[16]);
}

/// Moves boxes to view space, signed so that tile indices grow with x and y, and z is the view depth. Sets box.error to
/// a bound on the error of the transform. Returns a mask of the boxes for which the bound holds.
///
/// given  the numbers of the boxes, see load_boxes()
/// ball   becomes the centres and radii of the balls, the spheres that cut the boxes
LIGHTBIN_INLINE auto move_boxes(const ViewLanes& view, const TransformLanes& transform, const Floats (&given)[17],
                                Floats (&ball)[4], BoxLanes<Floats>& box) {
    LIGHTBIN_UNROLL for (unsigned k = 0; k < 4; ++k)
        ball[k] = given[k];
    box.taper = given[16];
    box.error = Floats{};
    LIGHTBIN_UNROLL for (unsigned k = 0; k < 3; ++k) {
        box.centre[k] = given[4 + k];
        LIGHTBIN_UNROLL for (unsigned axis = 0; axis < 3; ++axis)
            box.half_axes[axis][k] = given[3 * axis + 7 + k];
    }
    auto safe = less_equal(Floats{}, Floats{});  // a mask of all boxes
    if (transform.to_view != nullptr) {
        transform_spheres(transform, ball[0], ball[1], ball[2], ball[3]);
        LIGHTBIN_UNROLL for (unsigned k = 0; k < 3; ++k)
            box.centre[k] = box.centre[k] - transform.origin[k];
        safe = less_equal(manhattan_length(box.centre), transform.max_distance);
        box.error = (mul(size_of(box), transform.error_rate) + transform.error_at_origin) * 2.0f;
        transform_vectors(transform, box.centre);
        LIGHTBIN_UNROLL for (unsigned k = 0; k < 3; ++k)
            box.centre[k] = box.centre[k] + transform.origin_image[k];
        LIGHTBIN_UNROLL for (Floats(&h)[3] : box.half_axes)
            transform_vectors(transform, h);
    }
    const Floats signs[] = {view.sign_x, view.sign_y, view.sign_z};
    LIGHTBIN_UNROLL for (unsigned row = 0; row < 3; ++row) {
        ball[row] = ball[row] * signs[row];
        box.centre[row] = box.centre[row] * signs[row];
        LIGHTBIN_UNROLL for (Floats(&h)[3] : box.half_axes)
            h[row] = h[row] * signs[row];
    }
    return safe;
}

/// Returns which of the boxes whose bit in `valid` is set are good input, see Box. Counts the bad ones.
///
/// safe   a mask of boxes whose coordinates were seen, by their sums, to be finite, and whose half axes are not all 0
/// given  the numbers of the boxes, see load_boxes()
template <class Mask>
LIGHTBIN_INLINE unsigned good_boxes(Mask safe, const Floats (&given)[17], unsigned valid, ProjectCounts& counts) {
    const auto radius_and_taper =
        both(both(less_equal(Floats{}, given[3]), less_equal(given[16], broadcast(1.0f))),
             less_equal(Floats{}, given[16]));
    if (const unsigned good = movemask(both(safe, radius_and_taper)) & valid; good == valid) return good;
    const Floats largest = broadcast(FLT_MAX), off = broadcast(-1.0f);
    auto in_range = radius_and_taper;
    Floats longest = Floats{};
    LIGHTBIN_UNROLL for (unsigned i = 0; i < 16; ++i) {
        if (i == 3) continue;  // a radius may be infinite
        in_range = both(in_range, less_equal(abs(given[i]), largest));
    }
    LIGHTBIN_UNROLL for (unsigned i = 7; i < 16; ++i)
        longest = maximum(abs(given[i]), longest);
    const unsigned good = movemask(both(in_range, less(Floats{}, longest))) & valid;
    const unsigned lit = ~movemask(both(less_equal(given[3], off), less_equal(off, given[3])));
    counts.rejected += static_cast<std::uint32_t>(std::popcount(valid & ~good & lit));
    return good;
}

/// Finds bounds on the slopes of boxes, with a perspective projection. Returns a mask of those for which float's
/// rounding errors are small enough.
///
/// shown  a bit for each box that may be in view
/// whole  a mask of the boxes off which the spheres that cut them cut nothing
template <class Mask>
LIGHTBIN_INLINE Mask find_box_slopes(const Camera& camera, const ViewLanes& view, const BoxLanes<Floats>& box,
                                     Floats ball_z, unsigned shown, Mask whole, BoxBounds<Floats>& bounds) {
    const Floats nearest_ball = ball_z - bounds.radius, least = maximum(bounds.box_nearest, view.front);
    corner_slopes(box, bounds.box_nearest, bounds.image);
    const auto clipped = less(bounds.box_nearest, view.front);
    if ((movemask(clipped) & shown) != 0) {
        ImageBounds<Floats> of_clipped;
        clipped_corner_slopes(box, least, of_clipped);
        for (unsigned axis = 0; axis < 2; ++axis) {
            bounds.image.low[axis] = select(clipped, of_clipped.low[axis], bounds.image.low[axis]);
            bounds.image.high[axis] = select(clipped, of_clipped.high[axis], bounds.image.high[axis]);
        }
    }
    return both(less_equal(box.error * 0x1p9f, least),
                either(whole, less(broadcast(camera.min_float_depth), nearest_ball)));
}

/// Stores a vector of boxes, except the half spaces around them, which store_box_planes() stores.
LIGHTBIN_INLINE void store_boxes(ViewBox* to, const BoxLanes<Floats>& box, const Floats (&ball)[4],
                                 const BoxBounds<Floats>& bounds) {
    const Floats(&h)[3][3] = box.half_axes;
    store_vec4s(&to->x, sizeof *to, ball[0], ball[1], ball[2], bounds.radius);
    store_vec4s(&to->box_x, sizeof *to, box.centre[0], box.centre[1], box.centre[2], h[0][0]);
    store_vec4s(to->half_axes[0] + 1, sizeof *to, h[0][1], h[0][2], h[1][0], h[1][1]);
    store_vec4s(to->half_axes[1] + 2, sizeof *to, h[1][2], h[2][0], h[2][1], h[2][2]);
    store_vec4s(&to->taper, sizeof *to, box.taper, bounds.nearest, bounds.farthest, box.error);
}

/// Loads what store_box_planes() reads of a vector of boxes.
inline void load_boxes(const ViewBox* from, BoxLanes<Floats>& box) {
    Floats nearest, farthest, (&h)[3][3] = box.half_axes;
    load_vec4s(&from->box_x, sizeof *from, box.centre[0], box.centre[1], box.centre[2], h[0][0]);
    load_vec4s(from->half_axes[0] + 1, sizeof *from, h[0][1], h[0][2], h[1][0], h[1][1]);
    load_vec4s(from->half_axes[1] + 2, sizeof *from, h[1][2], h[2][0], h[2][1], h[2][2]);
    load_vec4s(&from->taper, sizeof *from, box.taper, nearest, farthest, box.error);
}

/// Appends the footprints of the boxes first..first + count - 1 that are in view. Boxes are projected in
/// float where its rounding errors are at most 2^-9 of their depths and nothing overflows or underflows, and their
/// balls if these cut them and lie wholly beyond the near plane; all others in double.
template <>
inline void project_lights<LightKind::box>(const Camera& camera, const LightSource& source, std::uint32_t first,
                                           std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts) {
    ProjectedChunk chunk;
    Box buffer[ChunkRects::size], padded[lanes];
    const TransformLanes transform(source.to_view);
    const ViewLanes view(camera);
    const Floats largest = broadcast(float_safe_max), infinite = broadcast(infinity);
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, ChunkRects::size);
        const Box* const boxes = source.array != nullptr ? static_cast<const Box*>(source.array) + first : buffer;
        if (source.copy != nullptr) source.copy(source.lights, first, here, buffer);
        chunk.visible = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            const std::uint32_t used = min_of(lanes, here - i);
            const unsigned valid = (1u << used) - 1;
            const Box* const from = whole_vector(boxes + i, used, padded);
            Floats given[17], ball[4];
            BoxLanes<Floats> box;
            load_boxes(from, given);
            auto safe = move_boxes(view, transform, given, ball, box);

            const Floats centre_size = abs(ball[0]) + abs(ball[1]) + abs(ball[2]), ball_size = centre_size + ball[3];
            const auto ball_safe = safe_in_float(ball_size, ball[3]);
            const Floats axes = axes_size(box), size = size_of(box);
            safe = both(safe, both(both(less_equal(size, largest), less_equal(centre_size, largest)),
                                   less_equal(broadcast(float_safe_min), axes)));
            const auto culled = both(ball_safe, out_of_view(view, ball[0], ball[1], ball[2], ball[3],
                                                            ball[2] - ball[3], ball[2] + ball[3], ball_size));
            const unsigned kept = good_boxes(safe, given, valid, counts) & ~movemask(culled);
            if (kept == 0) continue;

            box.error = mul(size, broadcast(0x1p-20f)) + box.error;
            BoxBounds<Floats> bounds;
            auto visible = find_box_depths(camera, box, ball, bounds);
            const auto whole = less_equal(infinite, bounds.radius);
            safe = both(safe, either(whole, ball_safe));
            if (!camera.orthographic)
                safe = both(safe, find_box_slopes(camera, view, box, ball[2], movemask(visible) & kept, whole, bounds));
            if ((~movemask(whole) & kept) != 0)
                visible = narrow_to_balls<float>(camera, sphere_bounds(camera, ball[0], ball[1], ball[2], ball[3]),
                                                 bounds.radius, bounds.image, visible);
            const auto in_view = tile_rects<float>(camera, bounds.image, visible, chunk.rects, i);
            const unsigned in_float = movemask(safe) & kept, in_double = kept & ~in_float;
            chunk.visible |= std::uint64_t{movemask(in_view) & in_float} << i;

            ViewBox* const to = source.out_boxes != nullptr ? source.out_boxes + first + i : nullptr;
            box.error = box.error + 0x1p-120f;
            if (to != nullptr) store_boxes(to, box, ball, bounds);
            if (in_double != 0) {
                Sphere balls[lanes];
                store_spheres(balls, ball[0], ball[1], ball[2], ball[3]);
                for (unsigned rest = in_double; rest != 0; rest &= rest - 1) {
                    const std::uint32_t lane = static_cast<std::uint32_t>(std::countr_zero(rest));
                    project_box_in_double(camera, source.to_view, balls[lane], from[lane], i + lane, chunk,
                                          to != nullptr ? to + lane : nullptr);
                }
                if (to != nullptr) load_boxes(to, box);
            }
            if (source.with_planes) store_box_planes(to, box);
        }
        append_chunk(chunk, source.first_id + first, here, out, counts);
    }
}

}}}}  // namespace lightbin::detail
