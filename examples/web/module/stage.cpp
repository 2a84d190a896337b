// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include "moving_lights.hpp"
#include "projection.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace {

constexpr int most_lights = 1'000'000;
constexpr float cutoff = 0.05f;  // lux at which a file's light without a range ends

}  // namespace

void Stage::make(const std::string& kind, int lights) {
    if (kind == "street") return show(make_street());
    if (kind != "city") throw std::runtime_error("there is no made scene '" + kind + "'");
    if (lights < 1 || lights > most_lights)
        throw std::runtime_error("the city has 1 to " + std::to_string(most_lights) + " lights, not " +
                                 std::to_string(lights));
    show(make_scene(lights));
}

void Stage::open(std::span<const unsigned char> bytes, const std::string& name) {
    show(read_glb(bytes, name, cutoff));
}

void Stage::show(Scene scene) {
    scene_ = std::move(scene);
    scene_.boxes.clear();  // the shaders of the page know lights only
    has_spots_ = std::any_of(scene_.lights.begin(), scene_.lights.end(),
                             [](const Light& light) { return light.spot; });
}

Look Stage::look(const Camera& camera, double aspect, lightbin::ClipDepth clip_depth) const {
    const glm::mat4 world_to_view(glm::inverse(camera.to_world));
    return {projection_of(camera, aspect, clip_depth), world_to_view, glm::mat3(world_to_view) * way_to_moon};
}

const PlacedLights& Stage::place(const glm::dmat4& camera_to_world, double seconds, int dropped_light) {
    if (scene_.lights.empty()) throw std::runtime_error("there is no scene yet");
    const glm::dmat4 world_to_view = glm::inverse(camera_to_world);
    moved_ = scene_.lights;
    move_lights(scene_.lights, seconds, moved_);
    placed_.lights.clear();
    placed_.shapes.clear();
    placed_.reach = 0;
    for (const Light& light : moved_) {
        const GpuLight placed = gpu_light(light, world_to_view);
        placed_.lights.push_back(placed);
        placed_.shapes.push_back(spot_of(placed));
        placed_.reach = std::max(placed_.reach, placed.sphere.w - placed.sphere.z);
    }
    if (dropped_light >= 0 && dropped_light < static_cast<int>(placed_.shapes.size()))
        placed_.shapes[static_cast<std::size_t>(dropped_light)].radius = -1;
    const glm::dmat3 turn(world_to_view);
    for (const Sun& sun : scene_.suns)
        placed_.lights.push_back({glm::vec4(-glm::vec3(turn * glm::dvec3(sun.direction)), 0),
                                  glm::vec4(sun.illuminance, 0), glm::vec4(0)});
    return placed_;
}
