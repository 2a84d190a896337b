// SPDX-License-Identifier: MIT
// Random cameras of every kind, and the user's computation from view space to pixels.
#pragma once

#include "random.hpp"
#include "real.hpp"

#include <lightbin/lightbin.hpp>

#include <glm/glm.hpp>

#include <algorithm>
#include <optional>

namespace hunt {

/// A projection matrix as a user has it, for the clip space of the user's graphics API.
struct Camera {
    glm::dmat4 matrix = glm::dmat4(0);
    bool in_float = false;  ///< the matrix is given as floats, and its entries are floats
    lightbin::ImageSize viewport;
    lightbin::ViewOptions options;
    bool orthographic = false;
    bool turned = false;                 ///< by 90 or 270 degrees: view-space x is up or down in the window
    long double toward = -1;             ///< view depth = toward * z
    double near_hint = 0, far_hint = 0;  ///< approximate depths of the planes; the far plane may be infinite
};

/// Makes a camera of any API: either depth range, reversed or not, mirrored or not. If `ordinary`, the library must
/// accept it; otherwise some of its numbers are extreme.
inline Camera make_camera(bool ordinary, Random& random) {
    Camera camera;
    const bool orthographic = camera.orthographic = random.one_in(4);
    const auto extreme = [&](double least, double most) {
        return !ordinary && random.one_in(4) ? random.log_between(least, most) : 1;
    };
    // The slopes of the window's edges (orthographic: their coordinates), and the depths of the planes.
    const double half = std::tan(random.between(0.3, 1.2)) * (orthographic ? random.log_between(1, 1000) : 1) *
                        (orthographic ? extreme(1e-18, 1e18) : extreme(1e-7, 1e5)),
                 width = 2 * half * random.between(0.5, 2.5), height = 2 * half;
    const auto moved = [&] {  // by so many windows: jitter, off-centre windows, and such far from the axis
        const double most = random.pick({0.0, 0.0005, 0.6}) * extreme(1, 1e4);
        return random.between(-most, most);
    };
    const double x = width * moved(), y = height * moved();
    double near_depth = random.log_between(0.01, 1) * extreme(0x1p-118, 1e10),
           far_depth = near_depth * random.log_between(100, 1e5) * extreme(1e7, 1e28);
    if (!ordinary && random.one_in(8)) far_depth = near_depth * (1 + random.log_between(1e-6, 0.1));
    const bool endless = !orthographic && random.one_in(3);
    if (endless) far_depth = std::numeric_limits<double>::infinity();
    if (orthographic && random.coin()) near_depth = -far_depth * random.unit();
    camera.near_hint = near_depth, camera.far_hint = far_depth;

    const bool zero_to_one = random.coin(), reversed = random.one_in(3);
    camera.options.clip_depth = zero_to_one ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one;
    camera.options.reversed_z = orthographic ? reversed : random.coin();  // read for orthographic ones alone
    camera.options.origin = random.coin() ? lightbin::WindowOrigin::lower_left : lightbin::WindowOrigin::upper_left;

    // The matrix is that of clip = w * ndc, with w = depth (perspective) or 1, times a factor that changes nothing.
    const double scale = extreme(1e-20, 1e20), toward = random.sign();
    camera.toward = toward;
    const double x_scale = random.sign() * 2 / width, y_scale = random.sign() * 2 / height;
    double at_near = zero_to_one ? 0 : -1, at_far = 1;
    if (reversed) std::swap(at_near, at_far);
    glm::dmat4& m = camera.matrix;
    m[0][0] = scale * x_scale;
    m[1][1] = scale * y_scale;
    glm::dvec4& of_w = m[orthographic ? 3 : 2];  // the column that w is made of, as are the offsets in the image
    of_w = scale * (orthographic ? 1 : toward) * glm::dvec4(-x_scale * x, -y_scale * y, 0, 1);
    if (orthographic) {
        const double slope = (at_far - at_near) / (far_depth - near_depth);
        m[2][2] = scale * slope * toward;
        m[3][2] = scale * (at_near - slope * near_depth);
    } else {
        const double over_depth = (at_near - at_far) / (1 / near_depth - 1 / far_depth);
        m[2][2] = scale * toward * (at_far - over_depth / far_depth);
        m[3][2] = scale * over_depth;
    }
    if (random.one_in(5))  // an oblique near plane
        for (const int axis : {0, 1})
            m[axis][2] = m[axis][axis] * random.between(-0.5, 0.5);
    camera.turned = random.one_in(4);
    for (int column = 0; camera.turned && column < 4; ++column)
        std::swap(m[column][0], m[column][1]);
    camera.in_float = random.coin();
    if (camera.in_float) m = glm::dmat4(glm::mat4(m));
    return camera;
}

/// Gives the camera a viewport and a tile size: few tiles, one or none, or as many as a kernel works on at once, give
/// or take one. The last tile of a row or column is often partial.
inline void set_grid(Camera& camera, Random& random) {
    constexpr int most_side = lightbin::View::max_side;
    const int size = camera.options.tile_size =
        random.one_in(16) ? random.pick({1 << 14, 1 << 15, (1 << 15) + 1, 1 << 30, std::numeric_limits<int>::max()})
                          : random.pick({1, 1, 2, 3, 5, 7, 8, 13, 16, 31, 32, 33, 64, 128, 255, 1024});
    const auto side = [&](int most_tiles) {
        if (random.one_in(60)) return 0;
        if (random.one_in(30)) return std::min(most_side, most_tiles) - random.from_to(0, 2);
        int tiles = random.from_to(1, random.one_in(4) ? 2 : 40);
        if (random.coin())
            tiles = random.from_to(-1, 1) +
                    random.pick({8,   16,  31,  32,  62,  64,  96,   124,  128,  192,  240,  248,   256,   264,
                                 384, 496, 504, 512, 744, 992, 1024, 2040, 2048, 4096, 8192, 16384, 32760, 32768});
        tiles = std::min({tiles, most_tiles, most_side / size + 1});
        const std::int64_t pixels = std::int64_t{tiles} * size - (random.coin() ? 0 : random.below(size));
        return static_cast<int>(std::clamp<std::int64_t>(pixels, 1, most_side));
    };
    constexpr int most_tiles = 70'000;
    const int first = side(most_tiles), across = side(most_tiles / (first / size + 1));
    camera.viewport = random.coin() ? lightbin::ImageSize{first, across} : lightbin::ImageSize{across, first};
    if (!random.one_in(3)) return;
    const auto count = [&](int pixels, int most) {
        const int any =
            random.pick({random.from_to(1, 20), random.from_to(1, 300), pixels - 1, pixels, 2 * pixels + 1});
        return std::clamp(any, 1, std::min(most, most_side));
    };
    camera.options.columns = count(camera.viewport.width, most_tiles);
    camera.options.rows = count(camera.viewport.height, most_tiles / camera.options.columns);
}

/// The side of a tile along an axis of the window, in pixels.
inline long double tile_side(const Camera& camera, std::size_t axis) {
    const int pixels = axis == 0 ? camera.viewport.width : camera.viewport.height,
              count = axis == 0 ? camera.options.columns : camera.options.rows;
    return count > 0 && pixels > 0 ? static_cast<long double>(pixels) / count : camera.options.tile_size;
}

/// Where a point of view space is seen.
struct Seen {
    Real x, y;   ///< in pixels from the window's origin
    Real depth;  ///< view depth
};

/// Returns where a point is seen; nothing if it is outside of the clip volume or rounding leaves that open.
inline std::optional<Seen> see(const Camera& camera, const RealPoint& point) {
    Real clip[4];
    for (int row = 0; row < 4; ++row) {
        clip[row] = static_cast<long double>(camera.matrix[3][row]);
        for (int column = 0; column < 3; ++column)
            clip[row] = clip[row] + Real(static_cast<long double>(camera.matrix[column][row])) *
                                        point[static_cast<std::size_t>(column)];
    }
    const Real w = clip[3];
    if (!surely_less(0, w)) return std::nullopt;
    const bool zero_to_one = camera.options.clip_depth == lightbin::ClipDepth::zero_to_one;
    for (int row = 0; row < 3; ++row)
        if (!surely_less(row == 2 && zero_to_one ? Real(0) : -w, clip[row]) || !surely_less(clip[row], w))
            return std::nullopt;
    const Real half = 0.5L, y = clip[1] / w;
    const Real up = camera.options.origin == lightbin::WindowOrigin::lower_left ? y : -y;
    return Seen{(clip[0] / w + 1) * half * static_cast<long double>(camera.viewport.width),
                (up + 1) * half * static_cast<long double>(camera.viewport.height), Real(camera.toward) * point[2]};
}

/// Returns a point that is seen near a place in the window and near a view depth; not exactly.
inline Point point_at(const Camera& camera, long double x, long double y, long double depth) {
    const glm::dmat4& m = camera.matrix;
    const long double ndc_x = 2 * x / camera.viewport.width - 1;
    const long double up = 2 * y / camera.viewport.height - 1;
    const long double ndc_y = camera.options.origin == lightbin::WindowOrigin::lower_left ? up : -up;
    const long double z = camera.toward * depth, w = m[2][3] * z + m[3][3];
    const int of_x = camera.turned ? 1 : 0, of_y = 1 - of_x;
    const long double x_is = (ndc_x * w - m[2][0] * z - m[3][0]) / m[of_x][0],
                      y_is = (ndc_y * w - m[2][1] * z - m[3][1]) / m[of_y][1];
    return camera.turned ? Point{y_is, x_is, z} : Point{x_is, y_is, z};
}

}  // namespace hunt
