// SPDX-License-Identifier: MIT
// The pictures of tiled_forward equal those of every light in every fragment, however surfaces overlap within pixels.
#include "gl_context.hpp"
#include "renderer.hpp"

#include <doctest/doctest.h>

#include <random>

namespace {

constexpr int width = 61, height = 47;
// Makes steep, thin triangles that hide each other within pixels, and lights with short ranges.
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
