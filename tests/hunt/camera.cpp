// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace hunt {
namespace {

bool is(int kind, std::string_view name) {
    return camera_kinds[kind] == name;
}

/// Slopes of the window's edges (perspective) or their coordinates, and depths.
struct Frustum {
    double left, right, bottom, top, near_depth, far_depth;
    bool infinite = false;
};

Frustum make_frustum(int kind, Random& random) {
    const double half = std::tan(random.between(0.3, 1.2)), aspect = random.between(0.5, 2.5);
    const double near_depth = random.log_between(0.01, 1);
    Frustum f = {-half * aspect, half * aspect, -half,
                 half,           near_depth,    near_depth * random.log_between(100, 1e5)};
    const auto widen = [&](double by) {
        for (double* side : {&f.left, &f.right, &f.bottom, &f.top})
            *side *= by;
    };
    const auto move = [&](double most) {
        const double x = (f.right - f.left) * random.between(-most, most),
                     y = (f.top - f.bottom) * random.between(-most, most);
        f.left += x, f.right += x, f.bottom += y, f.top += y;
    };
    if (is(kind, "off-centre")) move(0.6);
    if (is(kind, "jittered")) move(0.0005);
    if (is(kind, "infinite far") || is(kind, "reversed Z, infinite")) {
        f.infinite = true;
        if (random.one_in(3)) f.near_depth *= random.log_between(1e-12, 1);
    }
    if (is(kind, "narrow")) widen(random.log_between(1e-7, 0.1));
    if (is(kind, "wide")) {
        widen(random.log_between(3, 1e5));
        if (random.coin()) move(0.5);
    }
    if (is(kind, "near extreme")) {
        f.near_depth = random.log_between(0x1p-125, 0x1p-20);
        f.far_depth = f.near_depth * random.log_between(2, 1e30);
        f.infinite = random.coin();
    }
    if (is(kind, "far extreme")) {
        f.near_depth = random.log_between(1e-3, 1e10);
        f.far_depth = random.log_between(1e12, 1e38);
    }
    if (is(kind, "thin depth range")) f.far_depth = f.near_depth * (1 + random.log_between(1e-6, 0.1));
    if (is(kind, "aside")) move(random.log_between(1, 1e4));  // the axis far out of the window
    if (is(kind, "orthographic") || is(kind, "ortho aside")) {
        widen(random.log_between(1, 1000));
        if (random.coin()) f.near_depth = -f.far_depth * random.unit();
    }
    if (is(kind, "ortho aside")) move(random.log_between(1, 1e5));
    if (is(kind, "ortho thin")) {
        f.near_depth = random.between(-100, 100);
        f.far_depth = f.near_depth + random.log_between(1e-3, 1);
    }
    if (is(kind, "ortho extreme")) {
        widen(random.log_between(1e-18, 1e18));
        f.far_depth = random.log_between(1e-18, 1e30);
        f.near_depth = random.pick({0.0, -f.far_depth, f.far_depth / 2});
    }
    return f;
}

}  // namespace

bool ordinary(int kind) {
    for (const char* name : {"symmetric", "off-centre", "jittered", "infinite far", "reversed Z",
                             "reversed Z, infinite", "orthographic"})
        if (is(kind, name)) return true;
    return false;
}

Camera make_camera(int kind, Random& random) {
    Camera camera;
    const Frustum f = make_frustum(kind, random);
    camera.orthographic = std::string_view(camera_kinds[kind]).starts_with("ortho");
    camera.toward = random.coin() ? 1 : -1;
    camera.near_hint = f.near_depth;
    camera.far_hint = f.infinite ? std::numeric_limits<double>::infinity() : f.far_depth;
    const bool zero_to_one = random.coin();
    const bool reversed = std::string_view(camera_kinds[kind]).starts_with("reversed") ||
                          (!is(kind, "symmetric") && random.one_in(3));
    camera.options.clip_depth =
        zero_to_one ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one;
    camera.options.reversed_z =
        camera.orthographic ? reversed : random.coin();  // read for orthographic ones alone
    camera.options.origin =
        random.coin() ? lightbin::WindowOrigin::lower_left : lightbin::WindowOrigin::upper_left;

    // clip = w * ndc, with w = depth (perspective) or 1; all times a number that changes nothing.
    double scale = 1;
    if (is(kind, "scaled matrix")) scale = random.log_between(1e-20, 1e20);
    const double flip_x = random.one_in(4) ? -1 : 1, flip_y = random.one_in(3) ? -1 : 1;
    const double toward = static_cast<double>(camera.toward);
    const double x_scale = flip_x * 2 / (f.right - f.left),
                 x_offset = -flip_x * (f.right + f.left) / (f.right - f.left);
    const double y_scale = flip_y * 2 / (f.top - f.bottom),
                 y_offset = -flip_y * (f.top + f.bottom) / (f.top - f.bottom);
    double at_near = zero_to_one ? 0 : -1, at_far = 1;
    if (reversed) std::swap(at_near, at_far);
    glm::dmat4& m = camera.matrix;
    m[0][0] = scale * x_scale;
    m[1][1] = scale * y_scale;
    const int column = camera.orthographic ? 3 : 2;
    const double of_depth = camera.orthographic ? 1 : toward;
    m[column][0] = scale * x_offset * of_depth;
    m[column][1] = scale * y_offset * of_depth;
    m[column][3] = scale * of_depth;
    if (camera.orthographic) {
        const double slope = (at_far - at_near) / (f.far_depth - f.near_depth);
        m[2][2] = scale * slope * toward;
        m[3][2] = scale * (at_near - slope * f.near_depth);
    } else {
        const double over_depth =
            (at_near - at_far) / (1 / f.near_depth - (f.infinite ? 0 : 1 / f.far_depth));
        m[2][2] = scale * toward * (f.infinite ? at_far : at_far - over_depth / f.far_depth);
        m[3][2] = scale * over_depth;
    }
    camera.in_float = random.coin();
    if (camera.in_float) m = glm::dmat4(glm::mat4(m));
    return camera;
}

void set_grid(Camera& camera, int kind, Random& random) {
    const std::string_view name = grid_kinds[kind];
    const auto side_of = [&](int tiles, int size) {  // of that many tiles, the last whole or not
        return std::min(tiles * size - (random.coin() ? 0 : random.below(size)), lightbin::View::max_side);
    };
    const auto edge =
        [&](int most) {  // numbers of tiles where a kernel may begin a new vector, band, panel or byte
            int tiles;
            do {
                const int base = random.pick({8,    16,   31,   32,   62,   64,    96,    124,  128, 192,
                                              240,  248,  256,  264,  384,  496,   504,   512,  744, 992,
                                              1024, 2040, 2048, 4096, 8192, 16384, 32760, 32768});
                tiles = base + random.from_to(-1, 1);
            } while (tiles > most);
            return tiles;
        };
    int size = random.pick({1, 2, 3, 5, 7, 8, 13, 16, 31, 32, 33, 64}), width = random.from_to(1, 40 * size),
        height = random.from_to(1, 30 * size);
    if (name == "tile multiples") {
        width = std::max(1, random.from_to(1, 40) * size + random.from_to(-1, 1));
        height = std::max(1, random.from_to(1, 30) * size + random.from_to(-1, 1));
    } else if (name == "one-pixel tiles") {
        size = 1, width = random.from_to(1, 200), height = random.from_to(1, 100);
    } else if (name == "kernel widths") {
        size = random.pick({1, 1, 2, 3});
        width = side_of(edge(2100), size), height = side_of(random.from_to(1, 20), size);
    } else if (name == "kernel heights") {
        size = random.pick({1, 1, 2, 3});
        width = side_of(random.from_to(1, 20), size), height = side_of(edge(2100), size);
    } else if (name == "kernel both") {
        size = random.pick({1, 1, 2, 7});
        width = side_of(edge(260), size), height = side_of(edge(260), size);
    } else if (name == "one tile wide") {
        width = random.from_to(1, size);
    } else if (name == "one tile high") {
        height = random.from_to(1, size);
    } else if (name == "one pixel") {
        width = height = 1;
    } else if (name == "huge tiles") {
        size = random.pick({1 << 14, 1 << 15, (1 << 15) + 1, 1 << 30, std::numeric_limits<int>::max()});
        width = random.from_to(1, lightbin::View::max_side),
        height = random.from_to(1, lightbin::View::max_side);
    } else if (name == "longest side") {
        size = random.pick({64, 100, 128, 255, 256, 257, 1024});
        width = lightbin::View::max_side - random.from_to(0, 2),
        height = lightbin::View::max_side - random.from_to(0, 2);
    } else if (name == "longest tall") {
        size = 1, width = random.pick({1, 2, 7, 8, 9, 16, 17}),
        height = random.pick({32768, 32768, 32767, 32760, 16385});
    } else if (name == "longest wide") {
        size = 1, width = random.pick({32768, 32768, 32767, 32760, 16385}),
        height = random.pick({1, 2, 7, 8, 9, 16, 17});
    } else if (name == "empty") {
        (random.coin() ? width : height) = 0;
        if (random.one_in(4)) width = height = 0;
    }
    camera.viewport = {width, height};
    camera.options.tile_size = size;
}

std::optional<Seen> see(const Camera& camera, const RealPoint& point) {
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
    const Real x = clip[0] / w, y = clip[1] / w, z = clip[2] / w, half = 0.5L;
    const Real width = static_cast<long double>(camera.viewport.width),
               height = static_cast<long double>(camera.viewport.height);
    const Real up = camera.options.origin == lightbin::WindowOrigin::lower_left ? y : -y;
    Seen seen;
    seen.x = (x + 1) * half * width;
    seen.y = (up + 1) * half * height;
    seen.depth = Real(camera.toward) * point[2];
    seen.window_depth = zero_to_one ? z : (z + 1) * half;
    return seen;
}

Point point_at(const Camera& camera, long double x, long double y, long double depth) {
    const glm::dmat4& m = camera.matrix;
    const long double ndc_x = 2 * x / camera.viewport.width - 1;
    const long double up = 2 * y / camera.viewport.height - 1;
    const long double ndc_y = camera.options.origin == lightbin::WindowOrigin::lower_left ? up : -up;
    const long double z = camera.toward * depth, w = m[2][3] * z + m[3][3];
    return {(ndc_x * w - m[2][0] * z - m[3][0]) / m[0][0], (ndc_y * w - m[2][1] * z - m[3][1]) / m[1][1], z};
}

}  // namespace hunt
