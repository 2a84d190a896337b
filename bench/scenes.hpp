// SPDX-License-Identifier: MIT
// Kinds of scene that ask different things of the binning: what the reports on error and on leaving out run
// over. Each is a camera, triangles that make its depth buffer, and as many light sets as are asked for.
#pragma once

#include "dice.hpp"
#include "sets.hpp"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <string>
#include <utility>

struct BenchScene {
    std::string name;
    glm::mat4 projection;              ///< OpenGL's: looks down -z, clip depth -1..1, near and far finite
    std::vector<glm::vec3> triangles;  ///< in view space, three corners each
    std::function<Lights(std::uint32_t seed)> lights;  ///< in view space; same seed, same lights
};

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

    /// place(dice, i) makes the world-space sphere of light i.
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
        const glm::mat4 projection =
            glm::perspectiveRH_NO(2 * std::atan(tan_half_fov), aspect, 0.1f, 1000.0f);
        return {std::move(name), projection, std::move(triangles_), lights};
    }

private:
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

/// Lamps along the street and rooms behind the walls.
inline glm::vec4 street_light(Dice& dice, std::size_t i) {
    if (i % 3 != 0) return {dice.between({-8, 2, -300}, {8, 5, 0}), dice.about(7, 1.5f)};
    const float side = dice.between(0, 1) < 0.5f ? -1.0f : 1.0f;
    return {side * dice.between(11, 22), dice.between(1, 20), dice.between(-300, 0), dice.about(5, 1.5f)};
}

/// Ground with boxes on it, lights above it, some beside the view.
inline BenchScene field_with_depth() {
    return plain_with_boxes().scene("field", 4000, [](Dice& dice, std::size_t) {
        return glm::vec4(dice.between({-160, 0.5f, -260}, {160, 6, 50}), dice.about(6, 2));
    });
}

inline BenchScene few_lights() {
    return street_canyon().scene("few", 8, [](Dice& dice, std::size_t) {
        return glm::vec4(dice.between({-8, 2, -80}, {8, 5, 0}), dice.about(8, 1.5f));
    });
}

/// Straight down on low boxes, all lights close to the ground: depth tells lights apart the least here.
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

/// A corridor with a doorway every 8 m: most lights are in the rooms behind its walls.
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

/// Thin leaves in front of ground and a far wall: most tiles see both, with a gap in depth between.
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

inline BenchScene giant_light() {
    return plain_with_boxes().scene("giant", 1, [](Dice& dice, std::size_t) {
        return glm::vec4(dice.between({-20, 50, -100}, {20, 80, 0}), 800.0f);
    });
}

/// As many lights as in the field, all behind the eye or surely beside the view.
inline BenchScene off_screen() {
    return plain_with_boxes().scene("off-screen", 4000, [](Dice& dice, std::size_t i) {
        const float radius = dice.about(6, 2);
        if (i % 2 == 0) return glm::vec4(dice.between({-160, 0.5f, 90}, {160, 6, 300}), radius);
        const float z = dice.between(-200, 30);
        const float beside = 2 * (40 - z) + 60;
        return glm::vec4(i % 4 == 1 ? beside : -beside, dice.between(0.5f, 6), z, radius);
    });
}

}  // namespace scenes

/// The kinds of the ablation.
inline std::vector<BenchScene> scene_kinds() {
    return {scenes::few_lights(), scenes::field_with_depth(), scenes::top_down(),    scenes::street(),
            scenes::corridor(),   scenes::foliage(),          scenes::giant_light(), scenes::off_screen()};
}
