// SPDX-License-Identifier: MIT
// The lists that this machine's renderer makes of a scene, in the settings that the page has.
#pragma once

#include "binned_lights.hpp"
#include "moving_lights.hpp"
#include "projection.hpp"
#include "value_of.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include <cstdint>
#include <span>
#include <vector>

struct FrameSettings {
    Camera camera;
    int width = 0, height = 0, tile_size = 16;
    lightbin::ClipDepth clip_depth = lightbin::ClipDepth::minus_one_to_one;
    lightbin::WindowOrigin origin = lightbin::WindowOrigin::lower_left;
    BinSettings bin;
    double seconds = 0;  // where moving lights are; 0: in their places
};

inline lightbin::View view_of(const FrameSettings& settings) {
    const double aspect = static_cast<double>(settings.width) / settings.height;
    return value_of(lightbin::View::from_projection(
        projection_of(settings.camera, aspect, settings.clip_depth), {settings.width, settings.height},
        {.tile_size = settings.tile_size, .clip_depth = settings.clip_depth, .origin = settings.origin}));
}

// The spans are valid until the next frame.
struct Frame {
    std::span<const GpuLight> lights;  // and then suns; with z-bins in the order of rank
    std::span<const lightbin::ListRange> ranges, glass_ranges;  // glass may have the same ones
    std::span<const std::uint32_t> ids, glass_ids;
    std::vector<std::uint32_t> slices;
    std::span<const lightbin::BinRange> bins;
};

class NativeLists {
public:
    explicit NativeLists(const Scene& scene) : scene_(scene), places_(scene.lights), binned_(scene_) {}
    NativeLists(const NativeLists&) = delete;

    const Scene& scene() const { return scene_; }

    Frame frame(const lightbin::View& view, const FrameSettings& settings,
                const lightbin::ZBounds& z_bounds, const lightbin::ZBounds& glass_z_bounds) {
        move_lights(places_, settings.seconds, scene_.lights);
        binned_.place(glm::inverse(settings.camera.to_world));
        BinSettings bin = settings.bin;
        bin.glass = !scene_.transparent.empty();
        const auto [opaque, glass] = binned_.bin(view, bin, z_bounds, glass_z_bounds);
        Frame frame = {binned_.in_order(), opaque.ranges(), glass.ranges(), opaque.ids(), glass.ids(), {},
                       opaque.ranks().bins};
        if (binned_.slices()) frame.slices = lightbin::shader_slices(*binned_.slices());
        return frame;
    }

private:
    Scene scene_;
    std::vector<Light> places_;
    BinnedLights binned_;
};
