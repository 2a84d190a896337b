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
// slopes x with n_x x <= max(m, 0) / z - n_z - min(n_y v0, n_y v1). With an orthographic projection the plane has the
// view direction, and n.p <= m.
//
// As m is the greatest n.p of the box as ViewBox holds it, plus |n| times the box's tolerance, a wrong choice of an
// edge because of rounding makes a bound looser but loses no light. The tolerance covers the rounding in m, see
// ViewBox; the quotient m / z and n_z have errors of at most 4u m / z and u |n|, with u = 2^-24, of which 8u are
// added. All other errors are less than 2^-48 of the slopes of rows and columns; 2^-40 of them is added.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/box_vectors.inl>
#include <lightbin/detail/project/spot_rows.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The lines that bound each of `lanes` boxes in the image, as WedgeTerms has them for spots.
struct OutlineTerms {
    double per_x[6][lanes], n_y[6][lanes], limit[6][lanes];
};

/// Finds the lines of the silhouettes of a vector of boxes. In place of lines that there are not it finds others that
/// hold the box, too.
///
/// box      BoxLanes::error is the ViewBox's tolerance
/// nearest  a positive lower bound on the lights' view depths; 1 with an orthographic projection
inline void find_outlines(const Camera& camera, const BoxLanes<Floats>& box, Floats nearest, OutlineTerms& terms) {
    const Floats zero = Floats{}, one = broadcast(1.0f), per_nearest = 1.0f / nearest;
    const Floats narrowing = mul(1.0f - box.taper, broadcast(0.5f)), per_size = 1.0f / size_of(box);
    const double slope_error = 0x1p-40 * (1 + max_row_slope(camera));
    Floats axes[3][3], normals[6][3];
    find_unit_axes(box, axes);
    find_normals(axes, box.taper, normals);
    decltype(less(zero, one)) seen[6];
    for (unsigned face = 0; face < 6; ++face)  // the eye is at 0: whether that lies on the outer side of the face
        seen[face] = less(camera.orthographic ? normals[face][2] : reach_of(box, normals[face]), zero);
    for (unsigned axis = 0; axis < 3; ++axis) {
        // Faces and edges around the half axis, in their order: edge i lies between the faces i and i + 1.
        const unsigned j = (axis + 1) % 3, k = (axis + 2) % 3;
        const auto f0 = seen[2 * j], f1 = seen[2 * k], f2 = seen[2 * j + 1], f3 = seen[2 * k + 1];
        const auto e0 = either(and_not(f0, f1), and_not(f1, f0)), e1 = either(and_not(f1, f2), and_not(f2, f1)),
                   e2 = either(and_not(f2, f3), and_not(f3, f2)), e3 = either(and_not(f3, f0), and_not(f0, f3));
        // The first and the last of the edges that are on the silhouette: on which side of half axes j and k they are.
        const Floats sides[2][2] = {{select(e0, one, -one), select(either(e0, e1), one, -one)},
                                    {select(e3, one, -one), select(either(e2, e3), -one, one)}};
        for (unsigned line = 0; line < 2; ++line) {
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
                if (axis == 2)
                    direction[i] = direction[i] + mul(narrowing, mul(side_j, axes[j][i]) + mul(side_k, axes[k][i]));
                eye[i] = camera.orthographic ? broadcast(i == 2 ? 1.0f : 0.0f) : mul(box.centre[i] + q[i], per_size);
            }
            cross(direction, eye, n);
            const auto inward = less(dot(n, q), zero);
            for (unsigned i = 0; i < 3; ++i)
                n[i] = select(inward, -n[i], n[i]);
            const Floats size = abs(n[0]) + abs(n[1]) + abs(n[2]), most = reach_of(box, n) + mul(size, box.error);
            const Floats at_nearest = camera.orthographic ? most : mul(maximum(most, zero), per_nearest);
            const Floats limit =
                at_nearest + mul(abs(at_nearest) + size, broadcast(0x1p-21f)) - (camera.orthographic ? zero : n[2]);
            for (unsigned half = 0; half < lanes / double_lanes; ++half) {
                const unsigned to = half * double_lanes;
                const Doubles error = widened(size, half) * slope_error;
                store_doubles(terms.per_x[2 * axis + line] + to, camera.x.scale / widened(n[0], half));
                store_doubles(terms.n_y[2 * axis + line] + to, widened(n[1], half));
                store_doubles(terms.limit[2 * axis + line] + to, widened(limit, half) + error);
            }
        }
    }
}

/// The silhouettes of a vector of boxes, from which row_spans() makes spans of tiles.
struct BoxRows {
    unsigned find(const Camera& camera, const FootprintArrays& lights, std::uint32_t begin, std::uint32_t count) {
        Sphere vec4s[5][lanes];  // a ViewBox up to its half axes
        static_assert(offsetof(ViewBox, around) == 5 * sizeof(Sphere));
        for (std::uint32_t i = 0; i < lanes; ++i) {
            const ViewBox& box = lights.view_lights.shape<LightKind::box>(lights.ids[begin + min_of(i, count - 1)]);
            for (std::size_t part = 0; part < 5; ++part)
                std::memcpy(vec4s[part] + i, reinterpret_cast<const char*>(&box) + part * sizeof(Sphere),
                            sizeof(Sphere));
        }
        Floats parts[5][4];
        for (unsigned part = 0; part < 5; ++part)
            load_spheres(vec4s[part], parts[part][0], parts[part][1], parts[part][2], parts[part][3]);
        BoxLanes<Floats> box;
        for (unsigned i = 0; i < 3; ++i) {
            box.centre[i] = parts[2][i];
            for (unsigned axis = 0; axis < 3; ++axis)
                box.half_axes[axis][i] = parts[2 + (3 * axis + i + 3) / 4][(3 * axis + i + 3) % 4];
        }
        box.taper = parts[1][2];
        box.error = parts[1][3];
        const Floats nearest =
            camera.orthographic ? broadcast(1.0f) : maximum(parts[1][0], broadcast(camera.near_depth));
        find_outlines(camera, box, nearest, lines);
        balls_known = 0;
        if (movemask(less(parts[0][3], broadcast(infinity))) != 0)
            for (unsigned half = 0; half < lanes / double_lanes; ++half)
                balls_known |=
                    row_terms(camera, widened(parts[0][0], half), widened(parts[0][1], half),
                              widened(parts[0][2], half), widened(parts[0][3], half), ball, half * double_lanes);
        const double margin = 0x1p-40 * (abs_of(camera.x.offset) + camera.x.tiles);
        low = camera.x.offset - margin;
        high = camera.x.offset + margin;
        return ~0u;
    }

    /// Stores the spans of tiles that light i covers in a vector of tile rows: see SpotRows::store().
    void store(std::uint32_t i, Doubles v0, Doubles v1, Doubles leftmost, Doubles rightmost, RowSpan* to) const {
        Doubles begin = leftmost, end = rightmost + 1.0;
        if ((balls_known >> i & 1) != 0) {
            Doubles ball_begin, ball_end;
            silhouette_ends(ball, i, v0, v1, ball_begin, ball_end);
            begin = maximum(ball_begin, begin);
            end = minimum(ball_end, end);
        }
        for (unsigned line = 0; line < 6; ++line)
            cut_at_line(lines.per_x[line][i], lines.n_y[line][i], lines.limit[line][i], low, high, v0, v1, begin, end);
        store_cut_spans(to, begin, end, leftmost, rightmost);
    }

    RowTerms ball;         ///< the silhouettes of the balls, the spheres that cut the boxes
    unsigned balls_known;  ///< a mask of the boxes whose ball's silhouette is in `ball`
    OutlineTerms lines;
    double low, high;  ///< the x of the view axis in the image, in tiles, less and plus a margin for rounding
};

/// The silhouettes of lights of a kind.
template <LightKind kind>
using RowsOf = std::conditional_t<kind == LightKind::box, BoxRows,
                                  std::conditional_t<kind == LightKind::spot, SpotRows, SphereRows>>;

}}}}  // namespace lightbin::detail
