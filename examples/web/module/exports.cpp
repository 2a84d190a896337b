// SPDX-License-Identifier: MIT
// The edge of the module: what scenes.js calls. Questions and answers are JSON in the module's memory; a large array is
// {"type", "at", "count"}, a place in it.
#include "stage.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
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
std::vector<unsigned char> data;  // beside the question: a file

// Numbers of the module's memory, where they are.
template <class T> json view_of(const char* type, std::span<const T> items) {
    return {{"type", type},
            {"at", reinterpret_cast<std::uintptr_t>(items.data())},
            {"count", items.size_bytes() / sizeof(float)}};
}
template <class Items> json floats(const Items& items) {
    return view_of("f32", std::span(items.data(), items.size()));
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

Camera camera_of(const json& from) {
    Camera camera;
    for (int i = 0; i < 16; ++i)
        camera.to_world[i / 4][i % 4] = from.at("to_world").at(static_cast<std::size_t>(i));
    camera.orthographic = from.at("orthographic");
    camera.height = from.at("height");
    camera.near = from.at("near");
    const json& far = from.at("far");  // JSON has no infinity
    camera.far = far.is_null() ? std::numeric_limits<double>::infinity() : far.get<double>();
    return camera;
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
            {"notes", scene.notes},
            {"lights", scene.lights.size()},
            {"has_spots", stage.has_spots()},
            {"cameras", cameras},
            {"centre", few_floats(low + (high - low) / 2.0f)},
            {"radius", glm::length(high - low) / 2},
            {"triangles", floats(scene.triangles)},
            {"glass", floats(scene.transparent)}};
}

json look_json(const json& asked) {
    const Look look = stage.look(camera_of(asked.at("camera")), asked.at("aspect"),
                                 asked.at("clip") == "webgpu" ? lightbin::ClipDepth::zero_to_one
                                                              : lightbin::ClipDepth::minus_one_to_one);
    return {{"projection", few_floats(look.projection)},
            {"view", few_floats(look.world_to_view)},
            {"moon", few_floats(look.moon)}};
}

json lights_json(const json& asked) {
    const PlacedLights& placed =
        stage.place(camera_of(asked.at("camera")).to_world, asked.at("seconds"), asked.at("drop"));
    return {{"lights", floats(placed.lights)},
            {"shapes", floats(placed.shapes)},
            {"has_spots", stage.has_spots()},
            {"reach", std::isinf(placed.reach) ? json() : json(placed.reach)}};
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
EXPORT(look) const char* answer_look() {
    return answered(look_json);
}
EXPORT(lights) const char* answer_lights() {
    return answered(lights_json);
}
