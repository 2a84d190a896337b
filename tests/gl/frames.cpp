// SPDX-License-Identifier: MIT
// Every technique of bench/frames against the picture of every light in every fragment, and its count of light evaluations
// against lists and depths that are gone through here.
#include "cases.hpp"
#include "passes.hpp"
#include "runner.hpp"
#include "technique.hpp"

#include <gl_context.hpp>

#include <doctest/doctest.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
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
    float exposure;
};
std::vector<Seen> seen_scenes() {
    const Scene made = make_scene(250), nova = load_glb(LIGHTBIN_FIXTURES "/nova.glb", 0.05f);
    Scene few = made;
    few.lights = few_lights(made.lights);
    const Scene random = with_random_lights(made, 200);
    Scene endless = made;
    for (Light& light : endless.lights)
        light.range = std::numeric_limits<float>::infinity();
    return {{"made scene, a street", made, made.cameras[1], 1},
            {"made scene, from above", made, camera_from_above(made, {}), 1},
            {"few lights", few, made_flight(15)[3], 1},
            {"random lights", random, made.cameras[0], 1},
            {"lights without an end", endless, made.cameras[1], 0.02f},
            {"nova", nova, nova.cameras[0], 1}};
}

// What the eye sees along a ray, in doubles.
struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t triangle = ~std::size_t{0};
    glm::dvec3 place{0}, normal{0}, colour{0};
};
Hit trace(const Scene& scene, glm::dvec3 eye, glm::dvec3 ray) {
    Hit hit;
    for (std::size_t i = 0; i < scene.triangles.size(); i += 3) {
        const Vertex* const t = &scene.triangles[i];
        const glm::dvec3 a(t[0].position), ab = glm::dvec3(t[1].position) - a,
                                           ac = glm::dvec3(t[2].position) - a;
        const glm::dvec3 face = glm::cross(ab, ac);
        const double slope = -glm::dot(ray, face), distance = glm::dot(eye - a, face) / slope;
        const glm::dvec3 place = eye + distance * ray;
        const double square = glm::dot(face, face), v = glm::dot(glm::cross(place - a, ac), face) / square,
                     w = glm::dot(glm::cross(ab, place - a), face) / square;
        if (!(distance > 0 && distance < hit.distance && v >= 0 && w >= 0 && v + w <= 1)) continue;
        const auto blend = [&](glm::vec3 Vertex::*part) {
            return (1 - v - w) * glm::dvec3(t[0].*part) + v * glm::dvec3(t[1].*part) +
                   w * glm::dvec3(t[2].*part);
        };
        hit = {distance, i, place, (slope > 0 ? 1.0 : -1.0) * glm::normalize(blend(&Vertex::normal)),
               blend(&Vertex::colour)};
    }
    return hit;
}

glm::dvec3 sent_to_eye(const Scene& scene, const Hit& hit, glm::dvec3 eye, double exposure) {
    if (std::isinf(hit.distance)) return glm::dvec3(0.02, 0.025, 0.04);
    glm::dvec3 radiance = 0.02 * hit.colour;
    const glm::dvec3 to_eye = glm::normalize(eye - hit.place);
    for (const Light& light : scene.lights) {
        const glm::dvec3 way = glm::dvec3(light.position) - hit.place;
        const double distance = glm::length(way), share = distance / static_cast<double>(light.range);
        const double window = std::max(1 - share * share * share * share, 0.0) / (distance * distance);
        const double highlight = std::max(glm::dot(hit.normal, glm::normalize(way / distance + to_eye)), 0.0);
        radiance += exposure * glm::dvec3(light.intensity) * window *
                    std::max(glm::dot(hit.normal, way / distance), 0.0) *
                    (hit.colour / 3.14159265358979 + 0.15 * std::pow(highlight, 24.0));
    }
    return glm::pow(1.0 - glm::exp(-radiance), glm::dvec3(1 / 2.2));
}

}  // namespace

TEST_CASE("the reference is what the lights send") {
    const OffscreenContext context(0);
    for (const Seen& seen : seen_scenes()) {
        CAPTURE(seen.name);
        Stage stage(seen.scene, context.glsl());
        const Settings settings = small_frame(seen.exposure);
        const Bytes picture = draw(stage, forward_every_light(), seen.camera, settings);
        const glm::dvec3 eye(seen.camera.to_world[3]);
        int compared = 0;
        for (int y = 3; y < settings.height; y += 9)
            for (int x = 4; x < settings.width; x += 9) {
                CAPTURE(x);
                CAPTURE(y);
                const auto through = [&](double across, double up) {
                    const double scale = 2 * std::tan(seen.camera.height / 2) / settings.height;
                    const glm::dvec3 ray((x + across - settings.width / 2.0) * scale,
                                         (y + up - settings.height / 2.0) * scale, -1);
                    return trace(seen.scene, eye, glm::dmat3(seen.camera.to_world) * ray);
                };
                const Hit hit = through(0.5, 0.5);
                if (through(0.45, 0.45).triangle != hit.triangle ||
                    through(0.55, 0.55).triangle != hit.triangle)
                    continue;
                const glm::dvec3 expected =
                    sent_to_eye(seen.scene, hit, eye, static_cast<double>(seen.exposure));
                for (int k = 0; k < 3; ++k) {
                    const int shown = picture[static_cast<std::size_t>(4 * (y * settings.width + x) + k)];
                    CHECK(std::abs(shown - 255 * expected[k]) <= 1);
                }
                ++compared;
            }
        CHECK(compared > 90);
    }
}

TEST_CASE("every technique draws the picture of every light") {
    const OffscreenContext context(0);
    REQUIRE(context.glsl() == 430);
    for (const Seen& seen : seen_scenes()) {
        CAPTURE(seen.name);
        Stage stage(seen.scene, context.glsl());
        const Settings settings = small_frame(seen.exposure);
        const Bytes expected = draw(stage, forward_every_light(), seen.camera, settings);
        CHECK(lit_share(expected) > 0.1);
        for (const Technique& technique : every_technique()) {
            CAPTURE(technique.name);
            CAPTURE(technique.g_buffer_bits);
            CHECK(technique.tolerance == (technique.g_buffer_bits == 0 ? 0 : technique.tolerance));
            const Unlikeness difference = compare(expected, draw(stage, technique, seen.camera, settings));
            CHECK(difference.largest <= technique.tolerance);
        }
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

    // The depths of the pixels, and lists of their tiles.
    DepthBounds bounds;
    stage.begin(scene.cameras[0], settings);
    begin_picture(stage);
    depth_pre_pass(stage);
    const lightbin::View view = stage.view();
    IntervalLists lists;
    const lightbin::ZBounds z_bounds = bounds.reduce(stage);
    const auto grid = lists.bin(stage, z_bounds);
    std::vector<float> depth(static_cast<std::size_t>(settings.width * settings.height));
    glReadPixels(0, 0, settings.width, settings.height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    std::uint64_t listed = 0, pixels = 0, reached = 0, nearly_reached = 0;
    struct Drawn {
        std::uint64_t pixels = 0;
        double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    };
    std::vector<Drawn> tiles(view.tile_count());
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
            Drawn& tile = tiles[static_cast<std::size_t>(y / settings.tile_size * view.tiles_x() +
                                                         x / settings.tile_size)];
            ++tile.pixels;
            tile.nearest = std::min(tile.nearest, -p.z);
            tile.farthest = std::max(tile.farthest, -p.z);
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
    // Spheres against the planes through the eye and the sides of each tile, and against its depths.
    std::uint64_t within_planes = 0;
    for (int ty = 0; ty < view.tiles_y(); ++ty)
        for (int tx = 0; tx < view.tiles_x(); ++tx) {
            const Drawn& tile = tiles[static_cast<std::size_t>(ty * view.tiles_x() + tx)];
            const auto corner = [&](int x, int y) {
                const auto p = view.view_point(
                    {static_cast<double>(std::min(x * settings.tile_size, settings.width)),
                     static_cast<double>(std::min(y * settings.tile_size, settings.height)), 1});
                return glm::dvec3(p.x, p.y, p.z);
            };
            const glm::dvec3 a = corner(tx, ty), b = corner(tx + 1, ty), c = corner(tx + 1, ty + 1),
                             d = corner(tx, ty + 1);
            for (const lightbin::Sphere& light : stage.lights()) {
                const glm::dvec3 centre(light.x, light.y, light.z);
                const double radius = static_cast<double>(light.radius);
                // The tile is on the left of the way from p to q.
                const auto beyond = [&](const glm::dvec3& p, const glm::dvec3& q) {
                    return glm::dot(glm::normalize(glm::cross(p, q)), centre) > radius;
                };
                within_planes += (beyond(a, b) || beyond(b, c) || beyond(c, d) || beyond(d, a) ||
                                  -centre.z - radius > tile.farthest || -centre.z + radius < tile.nearest)
                                     ? 0
                                     : tile.pixels;
            }
        }
    CHECK(within_planes > listed * 99 / 100);
    CHECK(counted(tiled_deferred_planes(32)) > within_planes * 999 / 1000);
    CHECK(counted(tiled_deferred_planes(32)) < within_planes * 1001 / 1000);
    // Of surfaces in one place both are lit.
    CHECK(counted(tiled_forward_pre_z(ZEnds::both)) >= listed);
    CHECK(counted(tiled_forward_pre_z(ZEnds::both)) < listed * 11 / 10);
    CHECK(counted(forward_every_light()) >= pixels * scene.lights.size());
    CHECK(counted(tiled_forward()) > listed);
    // A ball of triangles that holds the light's.
    const std::uint64_t marked = counted(deferred_stencil(32));
    CHECK(marked >= reached);
    CHECK(marked <= nearly_reached);
    CHECK(reached > pixels);
}

// One surface, so that nothing is lit and then hidden.
TEST_CASE("evaluations without a pre-pass, and a light at a time") {
    Scene scene = make_scene(250);
    scene.triangles.resize(6);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    settings.count = true;
    settings.wide = true;
    const Camera& camera = scene.cameras[1];
    stage.begin(camera, settings);
    begin_picture(stage);
    depth_pre_pass(stage);
    std::vector<float> depths(static_cast<std::size_t>(settings.width * settings.height));
    glReadPixels(0, 0, settings.width, settings.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());

    using lightbin::Slicing;
    const lightbin::View view = stage.view();
    const float reach = depth_of_lights(stage);
    const auto slices = value_of(lightbin::Slices::exponential(24, reach / 40, reach));
    const auto fine_slices = value_of(lightbin::Slices::linear(1024, 0, reach));
    lightbin::Binner binner;
    lightbin::Binner<lightbin::Options{.depth_test = true, .slicing = Slicing::clusters}>
        cluster_binner;
    lightbin::Binner<lightbin::Options{.slicing = Slicing::z_bins}> bin_binner;
    const auto tiles = value_of(binner.bin(view, stage.lights()));
    const auto clusters = value_of(cluster_binner.bin(view, stage.lights(), {.slices = slices}));
    const auto bins = value_of(bin_binner.bin(view, stage.lights(), {.slices = fine_slices}));
    const auto rectangles = stage.footprints(1);
    std::uint64_t of_tiles = 0, of_clusters = 0, of_bins = 0, of_rectangles = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const auto window = static_cast<double>(depths[static_cast<std::size_t>(y * settings.width + x)]);
            if (window == 1) continue;
            const float depth = view.view_depths(window, window).min;
            const int column = x / settings.tile_size, row = y / settings.tile_size;
            of_tiles += tiles.lights_in(column, row).size();
            of_clusters += clusters.lights_in(column, row, slices.slice_at(depth)).size();
            const auto bin = bins.ranks().bins[static_cast<std::size_t>(fine_slices.slice_at(depth))];
            of_bins += lightbin::lights_of_bin(bins.lights_in(column, row), bin).size();
            of_rectangles += static_cast<std::uint64_t>(
                std::ranges::count_if(rectangles, [&](const LightFootprint& f) {
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
    CHECK(of_clusters > 1000);
    CHECK(of_clusters < of_bins);
    CHECK(of_bins < of_tiles);
    CHECK(counted(light_indexed(8)) == counted(tiled_forward_pre_z(ZEnds::both)));
}

TEST_CASE("all lights are seen from above") {
    Scene below = make_scene(20);
    for (Light& light : below.lights)
        light.position.y -= 100;
    for (const Scene& scene : {make_scene(1), make_scene(20), below}) {
        const OffscreenContext context(0);
        Stage stage(scene, context.glsl());
        const Camera camera = camera_from_above(scene, {});
        stage.begin(camera, small_frame(1));
        const auto footprints = stage.footprints();
        CHECK(footprints.size() == scene.lights.size());
        CHECK(std::ranges::all_of(stage.lights(), [&](const lightbin::Sphere& light) {
            const double depth = -static_cast<double>(light.z);
            return depth > camera.near && depth < camera.far;
        }));
    }
}

TEST_CASE("from above is under a ceiling where most places have one") {
    Scene scene = make_scene(20);
    const double top = 30;  // a ceiling over the middle, and a floor below it
    const glm::vec3 up(0, 1, 0), white(1);
    for (const float height : {30.0f, 0.0f})
        for (const glm::vec3& corner : {glm::vec3(-20, 0, -20), glm::vec3(20, 0, -20), glm::vec3(0, 0, 30)})
            scene.triangles.push_back({corner + height * up, up, white});
    const auto at = [](double x, double y, double z) {
        Camera camera;
        camera.to_world[3] = glm::dvec4(x, y, z, 1);
        return camera;
    };
    const std::vector<Camera> within = {at(1, 25, 2), at(0, 26, 15), at(100, 25, 0)};
    const Camera camera = camera_from_above(scene, within);
    const glm::dvec3 eye(camera.to_world[3]);
    CHECK(eye.x == 1);
    CHECK(eye.z == 2);
    CHECK(eye.y < top);
    CHECK(eye.y > top - 1);
    CHECK(glm::distance(glm::dvec3(camera.to_world[2]), glm::dvec3(0, 1, 0)) < 1e-9);
    CHECK(glm::dvec3(camera_from_above(scene, {at(1, 25, 2), at(100, 25, 0)}).to_world[3]).y > top);
    CHECK(glm::dvec3(camera_from_above(scene, {}).to_world[3]).y > top);
}

TEST_CASE("few lights go along the order of the many") {
    std::vector<Light> many(924);
    for (std::size_t i = 0; i < many.size(); ++i)
        many[i] = {.position = glm::vec3(i, 0, 0), .range = 10, .intensity = glm::vec3(1)};
    for (const double time : {0.0, 0.5, 1.0}) {
        const std::vector<Light> few = few_lights(many, time);
        REQUIRE(few.size() == 11);
        for (std::size_t i = 0; i < few.size(); ++i) {
            CHECK(static_cast<double>(few[i].position.x) ==
                  84.0 * static_cast<double>(i) + std::round(83 * time));
            CHECK(few[i].range == 32);
        }
    }
    CHECK(few_lights({many.begin(), many.begin() + 3}, 1).size() == 11);  // some in one place
    CHECK(frame_of("frame 259") == 259);
    CHECK(frame_of("7") == 7);
    CHECK(frame_of("front") == -1);
    CHECK(frame_of("") == -1);
}

TEST_CASE("each view is as bright as if it were the first") {
    const Scene scene = make_scene(100);
    const RunSettings run{.width = 131, .height = 77, .tile_size = 13, .timed_frames = 1};
    const OffscreenContext context(0);
    LeftOut left_out;
    Runner first(scene, run, context.glsl(), left_out), second(scene, run, context.glsl(), left_out);
    REQUIRE(first.run("", scene.cameras[0], {}, {}).size() == 1);
    REQUIRE(second.run("", scene.cameras[1], {deferred_stencil(32)}, {}).size() == 2);
    REQUIRE(second.run("", scene.cameras[0], {}, {}).size() == 1);
    CHECK(compare(first.reference(), second.reference()).largest == 0);
    CHECK(lit_share(first.reference()) > 0.1);
}

// Mesa's compiler takes more than the standard has. The texts are got from OpenGL, which has all that were drawn with.
TEST_CASE("another compiler takes the shaders, too") {
    glslang::InitializeProcess();
    const Scene scene = make_scene(250);
    for (const int glsl : {330, 430}) {
        const OffscreenContext context(glsl);
        Stage stage(scene, glsl);
        Settings settings = small_frame(1);
        std::vector<Technique> techniques = every_technique();
        techniques.push_back(forward_every_light());
        for (const bool count : {false, true}) {
            settings.count = count && glsl == 430;
            for (const Technique& technique : techniques)
                if (technique.glsl <= glsl) draw(stage, technique, scene.cameras[0], settings);
        }
        int compiled = 0;
        for (GLuint program = 1; program < 500; ++program) {
            if (!glIsProgram(program)) continue;
            GLuint attached[2] = {};
            GLsizei count = 0;
            glGetAttachedShaders(program, 2, &count, attached);
            std::vector<std::unique_ptr<glslang::TShader>> shaders;
            glslang::TProgram other_program;
            for (GLsizei i = 0; i < count; ++i) {
                GLint kind = 0, length = 0;
                glGetShaderiv(attached[i], GL_SHADER_TYPE, &kind);
                glGetShaderiv(attached[i], GL_SHADER_SOURCE_LENGTH, &length);
                std::string text(static_cast<std::size_t>(length), '\0');
                glGetShaderSource(attached[i], length, nullptr, text.data());
                const char* const begin = text.c_str();
                glslang::TShader& shader = *shaders.emplace_back(
                    std::make_unique<glslang::TShader>(kind == GL_VERTEX_SHADER     ? EShLangVertex
                                                       : kind == GL_FRAGMENT_SHADER ? EShLangFragment
                                                                                    : EShLangCompute));
                shader.setStrings(&begin, 1);
                const bool taken = shader.parse(GetDefaultResources(), 100, false, EShMsgDefault);
                CHECK_MESSAGE(taken, std::string(shader.getInfoLog()), text);
                other_program.addShader(&shader);
            }
            const bool linked = other_program.link(EShMsgDefault);
            CHECK_MESSAGE(linked, std::string(other_program.getInfoLog()));
            ++compiled;
        }
        CHECK(compiled > 20);
    }
    glslang::FinalizeProcess();
}

TEST_CASE("what this OpenGL lacks is named") {
    const Scene scene = make_scene(300);
    const OffscreenContext context(0);
    Stage stage(scene, context.glsl());
    Settings settings = small_frame(1);
    CHECK_THROWS_WITH_AS(draw(stage, light_indexed(8), scene.cameras[0], settings),
                         doctest::Contains("number 255 lights, and 300 are"), std::runtime_error);
    settings.tile_size = 64;
    CHECK_THROWS_WITH_AS(draw(stage, tiled_deferred_planes(32), scene.cameras[0], settings),
                         doctest::Contains("a thread a pixel"), std::runtime_error);
    settings.tile_size = 8;
    const Scene many = make_scene(20000);
    Stage stage_of_many(many, context.glsl());
    CHECK_THROWS_WITH_AS(draw(stage_of_many, tiled_deferred_planes(32), many.cameras[0], settings),
                         doctest::Contains("and 20000 are in the scene"), std::runtime_error);
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

TEST_CASE("with OpenGL 3.3, what needs no more is drawn") {
    const Scene scene = make_scene(250);
    const OffscreenContext context(330);
    Stage stage(scene, 330);
    const Settings settings = small_frame(1);
    const Bytes expected = draw(stage, forward_every_light(), scene.cameras[1], settings);
    int drawn = 0;
    for (const Technique& technique : every_technique()) {
        if (technique.glsl > 330) continue;
        CAPTURE(technique.name);
        CHECK(compare(expected, draw(stage, technique, scene.cameras[1], settings)).largest <=
              technique.tolerance);
        ++drawn;
    }
    CHECK(drawn == 16);
}
