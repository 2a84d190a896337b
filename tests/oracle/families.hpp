// SPDX-License-Identifier: MIT
// Families of hard and extreme inputs. Each generates whole scenes (camera, lights, depth bounds of tiles) from a seed.
// Positions are computed in double; tests then use the rounded floats.
#pragma once

#include "bounds.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace oracle {

struct Scene {
    Camera camera;
    std::vector<Light> lights;
    std::vector<float> min, max;  ///< one for each tile, or none
};

namespace families {

/// Returns a screen, mostly of a few dozen tiles, often partial at the end; sometimes of very many tiles.
inline Screen any_screen(Random& random) {
    static constexpr int sizes[] = {1, 2, 7, 8, 16, 32, 57, 64, 256};
    const int tile = sizes[random.integer(0, 8)];
    const auto side = [&](int most) { return random.integer(1, most) * tile - random.integer(0, tile - 1); };
    if (random.chance(0.03)) {
        if (random.chance(0.3)) return {side(3), std::min(32768, 260 * tile), tile, random.chance(0.5)};
        return {side(60), side(40), tile, random.chance(0.5)};
    }
    return {side(13), side(9), tile, random.chance(0.5)};
}

/// Returns the lens with a random combination of the settings that graphics APIs and engines have.
inline Lens any_settings(Lens lens, Random& random) {
    lens.near_plane = random.power_of_two(-10, 3);
    lens.far_plane = random.chance(0.2) ? infinite : lens.near_plane * random.power_of_two(2, 16);
    lens.looks_up_z = random.chance(0.5);
    lens.zero_to_one = random.chance(0.5);
    lens.reversed = random.chance(0.3);
    lens.flip_x = random.chance(0.1);
    lens.flip_y = random.chance(0.3);
    lens.doubles = random.chance(0.1);
    if (random.chance(0.1)) lens.factor = random.power_of_two(-8, 8);
    return lens;
}

/// Moved by screens, both axes.
inline void shift(Lens& lens, double x, double y) {
    const double w = lens.right - lens.left, h = lens.top - lens.bottom;
    lens.left += x * w, lens.right += x * w, lens.bottom += y * h, lens.top += y * h;
}

inline Lens perspective(double aspect, Random& random) {
    Lens lens = any_settings(symmetric_lens(aspect, random.uniform(20, 110)), random);
    if (random.chance(0.3)) shift(lens, random.uniform(-1, 1), random.uniform(-1, 1));
    return lens;
}

inline Lens orthographic(double aspect, Random& random) {
    const Lens box = box_lens(aspect, random.power_of_two(-4, 8));
    Lens lens = any_settings(box, random);
    lens.orthographic = true;
    const double deep = random.power_of_two(0, 10);
    lens.near_plane = random.chance(0.3) ? 0 : deep * random.uniform(-1, 1);
    lens.far_plane = lens.near_plane + deep;
    if (random.chance(0.3)) shift(lens, random.uniform(-3, 3), random.uniform(-3, 3));
    return lens;
}

inline Lens any_lens(double aspect, Random& random) {
    return random.chance(0.15) ? orthographic(aspect, random) : perspective(aspect, random);
}

/// Returns a light of a random one of the sets in spheres.hpp.
inline Light any_light(const Aim& aim, Random& random) {
    const std::vector<SphereSet>& sets = sphere_sets();
    return sets[static_cast<std::size_t>(random.integer(0, static_cast<int>(sets.size()) - 1))].one(aim,
                                                                                                    random);
}

/// Returns a depth that no rasteriser leaves, but that a user may pass.
inline float special_depth(Random& random) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    static constexpr float values[] = {
        inf,          -inf,     0.0f,    -0.0f, std::numeric_limits<float>::quiet_NaN(), FLT_MAX, -FLT_MAX,
        FLT_TRUE_MIN, -FLT_MIN, FLT_MIN, 1.0f};
    return values[random.integer(0, 10)];
}

inline void set_bounds(Scene& scene, const Aim& aim, Random& random, double specials = 0.01) {
    Bounds bounds =
        make_bounds(scene.camera, aim, scene.lights, static_cast<BoundsShape>(random.integer(0, 2)), random);
    scene.min = bounds.min, scene.max = bounds.max;
    for (auto* side : {&scene.min, &scene.max})
        for (float& depth : *side)
            if (random.chance(specials)) depth = special_depth(random);
}

/// Makes a scene with one camera and `count` lights of one kind.
template <class MakeLens, class MakeLight>
Scene scene_of(Random& random, std::size_t count, const MakeLens& make_lens, const MakeLight& make_light,
               double specials = 0.01) {
    const Screen screen = any_screen(random);
    Scene scene{camera_of("", make_lens(aspect_of(screen), random), screen), {}, {}, {}};
    Camera& camera = scene.camera;
    if (random.chance(0.25)) camera.columns = random.integer(1, 20), camera.rows = random.integer(1, 13);
    camera.turned = random.chance(0.25);
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i)
        scene.lights.push_back(make_light(aim, random));
    set_bounds(scene, aim, random, specials);
    return scene;
}

template <auto make_lens, auto make_light> Scene of_kind(Random& random, std::size_t count) {
    return scene_of(random, count, make_lens, make_light);
}

// The spheres are stiff.

inline Scene tile_edges(Random& random, std::size_t count) {
    return scene_of(random, count, any_lens, [](const Aim& aim, Random& r) {
        return r.chance(0.2) ? spheres::tile_edge_exact(aim, r) : spheres::tile_edge(aim, r);
    });
}
inline Scene specials(Random& random, std::size_t count) {
    return scene_of(random, count, any_lens, spheres::special, 0.3);
}

/// Spheres that touch a face, an edge or a corner of a tile's cell from outside, between the tile's least and greatest
/// depth: hard for the depth test.
inline Scene cell_faces(Random& random, std::size_t count) {
    Scene scene = scene_of(random, 0, any_lens, spheres::field);
    const Aim aim(scene.camera);
    const int nx = scene.camera.tiles(0);
    while (scene.lights.size() < count) {
        const std::size_t tile = static_cast<std::size_t>(random.bits() % scene.min.size());
        const int place[2] = {static_cast<int>(tile) % nx, static_cast<int>(tile) / nx};
        float low = scene.min[tile], high = scene.max[tile];
        if (!std::isfinite(low)) low = static_cast<float>(aim.near_plane);
        if (!std::isfinite(high)) high = static_cast<float>(aim.depth(random));
        const int end = random.integer(-1, 1);
        const double d = end < 0   ? static_cast<double>(low)
                         : end > 0 ? static_cast<double>(high)
                                   : random.uniform(static_cast<double>(low), static_cast<double>(high));
        double p[3] = {0, 0, d}, n[3] = {0, 0, end * random.uniform()};
        for (int axis = 0; axis < 2; ++axis) {
            const int side = random.integer(-1, 1);
            const double from = scene.camera.first_pixel(axis, place[axis]),
                         beyond = scene.camera.first_pixel(axis, place[axis] + 1);
            const double pixel = from + (beyond - from) * (side < 0 ? 0.0 : side > 0 ? 1.0 : random.uniform());
            p[axis] = aim.at(axis, pixel, d);
            const double weight = side * random.uniform();
            n[axis] += weight;
            n[2] -= weight * aim.slope(axis, pixel);
        }
        const double length = std::hypot(n[0], n[1], n[2]);
        if (!(length > 0)) continue;
        const double r = std::max(std::abs(d), aim.unit) * random.power_of_two(-14, 2),
                     away = r * (1 + random.sign() * std::exp2(-random.integer(8, 40))) / length;
        scene.lights.push_back(
            nudged(aim.light(p[0] + away * n[0], p[1] + away * n[1], p[2] + away * n[2], r), random));
    }
    return scene;
}

/// Scenes with denormal numbers: as coordinates, as radii or for everything.
inline Scene denormals(Random& random, std::size_t count) {
    const bool whole = random.chance(0.5);
    const auto lens = [&](double aspect, Random& r) {
        Lens all = perspective(aspect, r);
        if (whole) {
            all.near_plane = static_cast<double>(FLT_MIN) * r.power_of_two(1, 12);
            all.far_plane = r.chance(0.3) ? infinite : all.near_plane * r.power_of_two(2, 16);
            all.factor = 1;  // m[3][2] is a float
            all.doubles = true;
        }
        return all;
    };
    return scene_of(random, count, lens, [&](const Aim& aim, Random& r) {
        Light light = any_light(aim, r);
        if (!whole)
            for (float* v : {&light.x, &light.y, &light.z, &light.w})
                if (r.chance(0.4))
                    *v = std::ldexp(*v < 0 ? -1.0f : 1.0f, -149) * static_cast<float>(r.integer(0, 1 << 23));
        return light;
    });
}

/// Ordinary scenes with all lengths multiplied by 2^-60 to 2^60.
inline Scene scales(Random& random, std::size_t count) {
    const auto lens = [](double aspect, Random& r) {
        const double k = std::exp2(r.integer(-60, 60));
        Lens all = any_lens(aspect, r);
        all.near_plane *= k, all.far_plane *= k;
        all.factor = 1;
        all.doubles = false;
        if (all.orthographic)
            for (double* side : {&all.left, &all.right, &all.bottom, &all.top})
                *side *= k;
        return all;
    };
    return scene_of(random, count, lens, any_light);
}

// The camera is extreme.

inline Scene near_to_far(Random& random, std::size_t count) {
    const auto lens = [](double aspect, Random& r) {
        Lens all = perspective(aspect, r);
        all.far_plane = all.near_plane * std::pow(10.0, r.uniform(5, 12));
        if (r.chance(0.5)) all.reversed = all.zero_to_one = true;  // with any other, float depth ends earlier
        all.doubles |= r.chance(0.3);
        return all;
    };
    return scene_of(random, count, lens, [](Aim aim, Random& r) {
        aim.deepest = 1e12;
        return any_light(aim, r);
    });
}

/// From 0.01 to 179.99 degrees.
inline Scene fields_of_view(Random& random, std::size_t count) {
    const auto lens = [](double aspect, Random& r) {
        const double small = std::pow(10.0, r.uniform(-2, 1));
        return any_settings(symmetric_lens(aspect, r.chance(0.5) ? small : 180 - small), r);
    };
    return scene_of(random, count, lens, any_light);
}

/// Up to 20 screens off-centre.
inline Scene off_centre(Random& random, std::size_t count) {
    const auto lens = [](double aspect, Random& r) {
        Lens all = perspective(aspect, r);
        shift(all, r.uniform(-20, 20), r.uniform(-20, 20));
        return all;
    };
    return scene_of(random, count, lens, any_light);
}

/// The view axis lies almost at a tile's edge, with small spheres beside it. The edge's position lost digits when the
/// image's offset was subtracted, which no relative error covers.
inline Scene axis_edges(Random& random, std::size_t count) {
    Scene scene = scene_of(random, 0, any_lens, spheres::field);
    Camera& camera = scene.camera;
    const int sides[] = {camera.width, camera.height};
    double edge[2];
    for (const int axis : {0, 1}) {
        edge[axis] = camera.first_pixel(axis, random.integer(0, camera.tiles(axis)));
        const double ndc = 2 * edge[axis] / sides[axis] - 1, up = axis == 1 && camera.upper_left ? -1 : 1;
        const int column = camera.m[2][3] == 0 ? 3 : 2, row = axis;
        const double entry = up * ndc * camera.m[column][3];
        camera.m[column][row] = camera.doubles ? entry : static_cast<double>(static_cast<float>(entry));
    }
    const Aim aim(camera);
    for (std::size_t i = 0; i < count; ++i) {
        const double d = aim.depth(random), at = std::max(std::abs(d), aim.unit);
        const double r = at * random.power_of_two(-60, -8);
        // Lights that touch one edge, or the corner where both meet.
        const double angle = random.uniform(0, std::acos(0.0)), parts[] = {std::cos(angle), std::sin(angle)};
        const int only = random.integer(-1, 1);
        const double away = r * (1 + random.sign() * std::exp2(-random.integer(1, 40)));
        double c[2];
        for (const int axis : {0, 1})
            c[axis] = only >= 0 && only != axis
                          ? aim.at(axis, aim.pixel(axis, random), d)
                          : aim.at(axis, edge[axis], d) + random.sign() * away * (only < 0 ? parts[axis] : 1);
        scene.lights.push_back(nudged(aim.light(c[0], c[1], d, r), random));
    }
    set_bounds(scene, aim, random);
    return scene;
}

/// The greatest number of tiles. Lists of all tiles would not fit into memory, so there are no depth bounds.
inline Scene most_tiles(Random& random, std::size_t count) {
    Scene scene{camera_of("", any_lens(1, random), {32768, 32768, 1, random.chance(0.5)}), {}, {}, {}};
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i)
        scene.lights.push_back(any_light(aim, random));
    return scene;
}

}  // namespace families

struct Family {
    std::string name;
    Scene (*make)(Random&, std::size_t lights);
};

inline const std::vector<Family>& all_families() {
    using namespace families;
    static const std::vector<Family> all = {
        {"eye_plane", of_kind<perspective, spheres::eye_plane>},
        {"eye_on_surface", of_kind<any_lens, spheres::eye_surface>},
        {"poke_from_behind", of_kind<any_lens, spheres::touching_near<true>>},
        {"touch_from_front", of_kind<any_lens, spheres::touching_near<false>>},
        {"near_corners", of_kind<perspective, spheres::near_corner>},
        {"centre_at_radius", of_kind<perspective, spheres::axis_tangent>},
        {"tile_edges", families::tile_edges},
        {"tile_corners", of_kind<any_lens, spheres::tile_corner>},
        {"cell_faces", families::cell_faces},
        {"tiny_and_far", of_kind<any_lens, spheres::tiny_far>},
        {"huge", of_kind<any_lens, spheres::huge>},
        {"beyond_far", of_kind<any_lens, spheres::beyond_far>},
        {"scales", families::scales},
        {"denormals", families::denormals},
        {"specials", families::specials},
        {"near_to_far", families::near_to_far},
        {"fields_of_view", families::fields_of_view},
        {"off_centre", families::off_centre},
        {"axis_edges", families::axis_edges},
        {"most_tiles", families::most_tiles},
    };
    return all;
}

}  // namespace oracle
