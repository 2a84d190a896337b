// SPDX-License-Identifier: MIT
// Compares every technique of bench/frames with the picture of every light in every fragment, and its number of light
// evaluations with counts from lists and depths made here.
#include "cases.hpp"
#include "passes.hpp"
#include "runner.hpp"
#include "technique.hpp"

#include <gl_context.hpp>

#include <lightbin/masks.hpp>

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

// Draws and binds the depth buffer of a frame, and returns its depths.
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
    }
    return difference;
}

// Returns the part of a picture that lights reach: pixels that are neither black nor white.
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
            CAPTURE(technique.name);
            CAPTURE(technique.g_buffer_bits);
            CHECK(technique.tolerance == (technique.g_buffer_bits == 0 ? 0 : technique.tolerance));
            const Unlikeness difference = compare(expected, draw(stage, technique, seen.camera, settings));
            CHECK(difference.largest <= technique.tolerance);
            ++drawn;
        }
        CHECK(drawn == 16);
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

    // Finds the depths of all pixels, and makes the lists of their tiles.
    DepthBounds bounds;
    const std::vector<float> depth = draw_depths(stage, scene.cameras[0], settings);
    const lightbin::View view = stage.view();
    IntervalLists lists;
    const lightbin::ZBounds z_bounds = bounds.reduce(stage);
    const auto grid = lists.bin(stage, z_bounds);
    std::uint64_t listed = 0, pixels = 0, reached = 0, nearly_reached = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const float d = depth[static_cast<std::size_t>(y * settings.width + x)];
            if (d == 1) continue;
            ++pixels;
            const int tx = x / settings.tile_size, ty = y / settings.tile_size;
            listed += grid.lights_in(tx, ty).size();
            const auto p = view.view_point(
                {x + 0.5, y + 0.5,
                 static_cast<double>(view.view_depths(static_cast<double>(d), static_cast<double>(d)).min)});
            for (const lightbin::Sphere& light : stage.lights()) {
                const double dx = p.x - static_cast<double>(light.x), dy = p.y - static_cast<double>(light.y),
                             dz = p.z - static_cast<double>(light.z);
                const double distance =
                    std::sqrt(dx * dx + dy * dy + dz * dz) / static_cast<double>(light.radius);
                reached += distance < 0.999;
                nearly_reached += distance < 1.07;
            }
        }
    REQUIRE(pixels > 1000);
    CHECK(listed > pixels);
    CHECK(counted(tiled_deferred(32)) == listed);
    // Of surfaces in one place both are lit.
    CHECK(counted(tiled_forward_pre_z(ZEnds::both)) >= listed);
    CHECK(counted(tiled_forward_pre_z(ZEnds::both)) < listed * 11 / 10);
    CHECK(counted(forward_every_light()) >= pixels * scene.lights.size());
    CHECK(counted(tiled_forward()) > listed);
    // The stencil is drawn with a polyhedron around the light's sphere, so it marks a few more pixels than the sphere.
    const std::uint64_t marked = counted(deferred_stencil(32));
    CHECK(marked >= reached);
    CHECK(marked <= nearly_reached);
    CHECK(reached > pixels);
}

// A scene of one surface, where nothing is lit and then hidden by something nearer.
TEST_CASE("evaluations without a pre-pass, and a light at a time") {
    Scene scene = make_scene(250);
    scene.triangles.resize(6);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    settings.count = true;
    settings.wide = true;
    const Camera& camera = scene.cameras[1];
    const std::vector<float> depths = draw_depths(stage, camera, settings);

    using lightbin::Slicing;
    const lightbin::View view = stage.view();
    const float reach = depth_of_lights(stage);
    const auto slices = value_of(lightbin::Slices::exponential(24, reach / 40, reach));
    const auto fine_slices = value_of(lightbin::Slices::linear(1024, 0, reach));
    lightbin::Binner binner;
    lightbin::Binner<lightbin::Options{.depth_test = true, .slicing = Slicing::clusters}> cluster_binner;
    lightbin::Binner<lightbin::Options{.slicing = Slicing::z_bins}> bin_binner;
    const auto tiles = value_of(binner.bin(view, stage.lights()));
    const auto clusters = value_of(cluster_binner.bin(view, stage.lights(), {.slices = slices}));
    const auto bins = value_of(bin_binner.bin(view, stage.lights(), {.slices = fine_slices}));
    const auto rectangles = stage.footprints(1);
    std::uint64_t pixels = 0, of_tiles = 0, of_clusters = 0, of_bins = 0, of_rectangles = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const auto window = static_cast<double>(depths[static_cast<std::size_t>(y * settings.width + x)]);
            if (window == 1) continue;
            ++pixels;
            const float depth = view.view_depths(window, window).min;
            const int column = x / settings.tile_size, row = y / settings.tile_size;
            of_tiles += tiles.lights_in(column, row).size();
            of_clusters += clusters.lights_in(column, row, slices.slice_at(depth)).size();
            const auto bin = bins.ranks().bins[static_cast<std::size_t>(fine_slices.slice_at(depth))];
            of_bins += lightbin::lights_of_bin(bins.lights_in(column, row), bin).size();
            of_rectangles +=
                static_cast<std::uint64_t>(std::ranges::count_if(rectangles, [&](const LightFootprint& f) {
                    return x >= f.x0 && x <= f.x1 && y >= f.y0 && y <= f.y1;
                }));
        }
    const auto counted = [&](const Technique& technique) {
        draw(stage, technique, camera, settings);
        return stage.evaluations();
    };
    const auto is_close = [](std::uint64_t a, std::uint64_t b) {
        return a <= b + b / 500 && b <= a + b / 500;
    };
    CHECK(counted(tiled_forward()) == of_tiles);
    CHECK(counted(deferred(32)) == of_rectangles);
    CHECK(is_close(counted(clustered_forward()), of_clusters));  // but for roundings at slices' ends
    CHECK(is_close(counted(z_binned_forward()), of_bins));
    CHECK(counted(masked_forward(Slicing::none)) == of_tiles);
    CHECK(stage.words() == pixels * value_of(lightbin::MaskBinner().bin(view, stage.lights())).mask_words());
    const std::uint64_t of_mask_bins = counted(masked_forward(Slicing::z_bins));
    CHECK(stage.words() >= pixels);
    CHECK(stage.words() < 4 * pixels);
    CHECK(counted(z_binned_forward()) == of_mask_bins);
    CHECK(of_clusters > 1000);
    CHECK(of_clusters < of_bins);
    CHECK(of_bins < of_tiles);
}

TEST_CASE("what this OpenGL lacks is named") {
    const Scene scene = make_scene(300);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    settings.width = 30000;
    CHECK_THROWS_WITH_AS(draw(stage, tiled_forward(), scene.cameras[0], settings),
                         doctest::Contains("no target of 30000 x 77 pixels"), std::runtime_error);

    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    const std::size_t bytes = 2 * static_cast<std::size_t>(most);
    stage.memory.read_texels(unit_lists, GL_R16UI, stage.memory.buffer("lists", bytes, nullptr));
    const GLuint larger = stage.memory.buffer("lists", bytes + 2, nullptr);
    CHECK_THROWS_WITH_AS(stage.memory.read_texels(unit_lists, GL_R16UI, larger),
                         doctest::Contains("this OpenGL reads at most"), std::runtime_error);
}

TEST_CASE("a view that cannot be drawn is left out, and no more") {
    Scene many = make_scene(65001);
    many.boxes.clear();
    Scene endless = many;
    for (Light& light : endless.lights)
        light.range = std::numeric_limits<float>::infinity();
    const OffscreenContext context(0);
    const RunSettings run{.width = 16, .height = 9, .tile_size = 8, .timed_frames = 1};
    for (const Scene& scene : {many, endless}) {
        LeftOut left_out;
        Runner runner(scene, run, context.glsl(), left_out);
        CHECK(runner.run("", scene.cameras[0], {tiled_forward()}, {}).empty());
        REQUIRE(left_out.lines().size() == 1);
        CHECK(left_out.lines()[0].find(" is left out: a fragment would loop over 65001 lights") !=
              std::string::npos);
    }
    many.lights.resize(10);
    many.cameras[0].orthographic = true;
    LeftOut left_out;
    Runner runner(many, run, context.glsl(), left_out);
    CHECK(runner.run("", many.cameras[0], {tiled_forward()}, {}).empty());
    CHECK(left_out.lines() == std::vector<std::string>{
                                  "every technique is left out: frames of orthographic cameras are not drawn "
                                  "here"});
    CHECK(runner.run("", many.cameras[1], {tiled_forward()}, {}).size() == 2);
}
