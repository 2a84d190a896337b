// What each light covers, against the lists, against exact depths, and against projected points of the lights.
#include "scene.hpp"

#include <lightbin/coverage.hpp>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include <limits>
#include <set>

using namespace lightbin;

namespace {

/// Returns the ids in the lists of each tile over all slices, sorted and without repeats.
template <class Id> test::Lists tiles_of(const LightGrid<Id>& grid) {
    test::Lists tiles;
    for (int y = 0; y < grid.tiles_y(); ++y)
        for (int x = 0; x < grid.tiles_x(); ++x) {
            std::set<std::uint32_t> here;
            for (int slice = 0; slice < grid.slices(); ++slice)
                for (const Id id : grid.lights_in(x, y, slice))
                    here.insert(grid.ranks().order.empty() ? id : grid.ranks().order[id]);
            tiles.emplace_back(here.begin(), here.end());
        }
    return tiles;
}

/// The ids of the lights whose rectangles have each tile.
test::Lists tiles_of(const std::vector<LightCoverage>& covered, const View& view) {
    test::Lists tiles(view.tile_count());
    for (const LightCoverage& light : covered) {
        CHECK((light.x0 <= light.x1 && light.y0 <= light.y1));
        for (int y = light.y0; y <= light.y1; ++y)
            for (int x = light.x0; x <= light.x1; ++x)
                tiles[static_cast<std::size_t>(y * view.tiles_x() + x)].push_back(light.id);
    }
    return tiles;
}

/// Returns spots with half angles up to 90 degrees; some are whole spheres.
std::vector<Spot> some_spots(std::size_t count, std::uint32_t seed) {
    std::vector<Spot> spots = test::random_kinds(0, count, 0, seed).spots;
    for (Spot& spot : spots)
        if (spot.cos_half_angle < 0) spot.cos_half_angle = -1;
    return spots;
}

/// Returns spheres at the depths of random_lights() for a view, whichever way it looks.
std::vector<glm::vec4> lights_before(const View& view, std::size_t count, std::uint32_t seed) {
    auto lights = test::random_lights(count, seed);
    const bool forward = view.image_point({0, 0, 1}).depth > 0;
    for (glm::vec4& light : lights)
        light.z = forward ? -light.z : light.z;
    return lights;
}

/// Returns the size of a sphere's image in pixels. Each image axis shows a disc: points of its edge beyond the near
/// plane are tried, and where edge and near plane meet. Without perspective nothing is cut off.
double sampled_pixels(const View& view, const glm::dvec4& sphere) {
    const double forward = view.image_point({0, 0, 1}).depth, z = forward * sphere.z, r = sphere.w,
                 near_z = view.orthographic() ? -HUGE_VAL : view.near_depth();
    double most = 0;
    for (int axis = 0; axis < 2; ++axis) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        const auto add = [&](double c, double depth) {
            if (depth < near_z) return;
            const ImagePoint at = view.image_point({c, c, forward * depth});
            low = std::min(low, axis == 0 ? at.x : at.y);
            high = std::max(high, axis == 0 ? at.x : at.y);
        };
        const double c = axis == 0 ? sphere.x : sphere.y;
        for (int i = 0; i < 4000; ++i) {
            const double angle = i * (2 * 3.14159265358979 / 4000);
            add(c + r * std::cos(angle), z + r * std::sin(angle));
        }
        if (const double half = r * r - (near_z - z) * (near_z - z); half > 0) {
            add(c - std::sqrt(half), near_z);
            add(c + std::sqrt(half), near_z);
        }
        most = std::max(most, high - low);
    }
    return most;
}

}  // namespace

TEST_CASE(
    "a light's rectangle is the tiles that list it, and every light in view has one, in ascending order") {
    for (const View& view : test::cameras(32))
        for (const std::size_t count : {0u, 1u, 65u, 700u}) {
            const auto spheres = lights_before(view, count, 3);
            const auto spots = some_spots(count, 4);
            const Slices slices = *Slices::exponential(6, 2, 70);
            const auto check =
                [&]<Options options>(const auto& lights,
                                     const Inputs<options.depth_test, options.slicing>& inputs) {
                    Binner<options> binner;
                    const auto grid = binner.bin(view, lights, inputs);
                    REQUIRE(grid);
                    const auto covered = *coverage(view, lights);
                    const LightCounts& counts = grid->light_counts();
                    CHECK(covered.size() == counts.lights - counts.rejected - counts.culled);
                    CHECK(std::ranges::is_sorted(covered, {}, &LightCoverage::id));
                    CHECK(tiles_of(covered, view) == tiles_of(*grid));
                };
            check.template operator()<Options{}>(spheres, {});
            check.template operator()<Options{.ids = IdWidth::u16}>(spots, {});
            check.template operator()<Options{.slicing = Slicing::clusters}>(spheres, {.slices = slices});
            check.template operator()<Options{.slicing = Slicing::z_bins}>(spots, {.slices = slices});
        }
}

TEST_CASE("what a Binner refuses of lights has no coverage") {
    const View view = test::view({640, 360}, 32);
    const auto lights = test::random_lights(100, 1);
    CHECK(coverage(view, std::vector<Sphere>())->empty());
    CHECK(!coverage(view, lights)->empty());
    const auto refused = coverage(view, world_space(lights, glm::mat4(NAN)));
    REQUIRE(!refused);
    Binner<> binner;
    CHECK(refused.error().code == binner.bin(view, world_space(lights, glm::mat4(NAN))).error().code);
}

TEST_CASE("the depths of a sphere enclose it, and are no more than a few floats wider") {
    for (const View& view : test::cameras(32)) {
        const double forward = view.image_point({0, 0, 1}).depth;
        auto lights = lights_before(view, 900, 21);
        lights.push_back({0, 0, forward * 10, std::numeric_limits<float>::infinity()});
        lights.push_back({0, 0, forward * 10, 0});
        lights.push_back({0, 0, forward * 10, 1e-30f});
        lights.push_back({0, 0, forward * 1e-3, 9});
        lights.push_back({0, 0, -FLT_MAX * forward, FLT_MAX});
        lights.push_back({0, 0, FLT_MAX * forward, FLT_MAX});
        const auto covered = *coverage(view, lights);
        for (const LightCoverage& light : covered) {
            const long double z = static_cast<long double>(forward) * lights[light.id].z,
                              r = lights[light.id].w;
            CHECK(light.nearest <= z - r);
            CHECK(light.farthest >= z + r);
            const auto before = [](float a) {
                return std::nextafter(std::nextafter(a, HUGE_VALF), HUGE_VALF);
            };
            if (std::isfinite(light.nearest)) CHECK(before(light.nearest) >= z - r);
            if (std::isfinite(light.farthest)) CHECK(-before(-light.farthest) <= z + r);
        }
    }
}

TEST_CASE("a sphere's size in pixels is that of its projection, cut off at the near plane and not at the "
          "viewport's edge") {
    for (const View& view : test::cameras(32)) {
        const auto lights = lights_before(view, 400, 31);
        const auto covered = *coverage(view, lights);
        CHECK(covered.size() > 50);
        int finite = 0, larger_than_viewport = 0;
        for (const LightCoverage& light : covered) {
            const glm::dvec4 sphere(lights[light.id]);
            const double sampled = sampled_pixels(view, sphere);
            CHECK(double{light.pixels} >= sampled);
            if (!std::isfinite(light.pixels)) continue;
            CHECK(double{light.pixels} <= sampled * 1.01);
            ++finite;
            larger_than_viewport += light.pixels > 500;
        }
        CHECK(finite > 40);
        CHECK((larger_than_viewport > 0 || view.orthographic()));
    }
}

TEST_CASE("the size in pixels of small, large and infinite spheres") {
    const View view = test::view({640, 360}, 32);
    // Pixels for a slope of 1, with the matrix rounded to float.
    const double per_slope = view.image_point({1, 0, -1}).x - view.image_point({0, 0, -1}).x;
    const std::vector<Sphere> lights = {{0, 0, -10, 0},          {0, 0, -10, 1e-6f}, {0, 0, -10, 1e-20f},
                                        {0, 0, -500, 1},         {3, -2, -9, 1},     {0, 0, -10, 9.89f},
                                        {0, 0, -10, 9.94f},      {0, 0, 0, 0.2f},    {0, 0, -10, HUGE_VALF},
                                        {0, 0, -1e6f, 999500.0f}};
    const auto covered = *coverage(view, lights);
    REQUIRE(covered.size() == lights.size());
    const View oblong = *View::from_projection(glm::perspectiveRH_NO(1.0471976f, 640 / 360.0f, 0.1f, 1000.0f),
                                               {640, 360}, {.columns = 40, .rows = 3});
    const auto in_oblong_tiles = *coverage(oblong, lights);
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (std::isfinite(covered[i].pixels))
            CHECK(in_oblong_tiles[i].pixels == doctest::Approx(covered[i].pixels).epsilon(1e-5));
    const auto near_is = [&](std::size_t i, double pixels) {
        CHECK(double{covered[i].pixels} >= pixels);
        CHECK(double{covered[i].pixels} <= pixels * (1 + 1e-5) + 1e-3);
    };
    const auto tangents = [&](double z, double r) {
        return 2 * r / std::sqrt((z - r) * (z + r)) * per_slope;
    };
    near_is(0, 0);
    near_is(1, tangents(10, 1e-6f));
    near_is(2, 0);
    near_is(3, tangents(500, 1));
    const double flank = std::atan2(3.0, 9.0), half = std::asin(1 / std::sqrt(90.0));
    near_is(4, (std::tan(flank + half) - std::tan(flank - half)) * per_slope);
    near_is(5, tangents(10, 9.89f));
    const double r = 9.94f,
                 touches = 10 - r * r / 10;  // the depth where the tangents touch is beyond the near plane
    CHECK(touches > 0.1);
    near_is(6, tangents(10, r));
    near_is(7, 2 * std::sqrt(0.2f * 0.2 - 0.01) / 0.1 * per_slope);
    CHECK(covered[8].pixels == HUGE_VALF);
    near_is(9, tangents(1e6, 999500));
}

TEST_CASE("a light in view has a size in pixels, however small it is") {
    const View view = *View::from_projection(glm::infinitePerspective(1.0f, 1.5f, 0.1f), {480, 320});
    const Box box = {0, 0, -9, 1, 0, 0, -9, {{0, 1e-42f, 0}, {0, 0, 0}, {0, 0, 0}}};
    const std::vector<Sphere> spheres = {{0, 0, -9, 0}, {0, 0, -3e38f, 0}, {1, 2, -9, 1e-45f}};
    const std::vector<Spot> spots = {{0, 0, -3e38f, 0, 0, 1, 0, 0.9f}, {1, 2, -9, 1e-45f, 0, 1, 0, 0.5f}};
    const std::vector<Box> boxes = {box};
    for (const float scale : {1.0f, 1e-5f}) {  // the box's half axes are 0 in float once they are scaled
        const glm::mat4 to_view = glm::scale(glm::mat4(1), glm::vec3(scale));
        const auto covered =
            *coverage(view, lights(world_space(spheres, glm::mat4(1)), world_space(spots, glm::mat4(1)),
                                   world_space(boxes, glm::translate(to_view, {0, 0, 9 - 9 / scale}))));
        CHECK(covered.size() == 6);
        for (const LightCoverage& light : covered) {
            CHECK(light.pixels > 0);
            CHECK(light.pixels < 1);
            CHECK(light.nearest <= light.farthest);
        }
    }
}

TEST_CASE("a spot's depths enclose it closely, and its size in pixels is that of its least sphere") {
    const glm::mat4 half_turn = glm::scale(glm::mat4(1), glm::vec3(-1, -1, 1));
    for (const View& view : test::cameras(32)) {
        const double forward = view.image_point({0, 0, 1}).depth;
        auto spots = some_spots(300, 41), in_world = spots;
        for (Spot& spot : spots)
            spot.z *= static_cast<float>(-forward);
        for (std::size_t i = 0; i < spots.size(); ++i) {
            const Spot& s = spots[i];
            in_world[i] = {-s.x, -s.y, s.z, s.radius, -s.axis_x, -s.axis_y, s.axis_z, s.cos_half_angle};
        }
        for (const bool world : {false, true}) {
            const auto covered = *(world ? coverage(view, world_space(in_world, half_turn)) : coverage(view, spots));
            CHECK(covered.size() > 40);
            for (const LightCoverage& light : covered) {
                const Spot& spot = spots[light.id];
                const double r = spot.radius, cosine = spot.cos_half_angle, z = forward * spot.z;
                const double aside = std::hypot(spot.axis_x, spot.axis_y), ahead = forward * spot.axis_z;
                const double length = std::hypot(aside, ahead), sine = std::sqrt(1 - cosine * cosine);
                // How far the spot reaches from its apex to (-1) or from (1) the eye: to its sphere, its rim or
                // nowhere.
                const auto reach = [&](double towards) {
                    const double along = towards * ahead / length;
                    if (cosine < 0 || along >= cosine) return r;
                    return std::max(r * (cosine * along + sine * aside / length), 0.0);
                };
                const double nearest = z - reach(-1), farthest = z + reach(1);
                const double slack = world ? 1e-4 * (r + std::fabs(z)) : 0, wider = slack + 1e-5 * (r + std::fabs(z));
                CHECK(light.nearest <= nearest + slack);
                CHECK(light.farthest >= farthest - slack);
                CHECK(light.nearest >= nearest - wider);
                CHECK(light.farthest <= farthest + wider);

                const Sphere least = bounding_sphere(spot);
                const glm::dvec4 sphere(least.x, least.y, least.z, least.radius);
                if (!std::isfinite(light.pixels) ||
                    forward * sphere.z - sphere.w < 0.01 * sphere.w + 2 * double{view.near_depth()})
                    continue;
                const double size = sampled_pixels(view, sphere), away = std::hypot(spot.x, spot.y, spot.z);
                CHECK(double{light.pixels} >= size * (world ? 0.999 : 0.99999));
                CHECK(double{light.pixels} <= size * 1.01 * (1 + 1e-5 * away / sphere.w) + 0.01);
            }
        }
    }
}

TEST_CASE("entries are counted for each light, also by rank and with clusters, and a light in no drawn tile "
          "has none") {
    const View view = test::view({640, 360}, 32);
    const auto lights = test::random_lights(800, 51);
    const Slices slices = *Slices::exponential(6, 2, 70);
    std::vector<float> min(view.tile_count(), 12.0f), max(view.tile_count(), 14.0f);
    const auto check = [&]<Options options>() {
        Binner<options> binner;
        const auto grid = binner.bin(view, lights, inputs_for<options>({.min = min, .max = max}, slices));
        REQUIRE(grid);
        std::vector<std::uint32_t> expected(lights.size()), entries(lights.size() + 1, 77);
        std::uint32_t listed = 0;
        for (const auto& list : test::to_lists(*grid))
            for (const std::uint32_t id : list)
                listed += expected[grid->ranks().order.empty() ? id : grid->ranks().order[id]]++ == 0;
        expected.push_back(77);
        const auto found = count_entries(*grid, entries);
        REQUIRE(found);
        CHECK(*found == listed);
        CHECK(entries == expected);
        const auto refused = count_entries(*grid, std::span(entries).first(lights.size() - 1));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::light_buffer_too_small);
        CHECK(std::string(refused.error().message()).find("has 799, and 800 lights") != std::string::npos);
        return listed;
    };
    const std::uint32_t all = check.template operator()<Options{.ids = IdWidth::u16}>();
    check.template operator()<Options{.slicing = Slicing::clusters}>();
    check.template operator()<Options{.slicing = Slicing::z_bins}>();
    const std::uint32_t drawn = check.template operator()<Options{.depth_test = true}>();
    CHECK(drawn == check.template operator()<Options{.depth_test = true, .slicing = Slicing::z_bins}>());
    CHECK(drawn < all);
}
