// SPDX-License-Identifier: MIT
// Random lights that are easily missed, in view space or in a world space, and points inside them.
#pragma once

#include "camera.hpp"

#include <cstdint>
#include <vector>

namespace hunt {

using lightbin::Sphere;
using Long = long double;

/// A point inside a light, in the space in which the lights are given.
struct Inside {
    std::uint32_t light;
    Point point;
};

struct Scene {
    bool in_world = false;  ///< the lights are given in world space, with the matrix `to_view`
    glm::dmat4 to_view = glm::dmat4(1);
    bool in_float = false;  ///< the matrix is given as floats
    std::vector<Sphere> lights;
    std::vector<Inside> inside;
};

inline Long dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point plus(const Point& a, const Point& b, Long times = 1) {
    return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}
inline Long length(const Point& a) {
    return std::sqrt(dot(a, a));
}
inline Point centre(const Sphere& light) {
    return {light.x, light.y, light.z};
}
inline Point direction(Random& random) {
    for (;;) {
        const Point p = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        if (const Long size = length(p); size > 0.1L && size < 1) return plus({}, p, 1 / size);
    }
}

/// Returns whether the documentation says that no list has this light: it is bad input or switched off.
inline bool is_unlit(const Sphere& light) {
    return !std::isfinite(light.x) || !std::isfinite(light.y) || !std::isfinite(light.z) || !(light.radius >= 0);
}

/// Returns whether the documentation calls this light bad input, which is skipped and counted.
inline bool is_bad(const Sphere& light) {
    return is_unlit(light) && light.radius != -1;
}

/// Returns true only if a point is certainly in a sphere or on its surface.
inline bool surely_inside(const Sphere& light, const Point& point) {
    if (is_unlit(light)) return false;
    if (light.radius == infinite) return true;
    Real square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Real off = Real(point[i]) - Real(centre(light)[i]);
        square = square + off * off;
    }
    const Real radius = static_cast<Long>(light.radius);
    return surely_at_most(square, radius * radius);
}

inline RealPoint in_view_space(const Scene& scene, const Point& point) {
    RealPoint moved;
    for (std::size_t row = 0; row < 3; ++row) {
        moved[row] = point[row];
        if (!scene.in_world) continue;
        const int r = static_cast<int>(row);
        moved[row] = static_cast<Long>(scene.to_view[3][r]);
        for (int column = 0; column < 3; ++column)
            moved[row] = moved[row] + Real(static_cast<Long>(scene.to_view[column][r])) *
                                          Real(point[static_cast<std::size_t>(column)]);
    }
    return moved;
}

/// Makes a world-to-view matrix: rotated, mirrored, scaled, sheared or flat, near its origin or far from it, or the
/// identity.
inline glm::dmat4 make_world(double reach, Random& random) {
    glm::dmat4 m(1);
    for (int mirror = 0; mirror < 2 && !random.one_in(4); ++mirror) {  // two make a rotation
        const Point n = direction(random);
        const glm::dvec3 v(n[0], n[1], n[2]);
        m = m * (glm::dmat4(1) - 2.0 * glm::dmat4(glm::outerProduct(v, v)));
        m[3] = glm::dvec4(0, 0, 0, 1);
    }
    if (random.one_in(3)) m[random.below(3)] *= random.pick({-1.0, 0.0, random.log_between(1e-3, 10)});
    if (random.one_in(6)) m[0] += random.between(-2, 2) * m[1] + random.between(-2, 2) * m[2];
    if (random.one_in(3)) {  // in the last case squares are more than a double holds
        const double scale =
            random.pick({0.01, 3.0, random.log_between(1e-30, 1e30), random.log_between(1e140, 1e300)});
        for (int i = 0; i < 3; ++i)
            m[i] *= scale;
    }
    const double away = reach * random.pick({0.0, 0.1, 1.0, 10.0, random.log_between(100, 1e9)});
    for (int row = 0; row < 3; ++row)
        m[3][row] = away * random.between(-1, 1);
    return m;
}

/// Makes lights and points for a camera.
class Maker {
public:
    Maker(const Camera& camera, Scene& scene, Random& random) : camera_(camera), scene_(scene), random_(random) {
        if (!scene.in_world) return;
        // The inverse: the cofactors of the matrix over its determinant.
        const glm::dmat4& m = scene.to_view;
        const auto at = [&](int row, int column) { return static_cast<Long>(m[column % 3][row % 3]); };
        const auto cofactor = [&](int row, int column) {
            return at(row + 1, column + 1) * at(row + 2, column + 2) -
                   at(row + 1, column + 2) * at(row + 2, column + 1);
        };
        Long determinant = 0;
        for (int i = 0; i < 3; ++i)
            determinant += at(0, i) * cofactor(0, i);
        regular_ = determinant != 0;
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 3; ++column)
                inverse_[row][column] = cofactor(static_cast<int>(column), static_cast<int>(row)) / determinant;
    }

    /// Makes `count` lights. At most `large` of them may cover the whole window; the others cover some tiles.
    void make_lights(std::uint32_t count, std::uint32_t large) {
        const bool seen = camera_.viewport.width > 0 && camera_.viewport.height > 0 && regular_;
        for (std::uint32_t id = 0; id < count; ++id) {
            const bool small = id >= large;
            if (seen && (small || random_.coin())) {
                Point point;
                scene_.lights.push_back(touching(small, point));
                if (scene_.inside.size() < 2000) scene_.inside.push_back({id, point});
            } else {
                scene_.lights.push_back(any_light());
            }
        }
        if (large == 0) return;
        if (random_.coin()) scene_.lights[random_.below(std::size_t{large})].radius = infinite;
        // The large lights replace some lights anywhere among the small ones.
        for (std::uint32_t i = 0; large < count && i < std::min(large, 64u); ++i) {
            const std::uint32_t j = static_cast<std::uint32_t>(random_.below(std::size_t{count}));
            std::swap(scene_.lights[i], scene_.lights[j]);
            for (Inside& inside : scene_.inside)
                inside.light = inside.light == i ? j : inside.light == j ? i : inside.light;
        }
    }

    /// Adds points of some lights: the centre, random points, and points that are seen farthest out; also random points
    /// in view with the lights around them.
    void find_points() {
        const std::uint32_t count = static_cast<std::uint32_t>(scene_.lights.size()), some = std::min(count, 3000u);
        if (count == 0 || camera_.viewport.width == 0 || camera_.viewport.height == 0) return;
        for (int i = 0; i < 40; ++i) {
            const std::uint32_t id = static_cast<std::uint32_t>(random_.below(std::size_t{count}));
            const Sphere& light = scene_.lights[id];
            if (!is_unlit(light) && light.radius != infinite) {
                const Long reach = static_cast<Long>(light.radius) * random_.log_between(1e-3, 1);
                scene_.inside.push_back({id, centre(light)});
                scene_.inside.push_back({id, extreme_point(light)});
                scene_.inside.push_back({id, plus(centre(light), direction(random_), reach)});
            }
            const Point at = from_view(any_point());
            const std::uint32_t first = static_cast<std::uint32_t>(random_.below(std::size_t{count - some + 1}));
            for (std::uint32_t other = first; other < first + some; ++other)
                if (surely_inside(scene_.lights[other], at)) scene_.inside.push_back({other, at});
        }
    }

private:
    /// Moves a point from view space to the lights' space, about. Without an inverse matrix it stays in place.
    Point from_view(const Point& p) const {
        if (!scene_.in_world || !regular_) return p;
        const glm::dvec4& moved = scene_.to_view[3];
        const Point q = plus(p, {moved[0], moved[1], moved[2]}, -1);
        return {dot(inverse_[0], q), dot(inverse_[1], q), dot(inverse_[2], q)};
    }

    /// Returns a view depth for a light or point: random, or right at the near or far plane.
    Long pick_depth() {
        const Long near_depth = camera_.near_hint, far_depth = camera_.far_hint,
                   step = random_.log_between(0x1p-45, 0x1p-3);
        if (camera_.orthographic)
            return near_depth +
                   (far_depth - near_depth) * random_.pick<Long>({step, 1 - step, random_.unit(), random_.unit()});
        if (random_.one_in(6)) return near_depth * (1 + step);
        if (std::isfinite(far_depth) && random_.one_in(6)) return far_depth * (1 - step);
        const double most =
            std::isfinite(far_depth) ? camera_.far_hint : camera_.near_hint * random_.pick({1e6, 1e6, 1e40});
        return random_.log_between(camera_.near_hint, std::clamp(most, camera_.near_hint * 1.0000001, 1e37));
    }
    Point any_point() {
        return point_at(camera_, random_.unit() * camera_.viewport.width, random_.unit() * camera_.viewport.height,
                        pick_depth());
    }

    /// Returns a light that barely contains a point of a tile. The point is often beside an edge or a corner of the
    /// tile, with the light beyond that edge, or before or behind the point.
    Sphere touching(bool small, Point& point) {
        const int sides[] = {camera_.viewport.width, camera_.viewport.height};
        int outward[2];
        Long at[2];
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const Long size = tile_side(camera_, axis);
            const int tiles = static_cast<int>(std::ceil(sides[axis] / size)),
                      tile = random_.one_in(6) ? random_.pick({0, tiles - 1}) : random_.below(tiles);
            outward[axis] = random_.from_to(-1, 1);
            const double step = random_.log_between(0x1p-28, 0x1p-3);
            const double place = outward[axis] < 0 ? step : outward[axis] > 0 ? 1 - step : random_.between(0.01, 0.99);
            const Long from = tile * size, end = std::min<Long>(from + size, sides[axis]);
            at[axis] = from + (end - from) * place;
            // Where tiles are no whole pixels, it is the edge of the tile's pixels that counts.
            const Long inward = -outward[axis] * step;
            if (size != std::floor(size) && inward != 0) at[axis] = std::round(at[axis] + inward) + inward;
            at[axis] = std::clamp<Long>(at[axis], 0, sides[axis]);
        }
        const Long depth = pick_depth();
        const Point seen_at = point_at(camera_, at[0], at[1], depth);

        // Directions at right angles to the planes through the eye and the tile's edges, and the direction of depth.
        Point away = {0, 0, random_.pick({0.0, 0.0, random_.between(-1, 1)})};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (outward[axis] == 0) continue;
            const Long step = outward[axis] * 0.001L * tile_side(camera_, axis);
            const std::size_t own = camera_.turned ? 1 - axis : axis;
            const Point beside =
                point_at(camera_, at[0] + (axis == 0 ? step : 0), at[1] + (axis == 1 ? step : 0), depth);
            Point normal = {};
            normal[own] = beside[own] < seen_at[own] ? -1 : 1;
            if (!camera_.orthographic) {
                Point ray = seen_at;
                ray[1 - own] = 0;
                normal = plus(normal, ray, -dot(normal, ray) / dot(ray, ray));
            }
            away = plus(away, normal, random_.pick({1.0, random_.unit()}) / length(normal));
        }
        if (!(length(away) > 0)) away = direction(random_);
        away = plus({}, away, 1 / length(away));

        // About a tile's width at that depth: a light with this radius covers few tiles.
        const std::size_t of_x = camera_.turned ? 1 : 0;
        const Long across =
                       std::fabs(point_at(camera_, at[0] + tile_side(camera_, 0), at[1], depth)[of_x] - seen_at[of_x]),
                   up = std::fabs(point_at(camera_, at[0], at[1] + tile_side(camera_, 1), depth)[1 - of_x] -
                                  seen_at[1 - of_x]),
                   slope = camera_.orthographic ? 0 : length({seen_at[0], seen_at[1], 0}) / std::fabs(seen_at[2]),
                   tile_reach = std::min(across, up) / (1 + slope);
        Long most = 30 * tile_reach;
        if (!small && random_.one_in(3)) most = std::max<Long>(most, 10 * length(seen_at));
        if (small)
            most = std::min<Long>(1.2L * tile_reach, camera_.orthographic ? most : (depth - camera_.near_hint) / 4);
        return holding(seen_at, away, std::min(1e-4L * tile_reach, most), most, point);
    }

    /// Makes lights that contain the point, in one direction from it; returns the one that rounding enlarges least.
    Sphere holding(const Point& in_view, const Point& away, Long least, Long most, Point& point) {
        point = from_view(in_view);
        Sphere best = {};
        Long best_excess = 2;
        for (int i = 0; i < 4; ++i) {
            const Long radius = random_.log_between(std::max(1e-44, static_cast<double>(least)),
                                                    std::clamp(static_cast<double>(most), 1e-43, 1e38));
            Sphere light = sphere(from_view(plus(in_view, away, radius)), 0);
            const Long reach = length(plus(point, centre(light), -1));
            light.radius = float_up(reach * (1 + 0x1p-58L));
            const Long excess = (light.radius - reach) / reach;
            if (i > 0 && !(excess < best_excess)) continue;
            best = light;
            best_excess = excess;
        }
        return best;
    }

    /// Returns a random light, tiny or huge; some are around the eye, with special numbers, or twice in the same place.
    Sphere any_light() {
        if (random_.one_in(12) && !scene_.lights.empty()) return scene_.lights[random_.below(scene_.lights.size())];
        const Point at = any_point();
        const Long reach = std::max(length(at), 1e-30L) * random_.pick({1.0, random_.log_between(1e-12, 1e6)});
        Sphere light =
            sphere(from_view(random_.one_in(6) ? plus({}, direction(random_), reach * random_.unit())
                                               : plus(at, direction(random_), reach * random_.between(0, 1.5))),
                   reach);
        for (float* number : {&light.x, &light.y, &light.z, &light.radius})
            if (random_.one_in(8)) *number = nasty_float(random_);
        return light;
    }
    static Sphere sphere(const Point& at, Long radius) {
        return {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                static_cast<float>(radius)};
    }

    /// Returns the point of a light that is seen farthest in a direction of the window, found by trying.
    Point extreme_point(const Sphere& light) {
        const Long inner = static_cast<Long>(light.radius) * (1 - random_.log_between(0x1p-50, 0x1p-10));
        const Point goal = direction(random_);
        const auto worth = [&](const Point& unit) -> Long {
            const auto seen = see(camera_, in_view_space(scene_, plus(centre(light), unit, inner)));
            return seen ? goal[0] * seen->x.value + goal[1] * seen->y.value : -std::numeric_limits<Long>::infinity();
        };
        Point best = direction(random_);
        Long best_worth = worth(best), step = 1;
        for (int i = 0; i < 60; ++i, step *= 0.85L) {
            Point next = plus(best, direction(random_), step);
            next = plus({}, next, 1 / length(next));
            if (const Long here = worth(next); here >= best_worth) best = next, best_worth = here;
        }
        return plus(centre(light), best, inner);
    }

    const Camera& camera_;
    Scene& scene_;
    Random& random_;
    Point inverse_[3] = {};
    bool regular_ = true;
};

/// Makes `count` lights, at most `large` of which may cover the whole window, and points inside them.
inline Scene make_scene(const Camera& camera, std::uint32_t count, std::uint32_t large, Random& random) {
    Scene scene;
    // Where everything else is tiny, a matrix' margin makes radii large, so these scenes get few lights.
    if (random.one_in(4) || (large < count && std::fabs(camera.near_hint) < 1e-30)) {
        Maker(camera, scene, random).make_lights(count, large);
        return scene;
    }
    scene.in_world = true;
    scene.to_view = make_world(std::clamp(std::fabs(camera.near_hint), 1e-20, 1e20) * 100, random);
    double largest = 0;
    for (int entry = 0; entry < 9; ++entry)
        largest = std::max(largest, std::fabs(scene.to_view[entry / 3][entry % 3]));
    scene.in_float = random.coin() && largest < 1e37;
    if (scene.in_float) scene.to_view = glm::dmat4(glm::mat4(scene.to_view));
    Maker(camera, scene, random).make_lights(count, large);
    return scene;
}

}  // namespace hunt
