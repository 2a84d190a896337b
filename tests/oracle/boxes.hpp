// SPDX-License-Identifier: MIT
// Random sets of boxes, as spheres.hpp has sets of spheres. Positions are computed in double in the camera's axes;
// tests then use the rounded float box.
#pragma once

#include "spots.hpp"

#include "../../bench/exact/box.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace oracle {

inline bool is_bad(const BoxLight& b) {
    bool finite = std::isfinite(b.x) && std::isfinite(b.y) && std::isfinite(b.z), sized = false;
    for (int i = 0; i < 3; ++i) {
        finite = finite && std::isfinite(b.centre[i]);
        for (const float v : b.half_axes[i])
            finite = finite && std::isfinite(v), sized = sized || v != 0;
    }
    return !finite || !sized || !(b.radius >= 0) || !(b.taper >= 0) || !(b.taper <= 1);
}
inline bool is_off(const BoxLight& b) {
    return b.radius == -1;
}

inline std::string text(const BoxLight& b) {
    char buffer[500];
    const auto d = [](float v) { return static_cast<double>(v); };
    std::snprintf(buffer, sizeof buffer, "{%a, %a, %a, %a; %a, %a, %a; %a, %a, %a; %a, %a, %a; %a, %a, %a; %a}",
                  d(b.x), d(b.y), d(b.z), d(b.radius), d(b.centre[0]), d(b.centre[1]), d(b.centre[2]),
                  d(b.half_axes[0][0]), d(b.half_axes[0][1]), d(b.half_axes[0][2]), d(b.half_axes[1][0]),
                  d(b.half_axes[1][1]), d(b.half_axes[1][2]), d(b.half_axes[2][0]), d(b.half_axes[2][1]),
                  d(b.half_axes[2][2]), d(b.taper));
    return buffer;
}

/// Returns world-space boxes that a view matrix moves about where they are wanted in view space.
inline std::vector<BoxLight> into_world(std::vector<BoxLight> lights, const ViewMatrix& view) {
    for (BoxLight& b : lights) {
        std::vector<Light> points = {{b.x, b.y, b.z, b.radius}, {b.centre[0], b.centre[1], b.centre[2], 0}};
        for (const float(&h)[3] : b.half_axes)
            points.push_back({b.centre[0] + h[0], b.centre[1] + h[1], b.centre[2] + h[2], 0});
        points = into_world(points, view);
        const Light &ball = points[0], &c = points[1];
        b.x = ball.x, b.y = ball.y, b.z = ball.z, b.radius = ball.w;
        b.centre[0] = c.x, b.centre[1] = c.y, b.centre[2] = c.z;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool none = b.half_axes[i][0] == 0 && b.half_axes[i][1] == 0 && b.half_axes[i][2] == 0;
            if (none) continue;
            const Light& end = points[2 + i];
            b.half_axes[i][0] = end.x - c.x, b.half_axes[i][1] = end.y - c.y, b.half_axes[i][2] = end.z - c.z;
        }
    }
    return lights;
}

namespace boxes {

using namespace spots;

/// Half axes in the camera's axes.
using Frame = std::array<Triple, 3>;

/// Returns three directions at right angles, of length 1, often along the camera's axes or towards the eye.
inline Frame frame(const Triple& at, Random& random) {
    const Triple first = axis(at, random), second = across(first, random);
    Frame f = {first, second, glm::cross(first, second)};
    for (std::size_t i = 0; i < 3; ++i)
        std::swap(f[i], f[static_cast<std::size_t>(random.integer(0, 2))]);
    return f;
}
inline Frame sized(const Frame& f, double a, double b, double c) {
    return {plus({}, f[0], a), plus({}, f[1], b), plus({}, f[2], c)};
}
/// Returns half axes of about this size: cubes, slabs, rods; sometimes flat, of no width, thin, or at odd angles.
inline Frame half_axes(const Triple& at, double size, Random& random) {
    const auto some = [&](double least = -4, double most = 0) { return size * random.power_of_two(least, most); };
    if (random.chance(0.2)) {
        Frame f;
        for (Triple& h : f)
            h = plus({}, any_direction(random), some());
        if (random.chance(0.3)) f[2] = plus(f[0], f[2], random.power_of_two(-30, -4));
        return f;
    }
    const double sizes[][2] = {{some(), 0},  // flat, a line, thin, a rod
                               {0, 0},
                               {some(), some(-40, -8)},
                               {some(-30, -8), some(-30, -8)},
                               {some(), some()}};
    const auto& [b, c] = sizes[std::min(random.integer(0, 7), 4)];
    return sized(frame(at, random), size, b, c);
}
inline double some_taper(Random& random) {
    const double tapers[] = {0, random.uniform(), random.power_of_two(-30, 0), 1};
    return tapers[std::min(random.integer(0, 5), 3)];
}

/// Given to the library as floats.
inline BoxLight box(const Aim& aim, const Light& ball, const Triple& centre, const Frame& f, double taper) {
    const Light c = aim.light(centre[0], centre[1], centre[2], 0);
    BoxLight b = {ball.x, ball.y, ball.z, ball.w, {c.x, c.y, c.z}, {}, static_cast<float>(taper)};
    for (std::size_t i = 0; i < 3; ++i) {
        const Light h = aim.light(f[i][0], f[i][1], f[i][2], 0);
        b.half_axes[i][0] = h.x, b.half_axes[i][1] = h.y, b.half_axes[i][2] = h.z;
    }
    return b;
}
/// Returns a box whose sphere holds all corners, or is so large that it does not cut the box.
inline BoxLight whole(const Aim& aim, Random& random, const Triple& centre, const Frame& f, double taper) {
    double most = 0;
    for (int i = 0; i < 4; ++i) {
        const Triple d = plus(plus(f[2], f[0], (i & 1) != 0 ? 1 : -1), f[1], (i & 2) != 0 ? 1 : -1);
        most = std::max(most, length(d));
    }
    Light ball = aim.light(centre[0], centre[1], centre[2], most * (1 + 0x1p-20));
    if (random.chance(0.2)) ball.w = std::numeric_limits<float>::infinity();
    return box(aim, ball, centre, f, taper);
}
/// With a sphere that cuts it.
inline BoxLight cut(const Aim& aim, Random& random, const Light& ball, double taper) {
    const Triple c = spots::centre(aim, ball);
    const double r = static_cast<double>(ball.w);
    const Frame f = half_axes(c, r * random.power_of_two(-2, 2), random);
    Triple at = c;
    for (const Triple& h : f)
        at = plus(at, h, random.chance(0.3) ? random.sign() : random.uniform(-1.2, 1.2));
    return box(aim, ball, at, f, taper);
}
/// Returns a box in, or cut by, a sphere that `sphere` makes.
template <auto sphere> BoxLight in_ball(const Aim& aim, Random& random) {
    const Light ball = sphere(aim, random);
    if (random.chance(0.5)) return cut(aim, random, ball, some_taper(random));
    const Triple c = spots::centre(aim, ball);
    return whole(aim, random, c, half_axes(c, static_cast<double>(ball.w), random), some_taper(random));
}

/// Returns a box with the eye inside, on a face or just beside it, or in the plane of a face.
inline BoxLight around_eye(const Aim& aim, Random& random) {
    const double size = aim.unit * random.power_of_two(-4, 14);
    const Frame f = half_axes({0, 0, 1}, size, random);
    Triple at = plus({}, any_direction(random), random.chance(0.3) ? 0 : aim.unit * random.power_of_two(-40, 0));
    for (const Triple& h : f) {
        double part = random.uniform(-1.1, 1.1);
        if (random.chance(0.4)) part = random.sign() * (1 + random.sign() * random.power_of_two(-45, -3));
        if (random.chance(0.2)) part = random.uniform(-4, 4);
        at = plus(at, h, part);
    }
    if (random.chance(0.6)) return whole(aim, random, at, f, some_taper(random));
    const Triple c = plus(at, any_direction(random), size * random.uniform());
    return box(aim, aim.light(c[0], c[1], c[2], size * random.power_of_two(-3, 1)), at, f, some_taper(random));
}

/// Returns a box with a corner, an edge or a face in the near plane or just beside it.
inline BoxLight at_near(const Aim& aim, Random& random) {
    const double n = aim.near_plane, size = aim.unit * random.power_of_two(-6, 12);
    Frame f = half_axes({0, 0, 1}, size, random);
    if (random.chance(0.3)) f[0][2] = 0;
    if (random.chance(0.2)) f[0][2] = f[1][2] = 0;
    Triple at = {aim.at(0, aim.pixel(0, random), n), aim.at(1, aim.pixel(1, random), n), n};
    for (const Triple& h : f)
        at = plus(at, h, random.sign());
    at[2] += size * random.sign() * std::exp2(-random.integer(4, 45));
    if (random.chance(0.7)) return whole(aim, random, at, f, 1);
    return box(aim, aim.light(at[0], at[1], at[2], size * random.power_of_two(-3, 1)), at, f, 1);
}

/// Returns a box a corner of which just touches a tile's cell, or misses it by 2^-k of the box's size.
inline BoxLight touching(const Aim& aim, Random& random) {
    auto [at, n, size] = on_cell(aim, random);
    const Frame f = half_axes(at, size, random);
    for (const Triple& axis : f)
        at = plus(at, axis, glm::dot(axis, n) > 0 ? -1 : 1);
    at = plus(at, n, size * random.sign() * std::exp2(-random.integer(4, 40)));
    if (random.chance(0.7)) return whole(aim, random, at, f, 1);
    const Triple c = plus(at, any_direction(random), size * random.uniform(0, 1.5));
    return box(aim, aim.light(c[0], c[1], c[2], size * random.power_of_two(-1, 1)), at, f, some_taper(random));
}

/// Returns a box with a face in, or just beside, the plane through the eye and a tile's edge.
inline BoxLight along_edge(const Aim& aim, Random& random) {
    const double d = aim.depth(random), h = aim.half_height(std::max(d, aim.unit));
    const int i = random.integer(0, 1);
    const double edge = aim.tile_edge(i, random);
    Triple at{0, 0, d}, n{};
    at[i] = aim.at(i, edge, d);
    at[1 - i] = aim.at(1 - i, aim.pixel(1 - i, random), d);
    n[i] = 1, n[2] = -aim.slope(i, edge);
    n = glm::normalize(n);
    const double size = h * random.power_of_two(-8, 1),
                 tilt = random.chance(0.4) ? 0 : random.sign() * random.power_of_two(-45, -8);
    n = glm::normalize(plus(n, any_direction(random), tilt));
    const Triple side = across(n, random);
    const Frame f = sized({n, side, glm::cross(n, side)}, random.chance(0.2) ? 0 : size * random.power_of_two(-6, 0), size,
                          size * random.power_of_two(-4, 0));
    at = plus(at, f[0], random.sign());
    return random.chance(0.7) ? whole(aim, random, at, f, 1)
                              : box(aim, aim.light(at[0], at[1], at[2], size), at, f, some_taper(random));
}

/// Out of all proportion to what is seen.
inline BoxLight huge(const Aim& aim, Random& random) {
    const double size = aim.unit * random.power_of_two(12, 60);
    const Frame f = half_axes({0, 0, 1}, size, random);
    Triple at = plus({}, any_direction(random), aim.unit * random.power_of_two(-4, 12));
    for (const Triple& h : f)
        at = plus(at, h, random.chance(0.4) ? random.sign() : random.uniform(-1.2, 1.2));
    if (random.chance(0.5)) return whole(aim, random, at, f, some_taper(random));
    return box(aim, spheres::field(aim, random), at, f, some_taper(random));
}

/// Returns a box that is the frustum of a projector; some are pyramids.
inline BoxLight projector(const Aim& aim, Random& random) {
    const Light ball = spheres::field(aim, random);
    const Triple eye = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w), taper = some_taper(random);
    Frame f = frame(eye, random);
    f = sized(f, size * random.power_of_two(-3, 0), size * random.power_of_two(-3, 0), size * (1 - taper) / 2);
    if (taper == 1) f = half_axes(eye, size, random);
    const Triple at = plus(eye, f[2], taper < 1 ? (1 + taper) / (1 - taper) : 0);
    return random.chance(0.5) ? whole(aim, random, at, f, taper) : box(aim, ball, at, f, taper);
}

/// Any bits, and bad input.
inline BoxLight special(const Aim& aim, Random& random) {
    BoxLight b = random.chance(0.5) ? boxes::in_ball<spheres::field>(aim, random) : boxes::in_ball<any_sphere>(aim, random);
    if (random.chance(0.4)) {
        const Light ball = spheres::special(aim, random);
        b.x = ball.x, b.y = ball.y, b.z = ball.z, b.radius = ball.w;
    }
    constexpr float inf = std::numeric_limits<float>::infinity();
    const float odd[] = {0,   -0.0f, FLT_TRUE_MIN,  FLT_MIN, FLT_MAX, -FLT_MAX,
                         inf, -inf,  std::nanf(""), 1,       -1,      1.0000001f};
    const auto any = [&] { return odd[random.integer(0, 11)]; };
    if (random.chance(0.2)) b.centre[random.integer(0, 2)] = any();
    if (random.chance(0.2)) b.half_axes[random.integer(0, 2)][random.integer(0, 2)] = any();
    if (random.chance(0.1)) b.taper = any();
    if (random.chance(0.1))
        for (float(&h)[3] : b.half_axes)
            h[0] = h[1] = h[2] = 0;
    return b;
}

}  // namespace boxes

struct BoxSet {
    std::string name;
    BoxLight (*one)(const Aim&, Random&);
};

inline const std::vector<BoxSet>& box_sets() {
    using namespace boxes;
    static const std::vector<BoxSet> sets = {
        {"field", boxes::in_ball<spheres::field>},        {"in any ball", boxes::in_ball<any_sphere>},
        {"around the eye", around_eye}, {"at the near plane", at_near},
        {"touching", boxes::touching},  {"along an edge", boxes::along_edge},
        {"huge", boxes::huge},          {"projector", projector},
        {"special", boxes::special},
    };
    return sets;
}

}  // namespace oracle
