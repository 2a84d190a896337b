// Lights that are switched off, empty input and odd input. That bad input harms no other light is tested in
// tests/oracle and tests/hunt.
#include "scene.hpp"
#include <cmath>
#include <limits>

using namespace lightbin;

namespace {
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
}

TEST_CASE("lights that are switched off are no bad input, whatever their other numbers are") {
    const std::vector<Sphere> spheres = {{0, 0, -5, -1}, {not_a_number, inf, 0, -1}, {0, 0, -5, -2}, {0, 0, -5, 1}};
    std::vector<Spot> spots;
    std::vector<Box> boxes;
    std::vector<glm::vec4> vec4s;
    for (const Sphere& s : spheres) {
        vec4s.emplace_back(s.x, s.y, s.z, s.radius);
        spots.push_back({s.x, s.y, s.z, s.radius, 0, 0, s.radius < 0 ? s.x : 1, 0.5f});  // without an axis if off
        boxes.push_back({s.x, s.y, s.z, s.radius, 0, 0, -5, {{s.radius < 0 ? s.y : 1, 0, 0}}});
    }
    const View view = test::view({960, 540}, 16);
    const auto check = [&](const auto& lights) {
        Binner<> binner;
        for (const bool world : {false, true}) {
            const auto grid = world ? binner.bin(view, world_space(lights, glm::mat4(1))) : binner.bin(view, lights);
            REQUIRE(grid);
            CHECK(grid->light_counts().rejected == 1);
            CHECK(grid->light_counts().culled == 2);
            CHECK(!grid->ids().empty());
            for (const std::uint32_t id : grid->ids())
                CHECK(id == 3);
        }
    };
    check(spheres);
    check(spots);
    check(boxes);
    check(vec4s);
    // Spheres around other shapes that are switched off are switched off, too.
    const glm::vec3 a(1, 2, 3), b(7, 2, 11);
    for (const Sphere& made :
         {tube_sphere(a, b, -1), rectangle_sphere(a, b, b, -1), bounding_sphere(spots[0]), bounding_sphere(boxes[0]),
          bounding_sphere(half_sphere(spheres[0], a)), bounding_sphere(tube_box(a, b, -1)),
          detail::AsLight()(glm::vec4(0, 0, -5, -1))})
        CHECK(made.radius == -1);
}

TEST_CASE("an empty viewport") {
    for (const ImageSize viewport : {ImageSize{0, 0}, ImageSize{0, 540}, ImageSize{960, 0}}) {
        const View view = test::view(viewport, 16);
        auto lights = test::random_lights(200, 41);
        lights.emplace_back(0, 0, 0, inf);
        lights.emplace_back(0, 0, not_a_number, 1);
        Binner<> binner;
        const auto grid = binner.bin(view, lights);
        REQUIRE(grid);
        CHECK(grid->ranges().empty());
        CHECK(grid->ids().empty());
        CHECK(grid->light_counts().rejected == 1);
        CHECK(grid->light_counts().culled == 201);

        Binner<Options{.depth_test = true}> pruned;
        const auto bounds = reduce_depth(view, {}, {});
        REQUIRE(bounds);
        const auto tested = pruned.bin(view, lights, {.bounds = *bounds});
        REQUIRE(tested);
        CHECK(tested->ids().empty());
        CHECK(tested->copy_to({}, {}));
    }
}

TEST_CASE("any number of workers") {
    const View view = test::view({320, 240}, 16);
    const auto lights = test::random_lights(1000, 44);
    for (const std::size_t workers :
         {std::size_t{1} << (std::numeric_limits<std::size_t>::digits - 10),
          (std::numeric_limits<std::size_t>::max)() / 4 + 1, (std::numeric_limits<std::size_t>::max)()}) {
        Binner<> binner;
        CHECK(test::to_lists(*binner.bin(view, lights, {}, Parallel(workers, test::backwards))) ==
              test::lists(view, lights));
    }
}
