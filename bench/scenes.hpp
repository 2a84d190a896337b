// SPDX-License-Identifier: MIT
// Kinds of scene that are hard for binning in different ways. Each has a camera, triangles for its depth buffer, and
// any number of light sets.
#pragma once

#include "sets.hpp"

#include <dice.hpp>

#include <lightbin/spot.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using Spots = std::vector<lightbin::Spot>;
using LightSet = std::variant<Lights, Spots>;  ///< spots if any of the lights is a spot

struct BenchScene {
    std::string name;
    glm::mat4 projection;              ///< OpenGL's: looks down -z, clip depth -1..1, near and far finite
    std::vector<glm::vec3> triangles;  ///< in view space, three corners each
    std::function<Lights(std::uint32_t seed)>
        lights;  ///< returns lights in view space from a seed; for spots their whole spheres
    std::function<Spots(std::uint32_t seed)> spots =
        {};  ///< returns the same lights as spots; empty if none is a spot

    LightSet light_set(std::uint32_t seed) const {
        if (spots) return spots(seed);
        return lights(seed);
    }
};

inline Lights whole_spheres(const Spots& spots) {
    Lights lights;
    for (const lightbin::Spot& s : spots)
        lights.emplace_back(s.x, s.y, s.z, s.radius);
    return lights;
}

inline Lights least_spheres(const Spots& spots) {
    Lights lights;
    for (const lightbin::Spot& spot : spots) {
        const lightbin::Sphere s = lightbin::bounding_sphere(spot);
        lights.emplace_back(s.x, s.y, s.z, s.radius);
    }
    return lights;
}

/// Returns a spot moved by a rigid matrix.
inline lightbin::Spot moved(const glm::dmat4& matrix, const lightbin::Spot& s) {
    const glm::vec3 centre(matrix * glm::dvec4(s.x, s.y, s.z, 1)),
        axis(glm::dmat3(matrix) * glm::dvec3(s.axis_x, s.axis_y, s.axis_z));
    return {centre.x, centre.y, centre.z, s.radius, axis.x, axis.y, axis.z, s.cos_half_angle};
}

/// Builds a scene in a world with y up, on a ground at y = 0.
class SceneBuilder {
public:
    SceneBuilder(glm::dvec3 eye, glm::dvec3 at, glm::dvec3 up = {0, 1, 0})
        : to_view_(glm::lookAt(eye, at, up)) {
        quad({-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
    }

    void quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
        for (const glm::vec3 p : {corner, corner + a, corner + a + b, corner, corner + a + b, corner + b})
            triangles_.push_back(glm::vec3(to_view_ * glm::dvec4(p, 1)));
    }

    void box(glm::vec3 low, glm::vec3 high) {
        const glm::vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
        for (const glm::vec3 from : {low, high}) {
            const float sign = from == low ? 1.0f : -1.0f;
            quad(from, sign * x, sign * y);
            quad(from, sign * y, sign * z);
            quad(from, sign * z, sign * x);
        }
    }

    /// Returns the scene with lights: place(dice, i) returns the world-space sphere of light i.
    template <class Place> BenchScene scene(std::string name, std::size_t count, Place place) && {
        const auto lights = [count, place, to_view = to_view_](std::uint32_t seed) {
            Dice dice(seed);
            Lights set;
            for (std::size_t i = 0; i < count; ++i) {
                const glm::vec4 sphere = place(dice, i);
                set.emplace_back(glm::vec3(to_view * glm::dvec4(glm::vec3(sphere), 1)), sphere.w);
            }
            return set;
        };
        return {std::move(name), projection(), std::move(triangles_), lights};
    }

    /// Returns the scene with spots: place(dice, i) returns the world-space spot of light i.
    template <class Place> BenchScene spot_scene(std::string name, std::size_t count, Place place) && {
        const auto spots = [count, place, to_view = to_view_](std::uint32_t seed) {
            Dice dice(seed);
            Spots set;
            for (std::size_t i = 0; i < count; ++i)
                set.push_back(moved(to_view, place(dice, i)));
            return set;
        };
        return {std::move(name), projection(), std::move(triangles_),
                [spots](std::uint32_t seed) { return whole_spheres(spots(seed)); }, spots};
    }

private:
    static glm::mat4 projection() {
        return glm::perspectiveRH_NO(2 * std::atan(tan_half_fov), aspect, 0.1f, 1000.0f);
    }

    glm::dmat4 to_view_;
    std::vector<glm::vec3> triangles_;
};

namespace scenes {

inline SceneBuilder plain_with_boxes() {
    SceneBuilder world({0, 14, 40}, {0, 0, -40});
    Dice dice(1);
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 at = dice.between({-90, 0, -170}, {90, 0, 15});
        world.box(at, at + dice.between({4, 3, 4}, {11, 16, 11}));
    }
    return world;
}

inline SceneBuilder street_canyon() {
    SceneBuilder world({1.5, 1.8, 6}, {0, 3, -60});
    Dice dice(2);
    for (int i = 0; i < 14; ++i)
        for (const float side : {-1.0f, 1.0f}) {
            const float z = -24.0f * static_cast<float>(i), near = side * dice.between(8, 10);
            const glm::vec3 a(near, 0, z - 20), b(near + side * 14, dice.between(8, 30), z + 2);
            world.box(glm::min(a, b), glm::max(a, b));
        }
    for (int i = 0; i < 40; ++i) {  // parked cars
        const glm::vec3 at(i % 2 == 0 ? -6.5f : 5.0f, 0, -8.0f * static_cast<float>(i / 2) - 4);
        world.box(at, at + glm::vec3(1.6f, 1.4f, dice.between(3.5f, 5)));
    }
    return world;
}

/// Returns a street lamp or a lamp in a room behind the walls.
inline glm::vec4 street_light(Dice& dice, std::size_t i) {
    if (i % 3 != 0) return {dice.between({-8, 2, -300}, {8, 5, 0}), dice.about(7, 1.5f)};
    const float side = dice.between(0, 1) < 0.5f ? -1.0f : 1.0f;
    return {side * dice.between(11, 22), dice.between(1, 20), dice.between(-300, 0), dice.about(5, 1.5f)};
}

/// Makes ground with boxes on it and lights above it, some of them beside the view.
inline BenchScene field_with_depth() {
    return plain_with_boxes().scene("field", 4000, [](Dice& dice, std::size_t) {
        return glm::vec4(dice.between({-160, 0.5f, -260}, {160, 6, 50}), dice.about(6, 2));
    });
}

/// Makes a view straight down on low boxes, with all lights close to the ground, where a depth test helps least.
inline BenchScene top_down() {
    SceneBuilder world({0, 60, 0}, {0, 0, 0}, {0, 0, -1});
    Dice dice(3);
    for (int i = 0; i < 120; ++i) {
        const glm::vec3 at = dice.between({-70, 0, -40}, {70, 0, 40});
        world.box(at, at + dice.between({1, 0.5f, 1}, {6, 5, 6}));
    }
    return std::move(world).scene("top-down", 2000, [](Dice& lights, std::size_t) {
        return glm::vec4(lights.between({-80, 0.3f, -50}, {80, 4, 50}), lights.about(4, 2));
    });
}

inline BenchScene street() {
    return street_canyon().scene("street", 1000, street_light);
}

/// Makes a corridor with a doorway every 8 m. Most lights are in the rooms behind its walls.
inline BenchScene corridor() {
    SceneBuilder world({0.3, 1.7, 0}, {0, 1.6, -50});
    world.quad({-2, 0, 4}, {0, 0, -70}, {0, 3, 0});
    world.quad({2, 0, 4}, {0, 3, 0}, {0, 0, -70});
    world.quad({-2, 3, 4}, {0, 0, -70}, {4, 0, 0});
    world.quad({-2, 0, -66}, {4, 0, 0}, {0, 3, 0});
    for (float z = -6; z > -66; z -= 8) {
        world.box({-2, 0, z}, {-1.2f, 3, z + 0.3f});
        world.box({1.2f, 0, z}, {2, 3, z + 0.3f});
        world.box({-1.2f, 2.3f, z}, {1.2f, 3, z + 0.3f});
    }
    return std::move(world).scene("corridor", 500, [](Dice& dice, std::size_t i) {
        if (i % 8 == 0) return glm::vec4(dice.between({-1.5f, 2, -62}, {1.5f, 2.8f, 2}), dice.about(4, 1.5f));
        return glm::vec4(dice.between({-30, 0.3f, -66}, {30, 2.8f, 4}), dice.about(4, 1.5f));
    });
}

/// Makes thin leaves in front of ground and a far wall. Most tiles show both, so their depths have a wide gap.
inline BenchScene foliage() {
    SceneBuilder world({0, 3, 0}, {0, 4, -30});
    world.quad({-300, 0, -110}, {600, 0, 0}, {0, 80, 0});
    Dice dice(4);
    for (int i = 0; i < 1500; ++i) {
        const float z = -dice.between(3, 28), width = dice.between(0.02f, 0.12f);
        const glm::vec3 at(z * dice.between(-1.1f, 1.1f), dice.between(0, 14), z);
        const glm::vec3 along = dice.between({-1, -1, -0.4f}, {1, 1, 0.4f});
        const glm::vec3 across(-along.y, along.x, dice.between(-0.5f, 0.5f));
        world.quad(at, along, across * width);
    }
    return std::move(world).scene("foliage", 1500, [](Dice& lights, std::size_t i) {
        if (i % 2 == 0) return glm::vec4(lights.between({-25, 0.5f, -28}, {25, 14, -3}), lights.about(2, 2));
        return glm::vec4(lights.between({-120, 0.5f, -110}, {120, 30, -28}), lights.about(7, 2));
    });
}

/// A spot as an author gives it. Made with braces: compilers then draw the random numbers in one order.
struct Beam {
    glm::vec3 from;
    float range;
    glm::vec3 way;
    float half_degrees;

    operator lightbin::Spot() const {
        return {from.x, from.y, from.z, range, way.x, way.y, way.z, std::cos(glm::radians(half_degrees))};
    }
};

/// Makes a street at night: lamps above it, head lamps, lights up the walls, and lamps in rooms behind them.
inline BenchScene street_lamps() {
    return street_canyon().spot_scene("lamps", 1000, [](Dice& dice, std::size_t i) {
        const float side = dice.between(0, 1) < 0.5f ? -1.0f : 1.0f, z = dice.between(-300, 0);
        const glm::vec3 tilt = dice.between({-0.15f, 0, -0.15f}, {0.15f, 0, 0.15f});
        switch (i % 4) {
        case 0:
            return Beam{{side * dice.between(5, 7), dice.between(5, 7), z},
                        dice.about(11, 1.3f),
                        tilt + glm::vec3(-0.2f * side, -1, 0),
                        dice.between(50, 70)};
        case 1:
            return Beam{{side * dice.between(1.5f, 4), 0.7f, z},
                        dice.about(25, 1.3f),
                        {0.3f * tilt.x, dice.between(-0.15f, -0.05f), -side},
                        dice.between(15, 28)};
        case 2:
            return Beam{{side * 7.9f, dice.between(0.2f, 4), z},
                        dice.about(12, 1.4f),
                        tilt + glm::vec3(0.05f * side, 1, 0),
                        dice.between(10, 25)};
        default:
            return Beam{{side * dice.between(11, 22), dice.between(2.5f, 20), z},
                        dice.about(5, 1.5f),
                        tilt + glm::vec3(0, -1, 0),
                        dice.between(30, 60)};
        }
    });
}

/// Makes a stage seen from the hall: narrow beams from above, wide floodlights, and a few lights towards the hall.
inline BenchScene stage() {
    SceneBuilder world({0, 4, 32}, {0, 4, -5});
    world.box({-16, 0, -14}, {16, 1.4f, 8});
    world.quad({-22, 0, -14}, {44, 0, 0}, {0, 18, 0});
    for (const float x : {-17.0f, 15.0f})
        world.box({x, 0, -2}, {x + 2, 14, 0});
    Dice dice(5);
    for (int i = 0; i < 24; ++i) {  // the band, and what it stands on
        const glm::vec3 at = dice.between({-13, 1.4f, -11}, {12, 1.4f, 5});
        world.box(at, at + dice.between({0.4f, 0.5f, 0.4f}, {2.5f, 2.2f, 1.5f}));
    }
    for (int i = 0; i < 200; ++i) {  // the audience
        const glm::vec3 at = dice.between({-20, 0, 11}, {20, 0, 27});
        world.box(at, at + glm::vec3(0.5f, dice.between(1.5f, 1.9f), 0.35f));
    }
    return std::move(world).spot_scene("stage", 500, [](Dice& lights, std::size_t i) {
        const glm::vec3 truss = lights.between({-15, 12, -12}, {15, 13, 8}),
                        to = lights.between({-14, 1, -13}, {14, 3, 7});
        if (i % 8 == 0)  // towards the hall
            return Beam{truss, 45, lights.between({-18, 0, 10}, {18, 4, 40}) - truss, lights.between(3, 7)};
        if (i % 8 < 6) return Beam{truss, lights.about(22, 1.2f), to - truss, lights.between(3, 10)};
        return Beam{truss, lights.about(17, 1.2f), to - truss, lights.between(20, 40)};
    });
}

/// Makes a car park at night: masts with four lamps each, head lamps, and small lamps along the paths.
inline BenchScene car_park() {
    SceneBuilder world({0, 11, 45}, {0, 0, -30});
    Dice dice(6);
    for (float z = 20; z > -150; z -= 10)
        for (float x = -76; x < 78; x += 3) {
            if (dice.between(0, 1) > 0.55f) continue;
            const glm::vec3 at(x, 0, z + dice.between(-0.4f, 0.4f));
            world.box(at, at + glm::vec3(1.8f, dice.between(1.3f, 1.9f), 4.4f));
        }
    for (float z = 15; z > -150; z -= 20)
        for (float x = -75; x < 76; x += 25)
            world.box({x - 0.15f, 0, z - 0.15f}, {x + 0.15f, 9, z + 0.15f});
    return std::move(world).spot_scene("car-park", 600, [](Dice& lights, std::size_t i) {
        if (i % 2 == 0) {  // four to a mast, in turn
            const std::size_t mast = i / 8 % 63, row = mast / 7;
            const glm::vec3 at(25 * static_cast<float>(mast % 7) - 75, 9, 15 - 20 * static_cast<float>(row));
            const float turn = 1.5708f * static_cast<float>(i / 2 % 4) + lights.between(-0.2f, 0.2f);
            return Beam{at,
                        lights.about(17, 1.2f),
                        {0.8f * std::cos(turn), -1, 0.8f * std::sin(turn)},
                        lights.between(40, 60)};
        }
        const glm::vec3 at = lights.between({-78, 0.7f, -150}, {78, 1, 22});
        if (i % 4 == 1)
            return Beam{at,
                        lights.about(22, 1.2f),
                        {lights.between(-1, 1), -0.12f, lights.between(-1, 1)},
                        lights.between(15, 28)};
        return Beam{at, lights.about(4, 1.3f), {0, -1, 0}, lights.between(60, 85)};
    });
}

}  // namespace scenes
