// SPDX-License-Identifier: MIT
// Sets of spheres, each made by a function of that name from a camera and a seed. Positions are computed in double;
// tests then use the rounded float sphere.
#pragma once

#include "../../bench/exact/oracle.hpp"
#include "../split_mix.hpp"
#include "cameras.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace oracle {

struct Light {
    float x, y, z, w;  ///< w = radius
};

inline std::string text(const Light& light) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, "{%a, %a, %a, %a}", static_cast<double>(light.x),
                  static_cast<double>(light.y), static_cast<double>(light.z), static_cast<double>(light.w));
    return buffer;
}

class Random : public SplitMix {
public:
    using SplitMix::SplitMix;
    double uniform(double low = 0, double high = 1) {
        return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    bool chance(double p) { return uniform() < p; }
    double sign() { return chance(0.5) ? 1 : -1; }
    double normal() {  // Box-Muller
        return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::acos(-1.0) * uniform());
    }
    double power_of_two(double low, double high) { return std::exp2(uniform(low, high)); }
};

/// A seed from a name (FNV-1a), so that no two kinds of camera get the same spheres.
inline std::uint64_t seed_of(const std::string& name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

/// Places in front of a camera, in its own axes: image coordinates grow with pixels, depth grows with distance.
class Aim {
public:
    explicit Aim(const Camera& of) : camera(of) {
        const Matrix& m = camera.m;
        orthographic = m[2][3] == 0;
        const double along = orthographic ? m[2][2] : m[2][3];
        sign_[2] = (along > 0) != (orthographic && camera.reversed) ? 1 : -1;
        sign_[0] = m[0][0] < 0 ? -1 : 1;
        sign_[1] = (m[1][1] < 0 ? -1 : 1) * up(1);
        const Depths range = Oracle(camera).range();
        near_plane = nearly(*range.min);
        far_plane = range.max ? nearly(*range.max) : std::numeric_limits<double>::infinity();
        if (!orthographic && far_plane > 1e13 * near_plane) far_plane = 1e7 * near_plane;  // at infinity, or as good as
        unit = orthographic ? (at(1, camera.height, 0) - at(1, 0, 0)) / 64 : near_plane;
    }

    /// Image coordinate of pixel edge a on an axis (0: x, 1: y), at a depth.
    double at(int axis, double pixel, double depth) const {
        return offset(axis, pixel) + slope(axis, pixel) * depth;
    }
    double offset(int axis, double pixel) const {
        const Matrix& m = camera.m;
        return (ndc(axis, pixel) * m[3][3] - up(axis) * m[3][axis]) / std::abs(m[axis][axis]);
    }
    double slope(int axis, double pixel) const {
        const Matrix& m = camera.m;
        return sign_[2] * (ndc(axis, pixel) * m[2][3] - up(axis) * m[2][axis]) / std::abs(m[axis][axis]);
    }
    /// Returns the pixel on which an image coordinate at this depth falls.
    double pixel_of(int axis, double coordinate, double depth) const {
        const double low = at(axis, 0, depth), high = at(axis, side(axis), depth);
        return (coordinate - low) / (high - low) * side(axis);
    }
    double coordinate(int axis, const Light& light) const {
        return sign_[axis] * static_cast<double>(axis == 0 ? light.x : light.y);
    }
    int side(int axis) const { return axis == 0 ? camera.width : camera.height; }

    /// Returns the position of a random tile edge in the viewport or at its border.
    double tile_edge(int axis, Random& random) const {
        return camera.first_pixel(axis, random.integer(0, camera.tiles(axis)));
    }
    double pixel(int axis, Random& random, double beyond = 0.2) const {
        return side(axis) * random.uniform(-beyond, 1 + beyond);
    }
    /// Half the height of the image at a depth.
    double half_height(double depth) const { return 0.5 * (at(1, camera.height, depth) - at(1, 0, depth)); }
    /// A depth in view, as likely near as far.
    double depth(Random& random) const {
        if (orthographic) return random.uniform(near_plane, far_plane);
        return near_plane * std::exp(random.uniform(0, std::log(std::min(far_plane / near_plane, deepest))));
    }

    Light light(double x, double y, double depth, double radius) const {
        const auto rounded = [](double v) {
            return static_cast<float>(std::clamp<double>(v, -FLT_MAX, FLT_MAX));
        };
        return {rounded(sign_[0] * x), rounded(sign_[1] * y), rounded(sign_[2] * depth), rounded(radius)};
    }

    float depth_of(const Light& light) const { return static_cast<float>(sign_[2]) * light.z; }

    Camera camera;
    bool orthographic;
    double near_plane, far_plane;
    double unit;           ///< a typical length: the near plane's distance, or a part of an orthographic box
    double deepest = 1e4;  ///< depth() returns up to this many near plane distances

private:
    double up(int axis) const { return axis == 1 && camera.upper_left ? -1 : 1; }
    double ndc(int axis, double pixel) const { return 2 * pixel / side(axis) - 1; }
    double sign_[3];
};

/// Moves each number by a few ulps up or down, often by none.
inline Light nudged(Light light, Random& random) {
    const auto nudge = [&](float v) {
        for (int steps = random.integer(-2, 2), i = 0; i < std::abs(steps); ++i)
            v = std::nextafter(v, steps < 0 ? -FLT_MAX : FLT_MAX);
        return v;
    };
    for (float* v : {&light.x, &light.y, &light.z})
        if (random.chance(0.3)) *v = nudge(*v);
    if (random.chance(0.3)) light.w = std::max(0.0f, nudge(light.w));
    return light;
}

namespace spheres {

/// Returns a light in or around the frustum with a radius of about a tenth of the image's height there.
inline Light field(const Aim& aim, Random& random) {
    const double d = aim.depth(random) * (random.chance(0.1) ? -1 : 1);
    const double at = std::max(std::abs(d), aim.unit);
    return aim.light(aim.at(0, aim.pixel(0, random), at), aim.at(1, aim.pixel(1, random), at), d,
                     0.1 * aim.half_height(at) * std::exp(0.7 * random.normal()));
}

/// Eye inside and beside the lights.
inline Light near_eye(const Aim& aim, Random& random) {
    const double u = 10 * aim.unit, z = random.uniform(-3, 30);
    const double half = aim.half_height(aim.orthographic ? 0 : 1);
    const double x = (3 + 1.2 * std::abs(z)) * random.uniform(-1, 1),
                 y = (3 + 0.8 * std::abs(z)) * random.uniform(-1, 1);
    const double shift_x = aim.at(0, 0.5 * aim.side(0), u * std::max(z, 0.1)),
                 shift_y = aim.at(1, 0.5 * aim.side(1), u * std::max(z, 0.1));
    const double spread = aim.orthographic ? 1 : std::max(1.0, half);
    return aim.light(shift_x + spread * u * x, shift_y + spread * u * y, u * z,
                     u * 2 * spread * std::exp(0.7 * random.normal()));
}

/// Returns a sphere that reaches through the near plane from one side, or stays short of it, by 2^-k of its size.
template <bool from_behind> Light touching_near(const Aim& aim, Random& random) {
    const double r = aim.unit * random.power_of_two(-12, 20);
    const double poke = random.sign() * r * std::exp2(-random.integer(1, 40));
    const double d = aim.near_plane + (from_behind ? -r : r) + poke;
    const double n = aim.near_plane, reach = random.chance(0.5) ? 0.1 * r : aim.unit;
    return nudged(aim.light(aim.at(0, aim.pixel(0, random), n) + reach * random.uniform(-1, 1),
                            aim.at(1, aim.pixel(1, random), n) + reach * random.uniform(-1, 1), d, r),
                  random);
}

/// Returns a sphere whose circle in the near plane ends at a tile's edge.
inline Light near_corner(const Aim& aim, Random& random) {
    const double n = aim.near_plane, r = aim.unit * random.power_of_two(-6, 12);
    const double w = r * random.uniform(-1, 1), h = std::sqrt((r - w) * (r + w));
    const int axis = random.integer(0, 1);
    double c[2];
    c[axis] = aim.at(axis, aim.tile_edge(axis, random), n) + random.sign() * h;
    c[1 - axis] = aim.at(1 - axis, aim.pixel(1 - axis, random), n) + h * random.uniform(-1, 1);
    return nudged(aim.light(c[0], c[1], n - w, r), random);
}

/// Returns a sphere with the eye on its surface or just beside it.
inline Light eye_surface(const Aim& aim, Random& random) {
    double v[3] = {random.normal(), random.normal(), random.normal()};
    const double length = std::hypot(v[0], v[1], v[2]), r = aim.unit * random.power_of_two(-3, 24);
    const double d = r * (1 + random.sign() * std::exp2(-random.integer(1, 40))) / length;
    return nudged(aim.light(d * v[0], d * v[1], d * v[2], r), random);
}

/// Returns a sphere whose |x| or |y| is its radius, so that one tangent plane through the eye contains the view axis.
inline Light axis_tangent(const Aim& aim, Random& random) {
    const double d = aim.depth(random),
                 r = aim.half_height(std::max(d, aim.unit)) * random.power_of_two(-8, 2);
    const int axis = random.integer(0, 1);
    double c[2];
    c[axis] = random.sign() * r * (1 + random.sign() * std::exp2(-random.integer(1, 40)));
    c[1 - axis] = aim.at(1 - axis, aim.pixel(1 - axis, random), d);
    return nudged(aim.light(c[0], c[1], d, r), random);
}

/// Returns a sphere at z = r (1 + 2^-k): it almost reaches the eye's plane, so its image is almost infinite.
inline Light eye_plane(const Aim& aim, Random& random) {
    const double r = aim.unit * random.power_of_two(-2, 20), d = r * (1 + std::exp2(-random.integer(1, 30)));
    return nudged(
        aim.light(aim.at(0, aim.pixel(0, random, 1), d), aim.at(1, aim.pixel(1, random, 1), d), d, r),
        random);
}

inline Light tiny_far(const Aim& aim, Random& random) {
    const double d = aim.depth(random);
    const double x = random.chance(0.5) ? aim.pixel(0, random) : aim.tile_edge(0, random);
    return nudged(aim.light(aim.at(0, x, d), aim.at(1, aim.pixel(1, random), d), d,
                            random.chance(0.1) ? 0.0 : std::abs(d) * random.power_of_two(-40, -13)),
                  random);
}

inline Light huge(const Aim& aim, Random& random) {
    const double r = aim.unit * random.power_of_two(20, 40);
    double v[3] = {random.normal(), random.normal(), random.normal()};
    const double length = std::hypot(v[0], v[1], v[2]);
    const double at = r + random.sign() * aim.unit * random.power_of_two(-4, 12);
    return aim.light(v[0] / length * at, v[1] / length * at, v[2] / length * at, r);
}

/// A light like those of field(), scaled by 2^-40 to 2^40.
inline Light scales(const Aim& aim, Random& random) {
    const double k = random.power_of_two(-40, 40);
    const Light light = field(aim, random);
    return {static_cast<float>(light.x * k), static_cast<float>(light.y * k), static_cast<float>(light.z * k),
            static_cast<float>(light.w * k)};
}

/// Tangent to the plane of a tile edge.
inline Light tile_edge(const Aim& aim, Random& random) {
    const double d = aim.depth(random), h = aim.half_height(std::max(d, aim.unit));
    const double r = h * random.power_of_two(-10, 1);
    const int axis = random.integer(0, 1);
    const double edge = aim.tile_edge(axis, random), s = aim.slope(axis, edge);
    double c[2];
    c[axis] = aim.at(axis, edge, d) + random.sign() * r * std::sqrt(1 + s * s);
    c[1 - axis] = aim.at(1 - axis, aim.pixel(1 - axis, random), d);
    const Light light = aim.light(c[0], c[1], d, r);
    return random.chance(0.3) ? light : nudged(light, random);
}

/// A light whose numbers have few bits, so that it can be exactly tangent to the plane of a tile edge.
inline Light tile_edge_exact(const Aim& aim, Random& random) {
    const double r = aim.unit * 5 * random.integer(1, 12) * 0.125,
                 d = aim.near_plane + r + aim.unit * random.integer(0, 40);
    const int axis = random.integer(0, 1);
    const double edge = aim.tile_edge(axis, random), s = aim.slope(axis, edge);
    double c[2];
    c[axis] = aim.at(axis, edge, d) + random.sign() * r * std::sqrt(1 + s * s);
    c[1 - axis] = aim.at(1 - axis, aim.tile_edge(1 - axis, random), d) * 0.5;
    return aim.light(c[0], c[1], d, r);
}

/// Tangent to the ray through a tile corner.
inline Light tile_corner(const Aim& aim, Random& random) {
    const double d = aim.depth(random), h = aim.half_height(std::max(d, aim.unit));
    const double r = h * random.power_of_two(-8, 0);
    const double px = aim.tile_edge(0, random), py = aim.tile_edge(1, random);
    const double ray[3] = {aim.slope(0, px), aim.slope(1, py), 1};
    const double angle = random.uniform(0, 2 * std::acos(-1.0));
    // A unit vector at right angles to the ray: a random one less its part along the ray.
    double n[3] = {std::cos(angle), std::sin(angle), random.uniform(-1, 1)};
    const double along =
        (n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2]) / (ray[0] * ray[0] + ray[1] * ray[1] + 1);
    for (int i = 0; i < 3; ++i)
        n[i] -= along * ray[i];
    const double length = std::hypot(n[0], n[1], n[2]);
    return nudged(aim.light(aim.at(0, px, d) + r * n[0] / length, aim.at(1, py, d) + r * n[1] / length,
                            d + r * n[2] / length, r),
                  random);
}

inline Light behind(const Aim& aim, Random& random) {
    const double r = aim.unit * random.power_of_two(-4, 12);
    return aim.light(r * random.normal(), r * random.normal(), aim.near_plane - r * random.uniform(0.9, 3),
                     r);
}

inline Light beyond_far(const Aim& aim, Random& random) {
    const double f = aim.far_plane, r = aim.half_height(f) * random.power_of_two(-6, 0);
    const double d = f + r * (1 + random.sign() * std::exp2(-random.integer(1, 24)));
    return nudged(aim.light(aim.at(0, aim.pixel(0, random), d), aim.at(1, aim.pixel(1, random), d), d, r),
                  random);
}

/// Returns a light of any bits: denormals, the largest floats, zeros of both signs, and bad input.
inline Light special(const Aim& aim, Random& random) {
    constexpr float inf = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    const auto odd = [&]() -> float {
        const auto bits = static_cast<std::uint32_t>(random.bits());
        float any = 0;  // std::bit_cast is not in every library
        std::memcpy(&any, &bits, sizeof any);
        const float sign = static_cast<float>(random.sign()),
                    values[] = {0, FLT_MAX, FLT_MIN, FLT_TRUE_MIN * static_cast<float>(random.integer(1, 1000)),
                                static_cast<float>(aim.near_plane), std::isfinite(any) ? any : 1};
        return sign * values[std::min(random.integer(0, 8), 5)];
    };
    Light light = random.chance(0.5) ? Light{odd(), odd(), odd(), std::abs(odd())} : field(aim, random);
    const float radii[] = {inf, FLT_MAX, -light.w, -1, -inf, nan, odd() * 0.0f}, bad[] = {nan, inf, -inf};
    if (random.chance(0.3)) light.w = radii[random.integer(0, 6)];
    float* const centre[] = {&light.x, &light.y, &light.z};
    if (random.chance(0.15)) *centre[random.integer(0, 2)] = bad[random.integer(0, 2)];
    return light;
}

}  // namespace spheres

struct SphereSet {
    std::string name;
    Light (*one)(const Aim&, Random&);
};

inline const std::vector<SphereSet>& sphere_sets() {
    using namespace spheres;
    static const std::vector<SphereSet> sets = {
        {"field", field},
        {"near eye", near_eye},
        {"poke from behind", touching_near<true>},
        {"touch from the front", touching_near<false>},
        {"near corner", near_corner},
        {"eye on the surface", eye_surface},
        {"axis tangent", axis_tangent},
        {"eye plane", eye_plane},
        {"tiny and far", tiny_far},
        {"huge", huge},
        {"scales", scales},
        {"tile edge", tile_edge},
        {"tile edge exact", tile_edge_exact},
        {"tile corner", tile_corner},
        {"behind", behind},
        {"beyond far", beyond_far},
        {"special", special},
    };
    return sets;
}

/// Returns the lights that a set, such as a SphereSet, makes for a camera.
template <class Set>
auto make(const Set& set, const Camera& camera, std::size_t count, std::uint64_t seed) {
    const Aim aim(camera);
    Random random(seed);
    std::vector<decltype(set.one(aim, random))> lights;
    for (std::size_t i = 0; i < count; ++i)
        lights.push_back(set.one(aim, random));
    return lights;
}

/// Returns whether no list may have the light: it is bad input or switched off.
inline bool is_bad(const Light& light) {
    return !std::isfinite(light.x) || !std::isfinite(light.y) || !std::isfinite(light.z) || !(light.w >= 0);
}
inline bool is_off(const Light& light) {
    return light.w == -1;
}
/// Returns how many of the lights must be counted as bad input.
template <class Any> std::uint32_t rejected_of(const std::vector<Any>& lights) {
    std::uint32_t count = 0;
    for (const Any& light : lights)
        count += is_bad(light) && !is_off(light);
    return count;
}

}  // namespace oracle
