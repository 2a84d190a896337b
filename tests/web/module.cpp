// SPDX-License-Identifier: MIT
// Tests that examples/web gives the page the lights of the renderer examples/tiled_forward. tests/web/pictures.mjs sees
// in pictures that the page's lists lack no light.
#include "binned_lights.hpp"
#include "moving_lights.hpp"
#include "stage.hpp"

#include <doctest/doctest.h>

#include <glm/glm.hpp>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace {

std::span<const unsigned char> bytes(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::string fixture(const std::string& name) {
    std::ifstream file(LIGHTBIN_FIXTURES "/" + name, std::ios::binary);
    REQUIRE(file);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool same_bytes(const auto& a, const auto& b) {
    return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

// Checks that the module's lights are the renderer's, at rest and in motion, also if one is left out.
void check_lights(Stage& stage) {
    const Camera& camera = stage.scene().cameras[0];
    for (const double seconds : {0.0, 12.5})
        for (const int dropped : {-1, 7}) {
            Scene moved = stage.scene();
            move_lights(stage.scene().lights, seconds, moved.lights);
            BinnedLights binned(moved);
            binned.place(glm::inverse(camera.to_world));
            const PlacedLights& placed = stage.place(camera.to_world, seconds, dropped);
            CHECK(same_bytes(placed.lights, binned.lights_and_suns()));
            CHECK(same_bytes(placed.shapes, binned.as_spots(dropped)));
            float reach = 0;
            for (const GpuLight& light : binned.lights())
                reach = std::max(reach, light.sphere.w - light.sphere.z);
            CHECK(placed.reach == reach);
        }
    const Look look = stage.look(camera, 1.5, lightbin::ClipDepth::zero_to_one);
    CHECK(glm::length(glm::vec3(look.world_to_view * glm::vec4(way_to_moon, 0)) - look.moon) < 1e-6f);
}

}  // namespace

TEST_CASE("the page's lights are those of the renderer") {
    Stage stage;
    SUBCASE("city") {
        stage.make("city", 1500);
        CHECK(stage.scene().lights.size() == 1500);
        check_lights(stage);
    }
    SUBCASE("street") {
        stage.make("street", 1);
        CHECK(stage.has_spots());
        check_lights(stage);
    }
    for (const char* name : {"nova.glb", "darkness.glb"})
        SUBCASE(name) {
            stage.open(bytes(fixture(name)), name);
            check_lights(stage);
        }
}
