// SPDX-License-Identifier: MIT
// Row spans: where a light's projection meets each tile row. Included once a tier, after its vectors; in double.
//
// A sphere's projection is an ellipse; wedge.inl has that of a spot.
// The plane  y = v z  through the eye cuts the sphere in a disc whose projection reaches over the slopes
//     u(v) = (x g -+ t S) / A,  g = y v + z,  S^2 = r^2 (1 + v^2) - (y - v z)^2,  A = y^2 + z^2 - r^2,  t^2 = A + x^2
// (the tangent cone, solved for u). The ellipse is convex, so within a row its right end is at the row slope v
// nearest to that of its rightmost point, and so for the left: those two slopes are clamped to each row, once
// a light and row, and u(v) is all there is. The rightmost point is where the plane x = u z touches the sphere:
// with T^2 = x^2 + z^2 - r^2 and Q = z T + |x| r its slope v is  y Q / (T (z^2 - r^2)),  and that of the
// point on the other side  y (x^2 + z^2) / (T Q).  Orthographic: g = 1, S^2 = r^2 - (y - v)^2, u = x -+ S, v = y.
//
// Rounding, with e = 2^-53, the rows' slopes within +-V, F = r (1 + V) >= r sqrt(1 + v^2), m = V z + |y| + F:
// - A row's edge is within 14 e V of the truth by the camera's numbers, the extreme slope within 14 e V: in all
//   v may be off by 2^-48 V. That and 6 e m F of rounding move S^2 by less than 2^-45 F m + 2^-94 m^2, for rows
//   that the sphere meets, where |y - v z| <= F. Twice that is added to S^2.
// - x g / A is within 13 e |x| (|y| V + z) / A and moves by 2^-48 |x y| V / A with v; t S / A within 18 e t F / A;
//   the camera's offset within 9 e (|offset| + tiles). Twice these and more are added to both ends.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Of `lanes` lights: g = y_v v + z and S^2 = r2 + r2_v v^2 - (y - v z)^2 + slack; in tiles, the ends are
/// middle g - reach S + low and middle g + reach S + high, at the row slopes left_v and right_v clamped to a row.
struct RowTerms {
    double y[lanes], y_v[lanes], z[lanes], r2[lanes], r2_v[lanes], slack[lanes];
    double middle[lanes], reach[lanes], low[lanes], high[lanes], left_v[lanes], right_v[lanes];
};

/// Writes the terms of spheres from place `at` on; x and y are as in an ImageAxis, z is the view depth. Returns a bit for
/// each whose silhouette is known: those wholly beyond the near plane.
inline unsigned row_terms(const Camera& camera, Doubles x, Doubles y, Doubles z, Doubles r,
                                          RowTerms& terms, unsigned at) {
    const double row_offset = camera.y.offset, scale = camera.x.scale, offset = camera.x.offset;
    const double most = (abs_of(row_offset) + camera.y.tiles) / camera.y.scale;  // V
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
        largest_f = mul(r, broadcast(1 + most));
        whole = less(broadcast(static_cast<double>(camera.min_float_depth)), z - r);
    }
    const Doubles m = mul(g_z, broadcast(most)) + abs(y) + largest_f;
    const Doubles error =
        (mul(abs(middle), mul(abs(y_v), broadcast(most)) + g_z) + mul(reach, largest_f)) * 0x1p-46 + margin;
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

/// Where light i's silhouette begins and ends in rows of the slopes v0 to v1, a lane each, in tiles.
LIGHTBIN_INLINE void silhouette_ends(const RowTerms& terms, std::uint32_t i, Doubles v0,
                                                     Doubles v1, Doubles& begin, Doubles& end) {
    const Doubles y = broadcast(terms.y[i]), y_v = broadcast(terms.y_v[i]), z = broadcast(terms.z[i]), r2 = broadcast(terms.r2[i]);
    const Doubles r2_v = broadcast(terms.r2_v[i]), middle = broadcast(terms.middle[i]), reach = broadcast(terms.reach[i]);
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

/// What becomes of `used` lights in view, from `begin` on.
struct SphereRows {
    /// Returns a bit for each whose row spans are known.
    unsigned find(const Camera& camera, const FootprintArrays& lights, std::uint32_t begin,
                                  std::uint32_t used) {
        Sphere spheres[lanes];
        for (std::uint32_t i = 0; i < lanes; ++i)
            spheres[i] = load_sphere(lights.spheres + lights.ids[begin + (i < used ? i : 0)]);
        Floats x, y, z, r;
        load_spheres(spheres, x, y, z, r);
        unsigned known = 0;
        for (unsigned half = 0; half < lanes / double_lanes; ++half)
            known |= row_terms(camera, widened(x, half) * static_cast<double>(camera.x.sign),
                               widened(y, half) * static_cast<double>(camera.y.sign),
                               widened(z, half) * static_cast<double>(camera.z_sign), widened(r, half), terms,
                               half * double_lanes);
        return known;
    }

    /// Stores light i's spans of rows of the slopes v0 to v1, a lane each, of the tiles leftmost..rightmost.
    LIGHTBIN_INLINE void store(std::uint32_t i, Doubles v0, Doubles v1, Doubles leftmost,
                                               Doubles rightmost, RowSpan* to) const {
        Doubles begin, end;
        silhouette_ends(terms, i, v0, v1, begin, end);
        store_spans(to, minimum(maximum(begin, leftmost), rightmost),
                    minimum(maximum(end, leftmost), rightmost));
    }

    RowTerms terms;
};

/// Writes the row spans of the lights in view in a run, from spans[place] on; whole vectors are stored. A light gets none
/// where they could drop nothing or can't be numbered. A sphere's row has at least one tile.
template <class Rows>
inline void row_spans(const Camera& camera, const FootprintArrays& lights, FootprintRun run,
                                      RowSpan* spans, std::uint64_t place) {
    static constexpr double count_up[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const Doubles lane = load_doubles(count_up);
    const double row_offset = camera.y.offset, per_scale = 1 / camera.y.scale;
    Rows rows;
    for (std::uint32_t begin = run.begin; begin < run.end; begin += lanes) {
        const std::uint32_t used = run.end - begin < lanes ? run.end - begin : lanes;
        const unsigned known = rows.find(camera, lights, begin, used);
        for (std::uint32_t i = 0; i < used; ++i) {
            const unsigned x0 = lights.x0[begin + i], x1 = lights.x1[begin + i], y0 = lights.y0[begin + i],
                           y1 = lights.y1[begin + i];
            std::uint32_t& first = lights.span_begin[begin + i];
            first = FootprintArrays::whole_rectangle;
            if ((known >> i & 1) == 0 || x0 == x1 || y0 == y1 || place + (y1 - y0) >= first) continue;
            first = static_cast<std::uint32_t>(place);
            const Doubles leftmost = broadcast(static_cast<double>(x0)), rightmost = broadcast(static_cast<double>(x1));
            for (unsigned row = y0; row <= y1; row += double_lanes) {
                const Doubles edge = lane + (static_cast<double>(row) - row_offset);
                rows.store(i, edge * per_scale, (edge + 1.0) * per_scale, leftmost, rightmost,
                           spans + place + (row - y0));
            }
            place += y1 - y0 + 1;
        }
    }
}

}}}}  // namespace lightbin::detail
