// SPDX-License-Identifier: MIT
// Stability: settled.
// Stage 1: reads a projection matrix, and fixes the tile grid of a viewport.
#pragma once

#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/view/projection.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The range of clip-space depth, a setting of the graphics API that a matrix does not show. With minus_one_to_one in
/// place of zero_to_one the near plane seems too near, which is safe; in the reverse case lights are missed.
enum class ClipDepth : std::uint8_t {
    minus_one_to_one,  ///< depths -1 to 1: OpenGL
    zero_to_one,       ///< depths 0 to 1: Direct3D, Vulkan, Metal, WebGPU, OpenGL with glClipControl
};

/// The corner of the window that holds pixel (0, 0) and tile (0, 0), where the lower side is the one with NDC y = -1.
/// Vulkan calls the side with NDC y = -1 the upper one: Vulkan's upper left corner is lower_left here.
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
struct ImageSize {
    int width = 0;
    int height = 0;
};

/// The parameters of a View that from_projection() cannot read from the matrix.
struct ViewOptions {
    int tile_size = 32;  ///< side of a square tile in pixels, 1 or more
    /// The numbers of tile columns and rows, to be given in place of tile_size: 1 to View::max_side each, or both 0.
    /// They divide the viewport's width and height into equal parts, which need not be whole pixels.
    int columns = 0, rows = 0;
    /// In place of all three: as many columns and rows of about square tiles as make at most so many tiles. For at most
    /// 4096 cells in 24 slices it is 4096 / 24. 0: is not read.
    int max_tiles = 0;
    ClipDepth clip_depth = ClipDepth::minus_one_to_one;
    WindowOrigin origin = WindowOrigin::lower_left;
    /// The near plane has the larger window depth. Read for orthographic matrices alone: a perspective matrix shows it.
    bool reversed_z = false;
};

/// View depths from min to max, both included.
struct DepthInterval {
    float min, max;
};

/// A point of view space, the space that the projection matrix is applied to.
struct ViewPoint {
    double x, y, z;
};

/// A point of the image: x and y in pixels from the corner that WindowOrigin names, and its view depth. The centre of
/// pixel (i, j) is (i + 0.5, j + 0.5).
struct ImagePoint {
    double x, y, depth;
};

/// A tile's column and row.
struct TilePosition {
    int x, y;
};

/// A projection, a viewport and a tile size. Together they fix the tile grid.
///
/// Tiles are squares of t = tile_size() pixels. Tile (tx, ty) has index ty * tiles_x() + tx and covers the pixels tx *
/// t to (tx + 1) * t in x and ty * t to (ty + 1) * t in y, cut off at the viewport's edge. With numbers of columns and
/// rows, of N tiles along W pixels, tile tx has the pixels x whose centre lies in it: (2 x + 1) N / (2 W), rounded
/// down, is tx. Its lists have all lights of these pixels, up to their edges.
///
/// If the projection turns the image by 90 or 270 degrees, as Android's pre-rotation does, the grid is that of the
/// upright image: tile columns are counted along y of the viewport, tile rows along x. View depth is the distance
/// from the eye (orthographic: from the plane z = 0) along the viewing direction, in the units of view space.
class View {
public:
    static constexpr int max_side = 32768;

    /// Returns the view of a projection matrix, or an Error that names why the matrix or a size is refused.
    ///
    /// projection  maps view space to clip space: a glm::mat4, any projection[column][row] of floats or doubles, or
    ///             another type that matrix.hpp lists. Perspective projections may be symmetric or not, jittered, with
    ///             finite or infinite far plane, standard or reversed Z, look down -z or +z, be flipped in x or y, and
    ///             turn the image by 90, 180 or 270 degrees. Orthographic ones may be centred or not. The near plane
    ///             may be oblique, as for mirrors: the View looks along z, whichever way the plane is turned.
    /// viewport    0 to max_side pixels a side. An empty viewport has no tiles.
    template <class Matrix>
    static Result<View> from_projection(const Matrix& projection, ImageSize viewport,
                                        const ViewOptions& options = {}) {
        return make(detail::to_matrix(projection), viewport, options);
    }

    /// Returns this view with square tiles of another size. Errors: those of from_projection().
    Result<View> with_tile_size(int tile_size) const {
        const auto clip_depth = static_cast<ClipDepth>(projection_.depth.zero_to_one);
        return make(projection_.matrix, viewport_,
                    {.tile_size = tile_size, .clip_depth = clip_depth, .origin = origin_, .reversed_z = reversed_z()});
    }

    ImageSize viewport() const { return viewport_; }
    /// In pixels; 0 if the view was made with numbers of columns and rows, or of tiles.
    int tile_size() const { return tile_size_; }
    int tiles_x() const { return projection_.camera.x.tiles; }
    int tiles_y() const { return projection_.camera.y.tiles; }
    std::size_t tile_count() const {
        return static_cast<std::size_t>(tiles_x()) * static_cast<std::size_t>(tiles_y());
    }
    WindowOrigin origin() const { return origin_; }
    bool orthographic() const { return projection_.camera.orthographic; }
    bool reversed_z() const { return projection_.depth.reversed; }
    /// Whether the near plane is oblique, as for mirrors, water and portals.
    bool oblique() const { return projection_.depth.oblique(); }
    /// Whether the projection turns the image by 90 or 270 degrees: for SnippetOptions::turned.
    bool turned() const { return projection_.turned; }

    /// Returns what was read from the matrix, to be printed with std::puts(to_string(view.summary()).c_str()).
    ViewSummary summary() const {
        return projection_.summary(viewport_.width, viewport_.height, tile_size_);
    }

    /// Least view depth in the clip region, rounded down: that of the near plane, unless this is oblique.
    float near_depth() const { return projection_.camera.near_depth; }
    /// Greatest view depth in the clip region, rounded up; +inf if the projection has no far plane. Oblique near planes
    /// tilt the far plane, which then mostly cuts off nothing.
    float far_depth() const { return projection_.camera.far_depth; }

    /// Returns the least and greatest view depth of all points of the image whose window depth, which a depth buffer
    /// stores, lies in [lower, upper], rounded outward. 0 and 1 are the two ends of the clip-depth range.
    DepthInterval view_depths(double lower, double upper) const {
        DepthInterval depths = {};
        projection_.depth.view_depths(lower, upper, projection_.depth.tilts_around(), depths.min, depths.max);
        return depths;
    }

    /// Window depth of an image point, up to rounding. NaN for an infinite view depth. With an oblique near plane
    /// alone, x and y matter, and the viewport must not be empty.
    float window_depth(const ImagePoint& point) const {
        const detail::DepthMap& map = projection_.depth;
        if (!map.oblique()) return map.window_depth(point.depth);
        const double x = 2 * point.x / viewport_.width - 1, y = 2 * point.y / viewport_.height - 1;
        return map.tilted(turned() ? map.tilt_at(y, x) : map.tilt_at(x, y)).window_depth(point.depth);
    }

    /// Returns where in the image a view-space point lies, inside or outside of the viewport, up to rounding in double.
    /// For a point that is not in front of a perspective view's eye, depth is 0 or less, and x and y mean nothing.
    ImagePoint image_point(const ViewPoint& point) const {
        const detail::Camera& camera = projection_.camera;
        const double depth = static_cast<double>(camera.z_sign) * point.z,
                     distance = camera.orthographic ? 1 : depth;
        const double x = pixels(camera.x, point.x / distance), y = pixels(camera.y, point.y / distance);
        return turned() ? ImagePoint{y, x, depth} : ImagePoint{x, y, depth};
    }

    /// The inverse of image_point(): the view-space point that an image point shows. The viewport must not be empty.
    ViewPoint view_point(const ImagePoint& point) const {
        const detail::Camera& camera = projection_.camera;
        const double distance = camera.orthographic ? 1 : point.depth;
        return {slope(camera.x, turned() ? point.y : point.x) * distance,
                slope(camera.y, turned() ? point.x : point.y) * distance,
                static_cast<double>(camera.z_sign) * point.depth};
    }

    /// Returns the tile that holds a pixel, or nothing if the pixel is outside of the viewport.
    std::optional<TilePosition> tile_of_pixel(int x, int y) const {
        return tile_at({x + 0.0, y + 0.0, 1});
    }

    /// Returns the tile that holds an image point, for LightGrid::lights_in(), or nothing if the point is outside of
    /// the viewport or not in front of a perspective view's eye.
    std::optional<TilePosition> tile_at(const ImagePoint& point) const {
        const bool inside =
            point.x >= 0 && point.x < viewport_.width && point.y >= 0 && point.y < viewport_.height;
        if (!inside || !(orthographic() || point.depth > 0)) return std::nullopt;
        const int x = static_cast<int>(point.x), y = static_cast<int>(point.y);
        return TilePosition{projection_.camera.x.split.tile_of(turned() ? y : x),
                            projection_.camera.y.split.tile_of(turned() ? x : y)};
    }

private:
    friend const detail::Projection& detail::projection_of(const View& view);

    View() = default;

    static Result<View> make(const Matrix& matrix, ImageSize viewport, const ViewOptions& options) {
        for (const int side : {viewport.width, viewport.height})
            if (side < 0 || side > max_side)
                return Error{ErrorCode::viewport_out_of_range, static_cast<std::uint64_t>(side), max_side};
        if (options.tile_size < 1)
            return Error{ErrorCode::tile_size_out_of_range, static_cast<std::uint64_t>(options.tile_size)};
        int columns = options.columns, rows = options.rows;
        const int fewest = detail::min_of(columns, rows), most = detail::max_of(columns, rows);
        if (fewest < 0 || most > max_side || (fewest == 0 && most > 0) || options.max_tiles < 0)
            return Error{ErrorCode::tile_count_out_of_range,
                         static_cast<std::uint64_t>(most > max_side ? most : detail::min_of(fewest, options.max_tiles)),
                         max_side};
        if (options.max_tiles > 0) {
            // Square tiles are  sqrt(max_tiles height / width)  rows; here rounded to the nearest whole number.
            const std::int64_t width = detail::max_of(viewport.width, 1), height = detail::max_of(viewport.height, 1),
                               limit = detail::min_of<std::int64_t>(options.max_tiles, height);
            std::int64_t count = 1;
            while (count < limit && (2 * count + 1) * (2 * count + 1) * width <= 4 * height * options.max_tiles)
                ++count;
            rows = static_cast<int>(count);
            columns = static_cast<int>(detail::min_of(options.max_tiles / count, width));
        }
        const auto split = [&](int side, int count) {
            return count > 0 ? detail::TileSplit{side, detail::max_of(side, 1), count}
                             : detail::TileSplit{side, options.tile_size, 1};
        };
        View view;
        view.viewport_ = viewport;
        view.tile_size_ = columns > 0 ? 0 : options.tile_size;
        view.origin_ = options.origin;
        view.projection_.matrix = matrix;
        view.projection_.depth.zero_to_one = options.clip_depth == ClipDepth::zero_to_one;
        if (const auto code =
                view.projection_.read(split(viewport.width, columns), split(viewport.height, rows),
                                      options.origin == WindowOrigin::lower_left, options.reversed_z))
            return Error{*code};
        return view;
    }

    /// Pixel coordinate of a slope x / depth (orthographic: of a view-space coordinate x) on one image axis.
    double pixels(const detail::ImageAxis& axis, double slope) const {
        return axis.split.pixels_of(axis.scale * static_cast<double>(axis.sign) * slope + axis.offset);
    }
    /// Slope x / depth (orthographic: view-space coordinate x) of a pixel coordinate on one image axis.
    double slope(const detail::ImageAxis& axis, double pixels) const {
        return static_cast<double>(axis.sign) * (axis.split.tiles_of(pixels) - axis.offset) / axis.scale;
    }

    detail::Projection projection_;
    ImageSize viewport_;
    int tile_size_ = 1;  ///< 0: numbers of columns and rows were given
    WindowOrigin origin_ = WindowOrigin::lower_left;
};

inline const detail::Projection& detail::projection_of(const View& view) {
    return view.projection_;
}
inline const detail::Camera& detail::camera_of(const View& view) {
    return projection_of(view).camera;
}

}}  // namespace lightbin
