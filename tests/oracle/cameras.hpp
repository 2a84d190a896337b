// SPDX-License-Identifier: MIT
// Every kind of camera that the library promises to support, by name.
#pragma once

#include "../../bench/exact/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace oracle {

/// What a projection matrix is made from. Extents are measured in the image plane at depth 1 (perspective) or across
/// the box (orthographic), x to the right, y up.
struct Lens {
    double left = 0, right = 0, bottom = 0, top = 0;
    double near_plane = 0.1, far_plane = 1000;  ///< far may be infinite
    bool orthographic = false;
    bool looks_up_z = false;  ///< +z is forward ("left-handed"); otherwise -z is
    bool zero_to_one = false;
    bool reversed = false;
    double factor = 1;  ///< times the whole matrix
    bool flip_x = false, flip_y = false;
    bool doubles = false;
    /// An oblique near plane in view space, points with x px + y py + z pz + w >= 0 being drawn; none if w is 0.
    double plane[4] = {};
};

/// Puts the lens' oblique near plane in the z row of its matrix, with the far plane through the corner farthest from it
/// of the old far side: E. Lengyel, Oblique View Frustum Depth Projection and Clipping, 2005.
inline void set_oblique_plane(Matrix& m, const Lens& lens) {
    const double(&plane)[4] = lens.plane;
    double scale = 0;
    for (const double x : {lens.left, lens.right})
        for (const double y : {lens.bottom, lens.top}) {
            const double s = lens.looks_up_z ? 1 : -1,
                         far_plane = std::isinf(lens.far_plane) ? 1e5 * lens.near_plane : lens.far_plane,
                         w = lens.orthographic ? 1 : far_plane;
            const double inside = plane[0] * x * w + plane[1] * y * w + plane[2] * s * far_plane + plane[3];
            scale = std::max(scale, inside / w);
        }
    const double depths = lens.zero_to_one ? 1 : 2, sign = lens.reversed ? -1 : 1;
    for (int i = 0; i < 4; ++i) {
        const double at_near = lens.reversed ? 1 : lens.zero_to_one ? 0 : -1;
        m[i][2] = at_near * m[i][3] + sign * depths / scale * plane[i];
    }
}

inline Matrix projection(const Lens& lens) {
    const double n = lens.near_plane, f = lens.far_plane, s = lens.looks_up_z ? 1 : -1;
    const double width = lens.right - lens.left, height = lens.top - lens.bottom;
    const double shift_x = (lens.right + lens.left) / width, shift_y = (lens.top + lens.bottom) / height;
    const double far_end = lens.zero_to_one ? 0 : -1;  // of NDC depth, the other end is 1
    const double at_near = lens.reversed ? 1 : far_end, at_far = lens.reversed ? far_end : 1;

    Matrix m{};
    m[0][0] = (lens.flip_x ? -2 : 2) / width;
    m[1][1] = (lens.flip_y ? -2 : 2) / height;
    if (lens.orthographic) {  // ndc depth = a d + b
        const double a = (at_far - at_near) / (f - n);
        m[2][2] = s * a;
        m[3][2] = at_near - a * n;
        m[3][0] = (lens.flip_x ? 1 : -1) * shift_x;
        m[3][1] = (lens.flip_y ? 1 : -1) * shift_y;
        m[3][3] = 1;
    } else {  // clip depth = a d + b, w = d
        const double a = std::isinf(f) ? at_far : (at_far * f - at_near * n) / (f - n);
        m[2][2] = s * a;
        m[3][2] = n * (at_near - a);
        m[2][0] = (lens.flip_x ? 1 : -1) * s * shift_x;
        m[2][1] = (lens.flip_y ? 1 : -1) * s * shift_y;
        m[2][3] = s;
    }
    if (lens.plane[3] != 0) set_oblique_plane(m, lens);
    for (auto& column : m.entry)
        for (double& entry : column) {
            entry *= lens.factor;
            if (!lens.doubles) entry = static_cast<double>(static_cast<float>(entry));
        }
    return m;
}

/// Viewport, tile size and window origin: sizes with and without partial last tiles, tiles of one pixel, a tile size
/// that divides nothing, and one tile larger than the screen.
struct Screen {
    int width, height, tile;
    bool upper_left;
};

inline const std::vector<Screen>& screens() {
    static const std::vector<Screen> all = {{1920, 1088, 32, false}, {1919, 1079, 16, true},
                                            {61, 47, 1, false},      {3841, 2161, 57, true},
                                            {47, 61, 1, true},       {100, 75, 256, false}};
    return all;
}

inline double aspect_of(const Screen& screen) {
    return static_cast<double>(screen.width) / screen.height;
}

inline Camera camera_of(const std::string& name, const Lens& lens, const Screen& screen) {
    return {name,
            projection(lens),
            lens.doubles,
            screen.width,
            screen.height,
            screen.tile,
            lens.zero_to_one,
            screen.upper_left,
            lens.orthographic && lens.reversed};
}

/// A kind of camera: one lens on the first screen and on one of the next four (chosen by the name's length), or on
/// every screen.
struct CameraKind {
    std::string name;
    Lens (*lens_of)(double aspect);
    bool every_screen = false;

    std::vector<Camera> cameras() const {
        std::vector<Camera> all;
        for (std::size_t i = 0; i < screens().size(); ++i) {
            const Screen& screen = screens()[i];
            if (!every_screen && i != 0 && i != 1 + name.size() % 4) continue;
            all.push_back(camera_of(name + " " + std::to_string(screen.width) + "x" + std::to_string(screen.height) +
                                        "/" + std::to_string(screen.tile) +
                                        (screen.upper_left ? " upper left" : " lower left"),
                                    lens_of(aspect_of(screen)), screen));
        }
        // 90 degrees and a power of two of pixels: edges have slopes such as 3/4, which a sphere can touch exactly.
        if (every_screen)
            all.push_back(camera_of(name + " 90 degrees", {-1, 1, -1, 1, 0.125, 512}, {256, 256, 32, false}));
        return all;
    }
};

/// Half the image height at depth 1 is tan(degrees / 2).
inline Lens symmetric_lens(double aspect, double degrees) {
    const double t = std::tan(degrees * std::acos(-1.0) / 360);
    return {-t * aspect, t * aspect, -t, t};
}

inline Lens box_lens(double aspect, double half_height) {
    Lens lens{-half_height * aspect, half_height * aspect, -half_height, half_height};
    lens.orthographic = true;
    lens.near_plane = -20;
    lens.far_plane = 300;
    return lens;
}

/// Sets an oblique near plane of a normal (x, y, and along depth) and a distance.
inline void oblique(Lens& lens, double x, double y, double depth, double w) {
    const double plane[4] = {x, y, lens.looks_up_z ? depth : -depth, w};
    std::copy_n(plane, 4, lens.plane);
}

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Returns a symmetric lens with this angle, or an orthographic box of this height, changed by `change`.
template <int degrees, auto change> Lens symmetric(double aspect) {
    Lens lens = symmetric_lens(aspect, degrees);
    change(lens);
    return lens;
}
template <int half_height, auto change> Lens box(double aspect) {
    Lens lens = box_lens(aspect, half_height);
    change(lens);
    return lens;
}

/// CMakeLists.txt reads the names.
inline const std::vector<CameraKind>& camera_kinds() {
    static const std::vector<CameraKind> kinds = {
        {"symmetric", symmetric<60, [](Lens&) {}>, true},
        {"left_handed", symmetric<60, [](Lens& lens) { lens.looks_up_z = lens.zero_to_one = true; }>},
        {"right_handed_zero_to_one",
         symmetric<75, [](Lens& lens) { lens.zero_to_one = true, lens.near_plane = 1e-5; }>},
        {"off_centre", [](double aspect) { return Lens{-0.9 * aspect, 0.3 * aspect, -0.2, 0.7, 0.25, 500}; }},
        {"jittered", symmetric<60, [](Lens& lens) {
             const double x = 0.37 / 1920 * (lens.right - lens.left), y = -0.21 / 1080 * (lens.top - lens.bottom);
             lens.left += x, lens.right += x, lens.bottom += y, lens.top += y;
         }>},
        {"infinite_far", symmetric<60, [](Lens& lens) { lens.far_plane = infinite; }>},
        {"reversed", symmetric<60, [](Lens& lens) { lens.zero_to_one = lens.reversed = true; }>},
        {"reversed_minus_one_to_one", symmetric<60, [](Lens& lens) { lens.reversed = lens.looks_up_z = true; }>},
        {"reversed_infinite", symmetric<60, [](Lens& lens) {
             lens.zero_to_one = lens.reversed = true, lens.far_plane = infinite;
         }>},
        {"y_flip", symmetric<60, [](Lens& lens) { lens.flip_y = lens.zero_to_one = true, lens.top *= 1.25; }>},
        {"x_flip", symmetric<60, [](Lens& lens) { lens.flip_x = true, lens.left *= 0.75; }>},
        {"tiny_fov", [](double aspect) { return symmetric_lens(aspect, 0.05); }},
        {"wide_fov", symmetric<170, [](Lens&) {}>},
        {"scaled_matrix", symmetric<60, [](Lens& lens) { lens.factor = 3.7e-3; }>},
        {"double_matrix", symmetric<60, [](Lens& lens) { lens.left *= 0.99, lens.doubles = true; }>},
        {"screens_off_centre", [](double aspect) {
             return Lens{-1.97 * aspect, -1.87 * aspect, 0.73, 0.83, 0.1, 1000};
         }},
        {"orthographic", box<32, [](Lens&) {}>},
        {"orthographic_off_centre", box<40, [](Lens& lens) {
             lens.left += 100, lens.right += 100, lens.bottom -= 10, lens.top -= 10;
             lens.looks_up_z = lens.zero_to_one = true;
             lens.near_plane = 0;
         }>},
        {"orthographic_reversed", box<25, [](Lens& lens) {
             lens.reversed = lens.zero_to_one = true, lens.factor = 5;
         }>},
        {"oblique", symmetric<60, [](Lens& lens) { oblique(lens, 0, 0.8, 0.6, -1); }>},
        {"oblique_reversed", symmetric<75, [](Lens& lens) {
             lens.zero_to_one = lens.reversed = lens.looks_up_z = true, lens.far_plane = infinite;
             oblique(lens, -0.5, 0.25, 1, -0.3);
         }>},
        {"oblique_orthographic", box<25, [](Lens& lens) {
             lens.left += 30, lens.right += 30;
             oblique(lens, 0.25, -0.125, 1, -7);
         }>},
    };
    return kinds;
}

/// The first camera of a kind.
inline Camera camera_of_kind(const std::string& name) {
    for (const CameraKind& kind : camera_kinds())
        if (kind.name == name) return kind.cameras().front();
    return {};
}

}  // namespace oracle
