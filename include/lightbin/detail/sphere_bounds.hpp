// SPDX-License-Identifier: MIT
// Screen bounds of one sphere. Everything is a 2-D problem in slope space: tile edges are planes x = s z
// through the eye, so along each image axis a sphere becomes a disc of centre (c, z), c being x or y, and its
// bounds are the slopes of two tangents (Mara and McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere", JCGT 2(2), 2013).
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/rounding.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <cmath>
#include <cstdint>

namespace lightbin::detail {

enum class Visibility : std::uint8_t { visible, culled, rejected };

inline namespace LIGHTBIN_FLAVOUR {

/// Extent of a sphere along one image axis: slopes (perspective) or view-space coordinates (orthographic).
template <class Real> struct Span { Real low, high; };

/// Slopes of the tangents from the origin to the disc (c, z, r), for z - r > 0, where `e` = (z - r)(z + r).
///
/// Each sum is of terms of one sign, so errors only add up: with u the unit roundoff, e is within 3u, c^2 + e
/// within 4u, its root 3u, q 5u, and both slopes 9u of the truth, each relative to itself. (The roots'
/// product is (c^2 - r^2) / e.)
template <class Real> Span<Real> tangent_slopes(Real c, Real z, Real r, Real e) {
    const Real a = std::fabs(c);
    const Real tangent_length = std::sqrt(rounded(a * a) + e);
    const Real q = rounded(a * z) + rounded(r * tangent_length);
    const Real outer = q / e;
    const Real inner = (a - r) * (a + r) / q;
    return c < 0 ? Span<Real>{-outer, -inner} : Span<Real>{inner, outer};
}

/// Upper bound on c / z over the part of the disc (c, z, r) at depth `near_z` or more; +inf where double
/// precision can't tell. For discs that cross the near plane, z - r <= near_z <= z + r. Doubles that hold
/// floats: products are exact, none overflows.
///
/// That part is convex, so its largest slope is at the tangent point if that lies beyond the near plane, else
/// at the corner where the circle meets the plane. The tangent bounds the whole disc, so it is right whenever
/// it exists: the corner is taken only when it is beyond doubt.
inline double clipped_max_slope(double c, double z, double r, double near_z) {
    const double w = near_z - z;
    const double h2 = (r - w) * (r + w);  // half chord, squared
    const double h2_error = 0x1p-50 * r * r;
    const double h = std::sqrt(std::fmax(h2, 0.0) + h2_error);  // rounded up
    const double h_low = std::sqrt(std::fmax(h2 - h2_error, 0.0));

    // Along the circle into the region the corner (c + h, near_z) moves by (-w, h), and c / z grows by
    // (near_z, -(c + h)) a step: the tangent point lies beyond the plane iff  near_z (z - near_z) > h (c +
    // h).
    const double corner_side = h_low * h_low + c * (c >= 0 ? h_low : h);
    const double tangent_side = near_z * (z - near_z);
    const double doubt = 0x1p-48 * (h * h + std::fabs(c) * h + near_z * (std::fabs(z) + near_z));
    if (corner_side > tangent_side + doubt) {
        const double corner = (c + h) / near_z;
        return corner + 0x1p-48 * (std::fabs(c) + h) / near_z;
    }

    const double t2 = (c * c + z * z) - r * r;  // tangent length, squared
    const double relative_error = 0x1p-50 * (c * c + z * z + r * r) / t2 + 0x1p-48;
    if (!(t2 > 0) || relative_error > 0x1p-20)
        return static_cast<double>(infinity);  // the eye is on the surface or inside
    const double t = std::sqrt(t2);
    if (c >= 0 && z <= r) return static_cast<double>(infinity);  // the tangent points backward
    // As in tangent_slopes: of the two forms of the same root, the one whose sums are of one sign.
    const double slope =
        c < 0 && z >= 0 ? (r + c) * (r - c) / (r * t - c * z) : (c * z + r * t) / ((z - r) * (z + r));
    return slope + std::fabs(slope) * relative_error;
}

/// Writes the tiles that the extent touches, grown by the axis' margin. Returns false if it is out of the
/// viewport.
template <class Real>
bool tile_span(const ImageAxis& axis, Real scale, Real offset, Span<Real> extent, std::uint16_t& first,
               std::uint16_t& last) {
    const Real low = rounded(extent.low * scale) + offset - static_cast<Real>(axis.margin);
    const Real high = rounded(extent.high * scale) + offset + static_cast<Real>(axis.margin);
    if (!(high >= 0) || !(low <= static_cast<Real>(axis.limit))) return false;
    const Real end = static_cast<Real>(axis.inside);
    first = static_cast<std::uint16_t>(low < 0 ? 0 : low < end ? low : end);
    last = static_cast<std::uint16_t>(high < end ? high : end);
    return true;
}

/// The general case, in double: near-plane straddlers, eye inside, tiny, huge and infinite spheres, bad
/// input. Never inlined: all tiers share its one set of instructions and so its roundings.
LIGHTBIN_NOINLINE inline Visibility project_carefully(const Camera& camera, const Sphere& light,
                                                      TileRect& rect) {
    if (!std::isfinite(light.x) || !std::isfinite(light.y) || !std::isfinite(light.z) || !(light.radius >= 0))
        return Visibility::rejected;
    const double z = static_cast<double>(camera.z_sign * light.z), r = static_cast<double>(light.radius);
    const double near_z = static_cast<double>(camera.near_depth);
    if (z + r < near_z || z - r > static_cast<double>(camera.far_depth)) return Visibility::culled;

    const auto extent = [&](const ImageAxis& axis, float coordinate) -> Span<double> {
        const double c = static_cast<double>(axis.sign * coordinate);
        if (std::isinf(r)) return {-r, r};
        if (camera.orthographic) return {c - r, c + r};
        if (z - r > near_z) {
            const Span<double> slopes = tangent_slopes(c, z, r, (z - r) * (z + r));
            return r > 0 ? slopes : Span<double>{c / z, c / z};
        }
        return {-clipped_max_slope(-c, z, r, near_z), clipped_max_slope(c, z, r, near_z)};
    };
    const bool visible =
        tile_span(camera.x, camera.x.scale, camera.x.offset, extent(camera.x, light.x), rect.x0, rect.x1) &&
        tile_span(camera.y, camera.y.scale, camera.y.offset, extent(camera.y, light.y), rect.y0, rect.y1);
    return visible ? Visibility::visible : Visibility::culled;
}

/// One light to its tile rectangle, in float where the error bound of tangent_slopes holds: no over- or
/// underflow (sizes of 2^-40 to 2^40) and the whole sphere beyond the near plane. Comparisons are arranged so
/// that NaN goes the careful way.
inline Visibility project_sphere(const Camera& camera, const Sphere& light, TileRect& rect) {
    const float x = camera.x.sign * light.x, y = camera.y.sign * light.y, z = camera.z_sign * light.z,
                r = light.radius;
    const float size = std::fabs(x) + std::fabs(y) + std::fabs(z) + r;
    if (!(size <= 0x1p40f && r >= 0x1p-40f)) return project_carefully(camera, light, rect);
    // Rounding is monotone and the planes are floats, so these comparisons of rounded sums are exact.
    if (z + r < camera.near_depth || z - r > camera.far_depth) return Visibility::culled;
    Span<float> extent_x, extent_y;
    if (camera.orthographic) {
        extent_x = {x - r, x + r};
        extent_y = {y - r, y + r};
    } else {
        if (!(z - r > camera.near_fast)) return project_carefully(camera, light, rect);
        const float e = rounded((z - r) * (z + r));
        extent_x = tangent_slopes(x, z, r, e);
        extent_y = tangent_slopes(y, z, r, e);
    }
    const bool visible =
        tile_span(camera.x, camera.x.scale_f, camera.x.offset_f, extent_x, rect.x0, rect.x1) &&
        tile_span(camera.y, camera.y.scale_f, camera.y.offset_f, extent_y, rect.y0, rect.y1);
    return visible ? Visibility::visible : Visibility::culled;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
