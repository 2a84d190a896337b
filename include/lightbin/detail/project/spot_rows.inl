// SPDX-License-Identifier: MIT
// Row spans of spots: their balls' silhouettes, cut off at lines that bound the cones. Included once per tier (ISA).
//
// Two planes through the eye touch a cone, unless the eye is inside it. In the image they are two lines through the
// apex. Let t be the half angle, a the unit axis, u the unit vector from the eye to the apex, b = a - (a.u) u and
// s = |b|. The planes' unit normals are
//     n = -(sin t / s) b / s +- sqrt(1 - (sin t / s)^2) u x b / s,   for which  n.u = 0  and  n.a = -sin t,
// and each point p of the cone has  n.p <= 0. So a spot's points whose view depth is at least z, within the slopes v0
// to v1 of a tile row, have slopes x with  n_x x <= tolerance / z - n_z - min(n_y v0, n_y v1),  where `tolerance` is
// the spot's. (The Universal Render Pipeline of Unity bounds spots by the same planes.) With an orthographic
// projection u is the view direction, and  n.(p - apex) <= tolerance. No such lines bound a cone of 90 degrees or more:
// of such a spot the row spans are those of its ball, within the spot's rectangle.
//
// Rounding, with the unit roundoffs u = 2^-24 of float and e = 2^-53 of double:
// - sin t and |a| have errors of at most 8u and 18u. Where t is near 90 degrees, a small change of the sine is a large
//   one of the angle: the planes' angle to the axis has an error of at most 26u tan t, and n.p can be larger by as
//   much times the radius r. The tolerance is enlarged by 32u r / cos t.
// - For s >= 2^-20, n is within 2^-30 of the normal for the given floats. The tolerance is enlarged by 2^-28 (|p| + r).
// - All other errors are less than 2^-48 of the slopes of rows and columns; 2^-40 of them is added.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/project/sphere_rows.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// For each of `lanes` lights `count` lines in the image that bound it. In a tile row a line ends or begins the span of
/// tiles that the light covers. Let n be the normal of the plane through eye and line, away from the light: the slopes
/// x and y of the light's points have  n_x x + n_y y <= L.  At the slope y the line is at  `at` - `drift` y,  in tiles.
template <unsigned count> struct LineTerms {
    /// Prepares for the lines of other lights.
    void reset(const Camera& camera) {
        margin[0] = 0x1p-40 * (abs_of(camera.x.offset) + camera.x.tiles);
        for (unsigned line = 0; line < count; ++line)
            ends[line] = rises[line] = 0;
    }

    /// Stores one of the lines of each light of a vector of doubles.
    ///
    /// lane   the first of the lights' lanes
    /// here   L / n_x, infinite if the light has no such line
    /// slope  n_y / n_x
    void store(const Camera& camera, unsigned line, unsigned lane, Doubles here, Doubles slope) {
        const Doubles scale = broadcast(camera.x.scale);
        store_doubles(at[line] + lane, mul(here, scale) + camera.x.offset);
        store_doubles(drift[line] + lane, slope * scale);
    }

    double at[count][lanes], drift[count][lanes];
    unsigned ends[count];   ///< a mask of the lights whose n_x is positive: the line ends spans, else it begins them
    unsigned rises[count];  ///< a mask of the lights whose n_y is positive
    /// By how many tiles a line is moved outward before spans are cut at it. [0]: at that end of the spans, left or
    /// right, which the line bounds, for rounding. [1]: at the opposite end; infinity keeps the line from cutting there.
    double margin[2] = {0, static_cast<double>(infinity)};
};

/// A vector of spots in double, for find_wedges(): the cones' apexes, unit axes and the sines of their half angles.
struct WedgeLanes {
    Doubles apex[3], axis[3];
    Doubles sine;  ///< 1 for half angles of 90 degrees and more: with this sine no line bounds the cone
    /// The most n.(p - apex) for points p of the spot and the outward unit normals n of the two planes through the eye
    /// that touch the cone: not 0, because of rounding. With perspective it is divided by the depth of p.
    Doubles tolerance;
};

/// Finds the two image lines that bound each spot's cone, and stores them from lane `at` on. A cone that no
/// such lines bound gets lines at infinity.
inline void find_wedges(const Camera& camera, const WedgeLanes& spots, unsigned at, LineTerms<2>& lines) {
    const Doubles zero = broadcast(0.0), one = broadcast(1.0), none = broadcast(static_cast<double>(infinity));
    Doubles u[3] = {zero, zero, one};
    if (!camera.orthographic) {
        const Doubles per_length = 1.0 / sqrt(dot(spots.apex, spots.apex));
        for (unsigned i = 0; i < 3; ++i)
            u[i] = mul(spots.apex[i], per_length);
    }
    const Doubles along = dot(spots.axis, u);
    Doubles b[3];
    for (unsigned i = 0; i < 3; ++i)
        b[i] = spots.axis[i] - mul(along, u[i]);
    const Doubles s = sqrt(dot(b, b)), per_s = 1.0 / s;
    const auto eye_outside = less(mul(spots.sine, broadcast(1 + 0x1p-20)) + 0x1p-20, s);
    const Doubles cosine = mul(spots.sine, per_s),
                  sine = mul(sqrt(maximum(mul(s - spots.sine, s + spots.sine), zero)), per_s);
    Doubles back[3], aside[3];
    for (unsigned i = 0; i < 3; ++i) {
        const unsigned j = (i + 1) % 3, k = (i + 2) % 3;
        back[i] = mul(b[i], mul(per_s, cosine));
        aside[i] = mul(mul(u[j], b[k]) - mul(u[k], b[j]), mul(per_s, sine));
    }
    const Doubles slack = spots.tolerance + 0x1p-40 * (1 + max_row_slope(camera));
    for (unsigned side = 0; side < 2; ++side) {
        Doubles n[3];
        for (unsigned i = 0; i < 3; ++i)
            n[i] = (side == 0 ? aside[i] : -aside[i]) - back[i];
        const Doubles limit =
            camera.orthographic ? slack + mul(n[0], spots.apex[0]) + mul(n[1], spots.apex[1]) : slack - n[2];
        const Doubles per_x = 1.0 / select(eye_outside, n[0], one);
        lines.store(camera, side, at, mul(select(eye_outside, limit, none), per_x),
                    mul(select(eye_outside, n[1], zero), per_x));
        lines.ends[side] |= movemask(less(zero, per_x)) << at;
        lines.rises[side] |= movemask(less(zero, n[1])) << at;
    }
}

/// The slopes v1, then v0, of the edges of a vector of tile rows, for cut_at_line().
struct RowEdges {
    RowEdges(Doubles v0, Doubles v1) {
        store_doubles(slopes[0], v1);
        store_doubles(slopes[1], v0);
    }
    alignas(DoubleRegister) double slopes[2][double_lanes];  ///< aligned: loads of vectors just stored would else wait
};

/// Shortens the spans of tiles, begin..end, of light i in a vector of tile rows to the light's side of a line.
template <unsigned count>
LIGHTBIN_INLINE void cut_at_line(const LineTerms<count>& lines, unsigned line, std::uint32_t i, const RowEdges& rows,
                                 Doubles& begin, Doubles& end) {
    // In a row, the light reaches farthest at the edge v0 if n_y is positive, else at v1.
    const Doubles v = load_doubles(rows.slopes[lines.rises[line] >> i & 1]);
    const Doubles here = broadcast(lines.at[line][i]) - mul(broadcast(lines.drift[line][i]), v);
    const unsigned ends = lines.ends[line] >> i & 1;
    end = minimum(here + lines.margin[1 - ends], end);
    begin = maximum(here - lines.margin[ends], begin);
}

/// Stores the spans begin..end, clamped to tile columns leftmost..rightmost; as 1..0 where end < begin.
LIGHTBIN_INLINE void store_cut_spans(RowSpan* to, Doubles begin, Doubles end, Doubles leftmost, Doubles rightmost) {
    const auto none = less(end, begin);
    store_spans(to, select(none, broadcast(1.0), minimum(maximum(begin, leftmost), rightmost)),
                select(none, broadcast(0.0), minimum(maximum(end, leftmost), rightmost)));
}

/// The silhouettes of a vector of spots, from which row_spans() makes spans of tiles. For spheres it takes SphereRows.
struct SpotRows {
    unsigned find(const Camera& camera, const FootprintArrays& lights, std::uint32_t begin, std::uint32_t count) {
        Sphere balls[lanes], axes[lanes], rest[lanes];
        for (std::uint32_t i = 0; i < lanes; ++i) {
            const ViewSpot& spot = lights.view_lights.shape<LightKind::spot>(lights.ids[begin + min_of(i, count - 1)]);
            balls[i] = spot.ball;
            axes[i] = {spot.axis_x, spot.axis_y, spot.axis_z, spot.cosine};
            rest[i] = {spot.nearest, spot.farthest, spot.sine, spot.tolerance};
        }
        Floats apex[3], r, axis[3], cosine, nearest, farthest, sine, tolerance;
        load_spheres(balls, apex[0], apex[1], apex[2], r);
        load_spheres(axes, axis[0], axis[1], axis[2], cosine);
        load_spheres(rest, nearest, farthest, sine, tolerance);
        wedges.reset(camera);
        balls_known = 0;
        for (unsigned half = 0; half < lanes / double_lanes; ++half) {
            WedgeLanes wedge;
            const Doubles radius = widened(r, half);
            Doubles size = radius;
            for (unsigned i = 0; i < 3; ++i) {
                wedge.apex[i] = widened(apex[i], half);
                wedge.axis[i] = widened(axis[i], half);
                size = size + abs(wedge.apex[i]);
            }
            balls_known |=
                row_terms(camera, wedge.apex[0], wedge.apex[1], wedge.apex[2], radius, ball, half * double_lanes);
            const Doubles cosine_of = widened(cosine, half);
            wedge.sine = select(less(broadcast(0.0), cosine_of), widened(sine, half), broadcast(1.0));
            wedge.tolerance = widened(tolerance, half) + size * 0x1p-28 + radius * 0x1p-19 / cosine_of;
            if (!camera.orthographic)
                wedge.tolerance = wedge.tolerance /
                                  maximum(widened(nearest, half), broadcast(static_cast<double>(camera.near_depth)));
            find_wedges(camera, wedge, half * double_lanes, wedges);
        }
        return ~0u;
    }

    /// Stores the spans of tiles that light i covers in a vector of tile rows. The edges of each row lie at the slopes
    /// y / depth = v0 and v1 in view space (orthographic: y = v0 and v1). The spans are clamped to the tile columns
    /// leftmost..rightmost; empty spans are stored as 1..0.
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
        for (unsigned side = 0; side < 2; ++side)
            cut_at_line(wedges, side, i, rows, begin, end);
        store_cut_spans(to, begin, end, leftmost, rightmost);
    }

    RowTerms ball;         ///< the silhouettes of the balls, the spheres that the spots' cones cut
    unsigned balls_known;  ///< a mask of the spots whose sphere has a silhouette in `ball`: beyond the near plane
    LineTerms<2> wedges;
};

}}}}  // namespace lightbin::detail
