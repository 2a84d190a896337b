// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <string_view>

namespace hunt {
namespace {

using Long = long double;

// The first six are made to touch something.
constexpr const char* light_kinds[] = {
    "touches an edge", "touches a corner", "touches a depth", "touches all ways", "crosses near", "beyond far", "around",
    "eye inside", "tiny", "huge", "denormal", "infinite", "bad input", "on an axis", "largest", "the same again", "nasty"};

Long dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point plus(const Point& a, const Point& b, Long times = 1) {
    return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}
Long length(const Point& a) {
    return std::sqrt(dot(a, a));
}
Point direction(Random& random) {
    for (;;) {
        const Point p = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        if (const Long long_is = length(p); long_is > 0.1L && long_is < 1) return plus({}, p, 1 / long_is);
    }
}

/// View space to the space of the lights, about.
class FromView {
public:
    explicit FromView(const glm::dmat4& m) {
        const auto at = [&](int row, int column) { return static_cast<Long>(m[column % 3][row % 3]); };
        Long determinant = 0;
        for (int i = 0; i < 3; ++i)
            determinant += at(0, i) * (at(1, i + 1) * at(2, i + 2) - at(1, i + 2) * at(2, i + 1));
        regular_ = determinant != 0;
        for (int row = 0; row < 3; ++row) {
            moved_[static_cast<std::size_t>(row)] = m[3][row];
            for (int column = 0; column < 3; ++column)
                inverse_[row][column] = (at(column + 1, row + 1) * at(column + 2, row + 2) -
                                         at(column + 1, row + 2) * at(column + 2, row + 1)) /
                                        determinant;
        }
    }
    bool regular() const { return regular_; }
    Point operator()(const Point& p) const {
        const Point q = plus(p, moved_, -1);
        Point world;
        for (std::size_t row = 0; row < 3; ++row)
            world[row] = inverse_[row][0] * q[0] + inverse_[row][1] * q[1] + inverse_[row][2] * q[2];
        return world;
    }

private:
    Long inverse_[3][3];
    Point moved_;
    bool regular_;
};

glm::dmat4 make_world(std::string_view kind, double reach, Random& random) {
    // Two mirrors make a rotation.
    glm::dmat4 m(1);
    for (int mirror = 0; mirror < 2; ++mirror) {
        const Point n = direction(random);
        glm::dmat4 h(1);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                h[i][j] -=
                    static_cast<double>(2 * n[static_cast<std::size_t>(i)] * n[static_cast<std::size_t>(j)]);
        m = m * h;
    }
    if (random.one_in(4)) m = glm::dmat4(1);
    if (kind == "scaled")
        for (int i = 0; i < 3; ++i)
            m[i] *= random.pick({0.01, 0.5, 3.0, 1000.0}) + 0 * i;
    if (kind == "extreme scale" || kind == "vast scale") {  // vast: squares are more than a double holds
        const double by =
            kind == "vast scale" ? random.log_between(1e140, 1e300) : random.log_between(1e-30, 1e30);
        for (int i = 0; i < 3; ++i)
            m[i] *= by;
    }
    if (kind == "mirrored") m[random.below(3)] *= -1.0;
    if (kind == "sheared") m[0] += random.between(-2, 2) * m[1] + random.between(-2, 2) * m[2];
    if (kind == "squashed") m[random.below(3)] *= random.log_between(1e-3, 10);
    if (kind == "flat") m[random.below(3)] *= 0.0;
    double away = reach * random.pick({0.0, 0.1, 1.0, 10.0});
    if (kind == "far from origin") away = reach * random.log_between(100, 1e9);
    for (int row = 0; row < 3; ++row)
        m[3][row] = away * random.between(-1, 1);
    return m;
}

/// A view depth to put something at: anywhere, or right at the planes.
Long pick_depth(const Camera& camera, Random& random) {
    const Long near_depth = camera.near_hint, far_depth = camera.far_hint,
               step = random.log_between(0x1p-45, 0x1p-3);
    if (camera.orthographic) {
        const Long all = far_depth - near_depth;
        return random.one_in(6)   ? near_depth + all * step
               : random.one_in(6) ? far_depth - all * step
                                  : near_depth + all * random.unit();
    }
    if (random.one_in(8)) return near_depth * (1 + step);
    if (random.one_in(8) && std::isfinite(far_depth)) return far_depth * (1 - step);
    if (!std::isfinite(far_depth) && random.one_in(8))  // where what a depth buffer holds has few bits
        return std::min(near_depth * random.log_between(0x1p120, 0x1p150), 1e37L);
    const double most = std::isfinite(camera.far_hint) ? camera.far_hint
                        : random.one_in(4)             ? 1e37
                                                       : camera.near_hint * 1e6;
    return random.log_between(camera.near_hint, std::clamp(most, camera.near_hint * 1.0000001, 1e37));
}

class Maker {
public:
    Maker(const Camera& camera, const Scene& scene, Random& random)
        : camera_(camera), scene_(scene), from_view_(scene.to_view), random_(random) {}

    /// A light that holds a chosen point of a tile, but hardly more.
    Sphere touching(std::string_view kind, bool small, Point& point) {
        // Near a tile's edge or two, so that next to nothing of the light is in the tile.
        const int size = camera_.options.tile_size;
        int outward[2] = {};
        Long at[2];
        const int sides[] = {camera_.viewport.width, camera_.viewport.height};
        for (int axis = 0; axis < 2; ++axis) {
            const int tiles = (sides[axis] - 1) / size + 1;
            const int tile = random_.one_in(6) ? random_.pick({0, tiles - 1}) : random_.below(tiles);
            const bool near_edge = kind == "touches an edge" ? (axis == 0) == edge_of_x_
                                                             : kind == "touches a corner" || random_.coin();
            const double step = random_.log_between(0x1p-28, 0x1p-3);
            double place = random_.between(0.01, 0.99);
            if (near_edge) {
                outward[axis] = random_.coin() ? 1 : -1;
                place = outward[axis] < 0 ? step : 1 - step;
            }
            const Long from = static_cast<Long>(tile) * size, end = std::min<Long>(from + size, sides[axis]);
            at[axis] = from + (end - from) * place;
        }
        edge_of_x_ = !edge_of_x_;
        Long depth = pick_depth(camera_, random_);
        if (kind == "crosses near")
            depth = camera_.near_hint + std::fabs(camera_.near_hint) * random_.log_between(0x1p-30, 0x1p-2);
        if (kind == "beyond far" && std::isfinite(camera_.far_hint))
            depth = camera_.far_hint - std::fabs(camera_.far_hint) * random_.log_between(0x1p-30, 0x1p-2);
        const Point seen_at = point_at(camera_, at[0], at[1], depth);

        // Away from it: square to the planes through the eye and the tile's edges, along the depth, or any.
        Point away = {};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (outward[axis] == 0) continue;
            const Long step = outward[axis] * 0.001L * size;
            const Point beside =
                point_at(camera_, at[0] + (axis == 0 ? step : 0), at[1] + (axis == 1 ? step : 0), depth);
            Point normal = {};
            normal[axis] = beside[axis] < seen_at[axis] ? -1 : 1;
            if (!camera_.orthographic) {
                Point ray = seen_at;
                ray[1 - axis] = 0;
                normal = plus(normal, ray, -dot(normal, ray) / dot(ray, ray));
                normal = plus({}, normal, 1 / length(normal));
            }
            away = plus(away, normal,
                        kind == "touches a corner" || kind == "touches all ways" ? random_.unit() : 1);
        }
        if (kind == "touches a depth") away = {0, 0, static_cast<Long>(random_.sign())};
        if (kind == "touches all ways") away[2] += random_.between(-1, 1);
        if (kind == "crosses near") away = plus(away, {0, 0, -camera_.toward}, random_.between(0, 3));
        if (kind == "beyond far") away = plus(away, {0, 0, camera_.toward}, random_.between(0, 3));
        if (!(length(away) > 0)) away = direction(random_);
        away = plus({}, away, 1 / length(away));

        const Long tile_reach = this->tile_reach(at[0], at[1], depth);
        Long least = 1e-4L * tile_reach, most = 30 * tile_reach;
        if (!small && random_.one_in(3)) most = std::max<Long>(most, 10 * length(seen_at));
        if (small)
            most = std::min<Long>(1.2L * tile_reach,
                                  camera_.orthographic ? most : (depth - camera_.near_hint) / 4);
        return holding(seen_at, away, std::min(least, most), most, point);
    }

    /// Lights of other kinds: no point goes with them.
    Sphere other(std::string_view kind) {
        const Long x = random_.unit() * camera_.viewport.width, y = random_.unit() * camera_.viewport.height;
        const Long depth = pick_depth(camera_, random_);
        const Point at = point_at(camera_, x, y, depth);
        const Long reach = std::max(length(at), tile_reach(x, y, depth));
        const float nasty[] = {nasty_float(random_), nasty_float(random_), nasty_float(random_),
                               nasty_float(random_)};
        if (kind == "eye inside") {
            const Long radius = reach * random_.log_between(1e-3, 10);
            return moved(plus({}, direction(random_), radius * random_.unit()), radius);
        }
        if (kind == "tiny") return moved(at, reach * random_.log_between(1e-12, 1e-5));
        if (kind == "huge")
            return moved(plus(at, direction(random_), reach * 10), reach * random_.log_between(1, 1e6));
        if (kind == "denormal") {
            Sphere light = moved(at, random_.pick({0x1p-149L, 0x1p-140L, 0x1p-126L}));
            if (random_.coin()) light = {light.radius, -light.radius * 3, light.z, light.radius};
            if (random_.one_in(4)) light.z = random_.coin() ? 0x1p-149f : -0x1p-130f;
            return light;
        }
        if (kind == "infinite") return {nasty[0], nasty[1], nasty[2], infinite};
        if (kind == "bad input") {
            Sphere light = moved(at, reach);
            float* const numbers[] = {&light.x, &light.y, &light.z, &light.radius};
            const int which = random_.below(4);
            *numbers[which] = which == 3 ? random_.pick({-1.0f, -0x1p-149f, -infinite, std::nanf("")})
                                         : random_.pick({infinite, -infinite, std::nanf("")});
            return light;
        }
        if (kind == "on an axis") {
            Point axis = at;
            for (std::size_t i = 0; i < 3; ++i)
                if (random_.one_in(3)) axis[i] = random_.coin() ? 0.0L : -0.0L;
            return moved(axis, reach * random_.log_between(1e-3, 1));
        }
        if (kind == "largest") {
            constexpr float most = std::numeric_limits<float>::max();
            const auto one = [&] { return random_.pick({most, -most, most / 2, 0.0f, -most / 4, 1.0f}); };
            return {one(), one(), one(), std::fabs(one())};
        }
        if (kind == "nasty") return {nasty[0], nasty[1], nasty[2], nasty[3]};
        return moved(plus(at, direction(random_), reach * random_.log_between(1e-3, 3)),
                     reach * random_.log_between(1e-3, 2));
    }

    bool regular() const { return from_view_.regular(); }

private:
    /// About a tile's width at a point, as a radius whose light covers few tiles.
    Long tile_reach(Long x, Long y, Long depth) const {
        const Long size = camera_.options.tile_size;
        const Point here = point_at(camera_, x, y, depth);
        const Long across = std::fabs(point_at(camera_, x + size, y, depth)[0] - here[0]),
                   up = std::fabs(point_at(camera_, x, y + size, depth)[1] - here[1]);
        const Long slope = camera_.orthographic ? 0 : length({here[0], here[1], 0}) / std::fabs(here[2]);
        return std::min(across, up) / (1 + slope);
    }

    /// Of some lights of the point and a direction, the one whose rounding makes it the least larger than needed.
    Sphere holding(const Point& in_view, const Point& away, Long least, Long most, Point& point) {
        point = from_view_(in_view);
        Sphere best = {};
        Long best_excess = 2;
        for (int i = 0; i < 4; ++i) {
            const Long radius = random_.log_between(std::max(1e-44, static_cast<double>(least)),
                                                    std::clamp(static_cast<double>(most), 1e-43, 1e38));
            const Point centre = from_view_(plus(in_view, away, radius));
            Sphere light = {static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                            static_cast<float>(centre[2]), 0};
            const Long reach = length(plus(point, {light.x, light.y, light.z}, -1));
            light.radius = float_up(reach * (1 + 0x1p-58L));
            const Long excess = (light.radius - reach) / reach;
            if (i > 0 && !(excess < best_excess)) continue;
            best = light;
            best_excess = excess;
        }
        return best;
    }

    /// A sphere of view space, in the lights' space: about, as nothing is known of it.
    Sphere moved(const Point& centre, Long radius) const {
        const Point at = from_view_.regular() ? from_view_(centre) : centre;
        Long by = 1;
        if (scene_.in_world && from_view_.regular())
            by = length(plus(from_view_({1, 0, 0}), from_view_({}), -1));
        return {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                static_cast<float>(radius * by)};
    }

    const Camera& camera_;
    const Scene& scene_;
    FromView from_view_;
    Random& random_;
    bool edge_of_x_ = false;
};

/// The point of a light that is seen farthest in a direction of the window, as far as trying finds it.
Point extreme_point(const Camera& camera, const Scene& scene, const Sphere& light, Random& random) {
    const Point centre = {light.x, light.y, light.z};
    const Long inner = static_cast<Long>(light.radius) * (1 - random.log_between(0x1p-50, 0x1p-10));
    const Point goal = direction(random);
    const auto worth = [&](const Point& unit) -> Long {
        const auto seen = see(camera, in_view_space(scene, plus(centre, unit, inner)));
        if (!seen) return -std::numeric_limits<Long>::infinity();
        return goal[0] * seen->x.value + goal[1] * seen->y.value;
    };
    Point best = direction(random);
    Long best_worth = worth(best), step = 1;
    for (int i = 0; i < 60; ++i, step *= 0.85L) {
        Point next = plus(best, direction(random), step);
        next = plus({}, next, 1 / length(next));
        if (const Long here = worth(next); here >= best_worth) best = next, best_worth = here;
    }
    return plus(centre, best, inner);
}

}  // namespace

bool is_bad(const Sphere& light) {
    return !std::isfinite(light.x) || !std::isfinite(light.y) || !std::isfinite(light.z) ||
           std::isnan(light.radius) || light.radius < 0;
}

bool surely_inside(const Sphere& light, const Point& point) {
    if (is_bad(light)) return false;
    if (light.radius == infinite) return true;
    const Long centre[] = {light.x, light.y, light.z};
    Real square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Real off = Real(point[i]) - Real(centre[i]);
        square = square + off * off;
    }
    const Real radius = static_cast<Long>(light.radius);
    return surely_at_most(square, radius * radius);
}

RealPoint in_view_space(const Scene& scene, const Point& point) {
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

Scene make_scene(const Camera& camera, int space, std::uint32_t count, std::uint32_t large, Random& random) {
    Scene scene;
    std::string_view kind = space_kinds[space];
    // What a matrix adds to a radius is large where all else is next to nothing.
    if (large < count)
        kind = std::fabs(camera.near_hint) < 1e-30 || kind.starts_with("view") ? "view" : "rigid";
    if (!kind.starts_with("view")) {
        scene.in_world = true;
        const double reach = std::clamp(std::fabs(camera.near_hint), 1e-20, 1e20) * 100;
        scene.to_view = make_world(kind, reach, random);
        scene.in_float = random.coin() && kind != "vast scale";
        if (scene.in_float) scene.to_view = glm::dmat4(glm::mat4(scene.to_view));
    }
    Maker maker(camera, scene, random);
    scene.lights.reserve(count);
    constexpr int kinds = static_cast<int>(std::size(light_kinds)), touching = 6;
    const int shift = random.below(kinds);
    const bool empty = camera.viewport.width == 0 || camera.viewport.height == 0;
    for (std::uint32_t id = 0; id < count; ++id) {
        // Mostly lights that touch something: the others are there to be in the way.
        const bool small = id >= large;
        int light = random.coin() || small ? random.below(touching) : (static_cast<int>(id) + shift) % kinds;
        if ((empty || !maker.regular()) && light < touching) light = touching;
        if (small && light > 3) light = 0;
        const std::string_view name = light_kinds[light];
        if (light < touching) {
            Point point;
            scene.lights.push_back(maker.touching(name, small, point));
            if (scene.inside.size() < 2000) scene.inside.push_back({id, point});
        } else if (name == "the same again" && id > 0) {
            scene.lights.push_back(scene.lights[random.below(std::size_t{id})]);
        } else {
            scene.lights.push_back(maker.other(name));
        }
    }
    // One of infinite radius reaches each end of the grid.
    if (large > 0 && random.coin()) {
        const std::size_t id = random.below(std::size_t{large});
        scene.lights[id].radius = infinite;
    }
    // Lights that may be anywhere among those that are small.
    if (large > 0 && large < count)
        for (std::uint32_t i = 0; i < std::min(large, 64u); ++i) {
            const std::uint32_t j = static_cast<std::uint32_t>(random.below(std::size_t{count}));
            std::swap(scene.lights[i], scene.lights[j]);
            for (Inside& inside : scene.inside)
                inside.light = inside.light == i ? j : inside.light == j ? i : inside.light;
        }
    return scene;
}

void find_points(const Camera& camera, const Scene& scene, Random& random, std::vector<Inside>& points) {
    const std::uint32_t count = static_cast<std::uint32_t>(scene.lights.size());
    if (count == 0 || camera.viewport.width == 0 || camera.viewport.height == 0) return;
    for (int i = 0; i < 40; ++i) {
        const std::uint32_t id = static_cast<std::uint32_t>(random.below(std::size_t{count}));
        const Sphere& light = scene.lights[id];
        if (is_bad(light) || light.radius == infinite) continue;
        points.push_back({id, {light.x, light.y, light.z}});
        points.push_back({id, extreme_point(camera, scene, light, random)});
        const Long reach = static_cast<Long>(light.radius) * random.log_between(1e-3, 1);
        points.push_back({id, plus({light.x, light.y, light.z}, direction(random), reach)});
    }
    // Anywhere in view, in whatever lights there are.
    const FromView from_view(scene.to_view);
    const std::uint32_t some = std::min(count, 3000u);
    for (int i = 0; i < 40; ++i) {
        const Long x = random.unit() * camera.viewport.width, y = random.unit() * camera.viewport.height;
        Point at = point_at(camera, x, y, pick_depth(camera, random));
        if (scene.in_world && from_view.regular()) at = from_view(at);
        const std::uint32_t first = static_cast<std::uint32_t>(random.below(std::size_t{count - some + 1}));
        for (std::uint32_t id = first; id < first + some; ++id)
            if (surely_inside(scene.lights[id], at)) points.push_back({id, at});
    }
}

}  // namespace hunt
