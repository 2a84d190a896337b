// SPDX-License-Identifier: MIT
// Families of stiff and extreme inputs, each a named generator of whole scenes: camera, lights, Z bounds (or
// the depth buffer they come from). Repeatable from a seed; aimed in double precision, and only aimed: what is
// asked about are the floats that come out.
#pragma once

#include "bounds.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace oracle {

struct Scene {
    Camera camera;
    std::vector<Light> lights;
    std::vector<float> min, max;  ///< one a tile
    /// One a pixel, window depth: where it is not empty, all Z bounds are to be made from it.
    std::vector<float> depth;
    bool skip_background = false;
};

namespace families {

/// Mostly a few dozen tiles, often partial at the end; now and then more than a supertile engine takes.
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

/// The settings of APIs and engines, in any combination.
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

/// Lights of all the stiff sets.
inline Light any_light(const Aim& aim, Random& random) {
    const std::vector<SphereSet>& sets = sphere_sets();
    return sets[static_cast<std::size_t>(random.integer(0, static_cast<int>(sets.size()) - 1))].one(aim,
                                                                                                    random);
}

/// What no rasteriser leaves, but a caller may.
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

/// A scene of one camera and `count` lights of one kind.
template <class MakeLens, class MakeLight>
Scene scene_of(Random& random, std::size_t count, const MakeLens& make_lens, const MakeLight& make_light,
               double specials = 0.01) {
    const Screen screen = any_screen(random);
    Scene scene{camera_of("", make_lens(aspect_of(screen), random), screen), {}, {}, {}, {}, false};
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

inline constexpr auto eye_plane = of_kind<perspective, spheres::eye_plane>;
inline constexpr auto eye_on_surface = of_kind<any_lens, spheres::eye_surface>;
inline constexpr auto poke_from_behind = of_kind<any_lens, spheres::poke_from_behind>;
inline constexpr auto touch_from_front = of_kind<any_lens, spheres::touch_from_front>;
inline constexpr auto near_corners = of_kind<perspective, spheres::near_corner>;
inline constexpr auto centre_at_radius = of_kind<perspective, spheres::axis_tangent>;
inline Scene tile_edges(Random& random, std::size_t count) {
    return scene_of(random, count, any_lens, [](const Aim& aim, Random& r) {
        return r.chance(0.2) ? spheres::tile_edge_exact(aim, r) : spheres::tile_edge(aim, r);
    });
}
inline constexpr auto tile_corners = of_kind<any_lens, spheres::tile_corner>;
inline constexpr auto tiny_and_far = of_kind<any_lens, spheres::tiny_far>;
inline constexpr auto huge = of_kind<any_lens, spheres::huge>;
inline constexpr auto beyond_far = of_kind<any_lens, spheres::beyond_far>;
inline Scene specials(Random& random, std::size_t count) {
    return scene_of(random, count, any_lens, spheres::special, 0.3);
}

/// Tangent, from outside, to a face, an edge or a vertex of a cell between its Z bounds: what depth tests
/// decide on.
inline Scene cell_faces(Random& random, std::size_t count) {
    Scene scene = scene_of(random, 0, any_lens, spheres::field);
    const Aim aim(scene.camera);
    const int nx = (scene.camera.width + scene.camera.tile - 1) / scene.camera.tile;
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
            const double at = place[axis] + (side < 0 ? 0.0 : side > 0 ? 1.0 : random.uniform());
            const double pixel = std::min(at * scene.camera.tile, static_cast<double>(aim.side(axis)));
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

/// Coordinates, radii or whole scenes at the bottom of the number line.
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

/// The same scenes, all lengths times 2^-60 to 2^60.
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

/// Less than a pixel off-centre, as temporal antialiasing has it; spheres on tile edges, of the jittered camera
/// and of the one at rest.
inline Scene jitter(Random& random, std::size_t count) {
    Scene scene = scene_of(
        random, count,
        [](double aspect, Random& r) { return any_settings(symmetric_lens(aspect, r.uniform(20, 110)), r); },
        spheres::tile_edge);
    Matrix& m = scene.camera.m;
    m[2][0] += random.uniform(-1, 1) / scene.camera.width * m[2][3];
    m[2][1] += random.uniform(-1, 1) / scene.camera.height * m[2][3];
    if (!scene.camera.doubles)
        for (const int row : {0, 1})
            m[2][row] = static_cast<double>(static_cast<float>(m[2][row]));
    const Aim aim(scene.camera);
    for (Light& light : scene.lights)
        if (random.chance(0.5)) light = spheres::tile_edge(aim, random);
    set_bounds(scene, aim, random);
    return scene;
}

/// Tile edges in the planes through the axis, up to rounding, and small spheres beside them: what an edge's
/// position lost when the image's offset was taken from it, no relative error makes up for.
inline Scene axis_edges(Random& random, std::size_t count) {
    Scene scene = scene_of(random, 0, any_lens, spheres::field);
    Camera& camera = scene.camera;
    const int sides[] = {camera.width, camera.height};
    double edge[2];
    for (const int axis : {0, 1}) {
        edge[axis] = random.integer(0, sides[axis] / camera.tile) * camera.tile;
        const double ndc = 2 * edge[axis] / sides[axis] - 1, up = axis == 1 && camera.upper_left ? -1 : 1;
        const int column = camera.m[2][3] == 0 ? 3 : 2, row = axis;
        const double entry = up * ndc * camera.m[column][3];
        camera.m[column][row] = camera.doubles ? entry : static_cast<double>(static_cast<float>(entry));
    }
    const Aim aim(camera);
    for (std::size_t i = 0; i < count; ++i) {
        const double d = aim.depth(random), at = std::max(std::abs(d), aim.unit);
        const double r = at * random.power_of_two(-60, -8);
        // Tangent to one edge, or to the corner where both meet.
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

/// A light a few pixels wide, tangent to the edge of a one-pixel tile.
inline Light pixel_light(const Aim& aim, Random& random, double most_pixels) {
    const double d = aim.depth(random), at = std::max(d, aim.unit);
    // The radius whose image is a pixel: far off the axis an image is longer.
    double pixel = infinite, c[2], edge[2];
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

/// One-pixel tiles, 16384 along one side. Few large lights: one may have a million entries.
inline Scene one_pixel_tiles(Random& random, std::size_t count) {
    const bool wide = random.chance(0.5);
    const Screen screen = {wide ? 16384 : 24, wide ? 24 : 16384, 1, random.chance(0.5)};
    const double aspect = random.chance(0.5) ? 1 : aspect_of(screen);
    Scene scene{camera_of("", any_lens(aspect, random), screen), {}, {}, {}, {}, false};
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i)
        scene.lights.push_back(i % 5000 == 0 ? any_light(aim, random) : pixel_light(aim, random, 8));
    set_bounds(scene, aim, random);
    return scene;
}

/// One-pixel tiles, 16384 along both sides: 2^28. The Z bounds are one of a few in each, for what memory
/// there is. For the campaign only.
inline Scene whole_16k(Random& random, std::size_t count) {
    const Screen screen = {16384, 16384, 1, random.chance(0.5)};
    Scene scene{camera_of("", perspective(1, random), screen), {}, {}, {}, {}, false};
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i)
        scene.lights.push_back(pixel_light(aim, random, i % 5000 == 0 ? 256 : 8));
    float low[16], high[16];
    for (int i = 0; i < 16; ++i) {
        const double depth = aim.depth(random);
        low[i] = static_cast<float>(depth), high[i] = static_cast<float>(depth * random.power_of_two(0, 2));
    }
    constexpr std::size_t tiles = std::size_t{1} << 28;
    scene.min.resize(tiles), scene.max.resize(tiles);
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const std::size_t pick = random.bits() % 16;
        scene.min[tile] = low[pick], scene.max[tile] = high[pick];
    }
    return scene;
}

/// Orthographic, tile edges at short binary numbers, spheres that end exactly there.
inline Scene orthographic_edges(Random& random, std::size_t count) {
    const Screen screen = {64 * random.integer(1, 8), 64 * random.integer(1, 8), 64, random.chance(0.5)};
    const double pixel = std::exp2(random.integer(-6, 6));
    Lens lens = any_settings({}, random);
    lens.left = pixel * random.integer(-1024, 1024), lens.right = lens.left + pixel * screen.width;
    lens.bottom = pixel * random.integer(-1024, 1024), lens.top = lens.bottom + pixel * screen.height;
    lens.orthographic = true;
    lens.near_plane = random.integer(-8, 8), lens.far_plane = lens.near_plane + 64;
    lens.factor = 1;
    Scene scene{camera_of("", lens, screen), {}, {}, {}, {}, false};
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i) {
        const double r = pixel * random.integer(1, 4096) / 16;
        double c[2];
        for (const int axis : {0, 1})
            c[axis] = random.chance(0.7) ? aim.at(axis, aim.tile_edge(axis, random), 0) + random.sign() * r
                                         : aim.at(axis, aim.pixel(axis, random), 0);
        const double d = random.chance(0.2) ? aim.near_plane - r : aim.depth(random);
        const Light light = aim.light(c[0], c[1], d, r);
        scene.lights.push_back(random.chance(0.7) ? light : nudged(light, random));
    }
    set_bounds(scene, aim, random);
    return scene;
}

/// Depth buffers of few values: 0, 1, NaN, beyond them, and all that lies between; in a tile up to three.
/// Lights touch what is drawn.
inline Scene depth_buffers(Random& random, std::size_t count) {
    Screen screen = any_screen(random);
    while (screen.width * screen.height > 40000 || screen.tile == 1)
        screen = any_screen(random);
    Scene scene{camera_of("", any_lens(aspect_of(screen), random), screen), {}, {}, {}, {}, false};
    const Aim aim(scene.camera);
    scene.skip_background = random.chance(0.5);
    const auto sample = [&]() -> float {
        switch (random.integer(0, 19)) {
        case 0:
            return std::numeric_limits<float>::quiet_NaN();
        case 1:
        case 2:
            return 0.0f;
        case 3:
        case 4:
            return 1.0f;
        case 5:
            return special_depth(random);
        case 6:
        case 7:
            return static_cast<float>(1 - random.power_of_two(-24, 0));
        case 8:
        case 9:
            return static_cast<float>(random.power_of_two(-30, 0));
        default:
            return static_cast<float>(random.uniform());
        }
    };
    std::vector<float> palette;
    for (int i = 0; i < 10; ++i)
        palette.push_back(sample());
    const int nx = (screen.width + screen.tile - 1) / screen.tile,
              ny = (screen.height + screen.tile - 1) / screen.tile;
    std::vector<int> first(static_cast<std::size_t>(nx * ny)), values(first.size());
    for (std::size_t tile = 0; tile < first.size(); ++tile)
        first[tile] = random.integer(0, 9), values[tile] = random.integer(1, 3);
    for (int y = 0; y < screen.height; ++y)
        for (int x = 0; x < screen.width; ++x) {
            const std::size_t tile = static_cast<std::size_t>(y / screen.tile * nx + x / screen.tile);
            const int pick = first[tile] + random.integer(0, values[tile] - 1);
            scene.depth.push_back(palette[static_cast<std::size_t>(pick % 10)]);
        }
    for (std::size_t i = 0; i < count; ++i) {
        const float window = palette[static_cast<std::size_t>(random.integer(0, 9))];
        const double d = aim.view_depth(std::isnan(window) ? 0.5 : static_cast<double>(window));
        if (random.chance(0.2) || !(std::abs(d) < 1e30)) {
            scene.lights.push_back(any_light(aim, random));
            continue;
        }
        const double r = aim.half_height(std::max(d, aim.unit)) * random.power_of_two(-6, 1);
        const double off = random.sign() * r * (1 + random.sign() * std::exp2(-random.integer(4, 40)));
        scene.lights.push_back(nudged(
            aim.light(aim.at(0, aim.pixel(0, random), d), aim.at(1, aim.pixel(1, random), d), d + off, r),
            random));
    }
    return scene;
}

}  // namespace families

struct Family {
    std::string name;
    Scene (*make)(Random&, std::size_t lights);
    std::size_t lights;  ///< a scene, for a good balance between cameras and lights
};

#define ORACLE_FAMILIES(X)                                                                                   \
    X(eye_plane, 500)                                                                                        \
    X(eye_on_surface, 500)                                                                                   \
    X(poke_from_behind, 500)                                                                                 \
    X(touch_from_front, 500)                                                                                 \
    X(near_corners, 500)                                                                                     \
    X(centre_at_radius, 500)                                                                                 \
    X(tile_edges, 500)                                                                                       \
    X(tile_corners, 500)                                                                                     \
    X(cell_faces, 500)                                                                                       \
    X(tiny_and_far, 500)                                                                                     \
    X(huge, 500)                                                                                             \
    X(beyond_far, 500)                                                                                       \
    X(scales, 500)                                                                                           \
    X(denormals, 500)                                                                                        \
    X(specials, 500)                                                                                         \
    X(near_to_far, 500)                                                                                      \
    X(fields_of_view, 500)                                                                                   \
    X(off_centre, 500)                                                                                       \
    X(jitter, 500)                                                                                           \
    X(axis_edges, 500)                                                                                       \
    X(one_pixel_tiles, 20000)                                                                                \
    X(orthographic_edges, 500)                                                                               \
    X(depth_buffers, 500)

inline const std::vector<Family>& all_families() {
#define ORACLE_FAMILY(name, lights) {#name, families::name, lights},
    static const std::vector<Family> all = {ORACLE_FAMILIES(ORACLE_FAMILY)};
#undef ORACLE_FAMILY
    return all;
}

}  // namespace oracle
