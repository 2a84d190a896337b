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
#include <vector>

namespace {

using nlohmann::json;

Stage stage;
std::string question, answer;
std::vector<unsigned char> data;  // beside the question: a file, or Z bounds

template <class T> json array_of(const char* type, std::span<const T> items) {
    return {{"type", type}, {"at", reinterpret_cast<std::uintptr_t>(items.data())}, {"count", items.size_bytes() / 4}};
}
template <class T> json floats(std::span<const T> items) {
    return array_of("f32", items);
}
template <class T> json words(std::span<const T> items) {
    return array_of("u32", items);
}

// A struct of floats or of words, by value.
template <class Number, class Struct> json numbers(const Struct& from) {
    std::vector<Number> values(sizeof from / sizeof(Number));
    std::memcpy(values.data(), &from, sizeof from);
    return values;
}

json settings_json(const Camera& camera) {
    return {{"name", camera.name}, {"to_world", numbers<double>(camera.to_world)},
            {"orthographic", camera.orthographic}, {"height", camera.height}, {"near", camera.near},
            {"far", camera.far}};
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
    if (from.at("clip") == "webgpu") {
        settings.clip_depth = lightbin::ClipDepth::zero_to_one;
        settings.origin = lightbin::WindowOrigin::upper_left;
    }
    const std::string method = from.at("method");
    const auto found = methods.find(method);
    if (found == methods.end()) throw std::runtime_error("there is no method '" + method + "'");
    settings.bin.method = found->second;
    settings.bin.clusters = from.value("slices", 24);
    settings.bin.dropped_light = from.value("drop", -1);
    settings.seconds = from.value("seconds", 0.0);
    settings.on_gpu = from.value("on_gpu", false);
    return settings;
}

json scene_json() {
    const Scene& scene = stage.scene();
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const Vertex& vertex : scene.triangles) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    const glm::vec3 centre = (low + high) / 2.0f;
    json cameras = json::array();
    for (const Camera& camera : scene.cameras)
        cameras.push_back(settings_json(camera));
    return {{"name", scene.name},
            {"notes", scene.notes},
            {"lights", scene.lights.size()},
            {"suns", scene.suns.size()},
            {"has_spots", std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.spot; })},
            {"cameras", cameras},
            {"centre", numbers<float>(centre)},
            {"radius", glm::length(high - low) / 2},
            {"triangles", floats(std::span(scene.triangles))},
            {"glass", floats(std::span(scene.transparent))}};
}

json prepared_json(const Prepared& prepared) {
    const lightbin::View& view = prepared.view;
    return {{"projection", numbers<float>(prepared.projection)},
            {"view", numbers<float>(prepared.world_to_view)},
            {"moon", numbers<float>(prepared.moon)},
            {"grid", numbers<std::uint32_t>(lightbin::shader_grid(view))},
            {"shader_view", numbers<float>(lightbin::shader_view(view))},
            {"reduce", numbers<std::uint32_t>(lightbin::shader_reduce(view))},
            {"tiles_x", view.tiles_x()},
            {"tiles_y", view.tiles_y()}};
}

json frame_json(const json& from) {
    const FrameSettings settings = settings_of(from);
    json answer = prepared_json(stage.prepare(settings));
    const std::size_t tiles = answer["tiles_x"].get<std::size_t>() * answer["tiles_y"].get<std::size_t>();
    lightbin::ZBounds z_bounds;
    if (from.value("bounds", false)) {
        const auto side = [&](std::size_t i) {
            return std::span(reinterpret_cast<const float*>(data.data()) + i * tiles, tiles);
        };
        z_bounds = {.min = side(0), .max = side(1), .background_skipped = true};
        if (from.value("glass_bounds", false)) z_bounds.transparent_max = side(2);
    }
    const Frame& frame = stage.frame(settings, z_bounds);
    answer["lights"] = floats(frame.lights);
    answer["light_count"] = stage.scene().lights.size();
    answer["sun_count"] = stage.scene().suns.size();
    answer["ranges"] = words(frame.ranges);
    answer["ids"] = words(frame.ids);
    answer["slices"] = words(std::span<const std::uint32_t>(frame.slices));
    answer["bins"] = words(frame.bins);
    answer["ms"] = {{"lights", frame.light_ms}, {"bin", frame.bin_ms}};
    answer["in_view"] = frame.counts.lights - frame.counts.culled - frame.counts.rejected;
    answer["rejected"] = frame.counts.rejected;
    answer["entries"] = frame.ids.size();
    answer["longest"] = frame.longest;
    return answer;
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

}  // namespace

#define EXPORT(name) extern "C" __attribute__((export_name(#name)))

EXPORT(question) char* question_room(std::size_t bytes) {
    question.resize(bytes);
    return question.data();
}
EXPORT(data) unsigned char* data_room(std::size_t bytes) {
    data.resize(bytes);
    return data.data();
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
        stage.open(data, asked.at("name"));
        data = {};
        return scene_json();
    });
}
EXPORT(scene) const char* answer_scene() {
    return answered([](const json&) { return scene_json(); });
}
EXPORT(prepare) const char* answer_prepare() {
    return answered([](const json& asked) { return prepared_json(stage.prepare(settings_of(asked))); });
}
EXPORT(frame) const char* answer_frame() {
    return answered(frame_json);
}
EXPORT(text) const char* answer_text() {
    return answered([](const json& asked) { return shader_text(asked.at("what"), asked.at("options")); });
}
