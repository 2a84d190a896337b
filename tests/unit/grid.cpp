// The light grid itself: order, determinism, both id types, Z bounds, transparency, counts. That no light
// is missed is proved in tests/oracle.
#include "scene.hpp"

#include <bit>
#include <cstring>
#include <limits>

using namespace lightbin;

namespace {

constexpr Options by_interval = {.depth_test = DepthTest::interval};

std::vector<float> random_floats(std::size_t count, float low, float high, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    std::vector<float> values(count);
    for (float& v : values)
        v = value(random);
    return values;
}

}  // namespace

TEST_CASE("the same input gives the same bytes, whatever the Binner did before") {
    const View view = test::view({800, 600}, 16), other = test::view({3840, 2160}, 8);
    const auto lights = test::random_lights(1000, 11);
    Binner<> used, fresh;
    (void)used.bin(other, test::random_lights(5000, 12));
    (void)used.bin(view, test::random_lights(10, 13));
    const auto a = used.bin(view, lights), b = fresh.bin(view, lights);
    REQUIRE(a->ranges().size_bytes() == b->ranges().size_bytes());
    REQUIRE(a->ids().size_bytes() == b->ids().size_bytes());
    CHECK(std::memcmp(a->ranges().data(), b->ranges().data(), a->ranges().size_bytes()) == 0);
    CHECK(std::memcmp(a->ids().data(), b->ids().data(), a->ids().size_bytes()) == 0);
}

TEST_CASE("16-bit ids are the same ids") {
    const View view = test::view({1280, 720}, 32);
    const auto lights = test::random_lights(65536, 14);  // as many as there are ids
    CHECK(test::lists<Options{.ids = IdWidth::u16}>(view, lights) == test::lists(view, lights));
}

TEST_CASE("a NaN bound tests nothing; infinite bounds mean what they say") {
    const View view = test::view({320, 256}, 32);
    const std::size_t tiles = view.tile_count();
    const std::vector<glm::vec4> lights = {{0, 0, -5, 1}, {0, 0, 0, HUGE_VALF}};
    const auto everywhere = test::lists(view, lights);
    const std::vector<float> nan(tiles, std::nanf("")), inf(tiles, HUGE_VALF), minus_inf(tiles, -HUGE_VALF);
    CHECK(test::lists<by_interval>(view, lights, ZBounds{.min = nan, .max = nan}) == everywhere);
    CHECK(test::lists<by_interval>(view, lights, ZBounds{.min = minus_inf, .max = inf}) == everywhere);
    CHECK(test::entries(test::lists<by_interval>(view, lights, ZBounds{.min = inf, .max = minus_inf})) ==
          0);  // empty tiles
    CHECK(test::entries(test::lists<by_interval>(view, lights, ZBounds{.min = inf, .max = inf})) ==
          tiles);  // the infinite one

    // A tile of NaN among others of which all are in front of the light, or behind it.
    const std::size_t middle = 45;  // of 10 x 8
    REQUIRE(everywhere[middle].size() == 2);
    for (const float depth : {2.0f, 8.0f}) {
        std::vector<float> min(tiles, depth), max(tiles, depth + 1);
        min[middle] = max[middle] = std::nanf("");
        const auto lists =
            test::lists<by_interval>(view, std::vector(1, lights[0]), ZBounds{.min = min, .max = max});
        CHECK(lists[middle].size() == 1);
        CHECK(test::entries(lists) == 1);
    }
}

TEST_CASE("transparency lists: one call gives what two Binners give, of each kind of light") {
    constexpr Options options = {.ids = IdWidth::u16, .depth_test = DepthTest::box};
    const View view = test::view({960, 540}, 16);
    const test::Kinds kinds = test::random_kinds(1500, 300, 300, 20);
    const auto min = random_floats(view.tile_count(), 5.0f, 30.0f, 21),
               max = random_floats(view.tile_count(), 30.0f, 60.0f, 22);
    const auto check = [&](const auto& lights) {
        Binner<options> binner;
        const auto grids = binner.bin_transparency(view, lights, {.bounds = {.min = min, .max = max}});
        REQUIRE(grids);
        const auto opaque = test::to_lists(grids->opaque), transparent = test::to_lists(grids->transparent);
        CHECK(opaque == test::lists<options>(view, lights, ZBounds{.min = min, .max = max}));
        CHECK(transparent == test::lists<options>(view, lights, ZBounds{.min = {}, .max = max}));
        CHECK(test::is_superset(transparent, opaque));
        CHECK(test::entries(transparent) > test::entries(opaque));
    };
    check(kinds.spheres);
    check(kinds.spots);
    check(kinds.boxes);
}

TEST_CASE("what became of the lights, and how long the lists are") {
    const View view = test::view({960, 540}, 16);
    auto lights = test::random_lights(150, 23);
    std::erase_if(lights, [](const glm::vec4& light) { return light.z > -5; });  // leaves tiles empty
    lights.resize(20);
    lights[7].w = -1;
    lights[11].x = std::nanf("");
    lights[13] = {0, 0, 50, 1};  // behind the eye
    Binner<> binner;
    const auto grid = binner.bin(view, lights);
    REQUIRE(grid);
    const ListLengths lengths = list_lengths(*grid);
    const auto lists = test::to_lists(*grid);
    std::vector<bool> listed(lights.size());
    ListLengths expected;
    for (const auto& list : lists) {
        for (const std::uint32_t id : list)
            listed[id] = true;
        expected.longest = std::max(expected.longest, static_cast<std::uint32_t>(list.size()));
        std::size_t bits = 0;
        while (list.size() >> bits)
            ++bits;
        ++expected.histogram[bits];
    }
    const auto in_view = static_cast<std::uint64_t>(std::count(listed.begin(), listed.end(), true));
    CHECK(grid->light_counts().lights == 20);
    CHECK(grid->light_counts().rejected == 2);
    CHECK(grid->light_counts().culled == 20 - 2 - in_view);
    CHECK(lengths.longest == expected.longest);
    CHECK(lengths.histogram == expected.histogram);
    CHECK(lengths.histogram[0] > 0);

    const auto none = binner.bin(view, std::vector<glm::vec4>());
    REQUIRE(none);
    CHECK(none->light_counts().lights == 0);
    CHECK(list_lengths(*none).histogram[0] == view.tile_count());
}
