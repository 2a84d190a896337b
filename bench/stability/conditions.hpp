// SPDX-License-Identifier: MIT
// Families of stiff and extreme conditions, each by decade: what is varied, why that is hard, and a generator of
// scenes. Lights are aimed in double precision, and only aimed: what is asked about are the floats that come out.
#pragma once

#include "../../tests/oracle/families.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace stability {

using oracle::Aim, oracle::Camera, oracle::Lens, oracle::Light, oracle::Matrix, oracle::Random;

/// A camera and its lights.
struct Scene {
    Camera camera;
    std::vector<Light> lights;
    std::optional<Matrix> world;  ///< the view matrix, if the lights are in world space
};

/// Lights at certain depths, and the depth slices that they are sorted into.
struct DepthScene {
    int slices;
    float near_depth, last;  ///< where the slices begin and end
    double far_plane;        ///< of the camera
    std::vector<Light> lights;
};

struct Condition {
    std::string label;
    double value;  ///< its position on a plot's axis
};

struct Family {
    std::string name;  ///< a word, for files
    std::string title;
    std::string axis;  ///< what the values of the conditions are
    std::string what;  ///< what is varied
    std::string why;   ///< what makes that hard
    std::vector<Condition> conditions;
    Scene (*make)(Random&, double value, std::size_t lights) = nullptr;
    DepthScene (*make_depths)(Random&, double value, std::size_t lights) = nullptr;
    bool flush = false;  ///< denormal floats are flushed to 0 (FTZ and DAZ)
};

inline std::string short_text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

/// 10^from, 10^(from + step) ... 10^to.
inline std::vector<Condition> decades(int from, int to, int step = 1) {
    std::vector<Condition> all;
    for (int i = from; step > 0 ? i <= to : i >= to; i += step)
        all.push_back({"1e" + std::to_string(i), std::pow(10.0, i)});
    return all;
}
inline std::vector<Condition> values(const std::vector<double>& list) {
    std::vector<Condition> all;
    for (const double value : list)
        all.push_back({short_text(value), value});
    return all;
}

// The cameras: 1920 x 1080 pixels in tiles of 16, 60 degrees high, where nothing else is said.

inline constexpr oracle::Screen full_hd = {1920, 1080, 16, false};

inline Lens lens_of(double degrees = 60) {
    Lens lens = oracle::symmetric_lens(oracle::aspect_of(full_hd), degrees);
    lens.doubles = true;
    return lens;
}
inline Lens lens_from(double near_plane, Random& random) {
    Lens lens = lens_of();
    lens.near_plane = near_plane, lens.far_plane = oracle::infinite;
    // Shifts the image, so that no tile's edge lies in a plane through the view axis, where many of these lights end.
    oracle::families::shift(lens, random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
    return lens;
}
inline Scene scene_of(const Lens& lens, const oracle::Screen& screen = full_hd) {
    return {oracle::camera_of("", lens, screen), {}, {}};
}

// The lights.

/// Returns the position of a random pixel edge in the image, often that of a tile's edge.
inline double place_in_view(const Aim& aim, int axis, Random& random) {
    return random.chance(0.5) ? aim.tile_edge(axis, random) : aim.pixel(axis, random, 0);
}

/// Returns a sphere at depth d whose bounds along one axis end at a place in view.
inline Light ending_in_view(const Aim& aim, Random& random, double d, double r) {
    const int axis = random.integer(0, 1);
    double c[2];
    for (const int i : {0, 1}) {
        const double s = aim.slope(i, i == axis ? place_in_view(aim, i, random) : aim.pixel(i, random, 0));
        c[i] = s * d + (i == axis ? random.sign() * r * std::sqrt(1 + s * s) : 0);
    }
    return aim.light(c[0], c[1], d, r);
}

/// Returns a light 1 to 180 units away that covers a part of the picture.
inline Light ordinary_light(const Aim& aim, Random& random, double unit = 1) {
    const double d = unit * random.power_of_two(0, 7.5);
    return ending_in_view(aim, random, d, std::min(aim.half_height(d), d) * random.power_of_two(-6, -1));
}

inline Scene field_of_view(Random& random, double degrees, std::size_t lights) {
    Scene scene = scene_of(lens_of(degrees));
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(ordinary_light(aim, random));
    return scene;
}
inline Scene ordinary(Random& random, double, std::size_t lights) {
    return field_of_view(random, 60, lights);
}

inline Scene grazing(Random& random, double tangent, std::size_t lights) {
    const float r = static_cast<float>(random.uniform(1, 2));
    const double t = tangent * static_cast<double>(r);
    Scene scene = scene_of(lens_from(t / 100, random));
    const Aim aim(scene.camera);
    // Floats as large as r meet r^2 + t^2 = c^2 + z^2 only within 2^-24 of it. So for small tangents |c| is a few units
    // in the last place off the radius, and z, which is small, is set to make up for it.
    const double ulp = 0x1p-23, most = std::min(1e5, 0x1p45 * tangent * tangent);
    const double R = static_cast<double>(r), side = random.sign();
    for (std::size_t i = 0; i < lights; ++i) {
        const int axis = random.integer(0, 1);
        const double s = side * aim.slope(axis, place_in_view(aim, axis, random)),
                     length = std::sqrt(1 + s * s);
        double c = (t * s - R) / length, z = (t + R * s) / length;
        if (tangent < 1e-3) {
            c = -R + std::floor(random.uniform(0, most + 1)) * ulp;
            z = random.sign() * std::sqrt(t * t + (R + c) * (R - c));
        }
        const double other = R * random.uniform(-0.1, 0.1);
        scene.lights.push_back(axis == 0 ? aim.light(side * c, other, z, R)
                                         : aim.light(other, side * c, z, R));
    }
    return scene;
}

inline Scene eye_plane(Random& random, double gap, std::size_t lights) {
    const double r = random.uniform(1, 2);
    Scene scene = scene_of(lens_from(gap * r / 100, random));
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(ending_in_view(aim, random, r * (1 + gap), r));
    return scene;
}

inline Scene near_front(Random& random, double gap, std::size_t lights) {
    const double r = static_cast<double>(static_cast<float>(random.uniform(1, 2)));
    const double z = static_cast<double>(static_cast<float>(r * (1 + gap + random.power_of_two(-8, 0))));
    Scene scene = scene_of(lens_from(z - r - gap * r, random));
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(ending_in_view(aim, random, z, r));
    return scene;
}

inline Scene near_behind(Random& random, double gap, std::size_t lights) {
    const double r = static_cast<double>(static_cast<float>(random.uniform(1, 2)));
    const double z = static_cast<double>(static_cast<float>(r * (random.power_of_two(-8, 0) + gap - 1)));
    const double n = z + (1 - gap) * r, h = r * std::sqrt(gap * (2 - gap));
    Scene scene = scene_of(lens_from(n, random));
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i) {
        const int axis = random.integer(0, 1);
        double c[2];
        for (const int j : {0, 1})
            c[j] = n * aim.slope(j, j == axis ? place_in_view(aim, j, random) : aim.pixel(j, random, 0)) +
                   (j == axis ? random.sign() * h : h * random.uniform(-0.5, 0.5));
        scene.lights.push_back(aim.light(c[0], c[1], z, r));
    }
    return scene;
}

inline Scene world_scale(Random& random, double scale, std::size_t lights) {
    Lens lens = lens_of();
    lens.near_plane *= scale, lens.far_plane *= scale;
    Scene scene = scene_of(lens);
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(ordinary_light(aim, random, scale));
    return scene;
}

inline Scene far_from_origin(Random& random, double distance, std::size_t lights) {
    Lens lens = lens_of();
    lens.near_plane = 1, lens.far_plane = 1e6;
    Scene scene = scene_of(lens);
    const Aim aim(scene.camera);
    // A random rotation, from a quaternion, and a random eye position.
    double q[4], eye[3], length = 0, far_off = 0;
    for (double& part : q)
        part = random.normal(), length += part * part;
    for (double& part : q)
        part /= std::sqrt(length);
    for (double& part : eye)
        part = random.normal(), far_off += part * part;
    for (double& part : eye)
        part *= distance / std::sqrt(far_off);
    const double rotation[3][3] = {{1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
                                    2 * (q[1] * q[3] + q[0] * q[2])},
                                   {2 * (q[1] * q[2] + q[0] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]),
                                    2 * (q[2] * q[3] - q[0] * q[1])},
                                   {2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
                                    1 - 2 * (q[1] * q[1] + q[2] * q[2])}};
    Matrix view{};
    view[3][3] = 1;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            view[column][row] = rotation[row][column];
            view[3][row] -= rotation[row][column] * eye[column];
        }
    scene.world = view;
    for (std::size_t i = 0; i < lights; ++i) {
        const Light at = ordinary_light(aim, random, 100);
        const double in_view[3] = {static_cast<double>(at.x), static_cast<double>(at.y),
                                   static_cast<double>(at.z)};
        float world[3];
        for (int row = 0; row < 3; ++row) {
            double sum = eye[row];
            for (int column = 0; column < 3; ++column)
                sum += rotation[column][row] * in_view[column];
            world[row] = static_cast<float>(sum);
        }
        scene.lights.push_back({world[0], world[1], world[2], at.w});
    }
    return scene;
}

/// Returns a light a few pixels wide whose image ends at the edge of a one-pixel tile.
inline Light pixel_light(const Aim& aim, Random& random, double most_pixels) {
    const double d = aim.depth(random), at = std::max(d, aim.unit);
    // The radius of a sphere at that place whose image is one pixel wide.
    double pixel = oracle::infinite, c[2], edge[2];
    for (int axis = 0; axis < 2; ++axis) {
        edge[axis] = aim.tile_edge(axis, random);
        c[axis] = aim.at(axis, edge[axis], at);
        pixel = std::min(pixel, (aim.at(axis, edge[axis] + 1, at) - c[axis]) /
                                    std::hypot(1, aim.slope(axis, edge[axis])));
    }
    const int axis = random.integer(0, 1);
    const double r = std::min(pixel * random.power_of_two(-8, std::log2(most_pixels)), at / 4);
    c[axis] += random.sign() * r * std::hypot(1, aim.slope(axis, edge[axis]));
    return nudged(aim.light(c[0], c[1], at, r), random);
}

inline Scene tile_count(Random& random, double tiles, std::size_t lights) {
    const int side = static_cast<int>(tiles), other = std::min(side, 16);
    const bool wide = random.chance(0.5);
    Lens lens = oracle::symmetric_lens(1, 60);
    lens.doubles = true;
    Scene scene = scene_of(lens, {wide ? side : other, wide ? other : side, 1, false});
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(pixel_light(aim, random, 8));
    return scene;
}

inline Scene denormal(Random& random, double radius, std::size_t lights) {
    Lens lens = lens_of();
    lens.near_plane = 2e-38, lens.far_plane = oracle::infinite;
    Scene scene = scene_of(lens);
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < lights; ++i)
        scene.lights.push_back(ending_in_view(aim, random, lens.near_plane * random.power_of_two(2, 10),
                                              radius * random.uniform(1, 5)));
    return scene;
}

// Depths.

/// Lights that begin and end at a boundary, or a few units in the last place beside one.
inline DepthScene depths_at_boundaries(Random& random, DepthScene scene, std::size_t lights) {
    const double near_depth = static_cast<double>(scene.near_depth),
                 ratio = static_cast<double>(scene.last) / near_depth;
    const auto boundary = [&](int i) {
        return near_depth * std::pow(ratio, static_cast<double>(i) / scene.slices);
    };
    for (std::size_t i = 0; i < lights; ++i) {
        const int first = random.integer(1, scene.slices - 2),
                  last = std::min(scene.slices - 1, first + random.integer(0, 4));
        const double low = boundary(first), high = last == first ? low * (1 + 0x1p-20) : boundary(last);
        scene.lights.push_back(oracle::nudged(
            {0, 0, -static_cast<float>((low + high) / 2), static_cast<float>((high - low) / 2)}, random));
    }
    return scene;
}
inline DepthScene far_over_near(Random& random, double ratio, std::size_t lights) {
    const float last = static_cast<float>(0.1 * (std::isinf(ratio) ? 1e6 : ratio));
    return depths_at_boundaries(random, {1024, 0.1f, last, 0.1 * ratio, {}}, lights);
}
inline DepthScene slices_apart(Random& random, double ulps, std::size_t lights) {
    const float begin = 64 + static_cast<float>(random.uniform(0, 8));
    const float last = begin + static_cast<float>(64 * ulps * 0x1p-17);
    return depths_at_boundaries(random, {64, begin, last, 1e6, {}}, lights);
}

inline std::vector<Family> all_families() {
    std::vector<Condition> infinite_too = decades(1, 12);
    infinite_too.push_back({"inf", oracle::infinite});
    const std::vector<Condition> small = decades(-38, -45, -1);
    return {
        {"ordinary",
         "an ordinary scene",
         "",
         "Nothing: lights of a part of the picture, 1 to 180 units away.",
         "It is not. All formulas serve, and what the others cost can be held against it.",
         {{"-", 1}},
         ordinary},
        {"grazing", "eye grazing a sphere", "tangent's length / radius",
         "The eye is just outside of a large sphere beside it: the tangent is short beside the radius.",
         "The tangent's square is a difference of squares as large as the radius's: near the surface all "
         "its digits are rounding, or it is less than 0 and its root NaN.",
         decades(0, -12, -1), grazing},
        {"eye_plane", "reaching the eye's plane", "(z - r) / r",
         "A sphere in front of the eye reaches back almost to the plane through it, across the view axis. "
         "(Floats end at 1e-7.)",
         "Where one tangent is almost in that plane the other's slope is a small difference of large "
         "numbers over a smaller one.",
         decades(0, -7, -1), eye_plane},
        {"near_front", "ending at the near plane", "(z - r - near) / r",
         "A sphere in front of the near plane all but touches it.",
         "Whether it is cut decides which formula is right; most textbooks know none for a sphere that is.",
         decades(0, -12, -1), near_front},
        {"near_behind", "poking through the near plane", "(z + r - near) / r",
         "A sphere behind the near plane pokes through it by a cap as small as that.",
         "The cap's size is the root of a difference of squares that are as large as the sphere's.",
         decades(0, -12, -1), near_behind},
        {"far_over_near", "far over near", "far / near",
         "1,024 slices from near to far, each as many times as deep as the one before; lights begin and "
         "end at their boundaries. Errors are in slices.",
         "A logarithm's rounding moves a depth across a boundary. Where far is infinite the textbooks' "
         "formulas have no slices, ours end at a depth of the caller's.",
         infinite_too, nullptr, far_over_near},
        {"slices", "slices ulps apart", "ulps a slice",
         "64 slices so many units in the last place of a depth deep; lights begin and end at their "
         "boundaries. Errors are in slices.",
         "The slice's number is a small difference of logarithms times a large factor.", decades(5, 0, -1),
         nullptr, slices_apart},
        {"scale", "scale of the world", "scale", "The ordinary scene, all lengths times the same factor.",
         "Squares and fourth powers leave the floats' range: below 1e-19 a square is 0, above 1e19 infinite.",
         decades(-30, 30, 5), world_scale},
        {"origin", "eye far from the origin", "eye to origin",
         "Lights in world space, 100 to 18,000 units from an eye that is so far from the origin.",
         "A view matrix of floats rounds its translation, and the products that are added to it, to the "
         "size of that distance.",
         decades(0, 9), far_from_origin},
        {"fov", "field of view", "degrees", "The ordinary scene through lenses from 1e-3 to 179.99 degrees.",
         "In a narrow one a pixel is a millionth of a slope; in a wide one, slopes in view are thousands.",
         values({1e-3, 1e-2, 0.1, 1, 10, 90, 170, 179, 179.9, 179.99}), field_of_view},
        {"tiles", "tiles of one pixel", "tiles along a side",
         "Lights of a few pixels in pictures of one-pixel tiles.",
         "A float has 24 bits, a pixel's number takes 15 of them.", values({1, 8, 64, 512, 4096, 32768}),
         tile_count},
        {"denormals", "denormal radii", "radius",
         "A scene at the bottom of the number line: near plane at 2e-38, radii from 1e-38 to 1e-45.",
         "A denormal float has fewer digits the smaller it is, and the square of every number here is 0.",
         small, denormal},
        {"flushed", "denormal radii, FTZ and DAZ", "radius",
         "The same lights, the processor set to take denormal numbers for 0, as many programs do. So does "
         "the exact answer.",
         "Every sum and product may lose as much as the smallest normal number.", small, denormal, nullptr,
         true},
    };
}

}  // namespace stability
