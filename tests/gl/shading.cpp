// SPDX-License-Identifier: MIT
// The pictures of tiled_forward against the formulas of KHR_lights_punctual, worked out here pixel by pixel.
#include "gl_context.hpp"
#include "moving_lights.hpp"
#include "renderer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

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

// What is seen at a place of the picture, 0 to 255.
glm::dvec3 shown(const Scene& scene, glm::dvec2 place, double exposure) {
    const double slope = std::tan(scene.cameras[0].height / 2);
    const glm::dvec3 point(wall * slope * (place.x * 2 - width) / height,
                           wall * slope * (place.y * 2 - height) / height, -wall);
    const glm::dvec3 sky(0.02, 0.025, 0.04);
    const glm::dvec3 colour(0.8, 0.6, 0.4);
    const glm::dvec3 radiance = colour * illuminance(scene, point) / std::numbers::pi;
    const glm::dvec3 moon = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
    const glm::dvec3 night = colour * glm::dvec3(0.012, 0.015, 0.024) * (1 + moon.z);
    const glm::dvec3 display = 1.0 - glm::exp(-exposure * radiance - night);
    const glm::dvec3 surface = 255.0 * glm::pow(display, glm::dvec3(1 / 2.2));
    return scene.transparent.empty() ? surface : surface + sky * (255.0 - surface);
}

double largest_difference(const Scene& scene, const Picture& picture, double exposure) {
    double largest = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 wanted = shown(scene, glm::dvec2(x + 0.5, y + 0.5), exposure);
            for (int channel = 0; channel < 3; ++channel) {
                const auto place = static_cast<std::size_t>(3 * (y * width + x) + channel);
                largest = std::max(largest, std::abs(wanted[channel] - picture.rgb[place]));
            }
        }
    return largest;
}

// Steep splinters that hide each other within pixels, and lights that reach little.
Scene splinters() {
    std::mt19937 engine(4);
    const auto between = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * static_cast<double>(engine()) / 4294967296.0);
    };
    const auto point = [&](double reach, double deep) {
        return glm::vec3(between(-reach, reach), between(-reach, reach), between(-deep, deep));
    };
    Scene scene;
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 centre = glm::vec3(0, 0, -6) + point(3, 3), normal = glm::normalize(point(1, 1));
        for (int corner = 0; corner < 3; ++corner)
            scene.triangles.push_back({centre + point(0.15, 0.8), normal, glm::vec3(0.8f)});
    }
    for (int i = 0; i < 300; ++i) {
        Light light;
        light.position = glm::vec3(0, 0, -6) + point(3, 3);
        light.range = between(0.1, 0.5);
        light.intensity = glm::vec3(1);
        scene.lights.push_back(light);
    }
    Camera camera;
    camera.height = 1;
    scene.cameras = {camera};
    return scene;
}

}  // namespace

TEST_CASE("a pixel has the light that the specification gives it") {
    Scene scene = wall_scene();
    Light light;
    light.intensity = {0.3f, 0.2f, 0.1f};
    for (int i = 0; i < 20; ++i) {  // some behind the wall
        light.position = {0.3f * static_cast<float>(i) - 3, 0.2f * static_cast<float>(i % 5),
                          -3 - 0.1f * static_cast<float>(i)};
        light.range = 1 + 0.05f * static_cast<float>(i);
        scene.lights.push_back(light);
    }
    light.position = {0.5f, 0.25f, -3};
    light.range = std::numeric_limits<float>::infinity();
    scene.lights.push_back(light);
    light.range = 5;  // the rim of its cone is in the picture
    light.intensity = {3, 2, 1};
    light.spot = true;
    light.direction = glm::normalize(glm::vec3(0.3f, 0.1f, -1));
    light.cos_inner = std::cos(0.3f);
    light.cos_outer = std::cos(0.7f);
    scene.lights.push_back(light);
    scene.suns = {{glm::normalize(glm::vec3(1, 1, -1)), {0.1f, 0.1f, 0.2f}}};
    Scene glass = scene;  // the wall is a pane before the sky
    std::swap(glass.triangles, glass.transparent);

    for (const int glsl : {330, 430, 300, 310}) {
        CAPTURE(glsl);
        const OffscreenContext context(glsl);
        for (const Scene* const one : {&scene, &glass}) {
            const double most = one == &scene ? 1 : 1.5;  // blended colours are rounded more than once
            Renderer renderer(*one, glsl);
            FrameSettings settings;
            settings.width = width;
            settings.height = height;
            settings.exposure = 1.5f;
            renderer.draw(one->cameras[0], settings);
            CHECK(largest_difference(*one, renderer.read_picture(), 1.5) < most);
            renderer.draw_every_light(one->cameras[0], settings);
            CHECK(largest_difference(*one, renderer.read_picture(), 1.5) < most);
        }
    }
}

TEST_CASE("with MSAA no light is missing where surfaces hide each other within pixels") {
    const Scene scene = splinters();
    const OffscreenContext context(0);
    Renderer renderer(scene, context.glsl());
    FrameSettings settings;
    settings.width = width;
    settings.height = height;
    settings.samples = 4;
    Camera inside = scene.cameras[0];  // planes of splinters leave the drawn depths within a pixel
    inside.to_world[3].z = -6;
    inside.near = 0.5;
    inside.far = 2;
    for (const Camera& camera : {scene.cameras[0], inside})
        for (const DepthUse depth :
             {DepthUse::none, DepthUse::z_bins, DepthUse::clusters, DepthUse::pre_pass}) {
            CAPTURE(camera.near);
            CAPTURE(static_cast<int>(depth));
            settings.depth = depth;
            renderer.draw_every_light(camera, settings);
            const Picture expected = renderer.read_picture();
            for (const int tile : {1, 2, 5, 16}) {
                CAPTURE(tile);
                settings.tile_size = tile;
                renderer.draw(camera, settings);
                CHECK(compare(expected, renderer.read_picture()).pixels == 0);
            }
        }
}

TEST_CASE("a picture has the lights where they are by now") {
    Scene scene = make_street();
    const std::vector<Light> places = scene.lights;
    const OffscreenContext context(0);
    Renderer renderer(scene, context.glsl());
    FrameSettings settings;
    settings.width = 160;
    settings.height = 90;
    settings.exposure = renderer.meter(scene.cameras[0], settings);
    renderer.draw(scene.cameras[0], settings);
    const Picture before = renderer.read_picture();
    for (const DepthUse depth : {DepthUse::pre_pass, DepthUse::clusters}) {
        settings.depth = depth;
        move_lights(places, 3, scene.lights);
        renderer.draw(scene.cameras[0], settings);
        const Picture moved = renderer.read_picture();
        CHECK(compare(before, moved).pixels > 1000);
        renderer.draw_every_light(scene.cameras[0], settings);
        CHECK(compare(moved, renderer.read_picture()).pixels == 0);
    }
    settings.depth = DepthUse::pre_pass;
    move_lights(places, 0, scene.lights);
    renderer.draw(scene.cameras[0], settings);
    CHECK(compare(before, renderer.read_picture()).pixels == 0);
}
