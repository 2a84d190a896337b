// SPDX-License-Identifier: MIT
// What the module of examples/web hands to the page: the lights that the renderer of examples/tiled_forward has, whose
// lists lack none, by brute force in world space; and a bad file leaves the scene from before.
#include "glb.hpp"

#include "native_lists.hpp"
#include "stage.hpp"

#include <doctest/doctest.h>

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

class Dice {
public:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
    }

private:
    std::mt19937 engine_{21};
};

std::span<const unsigned char> bytes(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::string fixture(const std::string& name) {
    std::ifstream file(LIGHTBIN_FIXTURES "/" + name, std::ios::binary);
    REQUIRE(file);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A point of the picture, by the numbers that its fragment has, and where it is in the world.
struct Sample {
    int x, y;
    double depth;
    glm::dvec3 world;
};

Sample sample_at(const FrameSettings& settings, int x, int y, double depth) {
    const Camera& camera = settings.camera;
    const bool from_above = settings.origin == lightbin::WindowOrigin::upper_left;
    const double half = camera.orthographic ? camera.height / 2 : depth * std::tan(camera.height / 2);
    const double across = 2 * (x + 0.5) / settings.width - 1, rows = 2 * (y + 0.5) / settings.height - 1,
                 up = from_above ? -rows : rows;
    const glm::dvec4 in_view(half * across * settings.width / settings.height, half * up, -depth, 1);
    return {x, y, depth, glm::dvec3(camera.to_world * in_view)};
}

// Whether a light reaches a point, by a margin for the rounding of floats.
bool reaches(const Light& light, const glm::dvec3& point) {
    const glm::dvec3 way = point - glm::dvec3(light.position);
    const double distance = glm::length(way);
    if (!(distance < (1 - 1e-5) * static_cast<double>(light.range))) return false;
    if (!light.spot) return true;
    return glm::dot(way, glm::dvec3(light.direction)) >
           (static_cast<double>(light.cos_outer) + 1e-4) * distance;
}

// The slice of a depth as the shader looks it up: after the fourth word, the boundaries as words that ascend as they
// do.
std::size_t slice_at(const Frame& frame, double depth) {
    const float single = static_cast<float>(depth);
    std::uint32_t bits;
    std::memcpy(&bits, &single, sizeof bits);
    const std::uint32_t key = bits | 0x80000000;  // depths here are not negative
    const auto first = frame.slices.begin() + 4;
    return static_cast<std::size_t>(
        std::count_if(first, frame.slices.end(), [=](std::uint32_t b) { return b <= key; }));
}

// The ids that the shader goes through at a point.
std::vector<std::uint32_t> listed(const Frame& frame, const lightbin::View& view, DepthMethod method,
                                  const Sample& at, bool glass) {
    std::size_t place =
        static_cast<std::size_t>(at.y / view.tile_size() * view.tiles_x() + at.x / view.tile_size());
    if (method == DepthMethod::clusters) place += slice_at(frame, at.depth) * view.tile_count();
    const auto range = (glass ? frame.glass_ranges : frame.ranges)[place];
    const auto ids = (glass ? frame.glass_ids : frame.ids).subspan(range.offset, range.count);
    std::vector<std::uint32_t> list(ids.begin(), ids.end());
    if (method != DepthMethod::z_bins) return list;
    const auto bin = frame.bins[slice_at(frame, at.depth)];
    std::erase_if(list, [&](std::uint32_t rank) { return rank < bin.least || rank > bin.greatest; });
    return list;
}

// Whether one of the ids is that of a light, by what is uploaded: ids are ranks with z-bins.
bool has(const std::vector<std::uint32_t>& ids, const Frame& frame, const Light& light,
         const glm::dmat4& to_view) {
    const glm::vec3 centre(to_view * glm::dvec4(light.position, 1));
    return std::any_of(ids.begin(), ids.end(), [&](std::uint32_t id) {
        const GpuLight& uploaded = frame.lights[id];
        return glm::length(glm::vec3(uploaded.sphere) - centre) <= 1e-5f * (1 + glm::length(centre)) &&
               uploaded.sphere.w == light.range && glm::vec3(uploaded.colour) == light.intensity;
    });
}

struct Count {
    int reached = 0, missing = 0;
    std::size_t of_most = 0;  // the light that reaches most of the points
};

struct Bounds {
    std::vector<float> min, max, glass_max;
};

// Z bounds for a picture in which each tile shows some depths, or nothing.
Bounds made_bounds(Dice& dice, const lightbin::View& view, double deepest) {
    Bounds bounds;
    for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
        const double low = dice.between(1, deepest), high = low * dice.between(1, 1.5);
        const bool empty = tile % 7 == 0, sky = empty || tile % 5 == 0;
        bounds.min.push_back(empty ? infinity : static_cast<float>(low));
        bounds.max.push_back(empty ? -infinity : static_cast<float>(high));
        bounds.glass_max.push_back(sky ? view.far_depth() : static_cast<float>(high));
    }
    return bounds;
}

Count count_missing(NativeLists& native, const FrameSettings& settings, double deepest) {
    const lightbin::View view = view_of(settings);
    Dice dice;  // the same points again where a light is left out
    const Bounds bounds = made_bounds(dice, view, deepest);
    const Frame frame =
        native.frame(view, settings, {.min = bounds.min, .max = bounds.max}, {.max = bounds.glass_max});
    const DepthMethod method = settings.bin.method;
    const bool bounded = method == DepthMethod::z_bounds;
    const glm::dmat4 to_view = glm::inverse(settings.camera.to_world);
    const std::vector<Light>& lights = native.scene().lights;
    CHECK(frame.lights.size() == lights.size() + native.scene().suns.size());
    const std::size_t cells = frame.ranges.size();
    CHECK(cells == view.tile_count() * (method == DepthMethod::clusters ? 24 : 1));
    CHECK(frame.ids.size() < cells * lights.size());

    Count count;
    std::vector<int> points(lights.size());
    for (int i = 0; i < 300; ++i) {
        const int x = static_cast<int>(dice.between(0, settings.width)),
                  y = static_cast<int>(dice.between(0, settings.height));
        const auto tile =
            static_cast<std::size_t>(y / settings.tile_size * view.tiles_x() + x / settings.tile_size);
        const bool glass = i % 3 == 0 && !native.scene().transparent.empty();
        double low = settings.camera.near, high = deepest;
        if (bounded) {
            if (!glass) low = static_cast<double>(bounds.min[tile]);
            high = std::min(high, static_cast<double>((glass ? bounds.glass_max : bounds.max)[tile]));
        }
        if (low > high) continue;  // nothing is seen there
        const Sample at = sample_at(settings, x, y, dice.between(low, high));
        const auto ids = listed(frame, view, method, at, glass);
        CHECK(std::is_sorted(ids.begin(), ids.end()));
        for (std::size_t light = 0; light < lights.size(); ++light) {
            if (!reaches(lights[light], at.world)) continue;
            ++count.reached;
            ++points[light];
            if (!has(ids, frame, lights[light], to_view)) ++count.missing;
        }
    }
    count.of_most = static_cast<std::size_t>(std::max_element(points.begin(), points.end()) - points.begin());
    return count;
}

FrameSettings settings_for(const Camera& camera, DepthMethod method) {
    FrameSettings settings;
    settings.camera = camera;
    settings.width = 333;
    settings.height = 217;
    settings.bin.method = method;
    return settings;
}

constexpr DepthMethod methods[] = {DepthMethod::none, DepthMethod::z_bounds, DepthMethod::z_bins,
                                   DepthMethod::clusters};

// The module's lights are the renderer's.
void check_lights(Stage& stage, NativeLists& native, const FrameSettings& settings) {
    const PlacedLights& placed =
        stage.place(settings.camera.to_world, settings.seconds, settings.bin.dropped_light);
    FrameSettings in_ids = settings;
    in_ids.bin.method = DepthMethod::none;  // in which no light has another place
    const Frame frame = native.frame(view_of(in_ids), in_ids, {}, {});
    const auto bytes_of = [](const auto& items) { return std::as_bytes(std::span(items)); };
    CHECK(std::ranges::equal(bytes_of(placed.lights), bytes_of(frame.lights)));
    REQUIRE(placed.shapes.size() == stage.scene().lights.size());
    float reach = 0;
    for (std::size_t i = 0; i < placed.shapes.size(); ++i) {
        lightbin::Spot expected = spot_of(placed.lights[i]);
        if (static_cast<int>(i) == settings.bin.dropped_light) expected.radius = -1;
        CHECK(std::ranges::equal(std::as_bytes(std::span(&placed.shapes[i], 1)),
                                 std::as_bytes(std::span(&expected, 1))));
        reach = std::max(reach, placed.lights[i].sphere.w - placed.lights[i].sphere.z);
    }
    CHECK(placed.reach == reach);
    const Look look = stage.look(settings.camera, static_cast<double>(settings.width) / settings.height,
                                 settings.clip_depth);
    CHECK(glm::length(glm::vec3(look.world_to_view * glm::vec4(way_to_moon, 0)) - look.moon) < 1e-6f);
}

// Every method, as each graphics API counts, at rest and in motion; and it is seen where a light is left out.
void check_lists(Stage& stage, double deepest, int at_least) {
    NativeLists native(stage.scene());
    for (const DepthMethod method : methods) {
        FrameSettings settings = settings_for(stage.scene().cameras[0], method);
        CAPTURE(static_cast<int>(method));
        for (const bool webgpu : {false, true}) {
            CAPTURE(webgpu);
            settings.clip_depth =
                webgpu ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one;
            settings.origin =
                webgpu ? lightbin::WindowOrigin::upper_left : lightbin::WindowOrigin::lower_left;
            settings.seconds = webgpu ? 12.5 : 0;
            const Count count = count_missing(native, settings, deepest);
            CHECK(count.reached >= at_least);
            CHECK(count.missing == 0);
            settings.bin.dropped_light = static_cast<int>(count.of_most);
            CHECK(count_missing(native, settings, deepest).missing > 0);
            check_lights(stage, native, settings);
            settings.bin.dropped_light = -1;
        }
    }
}

}  // namespace

TEST_CASE("no list lacks a light that reaches a point of its tile") {
    Stage stage;
    SUBCASE("city") {
        stage.make("city", 1500);
        CHECK(stage.scene().lights.size() == 1500);
        check_lists(stage, 150, 200);
    }
    SUBCASE("street") {
        stage.make("street", 1);
        CHECK(stage.has_spots());
        check_lists(stage, 80, 100);
    }
    for (const char* name : {"nova.glb", "darkness.glb"})
        SUBCASE(name) {
            stage.open(bytes(fixture(name)), name);
            CHECK(stage.kind() == "file");
            check_lists(stage, 60, 100);
        }
    SUBCASE("an orthographic camera") {
        stage.open(bytes(everything_glb()), "everything.glb");
        Camera flat = stage.scene().cameras[1];
        REQUIRE(flat.orthographic);
        NativeLists native(stage.scene());
        for (const DepthMethod method : methods)
            CHECK(count_missing(native, settings_for(flat, method), 40).missing == 0);
    }
}

TEST_CASE("lights move about their places") {
    Stage stage;
    stage.make("city", 100);
    const std::vector<Light> places = stage.scene().lights;
    const Camera& camera = stage.scene().cameras[0];
    const glm::dmat4 to_view = glm::inverse(camera.to_world);
    const auto farthest = [&](double seconds) {
        const PlacedLights& placed = stage.place(camera.to_world, seconds, -1);
        float most = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::vec3 place(to_view * glm::dvec4(places[i].position, 1));
            most = std::max(most, glm::length(glm::vec3(placed.lights[i].sphere) - place) / places[i].range);
        }
        return most;
    };
    CHECK(farthest(0) == 0);
    CHECK(farthest(3) > 0.05f);
    CHECK(farthest(3) < 0.126f);
    CHECK(farthest(0) == 0);
}

TEST_CASE("a bad file is refused in a sentence, and the scene from before is there") {
    Stage stage;
    stage.make("city", 300);
    const std::string good = everything_glb();
    const auto refused = [&](const std::string& file, const std::string& reason) {
        std::string said;
        try {
            stage.open(bytes(file), "a.glb");
        } catch (const std::runtime_error& problem) {
            said = problem.what();
        }
        CAPTURE(said);
        CHECK(said.find("'a.glb': ") == 0);
        CHECK(said.find(reason) != std::string::npos);
        CHECK(said.find('\n') == std::string::npos);
        CHECK(stage.kind() == "city");
        CHECK(stage.scene().lights.size() == 300);
    };
    for (std::size_t size = 0; size < good.size(); size += good.size() / 16)
        refused(good.substr(0, size), "not a readable glTF binary");
    refused("PNG" + good.substr(3), "not a readable glTF binary");
    refused(with(good, "[0, 1, 2, 5]", "[0, 2]"), "no point or spot lights");
    refused(with(good, "{\"light\": 1}", "{\"light\": 8}"), "light 8");
    refused(with(good, "\"count\": 4", "\"count\":40"), "past the end");
    CHECK_THROWS_WITH(stage.make("moon", 1), "there is no made scene 'moon'");
    CHECK_THROWS_WITH(stage.make("city", 0), "the city has 1 to 1000000 lights, not 0");
    CHECK(stage.place(stage.scene().cameras[0].to_world, 0, -1).shapes.size() == 300);
}

TEST_CASE("at first there is no scene") {
    Stage stage;
    CHECK(stage.scene().lights.empty());
    CHECK_THROWS_WITH(stage.place(glm::dmat4(1), 0, -1), "there is no scene yet");
}
