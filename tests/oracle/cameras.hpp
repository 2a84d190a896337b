// SPDX-License-Identifier: MIT
// Every camera kind that is promised to work, by name.
#pragma once

#include "../../bench/exact/camera.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace oracle {

/// What a projection matrix is made from. Extents are those of the image plane at depth 1 (perspective) or of
/// the box (orthographic), x to the right, y up.
struct Lens {
    double left = 0, right = 0, bottom = 0, top = 0;
    double near_plane = 0.1, far_plane = 1000;  ///< far may be infinite
    bool orthographic = false;
    bool looks_up_z = false;  ///< +z is forward ("left-handed"); otherwise -z
    bool zero_to_one = false;
    bool reversed = false;
    double factor = 1;  ///< times the whole matrix
    bool flip_x = false, flip_y = false;
    bool doubles = false;
};

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
    for (auto& column : m.entry)
        for (double& entry : column) {
            entry *= lens.factor;
            if (!lens.doubles) entry = static_cast<double>(static_cast<float>(entry));
        }
    return m;
}

/// Viewport, tile size and window origin: whole tiles, odd sizes with partial last tiles on both sides,
/// one-pixel tiles, a tile that does not divide anything, one tile larger than the screen.
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

/// On the first screen and one of the next four, which take turns with the length of the name; or on every screen.
inline std::vector<Camera> on_screens(const std::string& name, const std::function<Lens(double aspect)>& lens_of,
                                      bool every = false) {
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < screens().size(); ++i) {
        const Screen& screen = screens()[i];
        if (!every && i != 0 && i != 1 + name.size() % 4) continue;
        cameras.push_back(camera_of(name + " " + std::to_string(screen.width) + "x" +
                                        std::to_string(screen.height) + "/" + std::to_string(screen.tile) +
                                        (screen.upper_left ? " upper left" : " lower left"),
                                    lens_of(aspect_of(screen)), screen));
    }
    return cameras;
}

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

constexpr double infinite = std::numeric_limits<double>::infinity();

namespace kinds {

/// A kind that is made of a symmetric lens of so many degrees, or of a box of so much height.
inline std::vector<Camera> of_symmetric(const std::string& name, double degrees, void (*change)(Lens& lens),
                                        bool every_screen = false) {
    const auto lens_of = [=](double aspect) {
        Lens lens = symmetric_lens(aspect, degrees);
        change(lens);
        return lens;
    };
    return on_screens(name, lens_of, every_screen);
}
inline std::vector<Camera> of_box(const std::string& name, double half_height, void (*change)(Lens& lens)) {
    return on_screens(name, [=](double aspect) {
        Lens lens = box_lens(aspect, half_height);
        change(lens);
        return lens;
    });
}

inline std::vector<Camera> symmetric() {
    auto cameras = of_symmetric("symmetric", 60, [](Lens&) {}, true);
    // 90 degrees and a power-of-two grid: tile edges with slopes such as 3/4, which a ball can touch exactly.
    const Lens square{-1, 1, -1, 1, 0.125, 512};
    cameras.push_back(
        {"symmetric 90 degrees 256x256/32", projection(square), false, 256, 256, 32, false, false, false});
    return cameras;
}
inline std::vector<Camera> left_handed() {
    return of_symmetric("left-handed [0,1]", 60, [](Lens& lens) { lens.looks_up_z = lens.zero_to_one = true; });
}
inline std::vector<Camera> right_handed_zero_to_one() {
    return of_symmetric("right-handed [0,1]", 75, [](Lens& lens) { lens.zero_to_one = true, lens.near_plane = 1e-5; });
}
inline std::vector<Camera> off_centre() {
    return on_screens(
        "off-centre", [](double aspect) { return Lens{-0.9 * aspect, 0.3 * aspect, -0.2, 0.7, 0.25, 500}; });
}
inline std::vector<Camera> jittered() {
    return of_symmetric("jittered", 60, [](Lens& lens) {
        const double x = 0.37 / 1920 * (lens.right - lens.left), y = -0.21 / 1080 * (lens.top - lens.bottom);
        lens.left += x, lens.right += x, lens.bottom += y, lens.top += y;
    });
}
inline std::vector<Camera> infinite_far() {
    return of_symmetric("infinite far", 60, [](Lens& lens) { lens.far_plane = infinite; });
}
inline std::vector<Camera> reversed() {
    return of_symmetric("reversed [0,1]", 60, [](Lens& lens) { lens.zero_to_one = lens.reversed = true; });
}
inline std::vector<Camera> reversed_minus_one_to_one() {
    return of_symmetric("reversed [-1,1]", 60, [](Lens& lens) { lens.reversed = lens.looks_up_z = true; });
}
inline std::vector<Camera> reversed_infinite() {
    return of_symmetric("reversed infinite", 60, [](Lens& lens) {
        lens.zero_to_one = lens.reversed = true, lens.far_plane = infinite;
    });
}
inline std::vector<Camera> y_flip() {
    return of_symmetric("y flip", 60, [](Lens& lens) { lens.flip_y = lens.zero_to_one = true, lens.top *= 1.25; });
}
inline std::vector<Camera> x_flip() {
    return of_symmetric("x flip", 60, [](Lens& lens) { lens.flip_x = true, lens.left *= 0.75; });
}
inline std::vector<Camera> tiny_fov() {
    return of_symmetric("tiny fov", 0.05, [](Lens&) {});
}
inline std::vector<Camera> wide_fov() {
    return of_symmetric("wide fov", 170, [](Lens&) {});
}
inline std::vector<Camera> scaled_matrix() {
    return of_symmetric("scaled matrix", 60, [](Lens& lens) { lens.factor = 3.7e-3; });
}
inline std::vector<Camera> double_matrix() {
    return of_symmetric("double matrix", 60, [](Lens& lens) { lens.left *= 0.99, lens.doubles = true; });
}
inline std::vector<Camera> screens_off_centre() {
    return on_screens("several screens off-centre", [](double aspect) {
        const double w = 0.1 * aspect, h = 0.1;
        return Lens{-19.7 * w, -18.7 * w, 7.3 * h, 8.3 * h, 0.1, 1000};
    });
}
inline std::vector<Camera> orthographic() {
    return of_box("orthographic", 32, [](Lens&) {});
}
inline std::vector<Camera> orthographic_off_centre() {
    return of_box("orthographic off-centre", 40, [](Lens& lens) {
        lens.left += 100, lens.right += 100, lens.bottom -= 10, lens.top -= 10;
        lens.looks_up_z = lens.zero_to_one = true;
        lens.near_plane = 0;
    });
}
inline std::vector<Camera> orthographic_reversed() {
    return of_box("orthographic reversed", 25, [](Lens& lens) {
        lens.reversed = lens.zero_to_one = true, lens.factor = 5;
    });
}

}  // namespace kinds

/// Calls X(function name) for every kind.
#define ORACLE_CAMERA_KINDS(X)                                                                               \
    X(symmetric)                                                                                             \
    X(left_handed)                                                                                           \
    X(right_handed_zero_to_one)                                                                              \
    X(off_centre) X(jittered) X(infinite_far) X(reversed) X(reversed_minus_one_to_one) X(reversed_infinite)  \
        X(y_flip) X(x_flip) X(tiny_fov) X(wide_fov) X(scaled_matrix) X(double_matrix) X(screens_off_centre)  \
            X(orthographic) X(orthographic_off_centre) X(orthographic_reversed)

}  // namespace oracle
