// SPDX-License-Identifier: MIT
// Row spans: which tiles of each tile row a sphere's silhouette touches, computed in double. Included once per tier.
//
// A plane  y = v z  through the eye is a line in the image at the height v. It cuts a sphere with the centre (x, y, z)
// and the radius r in a disc, whose projection reaches over the slopes
//     u(v) = (x g -+ t S) / A,   g = y v + z,   S^2 = r^2 (1 + v^2) - (y - v z)^2,
//     A = y^2 + z^2 - r^2,   t^2 = A + x^2,
// which is the equation of the sphere's tangent cone solved for u. The silhouette, an ellipse, is convex: within a
// tile row its right end lies at the row's slope v that is nearest to that of its rightmost point, and likewise on the
// left. So these two slopes are clamped to each row, once per light and row, and u(v) there gives both ends.
//
// The rightmost and the leftmost point are where the planes  x = u z  touch the sphere. Let T^2 = x^2 + z^2 - r^2 and
// Q = z T + |x| r. Then the slope v is  y Q / (T (z^2 - r^2))  of the outer point, which is farther from the view
// axis, and y (x^2 + z^2) / (T Q)  of the inner one. With an orthographic projection  u = x -+ S,
// S^2 = r^2 - (y - v)^2  and  v = y.
//
// Rounding, with the unit roundoff e = 2^-53 of double, the tile rows' slopes from -V to V, F = r (1 + V), which is at
// least r sqrt(1 + v^2), and m = V z + |y| + F:
// - The slope of a row's edge is within 14 e V of the exact one, as the camera's numbers are rounded, and the slope of
//   the outermost point within 14 e V. In all, v has an error of at most 2^-48 V. This and rounding errors of 6 e m F
//   change S^2 by less than 2^-45 F m + 2^-94 m^2 in rows that the sphere meets, where |y - v z| <= F. Twice this is
//   added to S^2.
// - x g / A has a rounding error of at most 13 e |x| (|y| V + z) / A, and the error of v changes it by 2^-48 |x y|
//   V / A. t S / A has an error of at most 18 e t F / A, and the camera's offset one of 9 e (|offset| + tiles). The
//   spans are enlarged by more than twice all of this on both ends.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The numbers by which silhouette_ends() finds what span of tiles the silhouettes of `lanes` lights have in a tile
/// row. The image line at the slope v = y / depth (orthographic: y = v) crosses a silhouette, in tiles, from
/// middle g - reach S + low  to  middle g + reach S + high,  where  g = y_v v + z  and
/// S^2 = r2 + r2_v v^2 - (y - v z)^2 + slack;  the other symbols are members. A row's span begins there for v = left_v
/// and ends there for v = right_v, the slopes of the silhouette's leftmost and rightmost point, clamped to the row.
struct RowTerms {
    double y[lanes], y_v[lanes], z[lanes], r2[lanes], r2_v[lanes], slack[lanes];
    double middle[lanes], reach[lanes], low[lanes], high[lanes], left_v[lanes], right_v[lanes];
};

/// Returns V: the view-space slopes y / depth (orthographic: the y) of all tile rows lie between -V and V.
inline double max_row_slope(const Camera& camera) {
    return (abs_of(camera.y.offset) + camera.y.tiles) / camera.y.scale;
}

/// Writes the coefficients of spheres' silhouettes, from lane `at` on. The centres (x, y, z) are signed so that z is
/// the view depth. Returns a bit for each sphere whose silhouette is an ellipse, being wholly beyond the near plane.
inline unsigned row_terms(const Camera& camera, Doubles x, Doubles y, Doubles z, Doubles r, RowTerms& terms,
                          unsigned at) {
    const double scale = camera.x.scale, offset = camera.x.offset, max_slope = max_row_slope(camera);
    const double margin = 0x1p-48 * (abs_of(offset) + camera.x.tiles) + 0x1p-80 * scale;
    const Doubles r2 = mul(r, r), one = broadcast(1.0), zero = broadcast(0.0);
    Doubles y_v = zero, g_z = one, r2_v = zero, middle = x * scale, reach = broadcast(scale);
    Doubles left_v = y, right_v = y, largest_f = r;
    auto whole = less(r, broadcast(static_cast<double>(infinity)));
    if (!camera.orthographic) {
        const Doubles a = abs(x), a2 = mul(x, x), e = mul(z - r, z + r), big_a = mul(y, y) + e;
        const Doubles per_a = scale / big_a, side = sqrt(a2 + e), q = mul(z, side) + mul(a, r);
        const Doubles outer_v = mul(y, q) / mul(side, e);
        const Doubles inner_v = mul(y, a2 + mul(z, z)) / mul(side, q);
        const auto negative = less(x, zero);
        left_v = select(negative, outer_v, inner_v);
        right_v = select(negative, inner_v, outer_v);
        middle = mul(x, per_a);
        reach = mul(sqrt(a2 + big_a), per_a);
        y_v = y;
        g_z = z;
        r2_v = r2;
        largest_f = mul(r, broadcast(1 + max_slope));
        whole = less(broadcast(static_cast<double>(camera.min_float_depth)), z - r);
    }
    const Doubles m = mul(g_z, broadcast(max_slope)) + abs(y) + largest_f;
    const Doubles error =
        (mul(abs(middle), mul(abs(y_v), broadcast(max_slope)) + g_z) + mul(reach, largest_f)) * 0x1p-46 + margin;
    store_doubles(terms.y + at, y);
    store_doubles(terms.y_v + at, y_v);
    store_doubles(terms.z + at, g_z);
    store_doubles(terms.r2 + at, r2);
    store_doubles(terms.r2_v + at, r2_v);
    store_doubles(terms.middle + at, middle);
    store_doubles(terms.reach + at, reach);
    store_doubles(terms.low + at, offset - error);
    store_doubles(terms.high + at, offset + error);
    store_doubles(terms.slack + at, mul(m, largest_f) * 0x1p-44 + mul(m, m) * 0x1p-93);
    store_doubles(terms.left_v + at, left_v);
    store_doubles(terms.right_v + at, right_v);
    return movemask(whole) << at;
}

/// Finds where silhouette i begins and ends, in tiles, in a vector of tile rows. The edges of each row lie at the
/// slopes y / depth = v0 and v1 in view space (orthographic: y = v0 and v1).
LIGHTBIN_INLINE void silhouette_ends(const RowTerms& terms, std::uint32_t i, Doubles v0, Doubles v1, Doubles& begin,
                                     Doubles& end) {
    const Doubles y = broadcast(terms.y[i]), y_v = broadcast(terms.y_v[i]), z = broadcast(terms.z[i]),
                  r2 = broadcast(terms.r2[i]);
    const Doubles r2_v = broadcast(terms.r2_v[i]), middle = broadcast(terms.middle[i]),
                  reach = broadcast(terms.reach[i]);
    const Doubles left = minimum(maximum(broadcast(terms.left_v[i]), v0), v1);
    const Doubles right = minimum(maximum(broadcast(terms.right_v[i]), v0), v1);
    const Doubles left_e = y - mul(left, z), right_e = y - mul(right, z);
    const Doubles left_s2 = r2 + mul(r2_v, mul(left, left)) - mul(left_e, left_e);
    const Doubles right_s2 = r2 + mul(r2_v, mul(right, right)) - mul(right_e, right_e);
    const Doubles left_s = sqrt(maximum(left_s2, broadcast(0.0)) + terms.slack[i]);
    const Doubles right_s = sqrt(maximum(right_s2, broadcast(0.0)) + terms.slack[i]);
    begin = mul(middle, mul(y_v, left) + z) - mul(reach, left_s) + terms.low[i];
    end = mul(middle, mul(y_v, right) + z) + mul(reach, right_s) + terms.high[i];
}

/// The silhouettes of a vector of spheres.
struct SphereRows {
    /// Prepares the silhouettes of `count` footprints from element `begin` on, at most a vector of them. Returns a bit
    /// for each whose row spans store() can find.
    unsigned find(const Camera& camera, const FootprintArrays& lights, std::uint32_t begin, std::uint32_t count) {
        Floats x, y, z, r;
        load_listed_spheres(lights.view_lights.spheres, lights.ids + begin, count, x, y, z, r);
        unsigned known = 0;
        for (unsigned half = 0; half < lanes / double_lanes; ++half)
            known |= row_terms(camera, widened(x, half) * static_cast<double>(camera.x.sign),
                               widened(y, half) * static_cast<double>(camera.y.sign),
                               widened(z, half) * static_cast<double>(camera.z_sign), widened(r, half), terms,
                               half * double_lanes);
        return known;
    }

    /// Stores the spans of tiles that light i covers in a vector of tile rows, clamped to columns leftmost..rightmost.
    /// The edges of each row lie at the slopes y / depth = v0 and v1 in view space (orthographic: y = v0 and v1).
    LIGHTBIN_INLINE void store(std::uint32_t i, Doubles v0, Doubles v1, Doubles leftmost, Doubles rightmost,
                               RowSpan* to) const {
        Doubles begin, end;
        silhouette_ends(terms, i, v0, v1, begin, end);
        store_spans(to, minimum(maximum(begin, leftmost), rightmost), minimum(maximum(end, leftmost), rightmost));
    }

    RowTerms terms;
};

/// Writes the row spans of a run of footprints, from spans[to] on; whole vectors are stored. A footprint gets no spans
/// where they could exclude no tile, because it is one tile wide or high, where its silhouette is not known, and where
/// they would begin beyond an index of 32 bits. A span of a sphere has at least one tile. Rows: SphereRows or SpotRows.
template <class Rows>
inline void row_spans(const Camera& camera, const FootprintArrays& lights, FootprintRun run, RowSpan* spans,
                      std::uint64_t to) {
    static constexpr double count_up[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const Doubles lane = load_doubles(count_up);
    const double row_offset = camera.y.offset, per_scale = 1 / camera.y.scale;
    Rows rows;
    for (std::uint32_t begin = run.begin; begin < run.end; begin += lanes) {
        const std::uint32_t count = min_of(run.end - begin, lanes);
        const unsigned known = rows.find(camera, lights, begin, count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const unsigned x0 = lights.x0[begin + i], x1 = lights.x1[begin + i], y0 = lights.y0[begin + i],
                           y1 = lights.y1[begin + i];
            std::uint32_t& first = lights.span_begin[begin + i];
            first = FootprintArrays::whole_rectangle;
            if ((known >> i & 1) == 0 || x0 == x1 || y0 == y1 || to + (y1 - y0) >= first) continue;
            first = static_cast<std::uint32_t>(to);
            const Doubles leftmost = broadcast(static_cast<double>(x0)), rightmost = broadcast(static_cast<double>(x1));
            for (unsigned row = y0; row <= y1; row += double_lanes) {
                const Doubles edge = lane + (static_cast<double>(row) - row_offset);
                rows.store(i, edge * per_scale, (edge + 1.0) * per_scale, leftmost, rightmost, spans + to + (row - y0));
            }
            to += y1 - y0 + 1;
        }
    }
}

}}}}  // namespace lightbin::detail
