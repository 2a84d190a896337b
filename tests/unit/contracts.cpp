// What holds after a call that failed, was left out, or came at the wrong time.
#include "scene.hpp"

#include <functional>
#include <type_traits>
#include <utility>

using namespace lightbin;

static_assert(!std::is_default_constructible_v<View>);  // a View of nothing would list nothing
static_assert(std::is_nothrow_move_constructible_v<Binner<>> && std::is_nothrow_move_assignable_v<Binner<>>);

namespace {

void run_backwards(std::size_t n, const std::function<void(std::size_t)>& body) {
    test::backwards(n, body);
}

}  // namespace

TEST_CASE("statistics are those of the last call that succeeded") {
    const View view = test::view({640, 640}, 32);
    const auto lights = test::random_lights(100, 50), others = test::random_lights(7, 51);
    Binner<Options{.depth_test = DepthTest::interval, .statistics = true}> binner;
    const std::vector<float> min(view.tile_count(), 0.0f), max(view.tile_count(), 50.0f);
    const std::span<const float> few = std::span(min).first(3);
    REQUIRE(binner.bin(view, lights, {min, max}));
    const Statistics before = binner.statistics();
    CHECK(before.lights == 100);
    CHECK(!binner.bin(view, others, {few, max}));
    CHECK(!binner.bin_transparency(view, others, {few, max}));
    CHECK(!binner.count(view, others, {few, max}));
    glm::mat4 bad(1.0f);
    bad[0][3] = 1;
    CHECK(!binner.bin(view, world_space(others, bad), {min, max}));
    CHECK(binner.statistics().lights == before.lights);
    CHECK(binner.statistics().culled == before.culled);
    CHECK(binner.statistics().entries == before.entries);
    CHECK(binner.statistics().histogram == before.histogram);
    REQUIRE(binner.bin_transparency(view, others, {min, max}));
    CHECK(binner.statistics().lights == 7);
}

TEST_CASE("a Binner that was moved from is as new, and what it had goes on elsewhere") {
    const View view = test::view({640, 360}, 16);
    const auto lights = test::random_lights(500, 52);
    const auto expected = test::lists(view, lights);
    for (const std::size_t workers : {1u, 3u}) {
        const Parallel parallel(workers, test::backwards, 0);
        Binner<> from;
        const GridSize size = *from.count(view, lights, parallel);
        Binner<> to = std::move(from);
        std::vector<Tile> tiles(size.tiles);
        std::vector<std::uint32_t> indices(size.indices);
        CHECK(from.emit(tiles, indices).error().code == ErrorCode::nothing_counted);
        const auto emitted = to.emit(tiles, indices);
        REQUIRE(emitted);
        CHECK(test::to_lists(*emitted) == expected);
        CHECK(test::to_lists(*from.bin(view, lights, parallel)) == expected);
        CHECK(test::to_lists(*to.bin(view, lights, parallel)) == expected);
        Binner<>& same = to;
        to = std::move(same);
        CHECK(test::to_lists(*to.bin(view, lights)) == expected);
        from = std::move(to);
        CHECK(test::to_lists(*to.bin(view, lights, parallel)) == expected);
    }
}

TEST_CASE("emit without a count before it, or with another call between, is an error") {
    const View view = test::view({640, 480}, 32);
    const auto lights = test::random_lights(10, 53), more = test::random_lights(20000, 54);
    Binner<> binner;
    std::vector<Tile> tiles(view.tile_count(), Tile{7, 7});
    std::vector<std::uint32_t> indices(100000, 7);
    CHECK(binner.emit(tiles, indices).error().code == ErrorCode::nothing_counted);
    REQUIRE(binner.count(view, lights));
    REQUIRE(binner.bin(view, more));
    CHECK(binner.emit(tiles, indices).error().code == ErrorCode::nothing_counted);
    CHECK(tiles.front().count == 7);
    CHECK(indices.front() == 7);
    REQUIRE(binner.count(view, lights));
    REQUIRE(binner.emit(tiles, indices));
    CHECK(binner.emit(tiles, indices).error().code == ErrorCode::nothing_counted);
}

TEST_CASE("a plain function runs a Parallel's work") {
    const View view = test::view({640, 360}, 16);
    const auto lights = test::random_lights(500, 55);
    const auto expected = test::lists(view, lights);
    CHECK(test::lists(view, lights, Parallel(3, run_backwards, 0)) == expected);
    CHECK(test::lists(view, lights, Parallel(3, &run_backwards, 0)) == expected);
    const std::function<void(std::size_t, const std::function<void(std::size_t)>&)> function = run_backwards;
    CHECK(test::lists(view, lights, Parallel(3, function, 0)) == expected);
}

TEST_CASE("what is transparent is lit before the sky as well") {
    // A wall at depth 5 in half of tile 1 and in tile 2, the rest is sky. A pane at depth 20, seen in tile 0 and beside
    // the wall, and a light at it, which the wall hides in tile 2.
    const View view = test::view({96, 32}, 32);
    const auto depth_of = [&](double depth) { return view.window_depth(depth); };
    std::vector<float> depth(96 * 32, 1.0f);
    for (std::size_t y = 0; y < 32; ++y)
        for (std::size_t x = 48; x < 96; ++x)
            depth[96 * y + x] = depth_of(5);
    const std::vector<glm::vec4> lights = {{0, 0, -20, 14}};
    std::vector<float> min(3), max(3), transparent_max(3);
    for (const bool skip : {false, true}) {
        const DepthBuffer buffer = {.depth = depth, .skip_background = skip};
        const auto bounds =
            reduce_depth(view, buffer, {.min = min, .max = max, .transparent_max = transparent_max});
        REQUIRE(bounds);
        CHECK(transparent_max[0] == view.far_depth());
        CHECK(transparent_max[1] == view.far_depth());
        CHECK(transparent_max[2] < 5.01f);
        CHECK(max[0] == (skip ? -HUGE_VALF : view.far_depth()));
        CHECK((max[1] < 5.01f) == skip);

        Binner<Options{.depth_test = DepthTest::box}> binner;
        const auto grids = binner.bin_transparency(view, std::vector<glm::vec4>{{0, 0, -20, 5}}, *bounds);
        REQUIRE(grids);
        const std::vector<std::uint32_t> none, listed = {0};
        const auto transparent = test::to_lists(grids->transparent), opaque = test::to_lists(grids->opaque);
        CHECK(transparent[1] == listed);
        CHECK(opaque[1] == (skip ? none : listed));
        const auto wide = binner.bin_transparency(view, lights, *bounds);
        REQUIRE(wide);
        CHECK(test::to_lists(wide->transparent) == test::Lists{listed, listed, none});

        // Without the maximum that counts the sky, it is refused.
        const auto without = reduce_depth(view, buffer, {.min = min, .max = max});
        const auto refused = binner.bin_transparency(view, lights, *without);
        CHECK(refused.has_value() == !skip);
        if (!refused) CHECK(refused.error().code == ErrorCode::no_transparent_max);
        // The opaque lists alone need none; nor does one that is not pruned by a maximum.
        CHECK(binner.bin(view, lights, *without));
        CHECK(binner.bin_transparency(view, lights, *reduce_depth(view, buffer, {.min = min})));
    }
}
