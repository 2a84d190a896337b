// SPDX-License-Identifier: MIT
#include "made_shapes.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cmath>

using namespace made;

Scene make_scene(int light_count) {
    constexpr int blocks = 20;               // a side
    constexpr float pitch = 8, half = 2.6f;  // of a block, and half its width: the streets are what is left
    constexpr float edge = blocks * pitch / 2;
    Dice dice(2011);
    Scene scene;
    scene.name = "made scene";

    add_quad(scene.triangles,
             {{{-edge - 4, 0, edge + 4},
               {edge + 4, 0, edge + 4},
               {edge + 4, 0, -edge - 4},
               {-edge - 4, 0, -edge - 4}}},
             {0, 1, 0}, glm::vec3(0.55f));
    for (int i = 0; i < blocks; ++i)
        for (int j = 0; j < blocks; ++j) {
            const glm::vec3 centre(pitch * (static_cast<float>(i) + 0.5f) - edge, 0,
                                   pitch * (static_cast<float>(j) + 0.5f) - edge);
            const float downtown = std::exp(-glm::dot(centre, centre) / 1600);
            const float height = dice.between(0.6f, 3.0f) + downtown * dice.between(2.0f, 16.0f);
            const glm::vec3 colour(dice.between(0.5f, 0.8f));
            const float kind = dice.between(0, 1);
            if (kind < 0.15f) {
                add_dome(scene, centre, half, colour);
            } else {
                add_block(scene, centre - glm::vec3(half, 0, half), centre + glm::vec3(half, height, half),
                          colour);
                if (kind > 0.6f) {  // a smaller one on top
                    const float inner = half * dice.between(0.4f, 0.8f);
                    add_block(scene, centre + glm::vec3(-inner, height, -inner),
                              centre + glm::vec3(inner, height + dice.between(0.5f, 4.0f) * (0.5f + downtown),
                                                 inner),
                              colour);
                }
                if (kind >= 0.3f && kind <= 0.6f)  // a flat roof
                    add_decal(scene, centre + glm::vec3(0, height, 0), 2,
                              0.2f + 0.8f * rainbow(0.13f * static_cast<float>(i + 3 * j)));
                if (kind < 0.3f) add_dome(scene, centre + glm::vec3(0, height, 0), half * 0.8f, colour);
            }
        }

    for (int i = 1; i < blocks; ++i)  // where streets cross
        for (int j = 1; j < blocks; ++j)
            if ((i + 2 * j) % 3 == 0)
                add_decal(scene,
                          {pitch * static_cast<float>(i) - edge, 0, pitch * static_cast<float>(j) - edge},
                          1.3f, 0.2f + 0.8f * rainbow(0.17f * static_cast<float>(2 * i + j)));
    add_probe(scene, {-11, -1, 9}, {13, 14, 33}, {0.2f, 0.7f, 1.1f});

    // Along the streets and up the walls; their colours go round the rainbow across the city.
    const float range = 8 * std::pow(1024 / static_cast<float>(std::max(light_count, 1)), 0.33f);
    for (int i = 0; i < light_count; ++i) {
        const float across =
            pitch * std::floor(dice.between(0, blocks + 1)) - edge + dice.between(-1.2f, 1.2f);
        const float along = dice.between(-edge, edge);
        Light light;
        light.position = i % 2 == 0 ? glm::vec3(along, 0, across) : glm::vec3(across, 0, along);
        const float downtown = std::exp(-glm::dot(light.position, light.position) / 1600);
        light.position.y =
            dice.between(0, 1) < 0.7f ? dice.between(0.4f, 2.0f) : dice.between(2.0f, 4.0f + 14 * downtown);
        light.range = range * dice.between(0.7f, 1.3f);
        const float hue =
            (light.position.x - 0.6f * light.position.z) / (1.5f * edge) + dice.between(-0.1f, 0.1f);
        light.intensity = rainbow(hue) * dice.between(6, 18) * (range / 8) * (range / 8);
        scene.lights.push_back(light);
    }

    // Glass: two panes before the sky, one half before walls, one in a street.
    const glm::vec3 glass(0.6f, 0.8f, 1);
    add_pane(scene, {-2, 0, -82}, {26, 0, -82}, 13, glass);
    add_pane(scene, {82, 0, 30}, {82, 0, 4}, 12, glass);
    add_pane(scene, {-28, 0, 32}, {-13, 0, 32}, 8, glass);
    add_pane(scene, {-1.3f, 0, 56}, {1.3f, 0, 56}, 3, glass);

    scene.cameras = {look("over the roofs", {-40, 30, 60}, {2, -2, 8}, 48),
                     look("in a street", {0.4, 2.2, 71}, {0, 4, 0}, 55),
                     look("from above", {0, 100, 0.1}, {0, 0, 0}, 60)};
    return scene;
}

Camera framing_camera(const std::vector<Vertex>& triangles) {
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const Vertex& vertex : triangles) {
        low = glm::min(low, glm::dvec3(vertex.position));
        high = glm::max(high, glm::dvec3(vertex.position));
    }
    const glm::dvec3 centre = (low + high) / 2.0;
    const double radius = std::max(glm::length(high - low) / 2, 1e-3);
    Camera camera = look("the whole scene", {}, {0, 0, -1}, 45);
    const double distance = radius / std::sin(camera.height / 2);
    camera.to_world = glm::inverse(glm::lookAt(centre + distance * glm::normalize(glm::dvec3(0.5, 0.6, 1)),
                                               centre, glm::dvec3(0, 1, 0)));
    camera.near = (distance - radius) / 10;
    camera.far = distance + 2 * radius;
    return camera;
}
