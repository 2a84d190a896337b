// SPDX-License-Identifier: MIT
// Makes benchmark scenes from the cameras of a glTF file.
#pragma once

#include "scenes.hpp"

#include <scene.hpp>

#include <lightbin/spot.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

/// Returns a spot with the points that a file's light reaches; from 90 degrees on, its whole sphere.
inline lightbin::Spot spot_of(const Light& light) {
    const glm::vec3 &at = light.position, &to = light.direction;
    if (!light.spot) return lightbin::Spot::whole({at.x, at.y, at.z, light.range});
    return {at.x, at.y, at.z, light.range, to.x, to.y, to.z, light.cos_outer};
}

/// One scene a camera of the file, named "file:camera number". Light set 0 is the file's own; the others are
/// what a camera sees that is turned by up to two degrees and moved by a tenth of a light's range (their
/// depth stays that of set 0), for timings that must not repeat themselves. Throws std::runtime_error with one
/// line of text.
inline std::vector<BenchScene> glb_scenes(const std::string& path) {
    const Scene file = load_glb(path, 0.01f);
    std::string name = file.name.substr(0, file.name.rfind('.'));
    std::vector<BenchScene> views;
    for (const Camera& camera : file.cameras) {
        if (camera.orthographic) throw std::runtime_error(path + ": has an orthographic camera");
        const glm::dmat4 to_view = glm::inverse(camera.to_world);
        const double far_depth = std::isinf(camera.far) ? 1e5 * camera.near : camera.far;
        BenchScene view{name + ":" + std::to_string(views.size()),
                        glm::mat4(glm::perspectiveRH_NO(camera.height, static_cast<double>(aspect),
                                                        camera.near, far_depth)),
                        {},
                        {}};
        for (const Vertex& vertex : file.triangles)
            view.triangles.push_back(glm::vec3(to_view * glm::dvec4(glm::dvec3(vertex.position), 1)));
        const auto spots = [lights = file.lights, to_view](std::uint32_t seed) {
            Dice dice(seed);
            glm::dmat4 to_set = to_view;
            if (seed != 0) {
                const double turn = static_cast<double>(dice.between(-0.035f, 0.035f));
                const glm::vec3 axis = dice.between(glm::vec3(-1), glm::vec3(1));
                const glm::vec3 step =
                    0.1f * lights.front().range * dice.between(glm::vec3(-1), glm::vec3(1));
                to_set = glm::translate(glm::dmat4(1), glm::dvec3(step)) *
                         glm::rotate(glm::dmat4(1), turn, glm::dvec3(axis)) * to_view;
            }
            Spots set;
            for (const Light& light : lights)
                set.push_back(moved(to_set, spot_of(light)));
            return set;
        };
        view.lights = [spots](std::uint32_t seed) { return whole_spheres(spots(seed)); };
        if (std::ranges::any_of(file.lights, &Light::spot)) view.spots = spots;
        views.push_back(std::move(view));
    }
    return views;
}
