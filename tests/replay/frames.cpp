// SPDX-License-Identifier: MIT
// dump() writes all that a frame's lists were made of: read back, it gives the same lists, and exact arithmetic misses
// no light. A light that is taken out of a list is named, with the cell.
#include "frame.hpp"

#include <lightbin/box.hpp>
#include <lightbin/dump.hpp>
#include <lightbin/spot.hpp>

#include "../split_mix.hpp"

#include <doctest/doctest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace lightbin;

struct Scene {
    std::vector<Sphere> spheres;
    std::vector<Spot> spots;
    std::vector<Box> boxes;
    std::vector<float> min, max;

    explicit Scene(std::size_t tiles, float side = -1) {
        SplitMix random(tiles);
        const auto any = [&](float low, float high) {
            return low + (high - low) * static_cast<float>(random.integer(0, 1 << 24)) * 0x1p-24f;
        };
        for (int i = 0; i < 40; ++i) {
            const float z = any(-1, 40), at[] = {any(-1, 1) * (2 + z), any(-1, 1) * (2 + z), side * z};
            const Sphere ball = {at[0], at[1], at[2], any(0.1f, 4)};
            spheres.push_back(ball);
            spots.push_back(
                {ball.x, ball.y, ball.z, ball.radius, any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1)});
            Box box = {ball.x, ball.y, ball.z, ball.radius, ball.x, ball.y, ball.z, {}, any(0, 1)};
            for (float(&axis)[3] : box.half_axes)
                for (float& number : axis)
                    number = any(-3, 3);
            boxes.push_back(box);
        }
        // What JSON has no numbers for, and what loses its sign in some readers.
        constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                        inf = std::numeric_limits<float>::infinity();
        spheres.push_back({nan, 0, 0, 1});
        spheres.push_back({-0.0f, -inf, 0, 1});
        spheres.push_back({0, 0, side * 1e30f, inf});
        spheres.push_back({0, 0, 0, -1});
        spots.push_back({0, 0, side * 5, 1e-45f, nan, nan, nan, -1});
        spots.push_back({0, 0, side * 5, 1, 0, 0, 0, 0.5f});
        boxes.push_back({0, 0, side * 5, inf, 0, 0, side * 5, {}, 1});
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            const float low = any(1.5f, 20);
            min.push_back(tile % 5 == 0 ? nan : low);
            max.push_back(tile % 7 == 0 ? inf : low + any(-1, 20));
        }
    }
};

/// The bits of a number: NaN counts as itself, and -0 not as 0.
bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
        return std::isnan(x) ? std::isnan(y)
                             : std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
    });
}

/// Replays a frame, and then with a light taken out of one list.
void check(const std::string& text) {
    Frame frame = read_frame(text);
    CHECK(bin_again(frame) == frame.made);
    const Cells cells = cells_of(frame);
    const Verdict verdict = check_exactly(frame, cells);
    CHECK(verdict.pairs > 0);
    CHECK(verdict.missed == 0);
    CHECK(verdict.undecided == 0);

    // The light of infinite radius reaches each cell, but those that an oblique near plane leaves nothing of.
    constexpr std::uint32_t endless = 42;
    Verdict caught;
    std::size_t cell = cells.lights.size();
    while (caught.missed == 0 && cell-- > 0) {
        Cells without = cells;
        if (std::erase(without.lights[cell], endless) > 0) caught = check_exactly(frame, without);
    }
    CHECK(caught.missed == 1);
    REQUIRE(caught.misses.size() == 1);
    CHECK(caught.misses[0] == "sphere 42, in " + name_of_cell(frame, cell));
}

template <Options options> void check_lists(const View& view, const auto& lights, const auto&... inputs) {
    Binner<options> binner;
    const auto grid = binner.bin(view, lights, inputs...);
    REQUIRE(grid.has_value());
    CHECK(!grid->ids().empty());
    check(dump(binner, *grid, view, lights, inputs...));
}

/// Checks lists and masks of each kind of options.
void check_all(const View& view, const auto& lights, const Scene& scene) {
    const Slices exact = *Slices::exponential(5, 1, 30), slices = exact.with_margin(0.01f);
    const ZBounds bounds = {scene.min, scene.max};
    check_lists<Options{}>(view, lights);
    check_lists<Options{.ids = IdWidth::u16, .depth_test = true}>(
        view, lights, inputs_for<Options{.ids = IdWidth::u16, .depth_test = true}>({{}, scene.max}));
    constexpr Options clusters = {.depth_test = true, .slicing = Slicing::clusters};
    check_lists<clusters>(view, lights, Binner<clusters>::Inputs{.slices = slices});
    check_lists<clusters>(view, lights, Binner<clusters>::Inputs{.slices = exact, .bounds = bounds});
    constexpr Options bins = {.slicing = Slicing::z_bins};
    check_lists<bins>(view, lights, Binner<bins>::Inputs{.slices = slices});
    MaskBinner binner;
    check(dump(*binner.bin(view, lights), view, lights));
    check(dump(*binner.bin(view, lights, slices), view, lights, slices));
}

}  // namespace

TEST_CASE("frames of all kinds of views, lights and options are replayed") {
    const glm::mat4 perspective = glm::perspectiveRH_NO(1.0f, 1.5f, 0.1f, 1000.0f);
    glm::mat4 turned(0), oblique = perspective;
    for (int column = 0; column < 4; ++column)
        turned[column] = {-perspective[column][1], perspective[column][0], perspective[column][2],
                          perspective[column][3]};
    for (int column = 0; column < 4; ++column)
        oblique[column][2] = glm::vec4(0.2f, 0.1f, -1.0f, -0.3f)[column];
    struct Given {
        std::string name;
        glm::mat4 projection;
        ViewOptions options;
        ImageSize size = {150, 100};
        float side = -1;
    };
    const Given all[] = {
        {"perspective", perspective, {.tile_size = 16}},
        {"left-handed, Direct3D",
         glm::perspectiveLH_ZO(1.0f, 1.5f, 0.1f, 60.0f),
         {.tile_size = 32, .clip_depth = ClipDepth::zero_to_one, .origin = WindowOrigin::upper_left},
         {150, 100},
         1},
        {"reversed Z",
         glm::perspectiveRH_ZO(1.0f, 1.5f, 60.0f, 0.1f),
         {.tile_size = 32, .clip_depth = ClipDepth::zero_to_one}},
        {"orthographic", glm::orthoRH_NO(-30.0f, 25.0f, -20.0f, 25.0f, 1.0f, 80.0f), {.tile_size = 32}},
        {"orthographic, reversed Z",
         glm::orthoRH_ZO(-30.0f, 25.0f, -20.0f, 25.0f, 80.0f, 1.0f),
         {.tile_size = 32, .clip_depth = ClipDepth::zero_to_one, .reversed_z = true}},
        {"columns and rows", perspective, {.columns = 7, .rows = 4}},
        {"at most so many tiles", perspective, {.max_tiles = 30}},
        {"turned", turned, {.tile_size = 24}, {100, 150}},
        {"turned, columns and rows",
         turned,
         {.columns = 3, .rows = 5, .origin = WindowOrigin::upper_left},
         {100, 150}},
        {"oblique", oblique, {.tile_size = 32}},
    };
    const glm::dmat4 camera =
        glm::rotate(glm::translate(glm::dmat4(1), {0.3, -0.2, 0.1}), 0.1, {0.6, 0.0, 0.8});
    for (const Given& given : all) {
        CAPTURE(given.name);
        const auto view = View::from_projection(given.projection, given.size, given.options);
        REQUIRE(view.has_value());
        const Scene scene(view->tile_count(), given.side);
        check_lists<Options{}>(*view, scene.spheres);
        check_lists<Options{}>(*view, lights(scene.spheres, scene.spots, scene.boxes));
        check_all(*view,
                  lights(world_space(scene.spheres, camera), world_space(scene.spots, camera),
                         world_space(scene.boxes, camera)),
                  scene);
    }

    // A large world.
    const WorldPoint eye = {1e9, -3e7, 0.37};
    const auto far = [&](const auto& array) {
        return world_space(array, camera, eye, [&](const auto& light) {
            return Placed<std::decay_t<decltype(light)>>{eye, light};
        });
    };
    const View view = *View::from_projection(perspective, {150, 100}, {.tile_size = 32});
    const Scene scene(view.tile_count());
    check_all(view, lights(far(scene.spheres), far(scene.spots), far(scene.boxes)), scene);
}

TEST_CASE("all that is in a frame reads back to the same bits, and has points in each locale") {
    const double projection[4][4] = {
        {1.1, 0, 0, 0}, {0, 1.0 / 3, 0, 0}, {0.1, 0, -1.0000000000000002, -1}, {0, 0, -0.2, 0}};
    const View view = *View::from_projection(projection, {150, 100}, {.tile_size = 32});
    const Scene scene(view.tile_count());
    constexpr Options options = {.depth_test = true};
    Binner<options> binner;
    const auto grid = *binner.bin(view, scene.boxes, {.bounds = {scene.min, scene.max}});
    const std::string text = dump(binner, grid, view, scene.boxes, {.bounds = {scene.min, scene.max}});
    const Frame frame = read_frame(text);
    CHECK(std::equal(frame.projection.begin(), frame.projection.end(), &projection[0][0],
                     &projection[0][0] + 16));
    CHECK(same_bits(frame.min, scene.min));
    CHECK(same_bits(frame.max, scene.max));
    REQUIRE(frame.arrays.size() == 1);
    REQUIRE(frame.arrays[0].lights.size() == scene.boxes.size());
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
        std::vector<float> numbers(17);
        std::memcpy(numbers.data(), &scene.boxes[i], sizeof scene.boxes[i]);
        CHECK(same_bits(frame.arrays[0].lights[i], numbers));
    }

    // Any bits, and numbers of few digits.
    SplitMix random(1);
    std::vector<float> floats;
    detail::JsonText json;
    for (int i = 0; i < 20000; ++i) {
        const auto bits = static_cast<std::uint32_t>(random.bits());
        floats.push_back(i % 2 == 0 ? std::bit_cast<float>(bits) : static_cast<float>(bits % 100000) / 1000);
    }
    json.add(std::span<const float>(floats));
    std::string whole = text;
    const std::string min = "\"min_depths\": ";
    const std::size_t begin = whole.find(min) + min.size();
    whole.replace(begin, whole.find(']', begin) + 1 - begin, json.text);
    CHECK(same_bits(read_frame(whole).min, floats));

    // Locales have other points, of one byte or more.
    json.text.clear();
    json.add_digits("-1,25e+03");
    json.add_digits("1\xd9\xab"
                    "5");
    CHECK(json.text == "-1.25e+031.5");
}

TEST_CASE("what is no frame is refused") {
    CHECK_THROWS(read_frame("{}"));
    CHECK_THROWS(read_frame(""));
}
