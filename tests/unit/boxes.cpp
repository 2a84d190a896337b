// Boxes: what the tests in tests/oracle do not cover.
#include "scene.hpp"

#include <lightbin/box.hpp>
#include <lightbin/coverage.hpp>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

using namespace lightbin;

namespace {

glm::vec3 random_vector(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    return {unit(random), unit(random), unit(random)};
}

/// Whether a point is in the sphere and the box of a Box, give or take a thousandth of its size.
bool contains(const Box& box, const glm::vec3& p) {
    const glm::vec3 ball(box.x, box.y, box.z), from = p - glm::vec3(box.box_x, box.box_y, box.box_z);
    const auto axis = [&](int i) { return glm::vec3(box.half_axes[i][0], box.half_axes[i][1], box.half_axes[i][2]); };
    const glm::vec3 at = glm::inverse(glm::mat3(axis(0), axis(1), axis(2))) * from;
    const float width = (1 + box.taper + at.z * (1 - box.taper)) / 2 * 1.001f + 0.001f;
    return glm::length(p - ball) <= box.radius * 1.001f && std::abs(at.x) <= width && std::abs(at.y) <= width &&
           std::abs(at.z) <= 1.001f;
}

}  // namespace

TEST_CASE("each rung lists fewer boxes than their spheres, and none that a lower one leaves out") {
    std::vector<Box> boxes = test::random_kinds(0, 0, 400, 5).boxes;
    for (Box& box : boxes)
        for (float& coordinate : box.half_axes[2])
            coordinate /= 8;
    std::vector<Sphere> spheres;
    for (const Box& box : boxes)
        spheres.push_back(bounding_sphere(box));
    test::check_rungs(boxes, spheres);
}

TEST_CASE("an affine matrix makes of a box the box of the transformed half axes") {
    const View view = test::view({641, 361}, 16);
    const glm::mat4 m = glm::mat4(1, 0.3f, 0, 0, 0.5f, -1, 0.1f, 0, 0.4f, 0, 2, 0, 1, 2, 3, 1);
    std::vector<Box> boxes = test::random_kinds(0, 0, 300, 8).boxes, moved;
    for (Box& box : boxes) {
        box.radius = HUGE_VALF;  // the image of a sphere is none
        const auto image = [&](float x, float y, float z, float w) { return m * glm::vec4(x, y, z, w); };
        moved.push_back(box);
        const glm::vec4 c = image(box.box_x, box.box_y, box.box_z, 1);
        moved.back().box_x = c.x, moved.back().box_y = c.y, moved.back().box_z = c.z;
        for (float(&h)[3] : moved.back().half_axes) {
            const glm::vec4 axis = image(h[0], h[1], h[2], 0);
            h[0] = axis.x, h[1] = axis.y, h[2] = axis.z;
        }
    }
    test::on_rungs([&]<Options options> {
        const double before = static_cast<double>(test::entries(test::id_lists<options>(view, world_space(boxes, m)))),
                     after = static_cast<double>(test::entries(test::id_lists<options>(view, moved)));
        CHECK(before == doctest::Approx(after).epsilon(0.002));
    });
}

TEST_CASE("a box reaches as deep as its numbers say, as far as floats do") {
    constexpr float size = 3e38f;
    const Box cube = {0, 0, 0, HUGE_VALF, 0, 0, 0, {{size, 0, 0}, {0, size, 0}, {0, 0, size}}};
    const std::vector<Box> boxes = {cube, clipped_sphere({0, 0, 0, size}, cube)};
    for (const LightCoverage& light : *coverage(test::view({96, 64}, 32), boxes)) {
        CHECK(light.nearest <= -size);
        CHECK(light.farthest >= size);
    }
}

TEST_CASE("the functions that make boxes contain what they are named after, and no more than they must") {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int round = 0; round < 300; ++round) {
        const glm::vec3 c = 10.0f * random_vector(random), x = random_vector(random), y = random_vector(random),
                        z = random_vector(random);
        const float radius = 0.1f + std::abs(unit(random));
        const Sphere ball = {c.x, c.y, c.z, radius};
        if (std::abs(glm::dot(x, glm::cross(y, z))) < 0.01f) continue;  // contains() divides by it
        const glm::vec3 s = random_vector(random);
        const glm::vec3 in_cube = c + s.x * x + s.y * y + s.z * z;
        const Box whole = oriented_box(c, x, y, z);
        const glm::mat4 m(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(c, 1));
        CHECK(contains(whole, in_cube));
        CHECK(contains(oriented_box(m, 1), in_cube));
        CHECK(contains(oriented_box(m, 0.5), c + 0.5f * (in_cube - c)));
        CHECK(!contains(oriented_box(m, 0.5), c + 0.51f * (x + s.y * y + s.z * z)));
        CHECK(contains(clipped_sphere(ball, whole), in_cube) == (glm::length(in_cube - c) <= radius * 1.001f));
        const Box half = half_sphere(ball, x);
        const glm::vec3 in_ball = c + radius * s / std::max(glm::length(s), 1.0f);
        CHECK((glm::dot(in_ball - c, x) < 0 || contains(half, in_ball)));
        CHECK(!contains(half, c - 0.01f * radius * glm::normalize(x)));
        const Box projector = projector_box(c, x, y, z, 0.25);
        const float depth = 0.25f + 0.75f * std::abs(s.x);
        CHECK(contains(projector, c + depth * (x + s.y * y + s.z * z)));
        CHECK(!contains(projector, c + depth * (x + 1.01f * y + s.z * z)));
        const Box tube = tube_box(c, c + x, radius);
        CHECK(contains(tube, c + std::abs(unit(random)) * x + radius * glm::normalize(s)));
        CHECK(!contains(tube, c + x + 1.02f * radius * glm::normalize(x)));
        // The sphere around a box holds all corners and touches one of them.
        float farthest = 0;
        for (int corner = 0; corner < 8; ++corner)
            farthest = std::max(farthest,
                                glm::length((corner & 1 ? x : -x) + (corner & 2 ? y : -y) + (corner & 4 ? z : -z)));
        CHECK(whole.radius == doctest::Approx(farthest).epsilon(1e-5));
        CHECK(bounding_sphere(clipped_sphere(ball, whole)).radius <= radius);
        CHECK(bounding_sphere(clipped_sphere({c.x, c.y, c.z, 100}, whole)).radius == whole.radius);
    }
    CHECK(!(bounding_sphere(half_sphere({0, 0, 0, 1}, glm::vec3(0))).radius >= 0));
    CHECK(!(bounding_sphere(half_sphere({0, 0, 0, std::nanf("")}, glm::vec3(1))).radius >= 0));
    CHECK(!(bounding_sphere(half_sphere({HUGE_VALF, 0, 0, HUGE_VALF}, glm::vec3(1))).radius >= 0));
    CHECK(!(bounding_sphere(tube_box(glm::vec3(HUGE_VALF), glm::vec3(1), 1)).radius >= 0));
    CHECK(!(bounding_sphere(tube_box(glm::vec3(0), glm::vec3(1), -1)).radius >= 0));
    CHECK(bounding_sphere(tube_box(glm::vec3(1), glm::vec3(1), 2)).radius == doctest::Approx(2));
}

TEST_CASE("the functions that make boxes lose no light that is as large as floats are, or endless, or a point") {
    constexpr float most = std::numeric_limits<float>::max();
    const glm::vec3 zero(0), up(0, 1, 0), far(0, 0, -most);
    std::vector<Box> boxes, points;
    for (const float radius : {HUGE_VALF, most, 2e38f}) {
        boxes.push_back(half_sphere({0, -3, -5, radius}, up));
        boxes.push_back(half_sphere({0, -1e38f, 0, radius}, glm::vec3(1e-45f, most, 0)));
        boxes.push_back(tube_box(zero, far, radius));
        boxes.push_back(tube_box(-far, far, radius));
        boxes.push_back(clipped_sphere({0, 0, -5, radius}, oriented_box(zero, up * most, far, glm::vec3(most, 0, 0))));
    }
    boxes.push_back(tube_box(glm::dvec3(0, 0, 1e308), glm::dvec3(0, 0, -1e308), 1e38f));
    boxes.push_back(oriented_box(glm::dvec3(0), glm::dvec3(1e39, 0, 0), glm::dvec3(0, 1e39, 0), glm::dvec3(0, 0, 1e39)));
    boxes.push_back(projector_box(glm::dvec3(0, 0, 1e39), {0, 0, -1e40}, {1e40, 0, 0}, {0, 1e40, 0}));
    const Sphere none = {0, 0, -5, light_range(0, 1)};
    for (const glm::vec3& centre : {glm::vec3(0, 0, -5), glm::vec3(1e-45f, 0, -3e38f)})
        for (const Sphere& point : {none, Sphere{centre.x, centre.y, centre.z, 0}, Sphere{0, 0, -1, 1e-45f}}) {
            points.push_back(half_sphere(point, up));
            points.push_back(tube_box(centre, centre, point.radius));
        }
    const View view = *View::from_projection(glm::infinitePerspective(1.0f, 1.5f, 0.1f), {96, 64}, {.tile_size = 32});
    Binner<> binner;
    for (const std::vector<Box>& some : {boxes, points}) {
        const auto grid = binner.bin(view, some);
        REQUIRE(grid);
        CHECK(grid->light_counts().rejected == 0);
        CHECK(grid->light_counts().culled == 0);
    }
    for (const std::vector<std::uint32_t>& list : test::lists(view, boxes))
        CHECK(list.size() == boxes.size());
}
