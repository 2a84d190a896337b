// SPDX-License-Identifier: MIT
// Reads a projection matrix: refuses unsupported ones, and derives the camera and the mapping of view to window depth.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/view/camera.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/view_summary.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// What the terms of x and y of an oblique near plane add to the depth map of one line of sight, or the range of this
/// for many, rounded outward.
struct Tilt {
    double low = 0, high = 0;
};

/// Maps view depth d to normalized device depth and back:  ndc = (z_scale d + z_offset) / (w_scale d + w_offset).
///
/// With an oblique near plane (Lengyel, "Oblique View Frustum Depth Projection and Clipping", 2005) each line of sight
/// has a map of its own: along it, x and y grow with d in a perspective view, and are constant in an orthographic one,
/// so that the matrix' terms of x and y add to z_scale or to z_offset. These two are those of the image's centre then.
struct DepthMap {
    double z_scale = 0, z_offset = 0, w_scale = 0, w_offset = 0;
    /// What half of the image's width, or height, adds on the way right, or to greater rows: 0 unless oblique.
    double tilt_x = 0, tilt_y = 0;
    double tilt_error = 0;     ///< a bound on the rounding error of all that is added in tilted(), and of tilt_at()
    bool reversed = false;     ///< reversed Z: the near plane has the larger device (NDC) depth
    bool zero_to_one = false;  ///< device (NDC) depth runs from 0 to 1, not from -1 to 1

    bool oblique() const { return tilt_x != 0 || tilt_y != 0; }

    /// Adds what an entry of the matrix' z row, `z`, makes of an image axis with the entries p, q and w, which
    /// Projection::set_axis() explains. A coordinate is  c = (ndc w - q) / p.
    void add_tilt(double& tilt, double z, double p, double q, double w) {
        if (z == 0) return;
        double& base = w_scale != 0 ? z_scale : z_offset;
        tilt = z / p * w;
        // Up to 11 roundings of 2^-53, none of a sum greater than this, lie between the matrix and the tilt at a point.
        tilt_error += 0x1p-49 * (abs_of(base) + abs_of(tilt) + abs_of(z / p * q));
        base -= z / p * q;
    }

    /// Returns the tilt at a point of the image: x and y run from -1 to 1 across it.
    double tilt_at(double x, double y) const { return tilt_x * x + tilt_y * y; }
    /// Returns the tilts at all points up to `reach_x` and `reach_y` away from a point: by default, in the whole image.
    Tilt tilts_around(double x = 0, double y = 0, double reach_x = 1, double reach_y = 1) const {
        const double tilt = tilt_at(x, y),
                     reach = abs_of(tilt_x) * reach_x + abs_of(tilt_y) * reach_y + tilt_error;
        return {tilt - reach, tilt + reach};
    }

    /// Returns the map of the lines of sight that have a tilt.
    DepthMap tilted(double tilt) const {
        DepthMap map = *this;
        (w_scale != 0 ? map.z_scale : map.z_offset) += tilt;
        return map;
    }

    /// Device depth of a window depth, which runs from 0 to 1.
    double device_depth(double window) const { return zero_to_one ? window : 2 * window - 1; }

    /// Window depth of a view depth, up to rounding. NaN for an infinite view depth.
    float window_depth(double view_depth) const {
        const double ndc = (z_scale * view_depth + z_offset) / (w_scale * view_depth + w_offset);
        return static_cast<float>(zero_to_one ? ndc : 0.5 * (ndc + 1));
    }

    /// View depth of a device depth `ndc`, moved down (direction -1) or up (+1) by a bound on the rounding error of the
    /// few steps below, or not moved (0). +inf where no view depth of a perspective projection has this device depth.
    double view_depth(double ndc, int direction) const {
        double top = ndc * w_offset - z_offset;
        double bottom = z_scale - ndc * w_scale;
        const double top_error = 0x1p-51 * (abs_of(ndc * w_offset) + abs_of(z_offset));
        const double bottom_error = 0x1p-51 * (abs_of(z_scale) + abs_of(ndc * w_scale));
        if (reversed) {
            top = -top;
            bottom = -bottom;
        }
        const double outward = direction;
        top += outward * top_error;
        bottom -= (top < 0 ? -outward : outward) * bottom_error;
        if (!(bottom > 0)) return static_cast<double>(infinity);
        return top / bottom * (1.0 + (top < 0 ? -outward : outward) * 0x1p-51);
    }

    /// Finds the least and the greatest view depth of all points whose window depth lies in [lower, upper], rounded
    /// outward, on lines of sight with such tilts. A larger tilt brings a point of the same window depth nearer, or
    /// takes it farther away with reversed Z.
    void view_depths(double lower, double upper, const Tilt& tilt, float& least, float& greatest) const {
        least = float_below(nearest(reversed ? upper : lower, tilt, -1));
        greatest = float_above(farthest(reversed ? lower : upper, tilt, +1));
    }

    // View depths of the nearest and the farthest point of a window depth, moved as by view_depth().
    double nearest(double window, const Tilt& tilt, int direction) const {
        return tilted(reversed ? tilt.low : tilt.high).view_depth(device_depth(window), direction);
    }
    double farthest(double window, const Tilt& tilt, int direction) const {
        return tilted(reversed ? tilt.high : tilt.low).view_depth(device_depth(window), direction);
    }
};

/// Whether a perspective matrix looks transposed: the 1 or -1 of its w row's z entry is in the w entry of its z row.
inline bool one_is_transposed(const Matrix& m) {
    return abs_of(m[3][2]) == 1 && abs_of(m[2][3]) != 1;
}

/// Returns why a matrix is no supported kind of projection, judged by which entries are zero, or nothing if it is one.
inline std::optional<ErrorCode> wrong_shape(const Matrix& m) {
    const double w_x = m[0][3], w_y = m[1][3], w_z = m[2][3], w_1 = m[3][3];
    const bool perspective = w_x == 0 && w_y == 0 && w_z != 0 && w_1 == 0;
    const bool orthographic = w_x == 0 && w_y == 0 && w_z == 0 && w_1 > 0;
    if (w_x == 0 && w_y == 0 && w_z != 0 && w_1 != 0) return ErrorCode::eye_not_at_origin;
    if (!perspective && !orthographic) return ErrorCode::not_a_projection;
    if (perspective && (m[3][0] != 0 || m[3][1] != 0)) return ErrorCode::eye_not_at_origin;
    if (m[1][0] != 0 || m[0][1] != 0) return ErrorCode::image_axes_rotated;
    if (orthographic && (m[2][0] != 0 || m[2][1] != 0)) return ErrorCode::image_axes_rotated;
    const bool oblique = m[0][2] != 0 || m[1][2] != 0;
    if (perspective && oblique && one_is_transposed(m)) return ErrorCode::projection_transposed;
    return {};
}

/// Returns a matrix with other columns of `m` in place of its first three.
inline Matrix with_columns(const Matrix& m, int x, int y, int z) {
    const int columns[] = {x, y, z, 3};
    return from_entries([&]<int column, int row>() { return m[columns[column]][row]; });
}

/// A View's projection: a matrix, and what was derived from it for a viewport and a tile size.
struct Projection {
    Matrix matrix = {};
    /// The image is turned by 90 or 270 degrees: the x of clip space is made of view-space y, and its y of x. The axis
    /// Camera::x, to which tile columns belong, is the y axis of the image then.
    bool turned = false;
    Camera camera;
    DepthMap depth;

    /// Sets one image axis from entries p, q and w of the matrix. A device coordinate
    /// is  ndc = c * p / w + q / w,  where c is a point's slope x / depth (or y / depth), or in orthographic views its
    /// coordinate. The viewport's side is ndc -1 to 1. Returns false if the scale is too small or too large.
    bool set_axis(ImageAxis& axis, double p, double q, double w, const TileSplit& split) const {
        const double tiles = split.tiles_of(split.side);
        axis.split = split;
        axis.tiles = split.count();
        axis.sign = p < 0 ? -1.0f : 1.0f;
        axis.scale = abs_of(p) / w * (0.5 * tiles);
        axis.offset = (q / w + 1.0) * (0.5 * tiles);
        axis.last_tile_centre = static_cast<float>(axis.tiles) - 0.5f;
        axis.limit = float_above(tiles);
        // A tangent's slope in floats is within 10u of the true one, where u = 2^-24 (derived in spheres.inl).
        // Multiplied by the scale, rounded to float, the error is 12u; rounding the offset and the sum adds u each.
        // Inside the viewport |scale * slope| <= |offset| + tiles, as scale * slope + offset is between 0 and `tiles`.
        // A margin of 16u of that also covers the rounding of `scale` and `offset` in double and the addition of the
        // margin itself. The term 2^-80 scale is for callers who flush denormal numbers to zero.
        axis.margin = float_above(0x1p-20 * (abs_of(axis.offset) + axis.tiles) + 0x1p-80 * axis.scale +
                                  split.overhang());
        if (!camera.orthographic && axis.scale > 0) {
            const double slope = max_of(tiles - axis.offset, axis.offset) / axis.scale;
            const double length = root_of(1 + slope * slope);
            axis.normal = static_cast<float>(1 / length);
            axis.normal_z = static_cast<float>(-slope / length);
        }
        if (split.side == 0) {
            axis.limit = -1;  // an empty viewport contains no coordinate
            return p != 0;
        }
        return axis.scale >= 0x1p-80 && axis.scale <= 0x1p80;
    }

    // View depths of the nearest and the farthest point of the clip region, not rounded outward.
    double nearest() const { return depth.nearest(depth.reversed ? 1 : 0, depth.tilts_around(), 0); }
    double farthest() const { return depth.farthest(depth.reversed ? 0 : 1, depth.tilts_around(), 0); }

    /// Sets the camera's near and far depth: those of the clip region. Returns why they are refused, or nothing.
    std::optional<ErrorCode> set_depth_range() {
        depth.view_depths(0, 1, depth.tilts_around(), camera.near_depth, camera.far_depth);
        camera.min_float_depth = max_of(float_safe_min, camera.near_depth);
        if (camera.orthographic) {
            if (is_finite(camera.near_depth) && is_finite(camera.far_depth)) return {};
            return ErrorCode::depth_range_not_finite;
        }
        if (camera.near_depth >= FLT_MIN && camera.near_depth < camera.far_depth && is_finite(nearest())) return {};
        const bool too_close = nearest() > 0 && camera.near_depth < FLT_MIN;
        return too_close ? ErrorCode::near_plane_too_close : ErrorCode::no_near_plane;
    }

    /// Finds `camera` and `depth` from `matrix` and depth.zero_to_one. Returns why the matrix is refused, or nothing.
    ///
    /// across      how tiles divide the viewport's width
    /// down        how they divide its height
    /// y_up        tile rows count up from the side of the image where device y is -1
    /// reversed_z  read for orthographic matrices alone: a perspective matrix shows whether Z is reversed
    ///
    /// Not inlined, so that no operation moves out of the lifetime of the local `environment`, which rounds to nearest.
    LIGHTBIN_NOINLINE std::optional<ErrorCode> read(const TileSplit& across, const TileSplit& down, bool y_up,
                                                    bool reversed_z) {
        const DefaultFloatEnvironment environment;
        Matrix m = matrix;
        if (!finite(m)) return ErrorCode::matrix_not_finite;
        turned = m[0][0] == 0 && m[1][1] == 0 && m[0][1] != 0 && m[1][0] != 0;
        for (int column = 0; turned && column < 4; ++column)
            std::swap(m.columns[column][0], m.columns[column][1]);
        if (const auto wrong = wrong_shape(m)) {
            if (!wrong_shape(transposed(m))) return ErrorCode::projection_transposed;
            if (!wrong_shape(with_columns(m, 1, 2, 0))) return ErrorCode::looks_along_x;
            if (!wrong_shape(with_columns(m, 0, 2, 1))) return ErrorCode::looks_along_y;
            return *wrong;
        }
        const double w_z = m[2][3], w_1 = m[3][3];
        const bool orthographic = camera.orthographic = w_z == 0;

        // Visible points have w > 0, so the sign of w_z is the viewing direction. An orthographic w tells no direction:
        // there, view depth grows with device depth, or against it where Z is reversed.
        const double w = orthographic ? w_1 : abs_of(w_z);
        const bool forward = orthographic ? (m[2][2] > 0) != reversed_z : w_z > 0;
        camera.z_sign = forward ? 1.0f : -1.0f;
        const double flip_z = forward ? 1.0 : -1.0, up = y_up ? 1.0 : -1.0,
                     up_x = turned ? up : 1, up_y = turned ? 1 : up;
        const double offset_x = orthographic ? m[3][0] : flip_z * m[2][0];
        const double offset_y = orthographic ? m[3][1] : flip_z * m[2][1];
        if (!set_axis(camera.x, up_x * m[0][0], up_x * offset_x, w, turned ? down : across) ||
            !set_axis(camera.y, up_y * m[1][1], up_y * offset_y, w, turned ? across : down))
            return ErrorCode::degenerate_scale;
        if (max_of(abs_of(camera.x.offset), abs_of(camera.y.offset)) > 0x1p80)
            return ErrorCode::image_offset_out_of_range;

        depth.z_scale = flip_z * m[2][2];
        depth.z_offset = m[3][2];
        depth.w_scale = orthographic ? 0 : w;
        depth.w_offset = orthographic ? w : 0;
        depth.add_tilt(depth.tilt_x, m[0][2], up_x * m[0][0], up_x * offset_x, w);
        depth.add_tilt(depth.tilt_y, m[1][2], up_y * m[1][1], up_y * offset_y, w);
        depth.reversed = orthographic ? reversed_z : depth.z_offset > 0;
        return set_depth_range();
    }

    /// Returns, for a View with this viewport, what was read from the matrix and what looks like a mistake.
    ViewSummary summary(int width, int height, int tile_size) const {
        const bool flat = camera.orthographic;
        const Matrix& m = matrix;
        // The entry that scales the image along an axis.
        const auto scale = [&](int axis) { return m[turned ? 1 - axis : axis][axis]; };
        // Returns the image's width or height in degrees (orthographic: in view-space units). It comes from the matrix,
        // as ImageAxis::scale is 0 for an empty viewport.
        const auto size = [&](int axis) {
            const double w = flat ? depth.w_offset : depth.w_scale,
                         offset = flat ? m[3][axis] : static_cast<double>(camera.z_sign) * m[2][axis];
            const double low = (-w - offset) / scale(axis), high = (w - offset) / scale(axis);
            return abs_of(flat ? high - low
                               : (arctan_of(high) - arctan_of(low)) * (180 / 3.14159265358979324));
        };
        // On a plane of equal depth the image is 2 w / scale(0) wide and 2 w / scale(1) high.
        const double aspect = abs_of(scale(1) / scale(0));
        const auto is_one = [](double x) { return abs_of(x) == 1; };
        const bool never_minus_one = !flat && !depth.oblique() && depth.reversed && !depth.zero_to_one &&
                                     depth.z_scale + 0.999 * depth.w_scale > 0;
        const double width_off = abs_of(aspect * height - width);
        // The near plane is where device depth has its near end: clip z is so many times clip w.
        const double near_end = depth.device_depth(depth.reversed ? 1 : 0);
        double plane[4];
        for (int i = 0; i < 4; ++i)
            plane[i] = (depth.reversed ? -1 : 1) * (m[i][2] - near_end * m[i][3]);
        const double length = root_of(plane[0] * plane[0] + plane[1] * plane[1] + plane[2] * plane[2]);
        // clang-format off
        return {.orthographic = flat,
                .x_size = size(0), .y_size = size(1), .aspect = aspect,
                .near_depth = nearest(), .far_depth = farthest(),
                .looks_down_negative_z = camera.z_sign < 0, .reversed_z = depth.reversed, .oblique = depth.oblique(),
                .near_plane = {plane[0] / length, plane[1] / length, plane[2] / length, plane[3] / length},
                .x_flipped = scale(0) < 0, .y_flipped = scale(1) < 0, .turned = turned,
                .width = width, .height = height, .tile_size = tile_size,
                .tiles_x = camera.x.tiles, .tiles_y = camera.y.tiles,
                .looks_transposed = !flat && one_is_transposed(m),
                .looks_like_view_matrix = flat && is_one(scale(0)) && is_one(scale(1)) && is_one(m[2][2]),
                .looks_turned = !turned && scale(0) < 0 && scale(1) < 0,
                .looks_behind = flat && camera.far_depth <= 0,
                .looks_zero_to_one = never_minus_one,
                .pixels_not_square = width > 0 && height > 0 && !(width_off <= 0.02 * width),
                .viewport_empty = width == 0 || height == 0};
        // clang-format on
    }
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
