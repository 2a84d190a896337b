// SPDX-License-Identifier: MIT
// The projection of boxes, and of the parts of spheres in boxes, to tile rectangles, a vector of lights at a time.
// Included once per tier.
//
// A rectangle is where those of the box and of the sphere, here called its ball, intersect. With a perspective
// projection, the box's is that of the corners beyond the near plane and of the points where edges cross it. Each
// corner is a sum of coordinates of the centre and the half axes, whose absolute values add up to S for all three
// coordinates together.
//
// Rounding in float, with the unit roundoff u = 2^-24: such sums have errors of at most 5u S, together for the three
// coordinates of a corner. BoxLanes::error is 16u S, and the error of the transform from world space is added. By
// world_to_view.hpp the centre is within error_rate (|x| + |y| + |z|) + error_at_origin of the exact one, where x, y
// and z are relative to the origin; the half axes are transformed by the same products and sums. In the sum of the
// three coordinates' differences this is less than twice as much.
//
// Rounding in double, with e = 2^-53: let M be the sum of the absolute values of all terms in the three rows of the
// transform, for the centre and the half axes. Each term goes through at most 8 roundings, so corners are within 8e M
// = 2^-50 M; the error is 2^-46 M.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/box_vectors.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Finds 1 / a and 1 / b from the reciprocal of a b, as divisions take long.
template <class Reals> LIGHTBIN_INLINE void reciprocals(Reals a, Reals b, Reals& per_a, Reals& per_b) {
    const Reals per_both = all<Reals>(1) / mul(a, b);
    per_a = mul(b, per_both);
    per_b = mul(a, per_both);
}

/// Finds bounds on the slopes of the parts of boxes beyond the near plane, with a perspective projection.
///
/// which    a bit for each box whose bounds are asked for
/// nearest  a lower bound on the boxes' view depths
///
/// Let E be BoxLanes::error and d the view depth of the near plane. Each exact point q of a box with q_z >= d is
/// within E of a point p of the computed box. Let D be the greater one of d and `nearest`: then q_z is at least D, and
/// p_z at least D - E. The computed box is cut at the depth D - E, where that is at least D / 2; else there are no
/// bounds. The slopes of q and p differ by at most  E (1 + |p_x / p_z|) / D.  Rounding in the point where an edge
/// crosses the depth, in quotients and in products moves p by less than 10u S, and so by less than E. For both together
/// bounds are moved outward by  2 E (1 + |s|) / D,  where s is the bound. That holds for the slopes s of all points of
/// the computed box, as the factor 2 E / D is at most 1 and so the moved slope grows with s.
template <class Reals>
void corner_slopes(const BoxLanes<Reals>& box, unsigned which, Reals nearest, double near_depth,
                   ImageBounds<Reals>& bounds) {
    const Reals infinite = all<Reals>(static_cast<double>(infinity)), front = all<Reals>(near_depth),
                least = maximum(nearest, front), cut = least - box.error;
    // Corners in the order of binary numbers: bits 0, 1 and 2 are set on the side that half axis 0, 1 or 2 points to.
    Reals corners[8][3];
    for (unsigned i = 0; i < 3; ++i) {
        const Reals sum = box.half_axes[0][i] + box.half_axes[1][i],
                    difference = box.half_axes[1][i] - box.half_axes[0][i];
        const Reals wide = box.centre[i] + box.half_axes[2][i], narrow = box.centre[i] - box.half_axes[2][i];
        const Reals small_sum = mul(sum, box.taper), small_difference = mul(difference, box.taper);
        corners[0][i] = narrow - small_sum;
        corners[1][i] = narrow - small_difference;
        corners[2][i] = narrow + small_difference;
        corners[3][i] = narrow + small_sum;
        corners[4][i] = wide - sum;
        corners[5][i] = wide - difference;
        corners[6][i] = wide + difference;
        corners[7][i] = wide + sum;
    }
    Reals low[] = {infinite, infinite}, high[] = {-infinite, -infinite};
    const auto crosses = less(nearest, front);
    if ((movemask(crosses) & which) == 0) {
        for (unsigned i = 0; i < 8; i += 2) {
            const Reals(&a)[3] = corners[i], (&b)[3] = corners[i + 1];
            Reals per_a, per_b;
            reciprocals(a[2], b[2], per_a, per_b);
            for (unsigned axis = 0; axis < 2; ++axis) {
                const Reals of_a = mul(a[axis], per_a), of_b = mul(b[axis], per_b);
                low[axis] = minimum(minimum(of_a, of_b), low[axis]);
                high[axis] = maximum(maximum(of_a, of_b), high[axis]);
            }
        }
    } else {
        const Reals per_cut = all<Reals>(1) / cut;
        for (unsigned from = 0; from < 8; ++from) {
            const Reals(&a)[3] = corners[from];
            const auto a_before = less(a[2], cut);
            Reals per_z, unused;
            reciprocals(a[2], corners[from ^ 1][2], per_z, unused);
            per_z = select(crosses, all<Reals>(1) / a[2], per_z);
            for (unsigned axis = 0; axis < 2; ++axis) {
                const Reals slope = mul(a[axis], per_z);
                low[axis] = select(a_before, low[axis], minimum(slope, low[axis]));
                high[axis] = select(a_before, high[axis], maximum(slope, high[axis]));
            }
            for (unsigned bit = 1; bit < 8; bit *= 2) {
                if ((from & bit) != 0) continue;
                const Reals(&b)[3] = corners[from | bit];
                const auto b_before = less(b[2], cut),
                           crossing = either(and_not(a_before, b_before), and_not(b_before, a_before));
                const Reals part = (cut - a[2]) / (b[2] - a[2]);
                for (unsigned axis = 0; axis < 2; ++axis) {
                    const Reals slope = mul(a[axis] + mul(part, b[axis] - a[axis]), per_cut);
                    low[axis] = select(crossing, minimum(slope, low[axis]), low[axis]);
                    high[axis] = select(crossing, maximum(slope, high[axis]), high[axis]);
                }
            }
        }
    }
    const auto bounded = less_equal(box.error, mul(least, all<Reals>(0.5)));
    const Reals blur = mul(box.error, all<Reals>(2)) / least;
    for (unsigned axis = 0; axis < 2; ++axis) {
        bounds.low[axis] = select(bounded, low[axis] - mul(blur, all<Reals>(1) + abs(low[axis])), -infinite);
        bounds.high[axis] = select(bounded, high[axis] + mul(blur, all<Reals>(1) + abs(high[axis])), infinite);
    }
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
    // The squared distance of any corner from the ball's centre is at most the sum of the squared lengths of the half
    // axes and of the way from the ball's centre to the box's, and of the absolute values of twice their scalar
    // products. In boxes around their ball's centre with half axes at right angles these products are 0. A ball that
    // holds all corners, up to rounding, cuts nothing off. It is forgotten, which loses no light.
    const Reals(&h)[3][3] = box.half_axes;
    const Reals way[] = {box.centre[0] - ball[0], box.centre[1] - ball[1], box.centre[2] - ball[2]};
    const Reals products = abs(dot(way, h[0])) + abs(dot(way, h[1])) + abs(dot(way, h[2])) + abs(dot(h[0], h[1])) +
                           abs(dot(h[0], h[2])) + abs(dot(h[1], h[2]));
    const Reals farthest2 =
        dot(way, way) + dot(h[0], h[0]) + dot(h[1], h[1]) + dot(h[2], h[2]) + (products + products);
    // An infinite error, of a box that bounds nothing, leaves each ball but infinite ones.
    const auto ball_cuts =
        less(mul(mul(ball[3], ball[3]), all<Reals>(1 + 0x1p-16)), farthest2 + mul(box.error, all<Reals>(0x1p-100)));
    bounds.radius = select(ball_cuts, ball[3], all<Reals>(static_cast<double>(infinity)));

    Reals low[3], high[3];
    for (unsigned axis = camera.orthographic ? 0 : 2; axis < 3; ++axis) {
        const Reals along = h[2][axis], across = abs(h[0][axis]) + abs(h[1][axis]), narrow = mul(across, box.taper);
        low[axis] = box.centre[axis] - maximum(across - along, narrow + along) - box.error;
        high[axis] = box.centre[axis] + maximum(across + along, narrow - along) + box.error;
    }
    if (camera.orthographic) bounds.image = {{low[0], low[1]}, {high[0], high[1]}};
    bounds.box_nearest = low[2];
    bounds.nearest = maximum(ball[2] - bounds.radius, low[2]);
    bounds.farthest = minimum(ball[2] + bounds.radius, high[2]);
    const auto inside = both(less_equal(all<Reals>(static_cast<double>(camera.near_depth)), bounds.farthest),
                             less_equal(bounds.nearest, all<Reals>(static_cast<double>(camera.far_depth))));
    return both(inside, less_equal(bounds.nearest, bounds.farthest));
}

/// Narrows the image bounds of boxes to those of their balls, where these cut the boxes. Returns `visible` without
/// the lights of which both do not intersect in the numbers that tile_span() takes tiles from.
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

/// The numbers of a vector of boxes that later stages read, with an array for each.
struct StoredBoxes {
    float ball[4][lanes], nearest[lanes], farthest[lanes], centre[3][lanes], half_axes[3][3][lanes], tolerance[lanes];
};

/// The transform from the lights' space to view space after the camera's signs, in double.
struct BoxTransform {
    BoxTransform(const Camera& camera, const WorldToView* to_view) {
        const double signs[] = {static_cast<double>(camera.x.sign), static_cast<double>(camera.y.sign),
                                static_cast<double>(camera.z_sign)};
        for (unsigned row = 0; row < 3; ++row) {
            for (unsigned column = 0; column < 4; ++column)
                matrix[column][row] = to_view != nullptr
                                          ? signs[row] * to_view->matrix()[static_cast<int>(column)][row]
                                      : column == row ? signs[row]
                                                      : 0.0;
            translation += abs_of(matrix[3][row]);
        }
        for (unsigned column = 0; column < 3; ++column)
            norm = max_of(norm, abs_of(matrix[column][0]) + abs_of(matrix[column][1]) + abs_of(matrix[column][2]));
    }

    double matrix[4][3];
    /// The absolute values of the terms of an image's three rows add up to at most  norm (|x| + |y| + |z|) +
    /// translation.
    double norm = 0, translation = 0;
};

/// Projects in double those boxes of a vector whose bit in `which` is set. Stores their rectangles from index i of
/// the chunk on, sets the bits of those in view in chunk.visible, and replaces their numbers in `stored`.
///
/// ball   the balls in view space after the camera's signs
/// given  the boxes' centres, half axes and tapers as they are given
LIGHTBIN_NOINLINE inline void project_boxes_in_double(const Camera& camera, const BoxTransform& transform,
                                                      unsigned which, const Floats (&ball)[4],
                                                      const Floats (&given)[13], std::uint32_t i,
                                                      ProjectedChunk& chunk, StoredBoxes& stored) {
    for (unsigned half = 0; half < lanes / double_lanes; ++half) {
        const unsigned chosen = which >> half * double_lanes & ((1u << double_lanes) - 1);
        if (chosen == 0) continue;
        BoxLanes<Doubles> box;
        Doubles size = broadcast(0.0);
        for (unsigned part = 0; part < 4; ++part) {
            Doubles from[3];
            for (unsigned k = 0; k < 3; ++k) {
                from[k] = widened(given[3 * part + k], half);
                size = size + abs(from[k]);
            }
            for (unsigned row = 0; row < 3; ++row) {
                const Doubles image = mul(from[0], broadcast(transform.matrix[0][row])) +
                                      mul(from[1], broadcast(transform.matrix[1][row])) +
                                      mul(from[2], broadcast(transform.matrix[2][row]));
                if (part == 0)
                    box.centre[row] = image + transform.matrix[3][row];
                else
                    box.half_axes[part - 1][row] = image;
            }
        }
        box.taper = widened(given[12], half);
        box.error = mul(mul(size, broadcast(transform.norm)) + transform.translation, broadcast(0x1p-46));
        // A box that is too large to be rounded to float bounds nothing: the light is then its whole ball.
        const Doubles view_size = size_of(box), infinite = broadcast(static_cast<double>(infinity)),
                      zero = broadcast(0.0);
        const auto fits = less_equal(view_size + box.error, broadcast(0x1p60));
        box.error = select(fits, box.error, infinite);
        for (unsigned k = 0; k < 3; ++k) {
            box.centre[k] = select(fits, box.centre[k], zero);
            for (Doubles(&h)[3] : box.half_axes)
                h[k] = select(fits, h[k], zero);
        }
        const Doubles sphere[] = {widened(ball[0], half), widened(ball[1], half), widened(ball[2], half),
                                  widened(ball[3], half)};
        BoxBounds<Doubles> bounds;
        auto visible = find_box_depths(camera, box, sphere, bounds);
        if (!camera.orthographic)
            corner_slopes(box, chosen, bounds.box_nearest, static_cast<double>(camera.near_depth), bounds.image);
        visible =
            narrow_to_balls<double>(camera, bounds_in_double(camera, sphere[0], sphere[1], sphere[2], sphere[3]),
                                    bounds.radius, bounds.image, visible);
        ChunkRects rects;
        const unsigned in_view = movemask(tile_rects<double>(camera, bounds.image, visible, rects, 0)) & chosen;

        // Depths are rounded outward to float: 2^-23 of a number is at least one unit in its last place. The limits
        // keep them in the range of floats. Rounding a box to float moves each point by less than 2^-24 of the box's
        // size, see StoredBoxes and ViewBox.
        const Doubles largest = broadcast(static_cast<double>(FLT_MAX) * 0.5);
        const Doubles numbers[] = {
            bounds.radius,
            maximum(bounds.nearest - mul(abs(bounds.nearest), broadcast(0x1p-23)) - 0x1p-120, -largest),
            minimum(bounds.farthest + mul(abs(bounds.farthest), broadcast(0x1p-23)) + 0x1p-120, largest),
            box.error + mul(select(fits, view_size, infinite), broadcast(0x1p-19)) + 0x1p-120};
        float* const to[] = {stored.ball[3], stored.nearest, stored.farthest, stored.tolerance};
        const auto put = [&](float* floats, Doubles values) {
            double of_lanes[double_lanes];
            store_doubles(of_lanes, values);
            for (unsigned lane = 0; lane < double_lanes; ++lane)
                if ((chosen >> lane & 1) != 0)
                    floats[half * double_lanes + lane] = static_cast<float>(of_lanes[lane]);
        };
        for (unsigned k = 0; k < 4; ++k)
            put(to[k], numbers[k]);
        for (unsigned k = 0; k < 3; ++k) {
            put(stored.centre[k], box.centre[k]);
            for (unsigned axis = 0; axis < 3; ++axis)
                put(stored.half_axes[axis][k], box.half_axes[axis][k]);
        }
        for (unsigned lane = 0; lane < double_lanes; ++lane) {
            if ((chosen >> lane & 1) == 0) continue;
            const std::uint32_t at = i + half * double_lanes + lane;
            chunk.rects.x0[at] = rects.x0[lane];
            chunk.rects.y0[at] = rects.y0[lane];
            chunk.rects.x1[at] = rects.x1[lane];
            chunk.rects.y1[at] = rects.y1[lane];
        }
        chunk.visible |= std::uint64_t{in_view} << (i + half * double_lanes);
    }
}

/// Finds and stores the half spaces of the six faces of boxes, whose BoxLanes::error is the ViewBox's tolerance.
///
/// Rounding, with u = 2^-24 and S = size_of(box): the greatest n.p of a box is computed with an error of at most 8u
/// S, which the tolerance covers, see ViewBox. For the 4u S that cell_planes.hpp asks for, 8u S = 2^-21 S is added. S
/// is not bounded from below as cell_planes.hpp wants it for underflow: with a perspective projection S is at least
/// the depth of any point of the light, and with an orthographic one the tolerance's 2^-120 is enough.
inline void store_box_planes(const Camera& camera, ViewBox* to, const BoxLanes<Floats>& box) {
    Floats axes[3][3], normals[6][3];
    find_unit_axes(box, axes);
    find_normals(axes, box.taper, normals);
    const Floats slack = box.error + mul(size_of(box), broadcast(0x1p-21f));
    // Without tapers, opposite faces have opposite normals, for which the numbers below are the same but for signs.
    const bool tapered = movemask(less(box.taper, broadcast(1.0f))) != 0;
    for (unsigned face = 0; face < 6; face += tapered ? 1 : 2) {
        Floats(&n)[3] = normals[face];
        const Floats length2 = dot(n, n);
        const auto has_area = less(broadcast(0x1p-100f), length2);
        const Floats per_length = select(has_area, 1.0f / sqrt(length2), Floats{});
        for (unsigned i = 0; i < 3; ++i)
            n[i] = mul(n[i], per_length);
        const Floats at_centre = dot(n, box.centre), from_centre = reach_from_centre(box, n);
        store_plane(camera, to, face, n, select(has_area, at_centre + from_centre + slack, broadcast(infinity)));
        if (tapered) continue;
        for (unsigned i = 0; i < 3; ++i)
            n[i] = -n[i];
        store_plane(camera, to, face + 1, n, select(has_area, from_centre - at_centre + slack, broadcast(infinity)));
    }
}

/// Stores a vector of boxes, except the half spaces around them, which store_box_planes() stores.
inline void store_boxes_in_view(ViewBox* to, const StoredBoxes& stored, Floats taper) {
    Sphere vec4s[lanes];
    const auto load = [](const float(&numbers)[lanes]) { return load_floats(numbers); };
    const auto store = [&](std::size_t offset, Floats a, Floats b, Floats c, Floats d) {
        store_spheres(vec4s, a, b, c, d);
        store_vec4s(to, offset, vec4s);
    };
    store(offsetof(ViewBox, ball), load(stored.ball[0]), load(stored.ball[1]), load(stored.ball[2]),
          load(stored.ball[3]));
    store(offsetof(ViewBox, nearest), load(stored.nearest), load(stored.farthest), taper, load(stored.tolerance));
    const float(&h)[3][3][lanes] = stored.half_axes;
    store(offsetof(ViewBox, centre), load(stored.centre[0]), load(stored.centre[1]), load(stored.centre[2]),
          load(h[0][0]));
    store(offsetof(ViewBox, centre) + sizeof *vec4s, load(h[0][1]), load(h[0][2]), load(h[1][0]), load(h[1][1]));
    store(offsetof(ViewBox, centre) + 2 * sizeof *vec4s, load(h[1][2]), load(h[2][0]), load(h[2][1]), load(h[2][2]));
}

/// Returns which boxes of a vector are good input, see Box: the balls, and the boxes' centres, half axes and tapers.
LIGHTBIN_INLINE unsigned good_boxes(const Floats (&ball)[4], const Floats (&given)[13]) {
    const Floats largest = broadcast(FLT_MAX);
    auto good =
        both(less(Floats{}, ball[3]), both(less_equal(Floats{}, given[12]), less_equal(given[12], broadcast(1.0f))));
    Floats longest = Floats{};
    for (unsigned i = 0; i < 3; ++i)
        good = both(good, both(less_equal(abs(ball[i]), largest), less_equal(abs(given[i]), largest)));
    for (unsigned i = 3; i < 12; ++i) {
        good = both(good, less_equal(abs(given[i]), largest));
        longest = maximum(abs(given[i]), longest);
    }
    return movemask(both(good, less(Floats{}, longest)));
}

/// Appends the footprints of those of the boxes first..first + count - 1 that are in view. Boxes are projected in
/// float where its rounding errors are at most 2^-9 of their depths and nothing overflows or underflows, and their
/// balls if these cut them and lie wholly beyond the near plane; all others in double.
inline void project_boxes(const Camera& camera, const LightSource& source, std::uint32_t first, std::uint32_t count,
                          const FootprintArrays& out, ProjectCounts& counts) {
    ProjectedChunk chunk;
    Sphere balls[ChunkRects::size], parts[4][ChunkRects::size];  // as LightSource::copy writes them
    StoredBoxes stored;
    const TransformLanes transform(source.to_view);
    const BoxTransform double_transform(camera, source.to_view);
    const ViewLanes view(camera);
    const Floats signs[] = {view.sign_x, view.sign_y, view.sign_z}, largest = broadcast(float_safe_max),
                 infinite = broadcast(infinity);
    const Floats front = broadcast(camera.near_depth);
    for (std::uint32_t here; count > 0; count -= here, first += here) {
        here = min_of(count, ChunkRects::size);
        source.copy(source.lights, first, here, balls, parts[0]);
        float tapers[ChunkRects::size];
        std::memcpy(tapers, parts[3], here * sizeof *tapers);
        for (std::uint32_t i = here; i % lanes != 0; ++i) {
            balls[i] = balls[0];
            for (unsigned part = 0; part < 3; ++part)
                parts[part][i] = parts[part][0];
            tapers[i] = tapers[0];
        }
        chunk.visible = 0;
        for (std::uint32_t i = 0; i < here; i += lanes) {
            const unsigned valid = (1u << min_of(lanes, here - i)) - 1;
            Floats ball[4], given[13];
            load_spheres(balls + i, ball[0], ball[1], ball[2], ball[3]);
            for (unsigned part = 0; part < 3; ++part)
                load_spheres(parts[part] + i, given[4 * part], given[4 * part + 1], given[4 * part + 2],
                             given[4 * part + 3]);
            given[12] = load_floats(tapers + i);
            const Floats given_ball[] = {ball[0], ball[1], ball[2], ball[3]};
            BoxLanes<Floats> box;
            box.taper = given[12];
            Floats moved_error = Floats{};
            auto safe = less_equal(Floats{}, Floats{});  // all
            if (source.to_view != nullptr) {
                transform_spheres(transform, ball[0], ball[1], ball[2], ball[3]);
                Floats from_origin[3], size = Floats{};
                for (unsigned k = 0; k < 3; ++k) {
                    from_origin[k] = given[k] - transform.origin[k];
                    size = size + abs(from_origin[k]);
                }
                safe = less_equal(size, transform.max_distance);
                for (unsigned k = 3; k < 12; ++k)
                    size = size + abs(given[k]);
                moved_error = (mul(size, transform.error_rate) + transform.error_at_origin) * 2.0f;
                for (unsigned row = 0; row < 3; ++row) {
                    box.centre[row] =
                        transformed_row(transform, row, from_origin[0], from_origin[1], from_origin[2]) +
                        transform.origin_image[row];
                    for (unsigned axis = 0; axis < 3; ++axis)
                        box.half_axes[axis][row] = transformed_row(transform, row, given[3 * axis + 3],
                                                                   given[3 * axis + 4], given[3 * axis + 5]);
                }
            } else {
                for (unsigned row = 0; row < 3; ++row) {
                    box.centre[row] = given[row];
                    for (unsigned axis = 0; axis < 3; ++axis)
                        box.half_axes[axis][row] = given[3 * axis + 3 + row];
                }
            }
            for (unsigned row = 0; row < 3; ++row) {
                ball[row] = ball[row] * signs[row];
                box.centre[row] = box.centre[row] * signs[row];
                for (Floats(&h)[3] : box.half_axes)
                    h[row] = h[row] * signs[row];
            }
            const Floats centre_size = abs(ball[0]) + abs(ball[1]) + abs(ball[2]), ball_size = centre_size + ball[3];
            const auto ball_safe = safe_in_float(ball_size, ball[3]);
            const Floats axes = axes_size(box), size = size_of(box);
            safe = both(safe, both(both(less_equal(size, largest), less_equal(centre_size, largest)),
                                   less_equal(broadcast(float_safe_min), axes)));
            // Most boxes are seen to be good by numbers that are needed anyway: sums that are not NaN or infinite, of
            // axes that are not 0.
            const auto in_range = both(both(less(Floats{}, given_ball[3]), less_equal(given[12], broadcast(1.0f))),
                                       less_equal(Floats{}, given[12]));
            unsigned good = movemask(both(safe, in_range)) & valid;
            if (good != valid) good = good_boxes(given_ball, given) & valid;
            counts.rejected += static_cast<std::uint32_t>(std::popcount(valid & ~good));
            const unsigned culled =
                ~good | movemask(both(ball_safe, out_of_view(view, ball[0], ball[1], ball[2], ball[3],
                                                             ball[2] - ball[3], ball[2] + ball[3], ball_size)));
            if ((~culled & valid) == 0) continue;

            box.error = mul(size, broadcast(0x1p-20f)) + moved_error;
            BoxBounds<Floats> bounds;
            auto visible = find_box_depths(camera, box, ball, bounds);
            const auto whole = less_equal(infinite, bounds.radius);
            safe = both(safe, either(whole, ball_safe));
            if (!camera.orthographic) {
                const Floats nearest_ball = ball[2] - bounds.radius;
                safe = both(safe, both(less_equal(box.error * 0x1p9f, maximum(bounds.box_nearest, front)),
                                       either(whole, less(broadcast(camera.min_float_depth), nearest_ball))));
                corner_slopes(box, movemask(visible) & ~culled & valid, bounds.box_nearest,
                              static_cast<double>(camera.near_depth), bounds.image);
            }
            if ((~movemask(whole) & ~culled & valid) != 0) {
                ImageBounds<Floats> of_balls = {{ball[0] - ball[3], ball[1] - ball[3]},
                                                {ball[0] + ball[3], ball[1] + ball[3]}};
                if (!camera.orthographic) {
                    const Floats e = mul(ball[2] - ball[3], ball[2] + ball[3]), per_e = 1.0f / e;
                    tangent_slopes(ball[0], ball[2], ball[3], e, per_e, of_balls.low[0], of_balls.high[0]);
                    tangent_slopes(ball[1], ball[2], ball[3], e, per_e, of_balls.low[1], of_balls.high[1]);
                }
                visible = narrow_to_balls<float>(camera, of_balls, bounds.radius, bounds.image, visible);
            }
            const unsigned in_float = movemask(safe) & ~culled & valid, in_double = ~movemask(safe) & ~culled & valid;
            const auto in_view = tile_rects<float>(camera, bounds.image, visible, chunk.rects, i);
            chunk.visible |= std::uint64_t{movemask(in_view) & in_float} << i;
            if (source.out_boxes == nullptr && in_double == 0) continue;

            for (unsigned k = 0; k < 3; ++k) {
                store_floats(stored.ball[k], ball[k]);
                store_floats(stored.centre[k], box.centre[k]);
                for (unsigned axis = 0; axis < 3; ++axis)
                    store_floats(stored.half_axes[axis][k], box.half_axes[axis][k]);
            }
            store_floats(stored.ball[3], bounds.radius);
            store_floats(stored.nearest, bounds.nearest);
            store_floats(stored.farthest, bounds.farthest);
            store_floats(stored.tolerance, box.error + 0x1p-120f);
            if (in_double != 0)
                project_boxes_in_double(camera, double_transform, in_double, ball, given, i, chunk, stored);
            if (source.out_boxes == nullptr) continue;
            store_boxes_in_view(source.out_boxes + first + i, stored, box.taper);
            if (!source.with_planes) continue;
            for (unsigned k = 0; k < 3; ++k) {
                box.centre[k] = load_floats(stored.centre[k]);
                for (unsigned axis = 0; axis < 3; ++axis)
                    box.half_axes[axis][k] = load_floats(stored.half_axes[axis][k]);
            }
            box.error = load_floats(stored.tolerance);
            store_box_planes(camera, source.out_boxes + first + i, box);
        }
        append_chunk(chunk, source.first_id + first, here, out, counts);
    }
}

}}}}  // namespace lightbin::detail
