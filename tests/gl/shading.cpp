// SPDX-License-Identifier: MIT
// The pictures of tiled_forward against the formulas of KHR_lights_punctual, worked out here pixel by pixel.
#include "gl_context.hpp"
#include "renderer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

namespace {

constexpr int width = 61, height = 47;
constexpr double wall = 4;  // distance of the wall that fills the picture

Scene wall_scene() {
    Scene scene;
    const glm::vec3 normal(0, 0, 1), colour(0.8f, 0.6f, 0.4f);
    const glm::vec3 a(-9, -9, -wall), b(9, -9, -wall), c(9, 9, -wall), d(-9, 9, -wall);
    for (const glm::vec3& corner : {a, b, c, a, c, d})
        scene.triangles.push_back({corner, normal, colour});
    Camera camera;
    camera.height = 1.2;
    scene.cameras = {camera};
    return scene;
}

// Illuminance at a point of the wall, from the specification's text.
glm::dvec3 illuminance(const Scene& scene, const glm::dvec3& point) {
    glm::dvec3 sum(0);
    for (const Light& light : scene.lights) {
        const glm::dvec3 way = glm::dvec3(light.position) - point;
        const double distance = glm::length(way);
        const double window =
            std::clamp(1 - std::pow(distance / static_cast<double>(light.range), 4), 0.0, 1.0);
        double cone = 1;
        if (light.spot) {
            const double along = -glm::dot(glm::dvec3(light.direction), way / distance);
            const double inner = static_cast<double>(light.cos_inner),
                         outer = static_cast<double>(light.cos_outer);
            cone = std::clamp((along - outer) / (inner - outer), 0.0, 1.0);
            cone *= cone;
        }
        sum += glm::dvec3(light.intensity) *
               (std::max(way.z / distance, 0.0) * window * cone / (distance * distance));
    }
    for (const Sun& sun : scene.suns)
        sum += glm::dvec3(sun.illuminance) * std::max(static_cast<double>(-sun.direction.z), 0.0);
    return sum;
}

double largest_difference(const Scene& scene, const Picture& picture, double exposure) {
    double largest = 0;
    const double slope = std::tan(scene.cameras[0].height / 2);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 point(wall * slope * ((x + 0.5) * 2 - width) / height,
                                   wall * slope * ((y + 0.5) * 2 - height) / height, -wall);
            const glm::dvec3 colour(0.8, 0.6, 0.4);
            const glm::dvec3 radiance = colour * illuminance(scene, point) / std::numbers::pi;
            const glm::dvec3 moon = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
            const glm::dvec3 night = colour * glm::dvec3(0.012, 0.015, 0.024) * (1 + moon.z);
            const glm::dvec3 display = 1.0 - glm::exp(-exposure * radiance - night);
            const glm::dvec3 sky(0.02, 0.025, 0.04);
            for (int channel = 0; channel < 3; ++channel) {
                double expected = 255 * std::pow(display[channel], 1 / 2.2);
                if (!scene.transparent.empty()) expected += sky[channel] * (255 - expected);
                const auto place = static_cast<std::size_t>(3 * (y * width + x) + channel);
                largest = std::max(largest, std::abs(expected - picture.rgb[place]));
            }
        }
    return largest;
}

}  // namespace

TEST_CASE("a pixel has the light that the specification gives it") {
    Scene scene = wall_scene();
    Light light;
    light.position = {0.5f, 0.25f, -3};
    light.intensity = {3, 2, 1};
    SUBCASE("a point light, its range ending in the picture") {
        light.range = 1.7f;
        scene.lights = {light};
    }
    SUBCASE("a point light without a range") {
        light.range = std::numeric_limits<float>::infinity();
        scene.lights = {light};
    }
    SUBCASE("a spot light, the rim of its cone in the picture") {
        light.range = 5;
        light.spot = true;
        light.direction = glm::normalize(glm::vec3(0.3f, 0.1f, -1));
        light.cos_inner = std::cos(0.3f);
        light.cos_outer = std::cos(0.7f);
        scene.lights = {light};
    }
    SUBCASE("several, one behind the wall, and a sun") {
        for (int i = 0; i < 20; ++i) {
            light.position = {0.3f * static_cast<float>(i) - 3, 0.2f * static_cast<float>(i % 5),
                              -3 - 0.1f * static_cast<float>(i)};
            light.range = 1 + 0.05f * static_cast<float>(i);
            scene.lights.push_back(light);
        }
        scene.suns = {{glm::normalize(glm::vec3(1, 1, -1)), {0.5f, 0.5f, 0.8f}}};
    }
    SUBCASE("the wall is a pane of glass before the sky") {
        light.range = 1.7f;
        scene.lights = {light};
        std::swap(scene.triangles, scene.transparent);
    }

    const double most = scene.transparent.empty() ? 1 : 1.5;  // blended colours are rounded more than once
    for (const int glsl : {330, 430, 300, 310}) {
        CAPTURE(glsl);
        const OffscreenContext context(glsl);
        Renderer renderer(scene, glsl);
        FrameSettings settings;
        settings.width = width;
        settings.height = height;
        settings.exposure = 1.5f;
        renderer.draw(scene.cameras[0], settings);
        CHECK(largest_difference(scene, renderer.read_picture(), 1.5) < most);
        renderer.draw_every_light(scene.cameras[0], settings);
        CHECK(largest_difference(scene, renderer.read_picture(), 1.5) < most);
    }
}

TEST_CASE("the light meter makes up for the unit of the lights") {
    Scene scene = wall_scene();
    Light light;
    light.position = {0, 0, -3};
    light.range = 3;
    const OffscreenContext context(0);
    const auto metered = [&](float candela) {
        light.intensity = glm::vec3(candela);
        scene.lights = {light};
        return Renderer(scene, context.glsl()).meter(scene.cameras[0], {}) * candela;
    };
    const float one = metered(1);
    CHECK(one > 0);
    CHECK(metered(0.01f) == doctest::Approx(one));
    CHECK(metered(5000) == doctest::Approx(one));
}

TEST_CASE("pictures that differ are seen to differ, and where") {
    Picture a{4, 3, std::vector<std::uint8_t>(36, 7)};
    CHECK(compare(a, a).pixels == 0);
    Picture b = a;
    b.rgb[3 * 6 + 1] = 9;   // x 2, y 1
    b.rgb[3 * 11 + 2] = 0;  // x 3, y 2
    const Difference difference = compare(a, b);
    CHECK(difference.pixels == 2);
    CHECK(difference.x == 2);
    CHECK(difference.y == 1);
    CHECK(difference.largest == 7);
}
