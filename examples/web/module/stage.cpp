// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include "moving_lights.hpp"
#include "projection.hpp"

#include <chrono>
#include <limits>
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

void Stage::make(const std::string& kind, int lights) {
    if (kind == "street") return show(make_street(), kind);
    if (kind != "city") throw std::runtime_error("there is no made scene '" + kind + "'");
    if (lights < 1 || lights > most_lights)
        throw std::runtime_error("the city has 1 to " + std::to_string(most_lights) + " lights, not " +
                                 std::to_string(lights));
    show(make_scene(lights), kind);
}

void Stage::open(std::span<const unsigned char> bytes, const std::string& name) {
    show(read_glb(bytes, name, cutoff), "file");
}

void Stage::show(Scene scene, const std::string& kind) {
    scene_ = std::move(scene);
    scene_.boxes.clear();  // the shaders of the page know lights only
    kind_ = kind;
    places_ = scene_.lights;
    frame_ = {};
    binned_.emplace(scene_);
}

Prepared Stage::prepare(const FrameSettings& settings) const {
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const glm::mat4 projection = projection_of(settings.camera, aspect, settings.clip_depth),
                    world_to_view(glm::inverse(settings.camera.to_world));
    return {
        value_of(lightbin::View::from_projection(
            projection, {settings.width, settings.height},
            {.tile_size = settings.tile_size, .clip_depth = settings.clip_depth, .origin = settings.origin})),
        projection, world_to_view, glm::mat3(world_to_view) * way_to_moon};
}

void Stage::place(const FrameSettings& settings) {
    if (!binned_) throw std::runtime_error("there is no scene yet");
    move_lights(places_, settings.seconds, scene_.lights);
    binned_->place(glm::inverse(settings.camera.to_world));
}

const Frame& Stage::frame(const lightbin::View& view, const FrameSettings& settings,
                          const lightbin::ZBounds& z_bounds) {
    frame_ = {};
    Stopwatch watch;
    place(settings);
    frame_.light_ms = watch.lap();
    if (settings.on_gpu)
        make_footprints(view, settings.bin);
    else
        make_lists(view, settings.bin, z_bounds);
    frame_.bin_ms = watch.lap();
    frame_.lights = settings.on_gpu ? binned_->lights_and_suns() : binned_->in_order();
    frame_.light_ms += watch.lap();
    return frame_;
}

void Stage::make_lists(const lightbin::View& view, BinSettings settings, const lightbin::ZBounds& z_bounds) {
    settings.glass = !scene_.transparent.empty();
    const auto [opaque, transparent] = binned_->bin(view, settings, z_bounds);
    frame_.ranges = opaque.ranges();
    frame_.ids = opaque.ids();
    frame_.glass_ranges = transparent.ranges();
    frame_.glass_ids = transparent.ids();
    if (binned_->slices()) frame_.slices = lightbin::shader_slices(*binned_->slices());
    frame_.bins = opaque.ranks().bins;
    frame_.counts = opaque.light_counts();
    frame_.longest = list_lengths(opaque).longest;
}

void Stage::make_footprints(const lightbin::View& view, const BinSettings& settings) {
    if (settings.method == DepthMethod::z_bins)
        throw std::runtime_error("z-bins are made on the processor, not by the GPU");
    frame_.footprints = binned_->visit_lights(settings.dropped_light, [&](const auto& lights) {
        return value_of(lightbin::shader_footprints(view, lights));
    });
    frame_.edges = lightbin::shader_edges(view);
    auto slices = value_of(lightbin::Slices::linear(1, 0, 0));
    if (settings.method == DepthMethod::clusters) {
        slices = slices_for(settings, view.orthographic(), binned_->lights());
        frame_.slices = lightbin::shader_slices(slices);
        frame_.slabs = lightbin::shader_slabs(slices);
    }
    std::uint64_t room = 0;  // for all tiles of the rectangles, in all slices that the lights meet
    for (const lightbin::ShaderFootprint& light : frame_.footprints) {
        const int deep =
            slices.slice_at(light.z + light.radius) - slices.slice_at(light.z - light.radius) + 1;
        room += std::uint64_t{1} * static_cast<unsigned>(deep) * (light.x1 - light.x0 + 1u) *
                (light.y1 - light.y0 + 1u);
    }
    if (room > std::numeric_limits<std::uint32_t>::max())
        throw std::runtime_error("the lists would have " + std::to_string(room) +
                                 " entries: take larger tiles");
    frame_.build = lightbin::shader_build(view, static_cast<std::uint32_t>(frame_.footprints.size()),
                                          static_cast<std::uint32_t>(room), slices.count());
    frame_.counts.lights = static_cast<std::uint32_t>(scene_.lights.size());
    frame_.counts.culled = frame_.counts.lights - static_cast<std::uint32_t>(frame_.footprints.size());
}
