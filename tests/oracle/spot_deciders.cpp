// SPDX-License-Identifier: MIT
// Verdicts about spots: certificates that prove nothing are turned down, verdicts agree with what is known, and few are
// left open. No part of the library takes part.
#include "cameras.hpp"
#include "spots.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

using namespace oracle;

namespace {

HalfSpace half_space(double x, double y, double z, double b) {
    return {{exact(x), exact(y), exact(z)}, exact(b)};
}

/// The box between two corners.
std::vector<HalfSpace> box(const spots::Triple& low, const spots::Triple& high) {
    return {half_space(1, 0, 0, -low[0]),  half_space(-1, 0, 0, high[0]), half_space(0, 1, 0, -low[1]),
            half_space(0, -1, 0, high[1]), half_space(0, 0, 1, -low[2]),  half_space(0, 0, -1, high[2])};
}

Vector vector(double x, double y, double z) {
    return {exact(x), exact(y), exact(z)};
}

/// The point of a spot (half angle below 90 degrees) that is nearest to another, in double precision: by the plane through
/// the axis and the point, in which the spot is a sector of a circle.
spots::Triple nearest(const SpotLight& spot, const spots::Triple& p) {
    using namespace spots;
    const Triple apex = {spot.ball.x, spot.ball.y, spot.ball.z},
                 axis = unit({spot.axis_x, spot.axis_y, spot.axis_z}), v = plus(p, apex, -1);
    const double r = static_cast<double>(spot.ball.w), c = static_cast<double>(spot.cosine);
    const double u = along(v, axis);
    const Triple off = plus(v, axis, -u);
    const double w = length(off);
    if (w == 0) return plus(apex, axis, std::clamp(u, 0.0, r));
    const double angle = std::acos(c), turn = std::atan2(w, u);
    double at = std::hypot(u, w), to = turn;
    if (turn > angle) at *= std::cos(std::min(turn - angle, std::acos(0.0))), to = angle;
    at = std::min(at, r);
    return plus(plus(apex, axis, at * std::cos(to)), off, at * std::sin(to) / w);
}

/// The distance of a spot and a box, from above, by going from the one to the other and back.
double distance(const SpotLight& spot, const spots::Triple& low, const spots::Triple& high) {
    spots::Triple p = {spot.ball.x, spot.ball.y, spot.ball.z}, q{};
    double last = INFINITY;
    for (int i = 0; i < 20000; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            q[k] = std::clamp(p[k], low[k], high[k]);
        p = nearest(spot, q);
        const double now = spots::length(spots::plus(p, q, -1));
        if (now < 1e-12 || (i % 100 == 99 && now > last * (1 - 1e-9))) return now;
        if (i % 100 == 99) last = now;
    }
    return last;
}

}  // namespace

TEST_CASE("spots: certificates that prove nothing") {
    // Range 5, half angle 60 degrees, along z. Exact numbers: 3-4-5 is within it.
    const ExactSpot spot = exact_spot(0, 0, 0, 5, 0, 0, 7, 0.5f);
    const auto cell = box({-9, -9, -9}, {9, 9, 9});
    CHECK(proves_meeting(cell, spot, {}));
    CHECK(proves_meeting(cell, spot, vector(3, 0, 4)));
    CHECK(proves_meeting(box({3, 0, 4}, {9, 9, 9}), spot, vector(3, 0, 4)));
    CHECK_FALSE(proves_meeting(cell, spot, vector(3, 0, 4 + 0x1p-50)));  // out of the ball
    CHECK_FALSE(proves_meeting(cell, spot, vector(4, 0, 2)));            // of the cone
    CHECK_FALSE(proves_meeting(cell, spot, vector(0, 0, -1)));           // behind the apex
    CHECK_FALSE(proves_meeting(box({3 + 0x1p-50, 0, 4}, {9, 9, 9}), spot, vector(3, 0, 4)));  // of the cell

    const auto apart = [&](const HalfSpace& side, const Rational& weight, const Vector& ball_part) {
        return proves_apart({side}, spot, {{weight}, ball_part});
    };
    CHECK(apart(half_space(0, 0, -1, -1), 1, {}));  // behind the apex
    CHECK(apart(half_space(1, 0, 0, -6), 1, vector(1, 0, 0)));
    CHECK_FALSE(apart(half_space(0, 0, -1, 0), 1, {}));    // the apex is in it
    CHECK_FALSE(apart(half_space(0, 0, -1, -1), -1, {}));  // a weight below 0
    CHECK_FALSE(apart(half_space(0, 0, 1, 1), -1, {}));    // the same, and g and n right but for it
    CHECK_FALSE(apart(half_space(0, 0, -1, -1), 0, {}));   // no weight at all
    CHECK_FALSE(apart(half_space(1, 0, 0, -6), 1, {}));    // the cone reaches that way
    CHECK_FALSE(apart(half_space(1, 0, 0, -5), 1, vector(1, 0, 0)));  // touches the ball
    CHECK_FALSE(
        apart(half_space(1, 0, 0, -6), 1, vector(1 - 0x1p-30, 0, 0)));  // a part that the cone reaches along
    CHECK_FALSE(proves_apart({half_space(0, 0, -1, -1)}, spot, {}));    // no weights
    CHECK_FALSE(proves_apart({half_space(0, 0, -1, -1)}, spot, {{1, 1}, {}}));  // too many
    CHECK(proves_apart({half_space(0, 0, 0, -1)}, spot, {{1}, {}}));            // no points
}

// Every certificate of weights and vectors by chance that is taken is one of a spot and a box that are apart.
TEST_CASE("spots: certificates by chance") {
    Random random(3);
    int taken = 0, wrong = 0;
    for (int i = 0; i < 40000; ++i) {
        const SpotLight spot = {{0, 0, 0, 1}, 0, 0, 1, static_cast<float>(random.uniform(0.05, 1))};
        const spots::Triple low = {random.uniform(-2, 1), random.uniform(-2, 1), random.uniform(-2, 1)},
                            high = spots::plus(low, {1, 1, 1}, random.uniform(0, 1));
        Separation by;
        Vector n{};
        const auto cell = box(low, high);
        for (const HalfSpace& side : cell) {
            by.weights.push_back(random.chance(0.6) ? Rational(0) : exact(random.uniform(-0.1, 1)));
            n = n + by.weights.back() * side.a;
        }
        by.ball_part = exact(random.uniform(0, 1)) * n + vector(0, 0, random.uniform(-0.2, 1));
        if (!proves_apart(cell, exact_spot(spot), by)) continue;
        ++taken;
        wrong += distance(spot, low, high) < 1e-9;
    }
    CHECK(taken >= 1000);
    CHECK(wrong == 0);
}

TEST_CASE("spots: verdicts agree with distances") {
    Random random(4);
    int met = 0, apart = 0, open = 0;
    for (int i = 0; i < 5000; ++i) {
        const spots::Triple axis = spots::axis({}, random);
        const auto number = [&](double low, double high) {
            return static_cast<float>(random.uniform(low, high));
        };
        const SpotLight spot = {{number(-2, 2), number(-2, 2), number(-2, 2), number(0, 2)},
                                static_cast<float>(3 * axis[0]),
                                static_cast<float>(3 * axis[1]),
                                static_cast<float>(3 * axis[2]),
                                static_cast<float>(std::cos(random.uniform(0, 1.5)))};
        const spots::Triple low = {random.uniform(-1, 0), random.uniform(-1, 0), random.uniform(-1, 0)};
        spots::Triple high = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
        const std::size_t flat = static_cast<std::size_t>(random.integer(0, 7));
        if (flat < 3) high[flat] = low[flat];
        const auto verdict = meets(box(low, high), exact_spot(spot));
        if (!verdict) {
            ++open;
            continue;
        }
        ++(*verdict ? met : apart);
        const double far_apart = distance(spot, low, high);
        if (*verdict ? far_apart > 1e-4 : far_apart < 1e-11)
            FAIL_CHECK(text(spot) << (*verdict ? " meets" : " is apart") << " at distance " << far_apart);
    }
    CHECK(met >= 500);
    CHECK(apart >= 1000);
    CHECK(open <= 4);
}

// The apex on a side of the cell, or a hair off it, and the cone all but the half-space in front of that side.
TEST_CASE("spots: a hair below 90 degrees") {
    const auto cell = box({1, 1, 1}, {2, 2, 2});
    const float above = std::nextafter(1.0f, 2.0f);
    for (const float cosine : {0x1p-149f, 0x1p-54f, 0x1p-20f})
        for (const float range : {2.0f, 0x1p24f, FLT_MAX}) {
            CHECK(meets(cell, exact_spot(1, 1, 0, range, -1, 0, 0, cosine)) == false);
            CHECK(meets(cell, exact_spot(1, 0, 0, range, -3, 0, 0, cosine)) == false);
            CHECK(meets(cell, exact_spot(above, 1, 0.5f, range, -1, 0, 0, cosine)) == (cosine < 0x1p-22f));
            CHECK(meets(cell, exact_spot(1, 1, 1, range, -1, 0, 0, cosine)) == true);
            CHECK(meets(cell, exact_spot(1.5f, 0, 0, range, -1, -1, -1, cosine)) == false);
        }
    // The plane of the cone goes through the corner (1, 1, 1), and the axis has no face of the cell for its own.
    for (const float cosine : {0x1p-149f, 0x1p-54f}) {
        CHECK(meets(cell, exact_spot(2, 0.5f, 0.5f, 9, -1, -1, -1, cosine)) == false);
        CHECK(meets(cell, exact_spot(2, 0.75f, 0.5f, 9, -1, -1, -1, cosine)) == true);
    }
}

// A ball that ends in a plane has a rational point there; a flat cell has no others.
TEST_CASE("spots: balls that touch, flat cells") {
    const auto cell = box({1, 1, 1}, {2, 2, 2}), flat = box({1, 1, 1}, {1, 2, 2});
    for (const auto& to : {cell, flat}) {
        CHECK(meets(to, exact_spot(-2, 1.5f, 1.5f, 3, 1, 0.5f, 0.25f, 0.5f)) == true);
        CHECK(meets(to, exact_spot(-2, 1.5f, 1.5f, std::nextafter(3.0f, 0.0f), 1, 0.5f, 0.25f, 0.5f)) ==
              false);
        CHECK(meets(to, exact_spot(-2, 1.5f, 1.5f, 3, 1, 1.5f, 0.25f, 0.75f)) == false);
    }
    CHECK(meets(box({0, 1, 1}, {2, 2, 2}),
                exact_spot(-0x1p100f, 1.5f, 1.5f, 0x1p100f, 1, 0.5f, 0.25f, 0.5f)) == true);
    CHECK(meets(flat, exact_spot(0, 0, 1.25f, 9, 1, 1.5f, 0.1f, 0.99f)) == true);
    CHECK(meets(flat, exact_spot(0, 0, 1.25f, 9, 1, 0.5f, 0.1f, 0.99f)) == false);
    CHECK(meets(flat, exact_spot(1.5f, 1.5f, 1.5f, 0x1p20f, -1, 0.1f, 0.1f, 0.9f)) == true);
    CHECK(meets(flat, exact_spot(1.5f, 1.5f, 1.5f, 0x1p20f, 1, 0.1f, 0.1f, 0.1f)) == false);
}

// An apex and a ray have rational points, so that even one in common is found.
TEST_CASE("spots: one point is enough") {
    const auto cell = box({1, 1, 1}, {2, 2, 2});
    const float above = std::nextafter(1.0f, 2.0f), below = std::nextafter(1.0f, 0.0f);
    for (const float cosine : {1.0f, below, 0.5f, 0x1p-100f}) {
        CHECK(meets(cell, exact_spot(1, 1, 1, 3, -1, -1, -1, cosine)) == true);
        CHECK(meets(cell, exact_spot(1, 1, 1, 0, -1, -1, -1, cosine)) == true);
        CHECK(meets(cell, exact_spot(1, 1, below, 3, -1, -1, -1, cosine)) == false);
        CHECK(meets(cell, exact_spot(1, 1, below, 0, 1, 1, 1, cosine)) == false);
        CHECK(meets(cell, exact_spot(2, 1.5f, 1.5f, 3, 1, 0, 0, cosine)) == true);
        CHECK(meets(cell, exact_spot(std::nextafter(2.0f, 3.0f), 1.5f, 1.5f, 3, 1, 0, 0, cosine)) == false);
    }
    // Rays that end in it, pass by its edge and its corner.
    CHECK(meets(cell, exact_spot(-2, 1.5f, 1.5f, 3, 5, 0, 0, 1)) == true);
    CHECK(meets(cell, exact_spot(-2, 1.5f, 1.5f, std::nextafter(3.0f, 0.0f), 5, 0, 0, 1)) == false);
    CHECK(meets(cell, exact_spot(0, 3, 1.5f, 9, 1, -1, 0, 1)) == true);
    CHECK(meets(cell, exact_spot(0, 2, 1, 9, 1, -1, 0, 1)) == true);
    CHECK(meets(cell, exact_spot(0, 2, below, 9, 1, -1, 0, 1)) == false);
    CHECK(meets(cell, exact_spot(0, 2, 1.5f, 9, 1, -1, 0, 1)) == true);
    CHECK(meets(cell, exact_spot(0, 2, 1.5f, 9, 1, -above, 0, 1)) == false);
    CHECK(meets(cell, exact_spot(0, 2, 1.5f, 9, 1, -below, 0, 1)) == true);
    // As balls.
    CHECK(meets(cell, exact_spot(0, 1, 1, 1, -1, 0, 0, -1)) == true);
    CHECK(meets(cell, exact_spot(0, 1, 1, INFINITY, -1, 0, 0, 1)) == true);
    CHECK(meets(cell, exact_spot(0, 1, 1, below, -1, 0, 0, -1)) == false);
    // As half balls, and beyond 90 degrees as balls that end at the plane of the rim: its distance is rounded.
    CHECK(meets(cell, exact_spot(0, 1, 1, 1, 3, 0, 0, 0)) == true);
    CHECK(meets(cell, exact_spot(0, 1, 1, 1, -3, 0, 0, 0)) == false);
    CHECK(meets(cell, exact_spot(2, 1.5f, 1.5f, 1, 3, 0, 0, 0)) == true);
    CHECK(meets(cell, exact_spot(std::nextafter(2.0f, 3.0f), 1.5f, 1.5f, 1, 3, 0, 0, 0)) == false);
    CHECK(meets(cell, exact_spot(std::nextafter(2.5f, 2.0f), 1.5f, 1.5f, 1, 3, 0, 0, -0.5f)) == true);
    CHECK(meets(cell, exact_spot(2.5f, 1.5f, 1.5f, 1, 3, 0, 0, -0.5f)) == std::nullopt);
    CHECK(meets(cell, exact_spot(std::nextafter(2.5f, 3.0f), 1.5f, 1.5f, 1, 3, 0, 0, -0.5f)) == false);
}

namespace {

struct Count {
    int asked = 0, met = 0, open = 0, special_open = 0;
};

/// A tile near a point of the spot, or any; between depths near that point, or all.
std::vector<HalfSpace> cell_near(const SpotLight& light, const Oracle& oracle, const Aim& aim,
                                 Random& random) {
    using namespace spots;
    const double r = static_cast<double>(light.ball.w);
    const Triple axis = unit(centre(aim, {light.axis_x, light.axis_y, light.axis_z, 0}));
    const Triple p = plus(plus(centre(aim, light.ball), axis, random.uniform(0, 1.2) * r),
                          any_direction(random), random.uniform(0, 0.7) * r);
    int tile[2];
    const int tiles[2] = {oracle.tiles_x(), oracle.tiles_y()};
    for (const int i : {0, 1}) {
        const double pixel = aim.pixel_of(i, p[static_cast<std::size_t>(i)], p[2]);
        const bool seen = pixel >= 0 && pixel < aim.side(i) && p[2] > aim.near_plane;
        tile[i] = seen ? static_cast<int>(pixel) / aim.camera.tile : random.integer(0, tiles[i] - 1);
        if (random.chance(0.3)) tile[i] = std::clamp(tile[i] + random.integer(-1, 1), 0, tiles[i] - 1);
    }
    std::optional<float> min, max;
    const float depth = static_cast<float>(p[2]);
    if (std::isfinite(depth) && random.chance(0.3)) min = depth * static_cast<float>(random.uniform(0.7, 1));
    if (std::isfinite(depth) && random.chance(0.3)) max = depth * static_cast<float>(random.uniform(1, 1.5));
    if (std::isfinite(depth) && random.chance(0.1)) min = max = depth;
    return oracle.half_spaces(oracle.columns(tile[0], tile[0] + 1), oracle.rows(tile[1], tile[1] + 1),
                              oracle.depths(min, max));
}

void decide(const Camera& camera, std::uint64_t& seed, Count& count) {
    const Aim aim(camera);
    const Oracle oracle(camera);
    Random random(++seed);
    for (const SpotSet& set : spot_sets())
        for (const SpotLight& light : make(set, camera, 150, ++seed)) {
            if (is_bad(light)) continue;
            const ExactSpot spot = exact_spot(light);
            if (spot.whole()) continue;
            const auto cell = cell_near(light, oracle, aim, random);
            const auto verdict = meets(cell, spot);
            ++count.asked;
            count.met += verdict == true;
            if (!verdict) ++(set.name == "special" ? count.special_open : count.open);
            // It is part of its ball, and of a spot of a wider cone.
            const auto check = [&](bool right, const char* what) {
                if (!right) FAIL_CHECK(what << ": " << camera.name << ", " << set.name << " " << text(light));
            };
            if (verdict == true) check(meets(cell, spot.ball), "meets, and its ball does not");
            if (count.asked % 4 == 0 && verdict) {
                SpotLight wider = light;
                wider.cosine *= static_cast<float>(random.uniform(0.5, 1));
                const auto of_wider = meets(cell, exact_spot(wider));
                check(!of_wider || *of_wider || !*verdict, "meets, and a wider one does not");
            }
        }
}

}  // namespace

TEST_CASE("spots: few verdicts are left open") {
    Count all;
    const auto kind = [&](const std::string& name, const std::vector<Camera>& cameras) {
        std::uint64_t seed = seed_of(name);
        Count count;
        for (const Camera& camera : cameras)
            decide(camera, seed, count);
        CHECK(count.met >= 500);
        CHECK(count.asked - count.met >= 500);
        all.asked += count.asked, all.met += count.met;
        all.open += count.open, all.special_open += count.special_open;
    };
#define DECIDE(name) kind(#name, kinds::name());
    ORACLE_CAMERA_KINDS(DECIDE)
#undef DECIDE
    MESSAGE(all.asked << " verdicts, " << all.met << " met, " << all.open << " left open, and "
                      << all.special_open << " of spots of any bits");
    CHECK((all.open + all.special_open) * 1000 < all.asked);
}
