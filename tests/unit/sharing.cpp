// What docs/kinds.md and docs/several-views.md say of lists that several kinds of lights share, of masks and priorities.
#include "scene.hpp"

#include <lightbin/encode.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

using namespace lightbin;

TEST_CASE("kinds that share one array have ranges of ids, in each list one after another") {
    const View view = test::view({640, 360}, 16);
    const std::vector<std::vector<glm::vec4>> kinds = {
        test::random_lights(60, 1), test::random_lights(1, 2), {}, test::random_lights(90, 3)};
    std::vector<glm::vec4> all;
    std::vector<std::uint32_t> first = {0};
    test::Lists together(view.tile_count());
    for (const auto& kind : kinds) {
        const test::Lists lists = test::lists(view, kind);
        for (std::size_t tile = 0; tile < lists.size(); ++tile)
            for (const std::uint32_t id : lists[tile])
                together[tile].push_back(first.back() + id);
        all.insert(all.end(), kind.begin(), kind.end());
        first.push_back(static_cast<std::uint32_t>(all.size()));
    }
    CHECK(test::lists(view, all) == together);
}

namespace {

template <Options options> test::Lists sliced(const View& view, const auto& lights) {
    Binner<options> binner;
    const auto grid = binner.bin(view, lights, {.slices = *Slices::exponential(24, 5, 100)});
    REQUIRE(grid);
    return test::to_lists(*grid);
}

/// Points as whole spots against the same as spheres, and with spots in the same array against two grids.
void check_points_and_spots(const auto& lists_of) {
    constexpr std::size_t points = 300;
    std::vector<Sphere> spheres;
    std::vector<Spot> spots, all;
    for (const glm::vec4& s : test::random_lights(2 * points, 6)) {
        if (spheres.size() < points)
            spheres.push_back({s.x, s.y, s.z, s.w});
        else
            spots.push_back({s.x, s.y, s.z, s.w, s.y, s.x, 1, 0.7f});
    }
    for (const Sphere& sphere : spheres)
        all.push_back(Spot::whole(sphere));
    const test::Lists of_points = lists_of(spheres), of_spots = lists_of(spots);
    CHECK(lists_of(all) == of_points);
    all.insert(all.end(), spots.begin(), spots.end());
    test::Lists together = of_points;
    for (std::size_t cell = 0; cell < together.size(); ++cell)
        for (const std::uint32_t id : of_spots[cell])
            together[cell].push_back(static_cast<std::uint32_t>(points) + id);
    CHECK(lists_of(all) == together);
    CHECK(test::entries(of_spots) > 0);
}

}  // namespace

TEST_CASE("points that are whole spots are in the same cells, and two grids list what one does") {
    const View view = test::view({640, 360}, 32);
    constexpr Options boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters},
                      slabs = {.slicing = Slicing::clusters};
    check_points_and_spots([&](const auto& lights) { return test::lists(view, lights); });
    check_points_and_spots([&](const auto& lights) { return sliced<slabs>(view, lights); });
    check_points_and_spots([&](const auto& lights) { return sliced<boxes>(view, lights); });
}

TEST_CASE("what to_light gives a negative radius is in no list, and is counted") {
    struct Lamp {
        glm::vec4 sphere;
        std::uint32_t mask;
    };
    std::vector<Lamp> lamps;
    for (const glm::vec4& sphere : test::random_lights(300, 4))
        lamps.push_back({sphere, static_cast<std::uint32_t>(lamps.size() % 7)});
    const View view = test::view({640, 360}, 32);
    const auto lists = [&](std::uint32_t mask) {
        Binner<> binner;
        const auto grid = binner.bin(view, view_space(lamps, [mask](const Lamp& lamp) {
                                         const float radius = (lamp.mask & mask) != 0 ? lamp.sphere.w : -1.0f;
                                         return Sphere{lamp.sphere.x, lamp.sphere.y, lamp.sphere.z, radius};
                                     }));
        REQUIRE(grid);
        CHECK(grid->light_counts().rejected ==
              std::count_if(lamps.begin(), lamps.end(), [&](const Lamp& l) { return (l.mask & mask) == 0; }));
        return test::to_lists(*grid);
    };
    const test::Lists all = lists(7), some = lists(2);
    for (std::size_t tile = 0; tile < all.size(); ++tile) {
        std::vector<std::uint32_t> expected;
        for (const std::uint32_t id : all[tile])
            if ((lamps[id].mask & 2) != 0) expected.push_back(id);
        CHECK(some[tile] == expected);
    }
    CHECK(test::entries(some) > 0);
}

TEST_CASE(
    "sorted by importance, the first of a list are its most important, and stay where a capacity cuts it") {
    std::vector<glm::vec4> lights = test::random_lights(500, 5);
    const auto importance = [](const glm::vec4& light) { return light.w; };
    std::stable_sort(lights.begin(), lights.end(),
                     [&](const glm::vec4& a, const glm::vec4& b) { return importance(a) > importance(b); });
    const View view = test::view({640, 360}, 32);
    Binner<Options{.ids = IdWidth::u16}> binner;
    const auto grid = binner.bin(view, lights);
    REQUIRE(grid);
    ListFormat format = binner.list_format;
    format.encoding = ListEncoding::sentinel;
    format.capacity = 5;
    const std::size_t tiles = view.tile_count();
    std::vector<std::uint16_t> places(encoded_bytes(format, tiles, 0) / 2);
    const auto encoded = encode(*grid, format, std::as_writable_bytes(std::span(places)));
    REQUIRE(encoded);
    CHECK(encoded->entries_cut > 0);
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const ListRange range = grid->ranges()[tile];
        const auto list = grid->ids().subspan(range.offset, range.count);
        float least_kept = HUGE_VALF;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const float here = importance(lights[list[i]]);
            CHECK(here <= least_kept);
            least_kept = here;
            if (i < format.capacity) CHECK(places[tile * format.capacity + i] == list[i]);
        }
    }
}
