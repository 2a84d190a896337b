// The forms in which lights are passed: all must give the same grid.
#include "scene.hpp"

#include <glm/ext/matrix_transform.hpp>

#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <type_traits>
#include <vector>

using namespace lightbin;

namespace {

const View full_view = test::view({641, 361}, 16);  // the last tiles are partial
const glm::mat4 full_turn = glm::rotate(glm::mat4(1.0f), 0.3f, glm::normalize(glm::vec3(1, 2, 3)));

/// Checks that lights in this form give the lists of the spheres, also if a depth test reads the lights again.
void check_form(const auto& lights, const std::vector<glm::vec4>& spheres) {
    constexpr Options tested = {.depth_test = true};
    const std::vector<float> low(full_view.tile_count(), 5.0f), high(full_view.tile_count(), 40.0f);
    const ZBounds bounds = {.min = low, .max = high};
    CHECK(test::lists(full_view, lights) == test::lists(full_view, spheres));
    CHECK(test::lists<tested>(full_view, lights, bounds) == test::lists<tested>(full_view, spheres, bounds));
}

struct IsOne : Sphere {};
struct IsOneWithMore : Sphere {
    std::uint32_t w = 0x7fc00000;  // not its radius
};
struct BecomesOne {
    float x, y, z, r;
    operator Sphere() const { return {x, y, z, r}; }
};
struct BecomesOneFromOther {
    std::uint64_t pad;
    double px, py, pz, r;
    operator Sphere() const {
        return {static_cast<float>(px), static_cast<float>(py), static_cast<float>(pz), static_cast<float>(r)};
    }
};
struct Reversed {  // as large as a Sphere, and not laid out like one
    float w, z, y, x;
};

}  // namespace

TEST_CASE("spheres in any form give the same lists") {
    const auto spheres = test::random_lights(500, 1);
    struct PointLight {  // nothing in the order lightbin would like
        float power = 1;
        glm::dvec3 position;
        std::uint16_t flags = 7;
        float range;
    };
    std::vector<Sphere> plain;
    std::vector<PointLight> own;
    std::vector<Reversed> reversed;
    std::vector<IsOne> same;
    std::vector<IsOneWithMore> more(spheres.size());
    std::vector<BecomesOne> becomes;
    std::vector<BecomesOneFromOther> other;
    for (const glm::vec4& s : spheres) {
        plain.push_back({s.x, s.y, s.z, s.w});
        own.push_back({.position = glm::dvec3(s), .range = s.w});
        reversed.push_back({s.w, s.z, s.y, s.x});
        same.push_back({plain.back()});
        static_cast<Sphere&>(more[same.size() - 1]) = plain.back();
        becomes.push_back({s.x, s.y, s.z, s.w});
        const glm::dvec4 wide(s);
        other.push_back({7, wide.x, wide.y, wide.z, wide.w});
    }
    const auto to_light = [](const PointLight& light) {
        const glm::vec3 p(light.position);
        return Sphere{p.x, p.y, p.z, light.range};
    };
    check_form(plain, spheres);
    check_form(view_space(own, to_light), spheres);
    check_form(std::span<const glm::vec4>(spheres), spheres);
    check_form(reversed, spheres);
    check_form(same, spheres);
    check_form(more, spheres);
    check_form(becomes, spheres);
    check_form(other, spheres);
    check_form(std::array<Sphere, 3>{plain[0], plain[1], plain[2]}, {spheres.begin(), spheres.begin() + 3});

    std::vector<const glm::vec4*> pointers;
    for (const glm::vec4& s : spheres)
        pointers.push_back(&s);
    check_form(view_space(pointers, [](const glm::vec4* s) { return Sphere{s->x, s->y, s->z, s->w}; }), spheres);
}

namespace {

struct Lamp {
    Sphere sphere;
    Spot spot;
};
Sphere sphere_of(const Lamp& lamp) {
    return lamp.sphere;
}

}  // namespace

TEST_CASE("to_light is a lambda, a function or a function object, and its lights may be references or convert") {
    std::mt19937 random(10);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Lamp> lamps;
    std::vector<Sphere> spheres;
    std::vector<Spot> spots;
    for (const glm::vec4& s : test::random_lights(300, 10)) {
        spheres.push_back({s.x, s.y, s.z, s.w});
        spots.push_back({s.x, s.y, s.z, s.w, unit(random), unit(random), unit(random), unit(random)});
        lamps.push_back({spheres.back(), spots.back()});
    }
    const auto check = [&](const auto& expected, const auto& to_light) {
        CHECK(test::lists(full_view, view_space(lamps, to_light)) == test::lists(full_view, expected));
        CHECK(test::lists(full_view, world_space(lamps, full_turn, to_light)) ==
              test::lists(full_view, world_space(expected, full_turn)));
    };
    struct Becomes {
        const Spot& spot;
        operator Spot() const { return spot; }
    };
    check(spheres, [](const Lamp& lamp) { return lamp.sphere; });
    check(spheres, sphere_of);
    check(spheres, std::function<Sphere(const Lamp&)>(sphere_of));
    check(spots, [](const Lamp& lamp) -> const Spot& { return lamp.spot; });
    check(spots, [](const Lamp& lamp) { return Becomes{lamp.spot}; });
    // A temporary span is allowed, because its elements outlive it.
    CHECK(view_space(std::span<const Sphere>(spheres)).array.data() == spheres.data());
}

namespace {

/// Puts lights that are given relative to the eye into a world where the eye is at `eye`: around their own positions in
/// double, of which each light keeps no more than is lost as `eye + x` is rounded.
template <class Light> auto into_world(const glm::dvec3& eye) {
    return [=](Light light) {
        const WorldPoint at = {eye.x + static_cast<double>(light.x), eye.y + static_cast<double>(light.y),
                               eye.z + static_cast<double>(light.z)};
        if constexpr (std::is_same_v<Light, Box>)
            light.box_x -= light.x, light.box_y -= light.y, light.box_z -= light.z;
        light.x = light.y = light.z = 0;
        return Placed<Light>{at, light};
    };
}

}  // namespace

// That no light is missed is proven by tests/oracle, in rational numbers.
TEST_CASE("lists far from the world's origin are those at the origin") {
    glm::mat4 moved = full_turn;  // its translation is not to be read
    moved[3] = {5, 1e20f, 7, 1};
    test::Kinds kinds = test::random_kinds(150, 150, 150, 8);
    const auto on_grid = [](float& a) { a = std::round(a * 16) / 16; };  // added to these eyes, it is not rounded
    const auto all_on_grid = [&](auto& light) { on_grid(light.x), on_grid(light.y), on_grid(light.z); };
    std::for_each(kinds.spheres.begin(), kinds.spheres.end(), all_on_grid);
    std::for_each(kinds.spots.begin(), kinds.spots.end(), all_on_grid);
    for (Box& box : kinds.boxes) {
        all_on_grid(box);
        on_grid(box.box_x), on_grid(box.box_y), on_grid(box.box_z);
    }
    const auto check = [&]<class Light>(const std::vector<Light>& lights) {
        constexpr Options tested = {.depth_test = true};
        const std::vector<float> low(full_view.tile_count(), 5.0f), high(full_view.tile_count(), 40.0f);
        const ZBounds bounds = {.min = low, .max = high};
        const auto near = world_space(lights, full_turn);
        const std::size_t entries = test::entries(test::lists(full_view, near));
        for (const double distance : {1e5, 1e6, 1e7, 1e8, 1e9}) {
            const glm::dvec3 whole(distance, 61.625, distance / 2), eye(distance + 0.37, 61.62, distance / 2 + 0.11);
            const auto far = world_space(lights, moved, {whole.x, whole.y, whole.z}, into_world<Light>(whole));
            CHECK(test::lists(full_view, far) == test::lists(full_view, near));
            CHECK(test::lists<tested>(full_view, far, bounds) == test::lists<tested>(full_view, near, bounds));
            const double ratio =
                static_cast<double>(test::entries(test::lists(
                    full_view, world_space(lights, moved, {eye.x, eye.y, eye.z}, into_world<Light>(eye))))) /
                static_cast<double>(entries);
            CHECK(std::fabs(ratio - 1) < 0.01);
        }
        // Sectors: the lights' floats are relative to an origin in double.
        for (const double distance : {0x1p40, 0x1p60, 0x1p127})
            CHECK(test::lists(full_view, world_space(lights, moved, {0, -distance, distance}, [=](const Light& light) {
                                  return Placed<Light>{{0, -distance, distance}, light};
                              })) == test::lists(full_view, near));
    };
    check(kinds.spheres);
    check(kinds.spots);
    check(kinds.boxes);
}

TEST_CASE("spheres that are moved in doubles hold what the rounding of their places relative to the eye moves") {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> small(0, 0.01);
    int wider = 0;  // what the rounding of the result alone would not explain
    for (int i = 0; i < 20000; ++i) {
        const double angle = small(random), eye = 1e9 * small(random);
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 0, 1));
        const std::vector<Placed<Sphere>> lights = {{{eye + 1 + small(random), 0, 0}, {0, 0, 0, 0}}};
        const auto world = world_space(lights, turn, {eye, 0, 0}, [](const auto& light) { return light; });
        const Sphere image = (*world.to_view)(world.made(lights[0]));
        const long double x = static_cast<long double>(lights[0].origin.x) - static_cast<long double>(eye),
                          dx = static_cast<long double>(turn[0].x) * x - static_cast<long double>(image.x),
                          dy = static_cast<long double>(turn[0].y) * x - static_cast<long double>(image.y),
                          moved = std::sqrt(dx * dx + dy * dy);
        CHECK_UNARY(moved <= static_cast<long double>(image.radius));
        wider += moved > 0x1p-24L * static_cast<long double>(image.x + image.y) * (1 + 0x1p-10L);
    }
    CHECK(wider > 100);
}

TEST_CASE("in a large world, too, bad input stays local, and an eye that is no point is refused") {
    const double nan = std::nan(""), infinite = HUGE_VAL;
    const std::vector<Sphere> lights = {{0, 0, 0, 1}, {0, 0, 0, HUGE_VALF}, {0, 0, 0, -1}};
    Binner<> binner;
    const auto bin = [&](double x, double eye) {
        return binner.bin(full_view, world_space(lights, full_turn, {0, 0, eye}, [=](const Sphere& light) {
                              return Placed<Sphere>{{x, 0, eye - 5}, light};
                          }));
    };
    for (const double x : {nan, infinite, -infinite, 1e39, -1.7e308}) {
        const auto grid = bin(x, 1e9);
        REQUIRE(grid);
        CHECK(grid->light_counts().rejected == 2);
        CHECK(grid->light_counts().culled == 1);
    }
    for (const double x : {0.0, 3e38}) CHECK(bin(x, 1e9)->light_counts().rejected == 0);
    CHECK(bin(0, DBL_MAX)->light_counts().rejected == 0);
    for (const double eye : {nan, infinite, -infinite}) {
        REQUIRE(!bin(0, eye));
        CHECK(bin(0, eye).error().code == ErrorCode::eye_not_finite);
    }
    const auto transposed = world_space(lights, glm::transpose(glm::translate(full_turn, {1.0f, 2.0f, 3.0f})),
                                        {0, 0, 0}, into_world<Sphere>({}));
    CHECK(binner.bin(full_view, transposed).error().code == ErrorCode::view_matrix_transposed);
}

TEST_CASE("a sphere of doubles becomes one of floats that holds it, and is no larger than it must be") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> mantissa(-2, 2);
    for (int i = 0; i < 200000; ++i) {
        const auto number = [&](int low, int high) {
            return std::ldexp(mantissa(random),
                              low + static_cast<int>(random() % static_cast<unsigned>(high - low)));
        };
        const glm::dvec4 light(number(-40, 40), number(-40, 40), number(-160, 127),
                               std::fabs(number(i % 3 == 0 ? -1000 : -30, i % 3 == 1 ? 126 : 30)));
        const Sphere sphere = detail::sphere_around({light.x, light.y, light.z}, light.w);
        // The point of one sphere farthest from the other's centre, in long double, which has 11 more bits.
        const long double dx = static_cast<long double>(light.x) - static_cast<long double>(sphere.x),
                          dy = static_cast<long double>(light.y) - static_cast<long double>(sphere.y),
                          dz = static_cast<long double>(light.z) - static_cast<long double>(sphere.z),
                          moved = std::sqrt(dx * dx + dy * dy + dz * dz),
                          reach = static_cast<long double>(light.w) + moved;
        CHECK_UNARY(static_cast<long double>(sphere.radius) >= reach * (1 - 0x1p-60L));
        CHECK_UNARY(static_cast<long double>(sphere.radius) <=
                    (reach + moved) * (1 + 0x1p-22L) + std::abs(static_cast<long double>(light.x)) * 0x1p-50L +
                        std::abs(static_cast<long double>(light.y)) * 0x1p-50L +
                        std::abs(static_cast<long double>(light.z)) * 0x1p-50L + 0x1p-123L);
    }
}

TEST_CASE("doubles out of the floats' range light everything; those that are bad input stay bad") {
    const double nan = std::nan(""), infinite = HUGE_VAL;
    for (const glm::dvec4& s : {glm::dvec4(1e300, 0, 0, 1e301), glm::dvec4(0, 0, 0, 1e300), glm::dvec4(0, 0, 0, infinite)})
        CHECK(detail::sphere_around({s.x, s.y, s.z}, s.w).radius == HUGE_VALF);
    for (const glm::dvec4& s : {glm::dvec4(nan, 0, 0, 1), glm::dvec4(infinite, 0, 0, 1), glm::dvec4(0, 0, 0, nan),
                                glm::dvec4(0, 0, 0, -1e-300)})
        CHECK(detail::sphere_around({s.x, s.y, s.z}, s.w).radius < 0);
}

// That these spheres hold the shapes, and are the least that do, is proven in tests/oracle/least_spheres.cpp.
TEST_CASE("spheres around lights of other shapes, whole, endless or bad") {
    for (const float cosine : {0.0f, -0.0f, -0.3f, -1.0f})
        CHECK(bounding_sphere(Spot{1, 2, 3, 8, 0, 1e-45f, 0, cosine}).radius == 8);
    for (const float axis : {0.0f, HUGE_VALF, std::nanf("")})
        CHECK(bounding_sphere(Spot{1, 2, 3, 8, axis, axis, 0, -1}).radius == 8);
    CHECK(bounding_sphere(Spot{1, 2, 3, HUGE_VALF, 0, 1, 0, 0.9f}).radius == HUGE_VALF);
    CHECK(bounding_sphere(Spot{1, 2, 3, 0, 0, 1, 0, 0.9f}).radius == 0);

    const glm::vec3 a(1, 2, 3), b(7, 2, 11);
    CHECK(tube_sphere(ViewPoint{1, 2, 3}, ViewPoint{7, 2, 11}, 2).radius == tube_sphere(a, b, 2).radius);
    CHECK(tube_sphere(a, b, HUGE_VALF).radius == HUGE_VALF);
    CHECK(rectangle_sphere(a, {3, 0, 0}, {3, 0, 0}, 2).radius == doctest::Approx(8));  // flat
    CHECK(rectangle_sphere(a, b, b, HUGE_VALF).radius == HUGE_VALF);
    const glm::vec3 bad(0, std::nanf(""), 0), endless(0, 0, HUGE_VALF);
    for (const glm::vec3& p : {bad, endless}) {
        CHECK(tube_sphere(p, b, 2).radius < 0);
        CHECK(tube_sphere(a, p, 2).radius < 0);
        CHECK(rectangle_sphere(p, a, b, 2).radius < 0);
        CHECK(rectangle_sphere(a, p, b, 2).radius < 0);
        CHECK(rectangle_sphere(a, b, p, HUGE_VALF).radius < 0);
    }
    for (const float radius : {std::nanf(""), -1e-45f, -HUGE_VALF}) {
        CHECK(tube_sphere(a, b, radius).radius < 0);
        CHECK(rectangle_sphere(a, b, b, radius).radius < 0);
    }
}

TEST_CASE("light_range") {
    CHECK(light_range(100.0f, 1.0f) == doctest::Approx(10.0f));
    CHECK(light_range(2.0f, 0.5f) == doctest::Approx(2.0f));
    for (const float intensity : {1.0f, 3.0f, 800.0f, 1e-20f, 1e30f})
        for (const float cutoff : {1.0f, 0.3f, 1e-3f, 7e10f}) {
            const double range = static_cast<double>(light_range(intensity, cutoff));
            CHECK(static_cast<double>(intensity) / (range * range) <=
                  static_cast<double>(cutoff));  // rounded up
            CHECK(static_cast<double>(intensity) / (range * range) >=
                  static_cast<double>(cutoff) * (1 - 1e-6));
        }
    CHECK(light_range(0, 1) == 0);
    CHECK(light_range(-5, 1) == 0);
    CHECK(light_range(5, 0) == HUGE_VALF);
    CHECK(light_range(5, -1) == HUGE_VALF);
    CHECK(std::isnan(light_range(std::nanf(""), 1)));
    CHECK(std::isnan(light_range(1, std::nanf(""))));
    CHECK(light_range(HUGE_VALF, HUGE_VALF) == HUGE_VALF);
    CHECK(light_range(HUGE_VALF, 1) == HUGE_VALF);
    CHECK(std::isnan(light_range(HUGE_VALF, std::nanf(""))));
}
