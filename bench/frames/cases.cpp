// SPDX-License-Identifier: MIT
#include "cases.hpp"

#include <dice.hpp>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace {

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{-low};
};

template <class Thing> Box box_of(const std::vector<Thing>& things) {
    Box box;
    for (const Thing& thing : things) {
        box.low = glm::min(box.low, thing.position);
        box.high = glm::max(box.high, thing.position);
    }
    return box;
}

Camera look(const std::string& name, glm::dvec3 from, glm::dvec3 to, glm::dvec3 up, double reach) {
    Camera camera;
    camera.name = name;
    camera.to_world = glm::inverse(glm::lookAt(from, to, up));
    camera.height = glm::radians(55.0);
    camera.near = reach / 1000;
    camera.far = 2 * reach;
    return camera;
}

// Returns the distance straight up (`up` is 1) or down (-1) to the first triangle; infinity if there is none.
double room(const std::vector<Vertex>& triangles, const glm::dvec3& from, double up) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a = glm::dvec3(triangles[i].position) - from,
                         b = glm::dvec3(triangles[i + 1].position) - from,
                         c = glm::dvec3(triangles[i + 2].position) - from;
        const double u = b.x * c.z - b.z * c.x, v = c.x * a.z - c.z * a.x, w = a.x * b.z - a.z * b.x;
        if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) continue;  // not over it
        const double away = up * (u * a.y + v * b.y + w * c.y) / (u + v + w);
        if (away > 0 && away < nearest) nearest = away;  // no, if that is no number
    }
    return nearest;
}

// Returns a camera that looks straight down from the highest ceiling over any of the places, nearest to the middle if
// several are as high. Nothing, if most places have no ceiling.
std::optional<Camera> under_a_ceiling(const Scene& scene, const std::vector<Camera>& places,
                                      const glm::dvec3& middle) {
    double highest = 0, nearest = 0;
    std::size_t ceilings = 0;
    std::optional<Camera> camera;
    for (const Camera& place : places) {
        const glm::dvec3 at(place.to_world[3]);
        const double above = room(scene.triangles, at, 1), height = above + room(scene.triangles, at, -1);
        const double away = glm::distance(glm::dvec2(at.x, at.z), glm::dvec2(middle.x, middle.z));
        if (std::isinf(height)) continue;
        ++ceilings;
        if (height < 0.99 * highest) continue;
        if (height < 1.01 * highest && away > nearest) continue;
        highest = height;
        nearest = away;
        const glm::dvec3 eye = at + glm::dvec3(0, above - 0.01 * height, 0);
        camera = look("under the ceiling", eye, at - glm::dvec3(0, 1, 0), {0, 0, -1}, height);
        camera->height = glm::radians(90.0);
    }
    if (2 * ceilings <= places.size()) camera.reset();
    return camera;
}

}  // namespace

Camera camera_from_above(const Scene& scene, const std::vector<Camera>& places) {
    const Box lights = box_of(scene.lights), surfaces = box_of(scene.triangles);
    const glm::dvec3 middle = glm::dvec3(lights.low + lights.high) / 2.0,
                     half = glm::dvec3(lights.high - lights.low) / 2.0;
    if (const auto camera = under_a_ceiling(scene, places, middle)) return *camera;
    const auto size = static_cast<double>(glm::distance(surfaces.low, surfaces.high));
    const double height =  // lights may be in one place
        std::max({half.z, half.x * 9 / 16, 0.1 * half.y, 0.01 * size}) / std::tan(glm::radians(27.5));
    const double bottom = static_cast<double>(std::min(surfaces.low.y, lights.low.y));
    const glm::dvec3 eye = middle + glm::dvec3(0, half.y + height, 0);
    Camera camera = look("from above", eye, middle, {0, 0, -1}, 1);
    camera.near = 0.99 * height;  // lights included
    camera.far = 1.01 * (eye.y - bottom);
    return camera;
}

std::vector<Camera> made_flight(std::size_t views) {
    std::vector<Camera> flight;
    for (std::size_t i = 0; i < views; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(views),
                     turn = glm::two_pi<double>() * t;
        const double height = 22 + 16 * std::cos(turn), radius = 50 + 20 * std::cos(turn);
        const glm::dvec3 eye(radius * std::sin(turn), height, radius * std::cos(turn));
        flight.push_back(
            look("flight " + std::to_string(i), eye, {10 * std::sin(3 * turn), 3, 0}, {0, 1, 0}, 250));
    }
    return flight;
}

Scene with_random_lights(Scene scene, std::size_t count) {
    const Box box = box_of(scene.triangles);
    const glm::vec3 size = box.high - box.low;
    Dice dice(2013);
    scene.lights.clear();
    for (std::size_t i = 0; i < count; ++i) {
        Light light;
        light.position = dice.between(box.low, box.high);
        light.range = 0.06f * std::max(size.x, size.z);
        const glm::vec3 colour(dice.between(0.1f, 1), dice.between(0.1f, 1), dice.between(0.1f, 1));
        light.intensity = colour * light.range * light.range;
        scene.lights.push_back(light);
    }
    return scene;
}

std::vector<Light> few_lights(const std::vector<Light>& lights, double time) {
    constexpr std::size_t count = 11;
    const auto of = [&](std::size_t i) { return i * lights.size() / count; };
    std::vector<Light> few;
    for (std::size_t i = 0; i < count; ++i) {
        const double last =
            static_cast<double>(of(i + 1) - of(i)) - 1;  // below 0: there are fewer than eleven
        Light light = lights[of(i) + static_cast<std::size_t>(std::lround(time * std::max(last, 0.0)))];
        light.range *= 3.2f;
        light.intensity *= 3.2f * 3.2f;
        few.push_back(light);
    }
    return few;
}

int frame_of(const std::string& name) {
    const std::size_t last = name.find_last_not_of("0123456789");
    const std::string digits = name.substr(last + 1);  // all of it, if there is nothing else
    return digits.empty() || digits.size() > 9 ? -1 : std::stoi(digits);
}
