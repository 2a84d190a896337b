// SPDX-License-Identifier: MIT
// Every technique of bench/frames against the picture of every light in every fragment, and its count of light evaluations
// against lists and depths that are gone through here.
#include "cases.hpp"
#include "passes.hpp"
#include "runner.hpp"
#include "technique.hpp"

#include <gl_context.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;

Settings small_frame(float exposure) {
    Settings settings;
    settings.width = 131;
    settings.height = 77;
    settings.tile_size = 13;
    settings.exposure = exposure;
    return settings;
}

Bytes draw(Stage& stage, const Technique& technique, const Camera& camera, Settings settings) {
    stage.memory.clear();
    settings.wide = technique.g_buffer_bits == 32;
    stage.begin(camera, settings);
    technique.draw(stage);
    stage.end();
    return stage.read_picture();
}

// Draws the depths of a frame, which stay bound, and returns them.
std::vector<float> draw_depths(Stage& stage, const Camera& camera, const Settings& settings) {
    stage.begin(camera, settings);
    begin_picture(stage);
    depth_pre_pass(stage);
    std::vector<float> depths(static_cast<std::size_t>(settings.width * settings.height));
    glReadPixels(0, 0, settings.width, settings.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    return depths;
}

struct Unlikeness {
    int largest = 0;
    double share = 0;       // of the pixels that differ at all
    double much_share = 0;  // and by more than 8 of 255
};
Unlikeness compare(const Bytes& a, const Bytes& b) {
    Unlikeness difference;
    const double pixel = 4.0 / static_cast<double>(a.size());
    for (std::size_t i = 0; i < a.size(); i += 4) {
        int largest = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            largest = std::max(largest, std::abs(a[k] - b[k]));
        difference.largest = std::max(difference.largest, largest);
        if (largest > 0) difference.share += pixel;
        if (largest > 8) difference.much_share += pixel;
    }
    return difference;
}

// What of a scene the lights are on: neither black nor white.
double lit_share(const Bytes& picture) {
    double lit = 0;
    for (std::size_t i = 0; i < picture.size(); i += 4)
        if (picture[i] + picture[i + 1] + picture[i + 2] > 60 &&
            picture[i] + picture[i + 1] + picture[i + 2] < 740)
            lit += 4.0 / static_cast<double>(picture.size());
    return lit;
}

struct Seen {
    std::string name;
    Scene scene;
    Camera camera;
    float exposure = 1;
    int glsl = 430;
};
std::vector<Seen> seen_scenes() {
    const Scene made = make_scene(250), nova = load_glb(LIGHTBIN_FIXTURES "/nova.glb", 0.05f);
    Scene few = with_random_lights(made, 20), endless = made;
    for (const Light& light : few_lights(made.lights))
        few.lights.push_back(light);
    for (Light& light : endless.lights)
        light.range = std::numeric_limits<float>::infinity();
    return {{"made scene, a street", made, made.cameras[1]},
            {"made scene, OpenGL 3.3", made, made.cameras[1], 1, 330},
            {"few lights, from above", few, camera_from_above(few, {})},
            {"lights without an end", endless, made.cameras[1], 0.02f},
            {"nova", nova, nova.cameras[0]}};
}

}  // namespace

TEST_CASE("every technique draws the picture of every light") {
    for (const Seen& seen : seen_scenes()) {
        CAPTURE(seen.name);
        const OffscreenContext context(seen.glsl);
        Stage stage(seen.scene, seen.glsl);
        const Settings settings = small_frame(seen.exposure);
        const Bytes expected = draw(stage, forward_every_light(), seen.camera, settings);
        CHECK(lit_share(expected) > 0.1);
        int drawn = 0;
        for (const Technique& technique : every_technique()) {
            if (technique.glsl > seen.glsl) continue;
            CAPTURE(technique.name);
            CAPTURE(technique.g_buffer_bits);
            CHECK(technique.tolerance == (technique.g_buffer_bits == 0 ? 0 : technique.tolerance));
            const Unlikeness difference = compare(expected, draw(stage, technique, seen.camera, settings));
            CHECK(difference.largest <= technique.tolerance);
            ++drawn;
        }
        CHECK(drawn > 15);
    }
}

TEST_CASE("a light that is missing is seen") {
    const Scene scene = with_random_lights(make_scene(1), 60);
    Scene without = scene;
    without.lights.erase(without.lights.begin() + 7);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl()), stage_without(without, context.glsl());
    const Settings settings = small_frame(1);
    const Bytes expected = draw(stage, forward_every_light(), scene.cameras[0], settings);
    for (const Technique& technique : every_technique()) {
        CAPTURE(technique.name);
        CHECK(compare(expected, draw(stage_without, technique, scene.cameras[0], settings)).largest > 8);
    }
}

TEST_CASE("three shaders, and panes") {
    const Scene scene = with_panes(make_scene(250), 40);
    const RunSettings run{.width = 131, .height = 77, .tile_size = 13, .timed_frames = 0};
    const OffscreenContext context(0);
    LeftOut left_out;
    Runner runner(scene, run, context.glsl(), left_out);
    runner.run("", scene.cameras[0], {}, {});
    const Bytes plain = runner.reference();
    std::vector<Technique> forward = every_technique();
    std::erase_if(forward, [](const Technique& technique) {
        return technique.name.starts_with("Deferred");  // a light at a time has one shader
    });
    using enum TransparentLists;
    const std::vector<Technique> panes = {transparent_forward(max_only), transparent_forward(shared),
                                          transparent_forward(own_min)};
    for (const bool transparent : {false, true}) {
        const std::vector<Technique>& techniques = transparent ? panes : forward;
        Settings settings;
        settings.transparent = transparent;
        settings.three_shaders = !transparent;
        const std::vector<Row> rows = runner.run("", scene.cameras[0], techniques, settings);
        CHECK(rows.size() == techniques.size() + 1);
        for (const Row& row : rows)
            CHECK_MESSAGE(row.as_stated, row.technique);
        CHECK(compare(plain, runner.reference()).share > 0.005);
    }
}

// Where samples of a pixel differ, forward lights a fragment's middle, deferred each sample; and forward without a
// pre-pass may light another point of a triangle, as the centroid is of the samples that are drawn.
TEST_CASE("several samples a pixel") {
    const Scene scene = make_scene(250);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    const Camera& camera = scene.cameras[1];
    const Bytes one = draw(stage, forward_every_light(), camera, settings);
    settings.samples = 4;
    const Bytes four = draw(stage, forward_every_light(), camera, settings);
    CHECK(compare(one, four).share > 0.02);
    CHECK(compare(one, four).share < 0.5);
    for (const Technique& technique : every_technique()) {
        if (!technique.multisampled) continue;
        CAPTURE(technique.name);
        const Unlikeness difference = compare(four, draw(stage, technique, camera, settings));
        CHECK(difference.much_share < (technique.g_buffer_bits == 0 ? 0.01 : 0.03));
    }
}

TEST_CASE("evaluations are those of the lists") {
    const Scene scene = load_glb(LIGHTBIN_FIXTURES "/nova.glb", 0.05f);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    settings.count = true;
    settings.wide = true;
    const auto counted = [&](const Technique& technique) {
        draw(stage, technique, scene.cameras[0], settings);
        return stage.evaluations();
    };

    // The depths of the pixels, and lists of their tiles.
    DepthBounds bounds;
    const std::vector<float> depth = draw_depths(stage, scene.cameras[0], settings);
    const lightbin::View view = stage.view();
    IntervalLists lists;
    const lightbin::ZBounds z_bounds = bounds.reduce_on_cpu(stage);
    const auto grid = lists.bin(stage, z_bounds);
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
    const auto grid_by_boxes = value_of(binner.bin(view, stage.lights(), {.bounds = z_bounds}));
    std::uint64_t listed = 0, listed_by_boxes = 0, pixels = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const float d = depth[static_cast<std::size_t>(y * settings.width + x)];
            if (d == 1) continue;
            ++pixels;
            const int tx = x / settings.tile_size, ty = y / settings.tile_size;
            listed += grid.lights_in(tx, ty).size();
            listed_by_boxes += grid_by_boxes.lights_in(tx, ty).size();
        }
    REQUIRE(pixels > 1000);
    CHECK(listed > pixels);
    CHECK(counted(tiled_deferred(32)) == listed);
    // The passes' margins are those of a GPU's arithmetic.
    CHECK(listed_by_boxes < listed);
    CHECK(counted(tiled_deferred_passes(32)) >= listed_by_boxes);
    CHECK(counted(tiled_deferred_passes(32)) <= listed_by_boxes + listed_by_boxes / 500);
    // Its bounds are not rounded outward.
    CHECK(counted(tiled_deferred_kernel(32)) <= listed);
    CHECK(counted(tiled_deferred_kernel(32)) > listed * 99 / 100);
    // Of surfaces in one place both are lit.
    CHECK(counted(tiled_forward_pre_z(ZEnds::both, Reduction::cpu)) >= listed);
    CHECK(counted(tiled_forward_pre_z(ZEnds::both, Reduction::cpu)) < listed * 11 / 10);
    CHECK(counted(forward_every_light()) >= pixels * scene.lights.size());
    CHECK(counted(tiled_forward()) > listed);
}
