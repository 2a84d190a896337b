// SPDX-License-Identifier: MIT
// Compares the methods of bench/exact, which decide in exact arithmetic whether a light meets a cell, with each other
// and with known answers. No part of the library takes part. tests/spot_verdicts repeats a million earlier answers.
#include "families.hpp"
#include "spots.hpp"

#include "../../bench/exact/truth.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

using namespace oracle;

namespace {

struct Tally {
    int cells = 0, met = 0, empty = 0, filtered = 0;
};

/// Compares two exact methods and, where it has an answer, double precision: for random blocks of tiles and lights.
void compare(const Scene& scene, Random& random, Tally& tally) {
    Truth truth(scene.camera);
    const Oracle& oracle = truth.oracle;
    const Aim aim(scene.camera);
    const auto some = [&](int tiles, int& first, int& last) {
        first = random.integer(0, tiles - 1);
        last = random.chance(0.6) ? first + 1 : random.integer(first + 1, tiles);
    };
    for (const Light& light : scene.lights) {
        if (is_bad(light)) continue;
        Block b;
        some(oracle.tiles_x(), b.x0, b.x1);
        some(oracle.tiles_y(), b.y0, b.y1);
        std::optional<float> min, max;
        const float depth = static_cast<float>(aim.depth(random));
        if (random.chance(0.3)) min = random.chance(0.5) ? depth : std::abs(light.z) - light.w;
        if (random.chance(0.3)) max = random.chance(0.5) ? depth * 1.5f : std::abs(light.z) + light.w;
        if (min && !std::isfinite(*min)) min.reset();
        if (max && !std::isfinite(*max)) max.reset();
        const Depths depths = oracle.depths(min, max);
        const Ball ball = exact_ball(light.x, light.y, light.z, light.w);
        const CameraBall seen = oracle.in_camera(ball);

        const bool by_slabs = meets({truth.columns(b.x0, b.x1), truth.rows(b.y0, b.y1)}, depths, seen);
        const auto cell = oracle.half_spaces(oracle.columns(b.x0, b.x1), oracle.rows(b.y0, b.y1), depths);
        const auto nearest = nearest_point(cell, ball.centre);
        for (const HalfSpace& h : cell)
            REQUIRE((!nearest || h.at(*nearest) >= 0));
        REQUIRE(nearest.has_value() == !depths.contains_none());
        REQUIRE(by_slabs == meets(cell, ball));
        if (nearest && !ball.all) {
            const FlatBall flat = {nearly(seen.x), nearly(seen.y), nearly(seen.depth), nearly(ball.radius)};
            const auto filtered = truth.filter.meets(b.x0, b.x1, b.y0, b.y1, FlatDepths(depths), flat);
            if (filtered) REQUIRE(*filtered == by_slabs);
            tally.filtered += filtered.has_value();
        }
        ++tally.cells, tally.met += by_slabs, tally.empty += !nearest;
    }
}

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

}  // namespace

TEST_CASE("the deciders of balls agree") {
    Tally tally;
    for (const Family& family : all_families())
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            Random random(seed_of(family.name) + seed);
            compare(family.make(random, 150), random, tally);
        }
    MESSAGE(tally.cells << " cells, " << tally.met << " met, " << tally.empty << " empty, " << tally.filtered
                        << " decided in double precision");
    CHECK(tally.met >= 1000);
    CHECK(tally.cells - tally.met - tally.empty >= 1000);
    CHECK(tally.empty >= 100);
    CHECK(tally.filtered >= 1000);
}

TEST_CASE("spots: certificates that prove nothing") {
    // A spot of range 5 and half angle 60 degrees along z: a point at distances 3 and 4 is exactly within it.
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

// A closed spot and a closed cell that share one point meet. An apex, a ray and where a ball ends in a plane are
// rational, so that even one point in common is found.
TEST_CASE("spots and balls: one point is enough") {
    struct Row {
        std::optional<bool> meets;
        float apex[3], range, axis[3], cosine;
    };
    const float above = std::nextafter(1.0f, 2.0f), below = std::nextafter(1.0f, 0.0f),
                over_2 = std::nextafter(2.0f, 3.0f), below_3 = std::nextafter(3.0f, 0.0f);
    std::vector<Row> rows = {
        // Thin rays that end in the cell, or pass by its edge and its corner.
        {true, {-2, 1.5f, 1.5f}, 3, {5, 0, 0}, 1},
        {false, {-2, 1.5f, 1.5f}, below_3, {5, 0, 0}, 1},
        {true, {0, 3, 1.5f}, 9, {1, -1, 0}, 1},
        {true, {0, 2, 1}, 9, {1, -1, 0}, 1},
        {false, {0, 2, below}, 9, {1, -1, 0}, 1},
        {true, {0, 2, 1.5f}, 9, {1, -1, 0}, 1},
        {false, {0, 2, 1.5f}, 9, {1, -above, 0}, 1},
        {true, {0, 2, 1.5f}, 9, {1, -below, 0}, 1},
        // Whole spheres, and wide cones that cut nothing off their sphere.
        {true, {0, 1, 1}, 1, {-1, 0, 0}, -1},
        {true, {0, 1, 1}, INFINITY, {-1, 0, 0}, 1},
        {false, {0, 1, 1}, below, {-1, 0, 0}, -1},
        {true, {-2, 1.5f, 1.5f}, 3, {1, 0.5f, 0.25f}, 0.5f},
        {false, {-2, 1.5f, 1.5f}, below_3, {1, 0.5f, 0.25f}, 0.5f},
        {false, {-2, 1.5f, 1.5f}, 3, {1, 1.5f, 0.25f}, 0.75f},
        // Half spheres, and spots beyond 90 degrees, which end at the plane of their rim: its distance is rounded.
        {true, {0, 1, 1}, 1, {3, 0, 0}, 0},
        {false, {0, 1, 1}, 1, {-3, 0, 0}, 0},
        {true, {2, 1.5f, 1.5f}, 1, {3, 0, 0}, 0},
        {false, {over_2, 1.5f, 1.5f}, 1, {3, 0, 0}, 0},
        {true, {std::nextafter(2.5f, 2.0f), 1.5f, 1.5f}, 1, {3, 0, 0}, -0.5f},
        {std::nullopt, {2.5f, 1.5f, 1.5f}, 1, {3, 0, 0}, -0.5f},
        {false, {std::nextafter(2.5f, 3.0f), 1.5f, 1.5f}, 1, {3, 0, 0}, -0.5f},
    };
    for (const float cosine : {1.0f, below, 0.5f, 0x1p-100f})  // the apex
        rows.insert(rows.end(), {{true, {1, 1, 1}, 3, {-1, -1, -1}, cosine},
                                 {true, {1, 1, 1}, 0, {-1, -1, -1}, cosine},
                                 {false, {1, 1, below}, 3, {-1, -1, -1}, cosine},
                                 {false, {1, 1, below}, 0, {1, 1, 1}, cosine},
                                 {true, {2, 1.5f, 1.5f}, 3, {1, 0, 0}, cosine},
                                 {false, {over_2, 1.5f, 1.5f}, 3, {1, 0, 0}, cosine}});
    // The apex is on a side of the cell or just beside it, and the cone almost the half-space before that side.
    for (const float cosine : {0x1p-149f, 0x1p-54f, 0x1p-20f})
        for (const float range : {2.0f, 0x1p24f, FLT_MAX})
            rows.insert(rows.end(), {{false, {1, 1, 0}, range, {-1, 0, 0}, cosine},
                                     {false, {1, 0, 0}, range, {-3, 0, 0}, cosine},
                                     {cosine < 0x1p-22f, {above, 1, 0.5f}, range, {-1, 0, 0}, cosine},
                                     {true, {1, 1, 1}, range, {-1, 0, 0}, cosine},
                                     {false, {1.5f, 0, 0}, range, {-1, -1, -1}, cosine}});
    const auto cell = box({1, 1, 1}, {2, 2, 2});
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CAPTURE(i);
        const auto& [expected, p, range, axis, cosine] = rows[i];
        CHECK(meets(cell, exact_spot(p[0], p[1], p[2], range, axis[0], axis[1], axis[2], cosine)) == expected);
    }
}
