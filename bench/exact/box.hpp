// SPDX-License-Identifier: MIT
// Whether a ball cut by a box, perhaps a tapered one, meets a cell. Nothing is left open and nothing is searched for:
// the point of cell and box that is nearest to the ball's centre is rational.
//
// The box is the convex hull of its eight corners. Its half-spaces are found by trying every three corners, without
// the formulas that the library has, so that flat, thin and mirrored boxes and pyramids need no cases of their own.
//
// The nearest point comes from Seidel's recursion: half-spaces are added one by one, and where one excludes the
// nearest point so far, the new one lies in its plane, which is the same problem in a dimension less. The nearest
// distance only grows on the way, so that a ball that is too small is known to miss early.
//
// Most questions are settled in double precision before, by a direction along which every point of the cell lies
// beyond all corners. It is found with ordinary rounding and proven for the direction that came out: filter.hpp
// bounds the rounding of the cell's side.
#pragma once

#include "filter.hpp"
#include "oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace oracle {

inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool is_zero(const Vector& v) {
    return v.x.is_zero() && v.y.is_zero() && v.z.is_zero();
}

/// The half-spaces of the convex hull of points, be they in space, in a plane, on a line or all the same.
inline std::vector<HalfSpace> convex_hull(const std::vector<Vector>& points) {
    const Vector& origin = points.front();
    std::vector<Vector> from_origin;
    for (const Vector& p : points)
        from_origin.push_back(p - origin);
    Vector line{}, plane{};
    bool solid = false;
    for (const Vector& v : from_origin)
        if (is_zero(line)) line = v;
    for (const Vector& v : from_origin)
        if (is_zero(plane)) plane = cross(line, v);
    for (const Vector& v : from_origin)
        solid = solid || !dot(plane, v).is_zero();

    std::vector<HalfSpace> hull;
    // Adds the half-space of the plane through `on` at right angles to n, if all points are on one side of it.
    const auto add = [&](const Vector& n, const Vector& on) {
        if (is_zero(n)) return;
        bool above = true, below = true;
        for (const Vector& p : points) {
            const Rational at = dot(n, p - on);
            above = above && at >= 0;
            below = below && at <= 0;
        }
        if (above) hull.push_back({n, -dot(n, on)});
        if (below) hull.push_back({Rational(-1) * n, dot(n, on)});
    };
    const auto known = [&](const Vector& a, const Vector& b, const Vector& c) {
        return std::any_of(hull.begin(), hull.end(), [&](const HalfSpace& h) {
            return h.at(a).is_zero() && h.at(b).is_zero() && h.at(c).is_zero();
        });
    };
    if (solid) {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                for (std::size_t k = 0; k < j; ++k)
                    if (!known(points[i], points[j], points[k]))
                        add(cross(points[i] - points[k], points[j] - points[k]), points[k]);
        return hull;
    }
    if (!is_zero(plane)) {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (!known(points[i], points[j], points[j])) add(cross(plane, points[i] - points[j]), points[j]);
        add(plane, origin);
        return hull;
    }
    const Vector axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (!is_zero(line)) {
        for (const Vector& p : points)
            add(line, p);
        for (const Vector& axis : axes)
            add(cross(line, axis), origin);
    } else {
        for (const Vector& axis : axes)
            add(axis, origin);
    }
    return hull;
}

/// The squared distance of a point from the intersection of half-spaces. Nothing: the intersection is empty, or the
/// distance is known to be more than `at_most`.
inline std::optional<Rational> distance2(const std::vector<HalfSpace>& space, const Vector& centre,
                                         const std::optional<Rational>& at_most = {}) {
    Vector p = centre;
    for (std::size_t i = 0; i < space.size(); ++i) {
        const HalfSpace& f = space[i];
        if (f.at(p) >= 0) continue;
        const Rational aa = dot(f.a, f.a);
        if (aa.is_zero()) return std::nullopt;
        const Vector in_plane = centre - (f.at(centre) / aa) * f.a;
        p = in_plane;
        for (std::size_t j = 0; j < i; ++j) {
            const HalfSpace& g = space[j];
            if (g.at(p) >= 0) continue;
            const Vector along = g.a - (dot(g.a, f.a) / aa) * f.a;  // the part of g's normal in f's plane
            const Rational bb = dot(along, along);
            if (bb.is_zero()) return std::nullopt;
            const Vector on_line = in_plane - (g.at(in_plane) / bb) * along, direction = cross(f.a, along);
            std::optional<Rational> low, high;
            for (std::size_t k = 0; k < j; ++k) {
                const HalfSpace& h = space[k];
                const Rational climb = dot(h.a, direction), at = h.at(on_line);
                if (climb.is_zero()) {
                    if (at < 0) return std::nullopt;
                    continue;
                }
                const Rational end = -at / climb;
                if (climb > 0) {
                    if (!low || end > *low) low = end;
                } else if (!high || end < *high) {
                    high = end;
                }
            }
            if (low && high && *low > *high) return std::nullopt;
            Rational t = 0;
            if (low && t < *low) t = *low;
            if (high && t > *high) t = *high;
            p = on_line + t * direction;
        }
        const Vector away = p - centre;
        if (at_most && dot(away, away) > *at_most) return std::nullopt;
    }
    const Vector away = p - centre;
    return dot(away, away);
}

/// A box light with the numbers as given; `half_axes` and `taper` have the meaning of lightbin::Box.
struct BoxLight {
    float x, y, z, radius;
    float centre[3], half_axes[3][3], taper;
};

/// Returns the eight corners. Corner i lies in the direction of half axis k if bit k of i is set.
inline std::vector<Vector> exact_corners(const BoxLight& light) {
    const auto vector = [](const float(&v)[3]) {
        return Vector{exact(static_cast<double>(v[0])), exact(static_cast<double>(v[1])),
                      exact(static_cast<double>(v[2]))};
    };
    const Vector centre = vector(light.centre),
                 h[] = {vector(light.half_axes[0]), vector(light.half_axes[1]), vector(light.half_axes[2])};
    std::vector<Vector> corners;
    for (int i = 0; i < 8; ++i) {
        const Rational width = (i & 4) != 0 ? Rational(1) : exact(static_cast<double>(light.taper));
        const Vector across = Rational((i & 1) != 0 ? 1 : -1) * h[0] + Rational((i & 2) != 0 ? 1 : -1) * h[1];
        corners.push_back(centre + Rational((i & 4) != 0 ? 1 : -1) * h[2] + width * across);
    }
    return corners;
}

struct ExactBox {
    Ball ball;
    std::vector<HalfSpace> faces;

    explicit ExactBox(const BoxLight& light)
        : ball(exact_ball(light.x, light.y, light.z, light.radius)), faces(convex_hull(exact_corners(light))) {}
};

/// Returns whether the ball and the box have a point of the cell in common.
inline bool meets(std::vector<HalfSpace> cell, const ExactBox& box) {
    cell.insert(cell.end(), box.faces.begin(), box.faces.end());
    if (box.ball.all) return distance2(cell, {}).has_value();
    const Rational radius2 = square(box.ball.radius);
    const auto distance = distance2(cell, box.ball.centre, radius2);
    return distance && *distance <= radius2;
}

/// A box in the camera's axes, in double precision. Its corners are in the order of exact_corners(), and each
/// coordinate is off by at most `error`.
struct FlatBox {
    double corners[8][3];
    double error;
};

/// Returns a box with its corners moved to the camera's axes by to_camera(corner), which returns a ball of radius 0.
template <class ToCamera> FlatBox flat_box(const BoxLight& light, const ToCamera& to_camera) {
    FlatBox box = {};
    const std::vector<Vector> corners = exact_corners(light);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const CameraBall seen = to_camera(corners[i]);
        const double at[] = {nearly(seen.x), nearly(seen.y), nearly(seen.depth)};
        for (std::size_t k = 0; k < 3; ++k) {
            box.corners[i][k] = at[k];
            box.error = std::max(box.error, std::abs(at[k]) * 0x1p-52);  // the digits that nearly() cuts off
        }
    }
    return box;
}

/// Returns true only if it is certain that the box does not meet the tiles [x0, x1) x [y0, y1) between these depths.
inline bool apart(Filter& filter, int x0, int x1, int y0, int y1, const FlatDepths& depths, const FlatBox& box) {
    using Direction = Filter::Direction;
    const auto separates = [&](const Direction& direction) {
        const Direction n = filter.tilted(direction, x0, x1, y0, y1);
        double reach = -HUGE_VAL;
        for (const double(&c)[3] : box.corners) {
            const double a = n.x * c[0], b = n.y * c[1], d = n.z * c[2];
            reach = std::max(reach, a + b + d + 0x1p-48 * (std::abs(a) + std::abs(b) + std::abs(d)));
        }
        reach += (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) * box.error * (1 + 0x1p-40);
        return filter.beyond(n, x0, x1, y0, y1, depths, reach + std::abs(reach) * 0x1p-48);
    };
    const auto either_way = [&](const Direction& n) { return separates(n) || separates({-n.x, -n.y, -n.z}); };
    const auto product = [](const Direction& a, const Direction& b) {
        return Direction{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const auto edge = [&](std::size_t from, std::size_t to) {
        const double(&a)[3] = box.corners[from], (&b)[3] = box.corners[to];
        return Direction{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    };
    for (const Direction& n : filter.sides(x0, x1, y0, y1))
        if (separates(n)) return true;
    const Direction h0 = edge(6, 7), h1 = edge(5, 7), sides[] = {edge(3, 7), edge(0, 4), edge(1, 5), edge(2, 6)};
    if (either_way(product(h0, h1))) return true;
    for (const Direction& side : sides)
        if (either_way(product(h0, side)) || either_way(product(h1, side))) return true;
    for (const Direction& of_cell : filter.edges(x0, x1, y0, y1)) {
        if (either_way(product(h0, of_cell)) || either_way(product(h1, of_cell))) return true;
        for (const Direction& side : sides)
            if (either_way(product(side, of_cell))) return true;
    }
    return false;
}

}  // namespace oracle
