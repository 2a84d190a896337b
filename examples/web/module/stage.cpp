// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include "moving_lights.hpp"
#include "projection.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

namespace {

constexpr int most_lights = 1'000'000;
constexpr float cutoff = 0.05f;  // lux at which a file's light without a range ends

// Milliseconds since the last call.
class Stopwatch {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(start_, now)).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Stage::Stage() {
    show(make_scene(1));
}

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
    places_ = scene_.lights;
    frame_ = {};
    binned_.emplace(scene_);
}

Prepared Stage::prepare(const FrameSettings& settings) const {
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const glm::mat4 projection = projection_of(settings.camera, aspect, settings.clip_depth),
                    world_to_view(glm::inverse(settings.camera.to_world));
    return {value_of(lightbin::View::from_projection(projection, {settings.width, settings.height},
                                                     {.tile_size = settings.tile_size,
                                                      .clip_depth = settings.clip_depth,
                                                      .origin = settings.origin})),
            projection, world_to_view, glm::mat3(world_to_view) * way_to_moon};
}

void Stage::place(const FrameSettings& settings) {
    move_lights(places_, settings.seconds, scene_.lights);
    binned_->place(glm::inverse(settings.camera.to_world));
}

const Frame& Stage::frame(const FrameSettings& settings, const lightbin::ZBounds& z_bounds) {
    const lightbin::View view = prepare(settings).view;
    frame_ = {};
    Stopwatch watch;
    place(settings);
    frame_.light_ms = watch.lap();

    BinSettings bin = settings.bin;
    bin.glass = !scene_.transparent.empty();
    const auto [opaque, transparent] = binned_->bin(view, bin, z_bounds);
    frame_.bin_ms = watch.lap();

    frame_.lights = binned_->in_order();
    frame_.light_ms += watch.lap();
    frame_.ranges = opaque.ranges();
    frame_.ids = opaque.ids();
    if (transparent.ranges().data() != opaque.ranges().data()) {
        frame_.glass_ranges = transparent.ranges();
        frame_.glass_ids = transparent.ids();
    }
    if (binned_->slices()) frame_.slices = lightbin::shader_slices(*binned_->slices());
    frame_.bins = opaque.ranks().bins;
    frame_.counts = opaque.light_counts();
    frame_.longest = list_lengths(opaque).longest;
    return frame_;
}
