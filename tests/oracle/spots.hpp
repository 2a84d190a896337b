// SPDX-License-Identifier: MIT
// Random sets of spots, as spheres.hpp has sets of spheres. Positions are computed in double in the camera's axes;
// tests then use the rounded float spot.
#pragma once

#include "spheres.hpp"
#include "world.hpp"

#include "../../bench/exact/spot.hpp"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace oracle {

struct SpotLight {
    Light ball;  ///< the whole of its sphere
    float axis_x, axis_y, axis_z, cosine;
};

inline ExactSpot exact_spot(const SpotLight& s) {
    if (s.cosine == -1) return exact_spot(s.ball.x, s.ball.y, s.ball.z, s.ball.w, 0, 0, 0, -1);  // any axis, even NaN
    return exact_spot(s.ball.x, s.ball.y, s.ball.z, s.ball.w, s.axis_x, s.axis_y, s.axis_z, s.cosine);
}

inline bool is_bad(const SpotLight& s) {
    const bool no_axis = !std::isfinite(s.axis_x) || !std::isfinite(s.axis_y) || !std::isfinite(s.axis_z) ||
                         (s.axis_x == 0 && s.axis_y == 0 && s.axis_z == 0);
    return is_bad(s.ball) || (no_axis && s.cosine != -1) || !(std::abs(s.cosine) <= 1);
}
inline bool is_off(const SpotLight& s) {
    return is_off(s.ball);
}

inline std::string text(const SpotLight& s) {
    char buffer[240];
    std::snprintf(buffer, sizeof buffer, "{%a, %a, %a, %a; %a, %a, %a; %a}", static_cast<double>(s.ball.x),
                  static_cast<double>(s.ball.y), static_cast<double>(s.ball.z), static_cast<double>(s.ball.w),
                  static_cast<double>(s.axis_x), static_cast<double>(s.axis_y), static_cast<double>(s.axis_z),
                  static_cast<double>(s.cosine));
    return buffer;
}

/// Returns world-space spots that a view matrix moves about where they are wanted in view space.
inline std::vector<SpotLight> into_world(std::vector<SpotLight> lights, const ViewMatrix& view) {
    for (SpotLight& s : lights) {
        const float size = s.ball.w / std::hypot(s.axis_x, s.axis_y, s.axis_z);
        const Light tip = {s.ball.x + size * s.axis_x, s.ball.y + size * s.axis_y, s.ball.z + size * s.axis_z, 0};
        const std::vector<Light> both = into_world({s.ball, tip}, view);
        s = {both[0], both[1].x - both[0].x, both[1].y - both[0].y, both[1].z - both[0].z, s.cosine};
    }
    return lights;
}

namespace spots {

/// A point or direction in the camera's axes.
using Triple = glm::dvec3;
using glm::length;

inline Triple plus(const Triple& a, const Triple& b, double k) {
    return a + k * b;
}
inline Triple any_direction(Random& random) {
    return glm::normalize(Triple{random.normal(), random.normal(), random.normal()});
}
/// Returns a random vector of length 1 at right angles to a direction.
inline Triple across(const Triple& direction, Random& random) {
    const Triple any = any_direction(random);
    return glm::normalize(plus(any, direction, -glm::dot(any, direction)));
}

/// Returns 0 to 180 degrees in radians, often where formulas change or rounding matters.
inline double half_angle(Random& random) {
    const double degree = std::acos(-1.0) / 180;
    const double angles[] = {0,
                             random.power_of_two(-16, 0),
                             45 * degree + random.sign() * random.power_of_two(-30, -3),
                             90 * degree - random.power_of_two(-30, -3),
                             random.chance(0.5) ? 90 * degree : random.uniform(90, 180) * degree,
                             random.uniform(90, 139) * degree,
                             random.uniform(0, 90) * degree};
    return angles[std::min(random.integer(0, 11), 6)];
}

/// Returns an axis in any direction, often along or across the view, or towards or away from the eye.
inline Triple axis(const Triple& apex, Random& random) {
    const double sign = random.sign();
    const Triple any = any_direction(random),
                 axes[] = {{0, 0, sign}, {sign, 0, 0}, {0, sign, 0},
                           length(apex) > 0 ? plus({}, glm::normalize(apex), sign) : any, any};
    return axes[std::min(random.integer(0, 7), 4)];
}

/// Returns the spot in floats, as the library gets it; the axis is often not of length 1.
inline SpotLight spot(const Aim& aim, Random& random, const Triple& apex, double radius, const Triple& axis,
                      double angle) {
    const double size = random.chance(0.7) ? 1 : random.power_of_two(-20, 20);
    const Light direction = aim.light(size * axis[0], size * axis[1], size * axis[2], 0);
    return {aim.light(apex[0], apex[1], apex[2], radius), direction.x, direction.y, direction.z,
            static_cast<float>(std::cos(angle))};
}

/// Returns a light's centre in the camera's axes, but without the sign of mirrored image axes.
inline Triple centre(const Aim& aim, const Light& light) {
    return {aim.coordinate(0, light), aim.coordinate(1, light), static_cast<double>(aim.depth_of(light))};
}

inline Light any_sphere(const Aim& aim, Random& random) {
    const std::vector<SphereSet>& sets = sphere_sets();  // the last is special
    return sets[static_cast<std::size_t>(random.integer(0, static_cast<int>(sets.size()) - 2))].one(aim,
                                                                                                    random);
}

/// Returns a spot whose whole sphere comes from `sphere`, a function of spheres.hpp.
template <auto sphere> SpotLight in_ball(const Aim& aim, Random& random) {
    const Light ball = sphere(aim, random);
    const Triple apex = centre(aim, ball);
    return spot(aim, random, apex, static_cast<double>(ball.w), axis(apex, random), half_angle(random));
}

/// The least sphere around it is.
template <auto sphere> SpotLight in_least(const Aim& aim, Random& random) {
    const Light ball = sphere(aim, random);
    const Triple c = centre(aim, ball), a = axis(c, random);
    const double angle = half_angle(random), cosine = std::cos(angle), r = static_cast<double>(ball.w);
    if (cosine <= 0) return spot(aim, random, c, r, a, angle);
    const bool narrow = 2 * cosine * cosine >= 1;
    const double range = narrow ? 2 * r * cosine : r / std::sin(angle);
    return spot(aim, random, plus(c, a, narrow ? -r : -range * cosine), range, a, angle);
}

/// Returns a spot with its apex at the eye, on the near plane, or just beside them.
inline SpotLight at_eye(const Aim& aim, Random& random) {
    const double off = random.chance(0.3) ? 0 : aim.unit * random.power_of_two(-40, 0);
    const bool eye = random.chance(0.5);
    Triple apex = plus({}, any_direction(random), off);
    if (!eye) {
        const double n = aim.near_plane;
        apex = {aim.at(0, aim.pixel(0, random), n), aim.at(1, aim.pixel(1, random), n),
                n + random.sign() * off};
    }
    return spot(aim, random, apex, aim.unit * random.power_of_two(-4, 14), axis(apex, random),
                half_angle(random));
}

/// A point on a side, an edge or a corner of a tile's cell, a direction out of the cell there, and a light's size.
struct OnCell {
    Triple at, outward;
    double size;
};
inline OnCell on_cell(const Aim& aim, Random& random) {
    const double d = random.chance(0.2) ? aim.near_plane : aim.depth(random);
    const double h = aim.half_height(std::max(d, aim.unit)), size = h * random.power_of_two(-10, 2);
    Triple n{};
    double pixel[2];
    const int sides = random.integer(1, 7);
    for (const int i : {0, 1}) {
        const bool edge = (sides >> i & 1) != 0;
        pixel[i] = edge ? aim.tile_edge(i, random) : aim.pixel(i, random, 0);
        if (!edge) continue;
        const double weight = random.sign() * random.power_of_two(-6, 0);
        n[i] += weight;
        n[2] -= weight * aim.slope(i, pixel[i]);
    }
    if (sides >> 2 != 0) n[2] += random.sign() * random.power_of_two(-6, 0);
    return {{aim.at(0, pixel[0], d), aim.at(1, pixel[1], d), d}, glm::normalize(n), size};
}

/// Returns a spot that just touches a tile's cell, or misses it by 2^-k of its size, with its apex, its rim or its
/// spherical end. The direction out of the cell makes an angle of `turn` with the axis.
inline SpotLight touching(const Aim& aim, Random& random) {
    const auto [at, n, r] = on_cell(aim, random);
    const double angle = half_angle(random), cosine = std::cos(angle), sine = std::sin(angle);
    // Any angle, or one where the tangent plane at the rim or the apex is also that of the least sphere.
    double turn = std::acos(random.uniform(-1, 1));
    if (random.chance(0.6)) turn = random.chance(0.7) ? std::min(2 * angle, std::acos(0.0)) : std::acos(-1.0);
    const Triple m = across(n, random);
    const Triple a = plus(plus({}, n, std::cos(turn)), m, std::sin(turn));
    Triple reach{};
    if (turn <= angle) {
        reach = plus({}, n, r);
    } else if (cosine * std::cos(turn) + sine * std::sin(turn) > 0) {
        const Triple aside = glm::normalize(plus(n, a, -glm::dot(n, a)));
        reach = plus(plus({}, a, r * cosine), aside, r * sine);
    }
    const double off = r * random.sign() * std::exp2(-random.integer(4, 40));
    SpotLight light = spot(aim, random, plus(plus(at, reach, -1), n, off), r, a, angle);
    if (random.chance(0.5)) light.ball = nudged(light.ball, random);
    return light;
}

/// Returns a spot with the eye on, or just beside, the side of its cone or of the cone's mirror image behind the apex.
inline SpotLight eye_on_cone(const Aim& aim, Random& random) {
    const Light ball = random.chance(0.5) ? spheres::field(aim, random) : any_sphere(aim, random);
    const Triple apex = centre(aim, ball);
    const Triple from_eye = aim.orthographic || !(length(apex) > 0) ? Triple{0, 0, 1} : glm::normalize(apex);
    const double angle = std::min(half_angle(random), std::acos(0.0)),
                 turn = angle * (1 + random.sign() * random.power_of_two(-45, -3));
    const Triple side = across(from_eye, random),
                 axis = plus(plus({}, from_eye, random.sign() * std::cos(turn)), side, std::sin(turn));
    return spot(aim, random, apex, static_cast<double>(ball.w) * random.power_of_two(0, 6), axis, angle);
}

/// Returns a spot with the side of its cone, or sometimes its axis, in or beside the plane of a tile's edge.
inline SpotLight along_edge(const Aim& aim, Random& random) {
    const double d = aim.depth(random), h = aim.half_height(std::max(d, aim.unit));
    const int i = random.integer(0, 1);
    const double edge = aim.tile_edge(i, random);
    double at[2];
    at[i] = aim.at(i, edge, d);
    at[1 - i] = aim.at(1 - i, aim.pixel(1 - i, random), d);
    Triple n{};
    n[i] = 1, n[2] = -aim.slope(i, edge);
    n = glm::normalize(n);
    const double right_angle = std::acos(0.0), angle = std::min(half_angle(random), right_angle),
                 turn = right_angle - (random.chance(0.3) ? 0 : angle) +
                        random.sign() * random.power_of_two(-45, -10);
    const Triple axis = plus(plus({}, n, random.sign() * std::cos(turn)), across(n, random), std::sin(turn));
    const double r = h * random.power_of_two(-8, 3),
                 off = random.chance(0.3) ? 0 : r * random.sign() * random.power_of_two(-45, -8);
    return spot(aim, random, plus({at[0], at[1], d}, n, off), r, axis, angle);
}

/// Returns a spot whose range is far larger than what is seen.
inline SpotLight huge(const Aim& aim, Random& random) {
    const Triple apex = plus({}, any_direction(random), aim.unit * random.power_of_two(-4, 12));
    return spot(aim, random, apex, aim.unit * random.power_of_two(12, 30), axis(apex, random),
                half_angle(random));
}

/// Any bits, and bad input.
inline SpotLight special(const Aim& aim, Random& random) {
    SpotLight light = random.chance(0.5) ? in_ball<spheres::field>(aim, random) : in_least<spheres::field>(aim, random);
    if (random.chance(0.5)) light.ball = spheres::special(aim, random);
    constexpr float inf = std::numeric_limits<float>::infinity();
    const float odd[] = {0,   -0.0f, FLT_TRUE_MIN,  FLT_MIN, FLT_MAX, -FLT_MAX,
                         inf, -inf,  std::nanf(""), 1,       -1,      1.0000001f};
    for (float* v : {&light.axis_x, &light.axis_y, &light.axis_z, &light.cosine})
        if (random.chance(0.3)) *v = odd[random.integer(0, 11)];
    if (random.chance(0.2)) light.axis_x = light.axis_y = light.axis_z = 0, light.cosine = -1;
    return light;
}

}  // namespace spots

struct SpotSet {
    std::string name;
    SpotLight (*one)(const Aim&, Random&);
};

inline const std::vector<SpotSet>& spot_sets() {
    using namespace spots;
    static const std::vector<SpotSet> sets = {
        {"field", in_ball<spheres::field>},
        {"in any ball", in_ball<any_sphere>},
        {"least sphere in the field", in_least<spheres::field>},
        {"least sphere", in_least<any_sphere>},
        {"at the eye", at_eye},
        {"touching", touching},
        {"eye on the cone", eye_on_cone},
        {"along an edge", along_edge},
        {"huge", huge},
        {"special", special},
    };
    return sets;
}

}  // namespace oracle
