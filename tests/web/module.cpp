// SPDX-License-Identifier: MIT
// What the module of examples/web hands to the page: the lights that the renderer of examples/tiled_forward has; and a
// bad file leaves the scene from before. That the page's lists lack none is seen in its pictures: tests/web/pictures.mjs.
#include "glb.hpp"

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
#include <stdexcept>
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

// The module's lights are the renderer's, at rest and in motion, also where one is left out.
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
            CHECK(stage.kind() == "file");
            check_lights(stage);
        }
}

TEST_CASE("lights move about their places") {
    Stage stage;
    stage.make("city", 100);
    const std::vector<Light> places = stage.scene().lights;
    const Camera& camera = stage.scene().cameras[0];
    const glm::dmat4 to_view = glm::inverse(camera.to_world);
    const auto farthest = [&](double seconds) {
        const PlacedLights& placed = stage.place(camera.to_world, seconds, -1);
        float most = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::vec3 place(to_view * glm::dvec4(places[i].position, 1));
            most = std::max(most, glm::length(glm::vec3(placed.lights[i].sphere) - place) / places[i].range);
        }
        return most;
    };
    CHECK(farthest(0) == 0);
    CHECK(farthest(3) > 0.05f);
    CHECK(farthest(3) < 0.126f);
    CHECK(farthest(0) == 0);
}

TEST_CASE("a bad file is refused in a sentence, and the scene from before is there") {
    Stage stage;
    stage.make("city", 300);
    const std::string good = everything_glb();
    const auto refused = [&](const std::string& file, const std::string& reason) {
        std::string said;
        try {
            stage.open(bytes(file), "a.glb");
        } catch (const std::runtime_error& problem) {
            said = problem.what();
        }
        CAPTURE(said);
        CHECK(said.find("'a.glb': ") == 0);
        CHECK(said.find(reason) != std::string::npos);
        CHECK(said.find('\n') == std::string::npos);
        CHECK(stage.kind() == "city");
        CHECK(stage.scene().lights.size() == 300);
    };
    for (std::size_t size = 0; size < good.size(); size += good.size() / 16)
        refused(good.substr(0, size), "not a readable glTF binary");
    refused("PNG" + good.substr(3), "not a readable glTF binary");
    refused(with(good, "[0, 1, 2, 5]", "[0, 2]"), "no point or spot lights");
    refused(with(good, "{\"light\": 1}", "{\"light\": 8}"), "light 8");
    refused(with(good, "\"count\": 4", "\"count\":40"), "past the end");
    CHECK_THROWS_WITH(stage.make("moon", 1), "there is no made scene 'moon'");
    CHECK_THROWS_WITH(stage.make("city", 0), "the city has 1 to 1000000 lights, not 0");
    CHECK(stage.place(stage.scene().cameras[0].to_world, 0, -1).shapes.size() == 300);
}

TEST_CASE("at first there is no scene") {
    Stage stage;
    CHECK(stage.scene().lights.empty());
    CHECK_THROWS_WITH(stage.place(glm::dmat4(1), 0, -1), "there is no scene yet");
}
