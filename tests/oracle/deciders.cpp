// SPDX-License-Identifier: MIT
// The two deciders of oracle.hpp against each other, and each "yes" against a point that lies in both cell
// and ball. No part of the library takes part.
#include "cameras.hpp"
#include "spheres.hpp"

#include "../../bench/exact/oracle.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

using namespace oracle;

namespace {

/// A random run of tiles, often a single one.
void random_block(Random& random, int tiles, int& first, int& last) {
    first = random.integer(0, tiles - 1);
    last = random.chance(0.6) ? first + 1 : random.integer(first + 1, tiles);
}

struct Tally {
    int cells = 0, met = 0, empty = 0, touching = 0;
};

void compare(const Camera& camera, const Aim& aim, const std::vector<Light>& lights, Random& random,
             Tally& tally) {
    const Oracle oracle(camera);
    for (const Light& light : lights) {
        if (is_bad(light)) continue;
        const Ball ball = exact_ball(light.x, light.y, light.z, light.w);
        int x0, x1, y0, y1;
        random_block(random, oracle.tiles_x(), x0, x1);
        random_block(random, oracle.tiles_y(), y0, y1);
        std::optional<float> min, max;
        const float depth = static_cast<float>(aim.depth(random));
        if (random.chance(0.3)) min = random.chance(0.5) ? depth : std::abs(light.z) - light.w;
        if (random.chance(0.3)) max = random.chance(0.5) ? depth * 1.5f : std::abs(light.z) + light.w;
        if (min && !std::isfinite(*min)) min.reset();
        if (max && !std::isfinite(*max)) max.reset();
        const Depths depths = oracle.depths(min, max);
        const Edges columns = oracle.columns(x0, x1), rows = oracle.rows(y0, y1);

        const bool fast =
            meets({oracle.column_slab(columns), oracle.row_slab(rows)}, depths, oracle.in_camera(ball));
        const auto cell = oracle.half_spaces(columns, rows, depths);
        const auto nearest = nearest_point(cell, ball.centre);
        bool slow = false;
        if (nearest) {
            for (const HalfSpace& h : cell)
                REQUIRE(h.at(*nearest) >= 0);
            const Vector away = *nearest - ball.centre;
            slow = ball.all || dot(away, away) <= square(ball.radius);
            tally.touching += !ball.all && dot(away, away) == square(ball.radius);
        }
        REQUIRE(nearest.has_value() == !depths.contains_none());
        if (tally.cells % 10 == 0) REQUIRE(slow == meets(cell, ball));
        if (fast != slow)
            FAIL_CHECK(camera.name << ": the deciders differ, tiles " << x0 << " " << x1 << " " << y0 << " "
                                   << y1);
        ++tally.cells;
        tally.met += fast;
        tally.empty += !nearest;
    }
}

}  // namespace

#define AGREE(kind)                                                                                          \
    TEST_CASE("the deciders agree: " #kind) {                                                                \
        Tally tally;                                                                                         \
        std::uint64_t seed = seed_of(#kind);                                                                 \
        for (const Camera& camera : kinds::kind()) {                                                         \
            const Aim aim(camera);                                                                           \
            Random random(seed);                                                                             \
            for (const SphereSet& set : sphere_sets())                                                       \
                compare(camera, aim, make(set, camera, 40, seed++), random, tally);                          \
        }                                                                                                    \
        MESSAGE(#kind ": " << tally.cells << " cells, " << tally.met << " met, " << tally.empty              \
                           << " empty, " << tally.touching << " touched in one point");                      \
        CHECK(tally.cells >= 1200);                                                                          \
        CHECK(tally.met >= 150);                                                                             \
        CHECK(tally.cells - tally.met - tally.empty >= 150);                                                 \
        CHECK(tally.empty >= 20);                                                                            \
    }
ORACLE_CAMERA_KINDS(AGREE)

// A closed ball and a closed cell that share one point meet, and only exact arithmetic can say so. Each edge
// of the grid splits the screen into two blocks; the spheres of this set touch one of the edges, if their
// numbers come out even.
TEST_CASE("one point is enough") {
    int touching = 0;
    for (const Camera& camera : {kinds::symmetric().back(), kinds::orthographic().front()}) {
        const Oracle oracle(camera);
        const SphereSet* exact_set = nullptr;
        for (const SphereSet& set : sphere_sets())
            if (set.name == "tile edge exact") exact_set = &set;
        REQUIRE(exact_set);
        for (Light light : make(*exact_set, camera, 100, 7)) {
            for (const bool smaller : {false, true}) {
                if (smaller) light.w = std::nextafter(light.w, 0.0f);
                const Ball ball = exact_ball(light.x, light.y, light.z, light.w);
                for (int edge = 1; edge < oracle.tiles_x(); ++edge)
                    for (const auto& [first, last] :
                         {std::pair(0, edge), std::pair(edge, oracle.tiles_x())}) {
                        const Edges columns = oracle.columns(first, last),
                                    rows = oracle.rows(0, oracle.tiles_y());
                        const auto cell = oracle.half_spaces(columns, rows, oracle.range());
                        const auto nearest = nearest_point(cell, ball.centre);
                        REQUIRE(nearest.has_value());
                        const Vector away = *nearest - ball.centre;
                        const Rational gap = dot(away, away) - square(ball.radius);
                        const bool fast = meets({oracle.column_slab(columns), oracle.row_slab(rows)},
                                                oracle.range(), oracle.in_camera(ball));
                        CHECK(fast == (gap <= 0));
                        touching += gap.is_zero();
                    }
            }
        }
    }
    MESSAGE(touching << " balls touch their cell in exactly one point");
    CHECK(touching >= 50);
}
