// SPDX-License-Identifier: MIT
// Row spans of boxes: the silhouettes of their balls, cut off at the lines of the boxes' silhouettes. Included once
// per tier (ISA).
//
// An edge of a box is on its silhouette if the eye sees one of the two faces that meet there and not the other. The
// plane through eye and edge is then a line in the image that bounds the box. The four faces around a half axis have
// two such edges between them or none, so that at most six lines bound a box. If the eye is in the box, there are
// none.
//
// Let n be the normal of such a plane, away from the box, and m the greatest n.p of all points p of the box, which is
// 0 up to rounding. The light's points within the slopes v0 to v1 of a tile row, whose view depth is at least z, have
// slopes x with  n_x x <= L - min(n_y v0, n_y v1),  where L = max(m, 0) / z - n_z.  With an orthographic projection the
// plane has the view direction, and L = m. Lines with |n_x| up to 2^-60 |n| are left out: they are all but horizontal, so
// the rectangle bounds the box as well.
//
// As m is the greatest n.p of the box as ViewBox holds it, plus |n| times the box's tolerance, a wrong choice of an
// edge because of rounding makes a bound looser but loses no light. The tolerance covers the rounding in m, see
// ViewBox. Let u = 2^-24, and V be a bound on the slopes of tile rows. The quotient m / z has an error of at most
// 2u m / z, and two sums make L of it. L / n_x and n_y / n_x have relative errors of 2u, which is as if L were off by
// 2u (|L| + |n_y| V). In all, this is less than 7u (m / z + |n| (1 + V)), of which 16u are added to L. What is left
// exceeds the errors of the rows' slopes and of computing in double, which are less than 2^-46 of the same.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/box_vectors.inl>
#include <lightbin/detail/project/spot_rows.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Finds the lines of the silhouettes of a vector of boxes. In place of lines that there are not it finds others that
/// hold the box, too.
///
/// box      BoxLanes::error is the ViewBox's tolerance
/// nearest  a positive lower bound on the lights' view depths; 1 with an orthographic projection
inline void find_outlines(const Camera& camera, const BoxLanes<Floats>& box, Floats nearest, LineTerms<6>& lines) {
    const Floats zero = Floats{}, one = broadcast(1.0f), per_nearest = 1.0f / nearest;
    const Floats narrowing = mul(1.0f - box.taper, broadcast(0.5f)), per_size = 1.0f / size_of(box);
    const Floats slopes = broadcast(float_above(1 + max_row_slope(camera)));
    Floats axes[3][3], normals[6][3];
    find_unit_axes(box, axes);
    find_normals(axes, box.taper, normals);
    decltype(less(zero, one)) seen[6];
    for (unsigned face = 0; face < 6; ++face) {  // whether the eye, which is at 0, lies on the outer side of the face
        const Floats(&h)[3][3] = box.half_axes;
        Floats point[3];  // of the face, where half axis 2 points to or, on face 5, away
        for (unsigned i = 0; i < 3; ++i) {
            const Floats end = box.centre[i] + (face == 5 ? -h[2][i] : h[2][i]);
            point[i] = face >= 4 ? end : face % 2 == 0 ? end + h[face / 2][i] : end - h[face / 2][i];
        }
        seen[face] = less(camera.orthographic ? normals[face][2] : dot(point, normals[face]), zero);
    }
    const bool tapered = movemask(less(box.taper, one)) != 0;
    LIGHTBIN_UNROLL for (unsigned axis = 0; axis < 3; ++axis) {
        // Faces and edges around the half axis, in their order: edge i lies between the faces i and i + 1.
        const unsigned j = (axis + 1) % 3, k = (axis + 2) % 3;
        const auto f0 = seen[2 * j], f1 = seen[2 * k], f2 = seen[2 * j + 1], f3 = seen[2 * k + 1];
        const auto e0 = either(and_not(f0, f1), and_not(f1, f0)), e1 = either(and_not(f1, f2), and_not(f2, f1)),
                   e2 = either(and_not(f2, f3), and_not(f3, f2)), e3 = either(and_not(f3, f0), and_not(f0, f3));
        // Of the four edges parallel to half axis `axis`, two are on the silhouette. For each of them, on which side of
        // the other two half axes, j and k, it lies: 1 where the half axis points to, or -1.
        const Floats sides[2][2] = {{select(e0, one, -one), select(either(e0, e1), one, -one)},
                                    {select(e3, one, -one), select(either(e2, e3), -one, one)}};
        LIGHTBIN_UNROLL for (unsigned line = 0; line < 2; ++line) {
            // A point of the edge, centre + q, and the edge's direction. The box is narrower where half axis 2 points
            // away.
            Floats side_j = sides[line][0], side_k = sides[line][1];
            if (j == 2) side_k = select(less(side_j, zero), mul(side_k, box.taper), side_k);
            if (k == 2) side_j = select(less(side_k, zero), mul(side_j, box.taper), side_j);
            Floats q[3], eye[3], direction[3], n[3];
            for (unsigned i = 0; i < 3; ++i) {
                const Floats out = mul(side_j, box.half_axes[j][i]) + mul(side_k, box.half_axes[k][i]);
                q[i] = axis == 2 ? out + box.half_axes[2][i] : out;
                direction[i] = axes[axis][i];
                if (axis == 2 && tapered)
                    direction[i] = direction[i] + mul(narrowing, mul(side_j, axes[j][i]) + mul(side_k, axes[k][i]));
                eye[i] = camera.orthographic ? broadcast(i == 2 ? 1.0f : 0.0f) : mul(box.centre[i] + q[i], per_size);
            }
            cross(direction, eye, n);
            const auto inward = less(dot(n, q), zero);
            for (unsigned i = 0; i < 3; ++i)
                n[i] = select(inward, -n[i], n[i]);
            const Floats size = abs(n[0]) + abs(n[1]) + abs(n[2]), most = reach_of(box, n) + mul(size, box.error);
            const Floats at_nearest = camera.orthographic ? most : mul(maximum(most, zero), per_nearest);
            const Floats error = mul(abs(at_nearest) + mul(size, slopes), broadcast(0x1p-20f));
            const Floats limit = at_nearest + error - (camera.orthographic ? zero : n[2]);
            const auto steep = less(mul(size, broadcast(0x1p-60f)), abs(n[0]));
            const Floats per_x = 1.0f / select(steep, n[0], one), drift = mul(n[1], per_x),
                         here = mul(select(steep, limit, broadcast(infinity)), per_x);
            const unsigned index = 2 * axis + line;
            lines.ends[index] = movemask(less(zero, per_x));
            lines.rises[index] = movemask(less(zero, n[1]));
            for (unsigned half = 0; half < lanes / double_lanes; ++half)
                lines.store(camera, index, half * double_lanes, widened(here, half), widened(drift, half));
        }
    }
}

/// The silhouettes of a vector of boxes, from which row_spans() makes spans of tiles.
struct BoxRows {
    unsigned find(const Camera& camera, const FootprintArrays& lights, std::uint32_t begin, std::uint32_t count) {
        BoxLanes<Floats> box;
        Floats balls[4], depths;
        load_boxes(
            [&](std::uint32_t lane) -> const ViewBox& {
                return lights.view_lights.shape<LightKind::box>(lights.ids[begin + min_of(lane, count - 1)]);
            },
            box, balls, depths);
        const Floats nearest =
            camera.orthographic ? broadcast(1.0f) : maximum(depths, broadcast(camera.near_depth));
        lines.reset(camera);
        find_outlines(camera, box, nearest, lines);
        balls_known = 0;
        if (movemask(less(balls[3], broadcast(infinity))) != 0)
            for (unsigned half = 0; half < lanes / double_lanes; ++half)
                balls_known |=
                    row_terms(camera, widened(balls[0], half), widened(balls[1], half),
                              widened(balls[2], half), widened(balls[3], half), ball, half * double_lanes);
        return ~0u;
    }

    /// Stores the spans of tiles that light i covers in a vector of tile rows: see SpotRows::store().
    LIGHTBIN_INLINE void store(std::uint32_t i, Doubles v0, Doubles v1, Doubles leftmost, Doubles rightmost,
                               RowSpan* to) const {
        Doubles begin = leftmost, end = rightmost + 1.0;
        if ((balls_known >> i & 1) != 0) {
            Doubles ball_begin, ball_end;
            silhouette_ends(ball, i, v0, v1, ball_begin, ball_end);
            begin = maximum(ball_begin, begin);
            end = minimum(ball_end, end);
        }
        const RowEdges rows(v0, v1);
        LIGHTBIN_UNROLL for (unsigned line = 0; line < 6; ++line)
            cut_at_line(lines, line, i, rows, begin, end);
        store_cut_spans(to, begin, end, leftmost, rightmost);
    }

    RowTerms ball;         ///< the silhouettes of the balls, the spheres that cut the boxes
    unsigned balls_known;  ///< a mask of the boxes whose ball's silhouette is in `ball`
    LineTerms<6> lines;
};

}}}}  // namespace lightbin::detail
