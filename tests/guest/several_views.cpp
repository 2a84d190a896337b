// Several views of one scene in a frame - two eyes, a split screen, six cube faces - each with a Binner of its own, from
// several threads that share the lights. Compiled for the thread sanitizer.
#include <lightbin/lightbin.hpp>

#include <doctest/doctest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <thread>
#include <vector>

using namespace lightbin;

namespace {

struct Eye {
    View view;
    glm::mat4 world_to_view;
    Binner<> binner = {};
    std::optional<LightGrid<std::uint32_t>> grid = {};
};

Eye eye(const glm::mat4& projection, Extent viewport, const glm::mat4& world_to_view) {
    const auto view = View::from_projection(projection, viewport, {.tile_size = 16});
    REQUIRE(view);
    return {*view, world_to_view};
}

std::vector<Eye> eyes() {
    const glm::mat4 camera = glm::lookAt(glm::vec3(3, 2, 5), glm::vec3(0, 0, -9), glm::vec3(0, 1, 0));
    std::vector<Eye> all;
    for (const float side : {-0.032f, 0.032f})  // off-centre, as headsets have them
        all.push_back(eye(glm::frustum(-0.11f + side, 0.11f + side, -0.1f, 0.12f, 0.1f, 500.0f), {252, 280},
                          glm::translate(glm::mat4(1), glm::vec3(-side, 0, 0)) * camera));
    for (const float turn : {0.0f, 2.0f})
        all.push_back(eye(glm::perspective(1.0f, 320.0f / 180, 0.1f, 500.0f), {320, 180},
                          glm::rotate(glm::mat4(1), turn, glm::vec3(0, 1, 0)) * camera));
    const glm::vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, lamp = {1, 2, -3};
    for (int face = 0; face < 6; ++face)
        all.push_back(eye(
            glm::perspective(glm::radians(90.0f), 1.0f, 0.1f, 500.0f), {128, 128},
            glm::lookAt(lamp, lamp + (face % 2 ? -1.0f : 1.0f) * axes[face / 2], axes[(face / 2 + 1) % 3])));
    return all;
}

/// The six faces see all that is around: who is in reach of the middle, or of a direction, is in some face's list.
void check_faces(const std::vector<Eye>& all, const std::vector<glm::vec4>& lights) {
    for (std::uint32_t id = 0; id < lights.size(); ++id) {
        bool seen = false;
        for (std::size_t i = all.size() - 6; i < all.size(); ++i)
            seen = seen || std::ranges::count(all[i].grid->ids(), id) > 0;
        const float distance = glm::distance(glm::vec3(lights[id]), glm::vec3(1, 2, -3));
        CHECK((seen || distance + lights[id].w < 0.2f || distance > 450));
    }
}

}  // namespace

TEST_CASE("views in several threads give the lists that they give one after another") {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> side(-40, 40), radius(0.5f, 6);
    std::vector<glm::vec4> lights(2000);
    for (glm::vec4& light : lights)
        for (const int i : {0, 1, 2, 3})
            light[i] = i < 3 ? side(random) : radius(random);

    std::vector<Eye> all = eyes();
    for (int frame = 0; frame < 3; ++frame) {
        for (glm::vec4& light : lights)
            light.y += 0.5f;
        std::vector<std::thread> threads;
        for (Eye& one : all)
            threads.emplace_back([&] {
                const auto grid = one.binner.bin(one.view, world_space(lights, one.world_to_view));
                if (grid) one.grid.emplace(*grid);
            });
        for (std::thread& thread : threads)
            thread.join();
        for (const Eye& one : all) {
            Binner<> alone;
            const auto grid = alone.bin(one.view, world_space(lights, one.world_to_view));
            REQUIRE(grid);
            REQUIRE(one.grid);
            CHECK(grid->ids().size() > 100);
            CHECK(std::ranges::equal(grid->ids(), one.grid->ids()));
            CHECK(std::ranges::equal(grid->ranges(), one.grid->ranges(),
                                     [](const ListRange& a, const ListRange& b) {
                                         return a.offset == b.offset && a.count == b.count;
                                     }));
        }
        check_faces(all, lights);
    }
}
