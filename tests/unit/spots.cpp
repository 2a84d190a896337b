// Spots compared with spheres: what the tests in tests/oracle do not cover.
#include "scene.hpp"

#include <glm/ext/matrix_transform.hpp>
#include <glm/vec3.hpp>

using namespace lightbin;

namespace {

/// Returns spots in and around the view with half angles of 0 to 80 degrees; every eighth is a whole sphere.
std::vector<Spot> random_spots(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1), angle(0, 1.4f);
    std::vector<Spot> spots;
    for (const glm::vec4& s : test::random_lights(count, seed)) {
        const Spot spot = {s.x,          s.y,          s.z,          s.w,
                           unit(random), unit(random), unit(random), std::cos(angle(random))};
        spots.push_back(spots.size() % 8 == 0 ? Spot::whole({s.x, s.y, s.z, s.w}) : spot);
    }
    return spots;
}

}  // namespace

TEST_CASE("a spot with the cosine -1 is binned as its sphere is, whatever its axis is, and so is a very wide one") {
    const View view = test::view({1283, 721}, 16);
    const float nan = std::nanf("");
    const glm::vec3 axes[] = {glm::vec3(0), glm::vec3(nan), glm::vec3(HUGE_VALF, 0, 0), glm::vec3(1e-45f), {0, 0, 1}};
    std::vector<Sphere> spheres;
    std::vector<Spot> spots, beyond_138_degrees;
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const glm::vec4& s : test::random_lights(700, 3)) {
        const glm::vec3& axis = axes[random() % 5];
        spheres.push_back({s.x, s.y, s.z, s.w});
        spots.push_back({s.x, s.y, s.z, s.w, axis.x, axis.y, axis.z, -1});
        beyond_138_degrees.push_back({s.x, s.y, s.z, s.w, unit(random), unit(random), unit(random),
                                      std::min(unit(random), -0.75f)});
    }
    const glm::mat4 to_view = glm::rotate(glm::mat4(1.0f), 0.3f, glm::normalize(glm::vec3(1, 2, 3)));
    test::on_rungs([&]<Options options> {
        const auto expected = test::id_lists<options>(view, spheres);
        CHECK(test::id_lists<options>(view, spots) == expected);
        CHECK(test::id_lists<options>(view, beyond_138_degrees) == expected);
        CHECK(test::id_lists<options>(view, world_space(spots, to_view)) ==
              test::id_lists<options>(view, world_space(spheres, to_view)));
    });
}

TEST_CASE("each rung lists fewer spots than their spheres, and none that a lower one leaves out") {
    const std::vector<Spot> spots = random_spots(500, 5);
    std::vector<Sphere> spheres;
    for (const Spot& spot : spots)
        spheres.push_back({spot.x, spot.y, spot.z, spot.radius});
    test::check_rungs(spots, spheres);
}

TEST_CASE("a matrix that bends cones makes spheres of spots") {
    const View view = test::view({641, 361}, 16);
    const std::vector<Spot> spots = random_spots(300, 7);
    std::vector<Sphere> least;
    for (const Spot& spot : spots)
        least.push_back(bounding_sphere(spot));
    const glm::mat4 stretched = glm::scale(glm::mat4(1.0f), glm::vec3(1, 1, 2));
    const auto as_spheres = test::id_lists<Options{}>(view, world_space(least, stretched)),
               as_spots = test::id_lists<Options{}>(view, world_space(spots, stretched));
    CHECK(test::is_superset(as_spheres, as_spots));
    CHECK(test::entries(as_spots) >= test::entries(as_spheres) * 999 / 1000);
    // A matrix of floats is never exactly a rotation, but its error hardly changes cones.
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 1.3f, glm::normalize(glm::vec3(1, 2, 3)));
    std::vector<Spot> moved = spots;
    for (Spot& spot : moved) {
        const glm::vec4 centre = turned * glm::vec4(spot.x, spot.y, spot.z, 1),
                        axis = turned * glm::vec4(spot.axis_x, spot.axis_y, spot.axis_z, 0);
        spot = {centre.x, centre.y, centre.z, spot.radius, axis.x, axis.y, axis.z, spot.cos_half_angle};
    }
    CHECK(test::entries(test::id_lists<Options{}>(view, world_space(spots, turned))) <=
          test::entries(test::id_lists<Options{}>(view, moved)) * 1001 / 1000);
}
