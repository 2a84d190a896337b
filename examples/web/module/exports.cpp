// SPDX-License-Identifier: MIT
// The edge of the module: what lightbin.js calls. Questions and answers are JSON in the module's memory; a large array is
// {"type", "at", "count"}, a place in it.
#include "stage.hpp"
#include "texts.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using nlohmann::json;

Stage stage;
std::string question, answer;
std::vector<unsigned char> data;  // beside the question: a file, or Z bounds

// Numbers of the module's memory, where they are.
template <class T> json view_of(const char* type, std::span<const T> items) {
    return {{"type", type},
            {"at", reinterpret_cast<std::uintptr_t>(items.data())},
            {"count", items.size_bytes() / sizeof(float)}};
}
template <class Items> json floats(const Items& items) {
    return view_of("f32", std::span(items.data(), items.size()));
}
template <class Items> json words(const Items& items) {
    return view_of("u32", std::span(items.data(), items.size()));
}

// A small struct of such numbers, by value.
template <class Number, class Struct> json copy_of(const char* type, const Struct& from) {
    std::vector<Number> values(sizeof from / sizeof(Number));
    std::memcpy(values.data(), &from, sizeof from);
    return {{"type", type}, {"values", values}};
}
template <class Struct> json few_floats(const Struct& from) {
    return copy_of<float>("f32", from);
}
template <class Struct> json few_words(const Struct& from) {
    return copy_of<std::uint32_t>("u32", from);
}

FrameSettings settings_of(const json& from) {
    static const std::map<std::string, DepthMethod> methods = {{"none", DepthMethod::none},
                                                               {"interval", DepthMethod::interval},
                                                               {"box", DepthMethod::box},
                                                               {"z_bins", DepthMethod::z_bins},
                                                               {"clusters", DepthMethod::clusters}};
    FrameSettings settings;
    const json& camera = from.at("camera");
    for (int i = 0; i < 16; ++i)
        settings.camera.to_world[i / 4][i % 4] = camera.at("to_world").at(static_cast<std::size_t>(i));
    settings.camera.orthographic = camera.at("orthographic");
    settings.camera.height = camera.at("height");
    settings.camera.near = camera.at("near");
    const json& far = camera.at("far");  // JSON has no infinity
    settings.camera.far = far.is_null() ? std::numeric_limits<double>::infinity() : far.get<double>();
    settings.width = from.at("width");
    settings.height = from.at("height");
    settings.tile_size = from.at("tile_size");
    if (from.value("clip", "webgl") == "webgpu") {
        settings.clip_depth = lightbin::ClipDepth::zero_to_one;
        settings.origin = lightbin::WindowOrigin::upper_left;
    }
    const std::string method = from.value("method", "none");
    const auto found = methods.find(method);
    if (found == methods.end()) throw std::runtime_error("there is no method '" + method + "'");
    settings.bin.method = found->second;
    settings.bin.clusters = from.value("slices", 24);
    settings.bin.dropped_light = from.value("drop", -1);
    settings.seconds = from.value("seconds", 0.0);
    settings.on_gpu = from.value("on_gpu", false);
    return settings;
}

json camera_json(const Camera& camera) {
    return {{"name", camera.name},
            {"to_world", copy_of<double>("f64", camera.to_world)},
            {"orthographic", camera.orthographic},
            {"height", camera.height},
            {"near", camera.near},
            {"far", camera.far}};
}

json scene_json() {
    const Scene& scene = stage.scene();
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const Vertex& vertex : scene.triangles) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    json cameras = json::array();
    for (const Camera& camera : scene.cameras)
        cameras.push_back(camera_json(camera));
    return {{"name", scene.name},
            {"kind", stage.kind()},
            {"notes", scene.notes},
            {"lights", scene.lights.size()},
            {"suns", scene.suns.size()},
            {"has_spots", stage.has_spots()},
            {"cameras", cameras},
            {"centre", few_floats(low + (high - low) / 2.0f)},
            {"radius", glm::length(high - low) / 2},
            {"triangles", floats(scene.triangles)},
            {"glass", floats(scene.transparent)}};
}

json prepared_json(const Prepared& prepared) {
    const lightbin::View& view = prepared.view;
    return {{"projection", few_floats(prepared.projection)},
            {"view", few_floats(prepared.world_to_view)},
            {"moon", few_floats(prepared.moon)},
            {"grid", few_words(lightbin::shader_grid(view))},
            {"shader_view", few_floats(lightbin::shader_view(view))},
            {"reduce", few_words(lightbin::shader_reduce(view))},
            {"tiles_x", view.tiles_x()},
            {"tiles_y", view.tiles_y()}};
}

// The data: one side after another, as long as the question says.
lightbin::ZBounds z_bounds_of(const json& asked) {
    if (!asked.contains("bounds")) return {};
    const float* at = reinterpret_cast<const float*>(data.data());
    const auto side = [&](const char* name) {
        const auto count = asked.at("bounds").value(name, std::size_t{0});
        return std::span(std::exchange(at, at + count), count);
    };
    return {.min = side("min"),
            .max = side("max"),
            .transparent_max = side("glass_max"),
            .background_skipped = true};
}

json frame_json(const json& asked) {
    const FrameSettings settings = settings_of(asked);
    const Prepared prepared = stage.prepare(settings);
    const lightbin::View& view = prepared.view;
    const Frame& frame = stage.frame(view, settings, z_bounds_of(asked));
    json made = prepared_json(prepared);
    made.update({{"lights", floats(frame.lights)},
                 {"light_count", stage.scene().lights.size()},
                 {"sun_count", stage.scene().suns.size()},
                 {"ranges", words(frame.ranges)},
                 {"ids", words(frame.ids)},
                 {"glass_ranges", words(frame.glass_ranges)},
                 {"glass_ids", words(frame.glass_ids)},
                 {"slices", words(frame.slices)},
                 {"bins", words(frame.bins)},
                 {"ms", {{"lights", frame.light_ms}, {"bin", frame.bin_ms}}},
                 {"in_view", frame.counts.lights - frame.counts.culled - frame.counts.rejected},
                 {"rejected", frame.counts.rejected},
                 {"entries", frame.ids.size()},
                 {"longest", frame.longest}});
    if (settings.on_gpu)
        made.update({{"footprints", words(frame.footprints)},
                     {"edges", floats(frame.edges)},
                     {"slabs", floats(frame.slabs)},
                     {"build", few_words(frame.build)}});
    return made;
}

json advice_json(const json& asked) {
    const FrameSettings settings = settings_of(asked);
    const lightbin::View view = stage.prepare(settings).view;
    const lightbin::Advice advice =
        stage.advise(view, settings, z_bounds_of(asked), 1e6 * asked.value("z_bounds_milliseconds", 0.0));
    json plans = json::array();
    for (const lightbin::Plan& plan : advice.plans())
        plans.push_back({{"tiled", plan.tiled},
                         {"footprint", to_string(plan.footprint)},
                         {"depth_test", to_string(plan.depth_test)},
                         {"slicing", to_string(plan.slicing)},
                         {"tile_size", plan.tile_size},
                         {"milliseconds", plan.total_ns * 1e-6},
                         {"build_milliseconds", plan.build_ns * 1e-6},
                         {"entries", plan.entries},
                         {"evaluations", plan.evaluations},
                         {"best", &plan == &advice.best()}});
    return plans;
}

// Answers the question, or says in a sentence what is wrong with it.
template <class Make> const char* answered(Make make) {
    json made;
    try {
        made = make(json::parse(question));
    } catch (const std::bad_alloc&) {
        made = {{"error", "there is not enough memory for this"}};
    } catch (const std::exception& problem) {
        made = {{"error", problem.what()}};
    }
    answer = made.dump(-1, ' ', false, json::error_handler_t::replace);  // a file's names need not be UTF-8
    return answer.c_str();
}

// Null where there is no memory.
template <class Bytes> auto room(Bytes& bytes, std::size_t size) -> decltype(bytes.data()) {
    try {
        bytes.resize(size);
        return bytes.data();
    } catch (const std::exception&) {
        return nullptr;
    }
}

}  // namespace

#define EXPORT(name) extern "C" __attribute__((export_name(#name)))

EXPORT(question) char* question_room(std::size_t bytes) {
    return room(question, bytes);
}
EXPORT(data) unsigned char* data_room(std::size_t bytes) {
    return room(data, bytes);
}
EXPORT(answer_length) std::size_t answer_length() {
    return answer.size();
}
EXPORT(make) const char* answer_make() {
    return answered([](const json& asked) {
        stage.make(asked.at("kind"), asked.at("lights"));
        return scene_json();
    });
}
EXPORT(open) const char* answer_open() {
    return answered([](const json& asked) {
        stage.open(std::exchange(data, {}), asked.at("name"));
        return scene_json();
    });
}
EXPORT(scene) const char* answer_scene() {
    return answered([](const json&) { return scene_json(); });
}
EXPORT(view) const char* answer_view() {
    return answered([](const json& asked) { return prepared_json(stage.prepare(settings_of(asked))); });
}
EXPORT(frame) const char* answer_frame() {
    return answered(frame_json);
}
EXPORT(advise) const char* answer_advise() {
    return answered(advice_json);
}
EXPORT(text) const char* answer_text() {
    return answered([](const json& asked) { return shader_text(asked.at("what"), asked.at("options")); });
}
