// SPDX-License-Identifier: MIT
// The spheres around spots, tubes and rectangles hold every point of them, and are no larger than they say: decided in
// rational arithmetic, from the floats that go in and come out.
//
// The farthest point of a spot (half angle below 90 degrees) from any point is the apex or on the cap, the part of the
// sphere that the cone holds. With q the point, from the apex, the farthest of the cap lies in the plane of q and the
// axis, on the other side of the axis: r^2 + |q|^2 - 2 r (q.a c - |q x a| s) / |a| away, squared, where q.a >= 0.
#include "spheres.hpp"

#include "../../bench/exact/oracle.hpp"

#include <lightbin/spot.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace oracle;

namespace {

/// sign * sqrt(u) + sqrt(v) <= w
bool roots_at_most(int sign, const Rational& u, const Rational& v, const Rational& w) {
    const Rational d = square(w) - u - v;
    if (sign >= 0) return w >= 0 && d >= 0 && 4 * u * v <= square(d);
    if (w >= 0) return v - u - square(w) <= 0 || square(v - u - square(w)) <= 4 * square(w) * u;
    return u - v - square(w) >= 0 && square(u - v - square(w)) >= 4 * square(w) * v;
}

Rational norm2(const Vector& v) {
    return dot(v, v);
}

bool good(const lightbin::Sphere& sphere) {
    return !is_bad({sphere.x, sphere.y, sphere.z, sphere.radius});
}

/// Returns whether the sphere holds all points of the spot.
bool holds(const Ball& sphere, const lightbin::Spot& spot) {
    const Vector q = sphere.centre - Vector{exact(spot.x), exact(spot.y), exact(spot.z)},
                 axis = {exact(spot.axis_x), exact(spot.axis_y), exact(spot.axis_z)};
    const Rational r = exact(spot.radius), c = exact(spot.cos_half_angle), along = dot(q, axis);
    REQUIRE(along >= 0);
    if (norm2(q) > square(sphere.radius)) return false;  // the apex
    const Rational rest = square(r) + norm2(q) - square(sphere.radius);
    return roots_at_most(rest.sign(), square(rest) * norm2(axis),
                         4 * square(r) * (norm2(q) * norm2(axis) - square(along)) * (1 - square(c)),
                         2 * r * c * along);
}

/// Returns what rounding to floats may add to a radius: 2^-22 of these sizes, and 2^-123.
Rational allowance(const Rational& sizes) {
    return sizes / (1 << 22) + exact(0x1p-123);
}

/// Returns a random number between 2^low and 2^high, sometimes 0.
float number(Random& random, double low, double high) {
    return random.chance(0.05) ? 0.0f : static_cast<float>(random.sign() * random.power_of_two(low, high));
}

float cosine(Random& random) {
    const double cosines[] = {1, 1 - random.power_of_two(-24, -1), random.power_of_two(-149, -1),
                              static_cast<double>(std::nextafter(std::sqrt(0.5f), random.chance(0.5) ? 0.0f : 1.0f)),
                              std::cos(89.99 * std::acos(-1.0) / 180), random.uniform(0x1p-20, 1)};
    return static_cast<float>(cosines[std::min(random.integer(0, 7), 5)]);
}

lightbin::Spot random_spot(Random& random) {
    const double scale = random.chance(0.8) ? random.uniform(-20, 20) : random.uniform(-120, 100);
    const double spread = random.chance(0.5) ? 2 : 25;
    const auto coordinate = [&] { return number(random, scale - spread, scale + spread); };
    const double unit = random.chance(0.8) ? 0 : random.uniform(-140, 120);
    const auto along = [&] { return number(random, unit - 7, unit + 7); };
    lightbin::Spot spot = {coordinate(), coordinate(), coordinate(), std::abs(coordinate()),
                           along(),      along(),      along(),      cosine(random)};
    if (spot.axis_x == 0 && spot.axis_y == 0 && spot.axis_z == 0) spot.axis_y = 1;
    return spot;
}

}  // namespace

TEST_CASE("the least sphere of a spot holds it, and is the least but for rounding") {
    Random random(1);
    int smaller = 0, outside = 0, larger = 0;
    for (int i = 0; i < 200000; ++i) {
        const lightbin::Spot spot = random_spot(random);
        const lightbin::Sphere least = lightbin::bounding_sphere(spot);
        REQUIRE(good(least));
        REQUIRE(least.radius <= spot.radius);
        smaller += least.radius < spot.radius;
        const Ball ball = exact_ball(least.x, least.y, least.z, least.radius);
        if (!holds(ball, spot) && ++outside <= 5)
            MESSAGE("a point outside: " << spot.x << " " << spot.y << " " << spot.z << " " << spot.radius
                                        << ", " << spot.axis_x << " " << spot.axis_y << " " << spot.axis_z
                                        << ", " << spot.cos_half_angle);
        const Rational r = exact(spot.radius), c2 = square(exact(spot.cos_half_angle));
        const Rational rest =
            ball.radius - allowance(r + abs(exact(spot.x)) + abs(exact(spot.y)) + abs(exact(spot.z)));
        larger +=
            rest > 0 && square(rest) > square(r) * (2 * c2 >= 1 ? Rational(1 / (4 * c2)) : Rational(1 - c2));
    }
    CHECK(outside == 0);
    CHECK(larger == 0);
    CHECK(smaller > 100000);
}

TEST_CASE("tubes and rectangles: the sphere holds them, and is the least but for rounding") {
    Random random(2);
    int outside = 0, larger = 0;
    for (int i = 0; i < 50000; ++i) {
        const double scale = random.chance(0.8) ? random.uniform(-20, 20) : random.uniform(-120, 100);
        const auto coordinate = [&] { return number(random, scale - 12, scale + 12); };
        struct Point {
            float x, y, z;
        };
        const auto point = [&] { return Point{coordinate(), coordinate(), coordinate()}; };
        const auto exactly = [](const Point& p) { return Vector{exact(p.x), exact(p.y), exact(p.z)}; };
        const float radius = std::abs(coordinate());
        const Rational r = exact(radius);
        // Convex shapes: if their corners are inside, all is. The sphere must reach `radius` beyond each corner.
        const auto check = [&](const lightbin::Sphere& sphere, const std::vector<Vector>& corners,
                               const Rational& half2) {
            REQUIRE(good(sphere));
            const Ball ball = exact_ball(sphere.x, sphere.y, sphere.z, sphere.radius);
            const Rational reach = ball.radius - r;
            for (const Vector& corner : corners)
                outside += reach < 0 || norm2(corner - ball.centre) > square(reach);
            const Vector& c = ball.centre;
            const Rational rest = reach - allowance(ball.radius + abs(c.x) + abs(c.y) + abs(c.z));
            larger += rest > 0 && square(rest) > half2;
        };
        const Point a = point(), b = point(), c = point();
        const Vector from = exactly(a), to = exactly(b), u = exactly(b), v = exactly(c);
        check(lightbin::tube_sphere(a, b, radius), {from, to}, norm2(to - from) / 4);
        check(lightbin::rectangle_sphere(a, b, c, radius),
              {from + u + v, from + u - v, from - u + v, from - u - v}, std::max(norm2(u + v), norm2(u - v)));
    }
    CHECK(outside == 0);
    CHECK(larger == 0);
}
