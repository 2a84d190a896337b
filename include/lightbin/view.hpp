// SPDX-License-Identifier: MIT
// Stage 1: projection matrix + viewport + tile size -> the few constants that all other stages use.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/project/camera.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view_summary.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Range of clip-space depth. It is a setting of the graphics API and cannot be read from the matrix.
/// Given wrongly, minus_one_to_one puts the near plane too near (safe); zero_to_one puts it too far (not
/// safe).
enum class ClipDepth : std::uint8_t {
    minus_one_to_one,  ///< OpenGL
    zero_to_one,       ///< Direct3D, Vulkan, Metal, WebGPU, OpenGL with glClipControl
};

/// The corner of the window that holds pixel (0, 0) and tile (0, 0), NDC y = -1 being the lower side.
/// Vulkan calls its NDC y = -1 the upper side: what is upper left there is lower_left here.
enum class WindowOrigin : std::uint8_t {
    lower_left,  ///< OpenGL, Vulkan
    upper_left,  ///< Direct3D, Metal, WebGPU
};

constexpr const char* to_string(ClipDepth depth) {
    return detail::name_at(depth, {"minus_one_to_one", "zero_to_one"});
}

constexpr const char* to_string(WindowOrigin origin) {
    return detail::name_at(origin, {"lower_left", "upper_left"});
}

/// Width and height in pixels.
struct Extent {
    int width = 0;
    int height = 0;
};

struct ViewOptions {
    int tile_size = 32;  ///< side of a tile in pixels, 1 or more
    ClipDepth clip_depth = ClipDepth::minus_one_to_one;
    WindowOrigin origin = WindowOrigin::lower_left;
    bool reversed_z = false;  ///< near has the larger depth; read for orthographic matrices alone
};

/// View depths from min to max, both included.
struct DepthInterval {
    float min, max;
};

/// A point of view space, the space that the projection matrix takes.
struct ViewPoint {
    double x, y, z;
};

/// The same point as the image has it: pixels from the corner of the window origin, and view depth. Pixel
/// (i, j) reaches from (i, j) to (i + 1, j + 1), and its centre is (i + 0.5, j + 0.5).
struct ImagePoint {
    double x, y, depth;
};

/// A tile's column and row.
struct TilePosition {
    int x, y;
};

/// A projection, a viewport and a tile size: what fixes the tile grid.
///
/// Tile (tx, ty) has index ty * tiles_x() + tx. It covers the pixels from tx * t to (tx + 1) * t across and
/// from ty * t to (ty + 1) * t up, cut off at the viewport's edge. View depth is the distance from the eye
/// (orthographic: from the plane z = 0) along the viewing direction, in the units of view space.
class View {
public:
    static constexpr int max_side = 32768;

    /// Returns the view of a projection matrix, or an Error that names why the matrix or a size is refused.
    ///
    /// projection  maps view space to clip space. A glm::mat4 or any projection[column][row] of floats or doubles, and
    ///             other types as they are: see matrix.hpp. Perspective: symmetric or not, jittered, finite or
    ///             infinite far, standard or reversed Z, looking down -z or +z, x or y flipped. Orthographic:
    ///             centred or not.
    /// viewport    0 to max_side pixels a side. An empty one has no tiles.
    template <class Matrix>
    static Result<View> from_projection(const Matrix& projection, Extent viewport,
                                        const ViewOptions& options = {}) {
        return from_columns(detail::to_matrix(projection), viewport, options);
    }

    /// Returns the same projection and viewport on a grid of other tiles, as from_projection makes it.
    Result<View> with_tile_size(int tile_size) const {
        return from_columns(projection_, viewport_, {tile_size, clip_depth_, origin_, reversed_});
    }

    Extent viewport() const { return viewport_; }
    int tile_size() const { return tile_size_; }
    int tiles_x() const { return camera_.x.tiles; }
    int tiles_y() const { return camera_.y.tiles; }
    std::size_t tile_count() const {
        return static_cast<std::size_t>(tiles_x()) * static_cast<std::size_t>(tiles_y());
    }
    WindowOrigin origin() const { return origin_; }
    bool orthographic() const { return camera_.orthographic; }
    bool reversed_z() const { return reversed_; }

    /// Returns what was read from the matrix, and what looks like a mistake: std::puts(to_string(view.summary()).c_str()).
    ViewSummary summary() const {
        const bool flat = orthographic();
        const Matrix& m = projection_;
        // From NDC -1 to 1, as an empty viewport has no two sides.
        const auto size = [&](int axis) {
            const double w = flat ? w_offset_ : w_scale_,
                         offset = flat ? m[3][axis] : static_cast<double>(camera_.z_sign) * m[2][axis];
            const double low = (-w - offset) / m[axis][axis], high = (w - offset) / m[axis][axis];
            return detail::abs_of(flat ? high - low
                                       : (detail::arctan_of(high) - detail::arctan_of(low)) *
                                             (180 / 3.14159265358979324));
        };
        // At a view depth of 1, or anywhere: w by scale is half of the image's width or height.
        const double aspect = detail::abs_of(m[1][1] / m[0][0]);
        const auto is_one = [](double x) { return detail::abs_of(x) == 1; };
        const bool never_minus_one = !flat && reversed_ && ndc(0) < 0 && z_scale_ + 0.999 * w_scale_ > 0;
        const double wider = detail::abs_of(aspect * viewport_.height - viewport_.width);
        return {flat,
                size(0),
                size(1),
                aspect,
                depth_at(ndc(reversed_ ? 1 : 0), 0),
                depth_at(ndc(reversed_ ? 0 : 1), 0),
                camera_.z_sign < 0,
                reversed_,
                m[0][0] < 0,
                m[1][1] < 0,
                viewport_.width,
                viewport_.height,
                tile_size_,
                !flat && one_is_transposed(m),
                flat && is_one(m[0][0]) && is_one(m[1][1]) && is_one(m[2][2]),
                m[0][0] < 0 && m[1][1] < 0,
                flat && far_depth() <= 0,
                never_minus_one,
                tile_count() > 0 && !(wider <= 0.02 * viewport_.width)};
    }

    /// View depth of the near plane, rounded down, and of the far plane, rounded up (+inf where there is
    /// none).
    float near_depth() const { return camera_.near_depth; }
    float far_depth() const { return camera_.far_depth; }

    /// Smallest and largest view depth of any point whose window depth lies in [lower, upper], both in 0..1,
    /// rounded outward. Window depth is what a depth buffer holds: 0 and 1 are the two ends of the clip-depth
    /// range.
    DepthInterval view_depths(double lower, double upper) const {
        const double nearer = reversed_ ? upper : lower, farther = reversed_ ? lower : upper;
        return {detail::float_below(depth_at(ndc(nearer), -1)),
                detail::float_above(depth_at(ndc(farther), +1))};
    }

    /// Window depth of a view depth, give or take rounding. NaN for an infinite one.
    float window_depth(double view_depth) const {
        const double ndc = (z_scale_ * view_depth + z_offset_) / (w_scale_ * view_depth + w_offset_);
        return static_cast<float>(clip_depth_ == ClipDepth::zero_to_one ? ndc : 0.5 * (ndc + 1));
    }

    /// Returns where in the image a point of view space lies, in the viewport or outside of it, up to the
    /// rounding of doubles. A perspective image has no place for what is not in front of the eye: depth is 0 or
    /// less then, and x and y are without meaning.
    ImagePoint image_point(const ViewPoint& point) const {
        const double depth = static_cast<double>(camera_.z_sign) * point.z,
                     distance = camera_.orthographic ? 1 : depth;
        return {pixels(camera_.x, point.x / distance), pixels(camera_.y, point.y / distance), depth};
    }

    /// Returns the point of view space that the image has at a place and view depth: the inverse of
    /// image_point(). The viewport must not be empty.
    ViewPoint view_point(const ImagePoint& point) const {
        const double distance = camera_.orthographic ? 1 : point.depth;
        return {slope(camera_.x, point.x) * distance, slope(camera_.y, point.y) * distance,
                static_cast<double>(camera_.z_sign) * point.depth};
    }

    /// Returns the tile of a pixel. None where it lies outside of the viewport.
    std::optional<TilePosition> tile_of_pixel(int x, int y) const {
        if (x < 0 || x >= viewport_.width || y < 0 || y >= viewport_.height) return std::nullopt;
        return TilePosition{x / tile_size_, y / tile_size_};
    }

    /// Returns the tile of a place in the image, for LightGrid::lights_in(). None where that lies outside of the
    /// viewport, or not in front of a perspective view's eye.
    std::optional<TilePosition> tile_at(const ImagePoint& point) const {
        const bool inside =
            point.x >= 0 && point.x < viewport_.width && point.y >= 0 && point.y < viewport_.height;
        if (!inside || !(camera_.orthographic || point.depth > 0)) return std::nullopt;
        return TilePosition{static_cast<int>(point.x) / tile_size_, static_cast<int>(point.y) / tile_size_};
    }

private:
    friend const detail::Camera& detail::camera_of(const View& view);

    View() = default;  // from_projection() alone makes one

    /// Why a matrix is of no promised kind, whatever its numbers are.
    static detail::Maybe<ErrorCode> wrong_shape(const Matrix& m) {
        const double w_x = m[0][3], w_y = m[1][3], w_z = m[2][3], w_1 = m[3][3];
        const bool perspective = w_x == 0 && w_y == 0 && w_z != 0 && w_1 == 0;
        const bool orthographic = w_x == 0 && w_y == 0 && w_z == 0 && w_1 > 0;
        if (w_x == 0 && w_y == 0 && w_z != 0 && w_1 != 0) return ErrorCode::eye_not_at_origin;
        if (!perspective && !orthographic) return ErrorCode::not_a_projection;
        if (perspective && (m[3][0] != 0 || m[3][1] != 0)) return ErrorCode::eye_not_at_origin;
        if (m[1][0] != 0 || m[0][1] != 0) return ErrorCode::image_axes_rotated;
        if (orthographic && (m[2][0] != 0 || m[2][1] != 0)) return ErrorCode::image_axes_rotated;
        if (m[0][2] != 0 || m[1][2] != 0) return ErrorCode::oblique_depth;
        return {};
    }

    /// A perspective's one, or minus one, is what its w reads of z. Transposed, it is what z reads of 1.
    static bool one_is_transposed(const Matrix& m) {
        return detail::abs_of(m[3][2]) == 1 && detail::abs_of(m[2][3]) != 1;
    }

    /// Not inline, so that no operation of it moves out of the environment.
    LIGHTBIN_NOINLINE static Result<View> from_columns(const Matrix& m, Extent viewport,
                                                       const ViewOptions& options) {
        const detail::DefaultFloatEnvironment environment;
        const auto error = [](ErrorCode code, int value = 0, int available = 0) {
            return Error{code, static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(available)};
        };
        for (const int side : {viewport.width, viewport.height})
            if (side < 0 || side > max_side) return error(ErrorCode::viewport_out_of_range, side, max_side);
        if (options.tile_size < 1) return error(ErrorCode::tile_size_out_of_range, options.tile_size);
        if (!detail::finite(m)) return error(ErrorCode::matrix_not_finite);
        if (const auto wrong = wrong_shape(m)) {
            const bool transposed = !wrong_shape(detail::transposed(m)) &&
                                    (*wrong != ErrorCode::oblique_depth || one_is_transposed(m));
            return error(transposed ? ErrorCode::projection_transposed : *wrong);
        }
        const double w_z = m[2][3], w_1 = m[3][3];
        const bool orthographic = w_z == 0;

        View view;
        view.projection_ = m;
        view.viewport_ = viewport;
        view.tile_size_ = options.tile_size;
        view.origin_ = options.origin;
        view.clip_depth_ = options.clip_depth;
        view.camera_.orthographic = orthographic;

        // Visible points have w > 0, so the sign of w_z is the viewing direction. An orthographic w has no
        // direction: there depth grows with NDC depth, or against it when Z is reversed.
        const double w = orthographic ? w_1 : detail::abs_of(w_z);
        const bool forward = orthographic ? (m[2][2] > 0) != options.reversed_z : w_z > 0;
        view.camera_.z_sign = forward ? 1.0f : -1.0f;
        const double flip_z = forward ? 1.0 : -1.0;
        const double offset_x = orthographic ? m[3][0] : flip_z * m[2][0];
        const double offset_y = orthographic ? m[3][1] : flip_z * m[2][1];
        const double up = options.origin == WindowOrigin::lower_left ? 1.0 : -1.0;
        if (!view.set_axis(view.camera_.x, m[0][0], offset_x, w, viewport.width) ||
            !view.set_axis(view.camera_.y, up * m[1][1], up * offset_y, w, viewport.height))
            return error(ErrorCode::degenerate_scale);
        if (detail::max_of(detail::abs_of(view.camera_.x.offset), detail::abs_of(view.camera_.y.offset)) >
            0x1p80)
            return error(ErrorCode::image_offset_out_of_range);

        view.z_scale_ = flip_z * m[2][2];
        view.z_offset_ = m[3][2];
        view.w_scale_ = orthographic ? 0 : w;
        view.w_offset_ = orthographic ? w : 0;
        view.reversed_ = orthographic ? options.reversed_z : view.z_offset_ > 0;
        if (const auto wrong = view.set_depth_range()) return error(*wrong);
        return view;
    }

    /// ndc = (p / w) * c + q / w; pixels 0..side are ndc -1..1. Returns whether the scale is one to compute with.
    bool set_axis(detail::ImageAxis& axis, double p, double q, double w, int side) const {
        const double tiles = static_cast<double>(side) / tile_size_;
        axis.tiles = side / tile_size_ + (side % tile_size_ != 0 ? 1 : 0);
        axis.sign = p < 0 ? -1.0f : 1.0f;
        axis.scale = detail::abs_of(p) / w * (0.5 * tiles);
        axis.offset = (q / w + 1.0) * (0.5 * tiles);
        axis.last_tile_centre = static_cast<float>(axis.tiles) - 0.5f;
        axis.limit = detail::float_above(tiles);
        // A float slope is within 10u of the truth (u = 2^-24, see project.inl), times scale as a float 12u, plus u
        // of offset and u of the sum; inside the viewport |scale * slope| <= |offset| + tiles. 16u leaves room
        // for the double steps above and for adding the margin itself; 2^-80 a scale is for a caller who
        // flushes denormal numbers to zero.
        axis.margin =
            detail::float_above(0x1p-20 * (detail::abs_of(axis.offset) + axis.tiles) + 0x1p-80 * axis.scale);
        if (!camera_.orthographic && axis.scale > 0) {
            const double slope = detail::max_of(tiles - axis.offset, axis.offset) / axis.scale;
            const double length = detail::root_of(1 + slope * slope);
            axis.normal = static_cast<float>(1 / length);
            axis.normal_z = static_cast<float>(-slope / length);
        }
        if (side == 0) {
            axis.limit = -1;  // nothing is inside
            return p != 0;
        }
        return axis.scale >= 0x1p-80 && axis.scale <= 0x1p80;
    }

    /// The pixel coordinate of a slope (orthographic: of a view-space coordinate), and back.
    double pixels(const detail::ImageAxis& axis, double slope) const {
        return tile_size_ * (axis.scale * static_cast<double>(axis.sign) * slope + axis.offset);
    }
    double slope(const detail::ImageAxis& axis, double pixels) const {
        return static_cast<double>(axis.sign) * (pixels / tile_size_ - axis.offset) / axis.scale;
    }

    /// Stores the depths of the near and far plane. Returns why these are refused, or nothing where they are not.
    detail::Maybe<ErrorCode> set_depth_range() {
        const DepthInterval range = view_depths(0, 1);
        camera_.near_depth = range.min;
        camera_.min_float_depth = detail::max_of(detail::float_safe_min, range.min);
        camera_.far_depth = range.max;
        if (camera_.orthographic) {
            if (detail::is_finite(range.min) && detail::is_finite(range.max)) return {};
            return ErrorCode::depth_range_not_finite;
        }
        if (range.min >= FLT_MIN && range.min < range.max) return {};
        const bool in_front = depth_at(ndc(reversed_ ? 1 : 0), 0) > 0;
        return in_front && range.min < FLT_MIN ? ErrorCode::near_plane_too_close : ErrorCode::no_near_plane;
    }

    double ndc(double window_depth) const {
        return clip_depth_ == ClipDepth::zero_to_one ? window_depth : 2 * window_depth - 1;
    }

    /// View depth d at which (z_scale d + z_offset) / (w_scale d + w_offset) = v, moved outward (-1 down, +1
    /// up) by the rounding of its own few steps. +inf where a perspective plane v is never reached.
    double depth_at(double v, int direction) const {
        double top = v * w_offset_ - z_offset_;
        double bottom = z_scale_ - v * w_scale_;
        const double top_error = 0x1p-51 * (detail::abs_of(v * w_offset_) + detail::abs_of(z_offset_));
        const double bottom_error = 0x1p-51 * (detail::abs_of(z_scale_) + detail::abs_of(v * w_scale_));
        if (reversed_) {
            top = -top;
            bottom = -bottom;
        }
        const double outward = direction;
        top += outward * top_error;
        bottom -= (top < 0 ? -outward : outward) * bottom_error;
        if (!(bottom > 0)) return static_cast<double>(detail::infinity);
        return top / bottom * (1.0 + (top < 0 ? -outward : outward) * 0x1p-51);
    }

    detail::Camera camera_;
    Matrix projection_ = {};
    Extent viewport_;
    int tile_size_ = 1;
    WindowOrigin origin_ = WindowOrigin::lower_left;
    ClipDepth clip_depth_ = ClipDepth::minus_one_to_one;
    bool reversed_ = false;
    double z_scale_ = 0, z_offset_ = 0, w_scale_ = 0, w_offset_ = 0;
};

inline const detail::Camera& detail::camera_of(const View& view) {
    return view.camera_;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
