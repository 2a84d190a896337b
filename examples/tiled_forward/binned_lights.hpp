// SPDX-License-Identifier: MIT
// The lights of a frame and the lists of them: all that the pictures ask of lightbin, for any graphics API.
#pragma once

#include "gpu_light.hpp"
#include "scene.hpp"
#include "value_of.hpp"

#include <lightbin/lightbin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// What keeps a light out of the lists of tiles that it covers.
enum class DepthMethod {
    none,      // nothing
    z_bounds,  // it must meet the box around what the tile has between its Z bounds
    z_bins,    // lists are entered and left by the bin of the fragment's depth
    clusters   // each tile has a list for each slice of depth
};

struct BinSettings {
    DepthMethod method = DepthMethod::none;
    bool glass = false;      // Z bounds: lists for it, too
    int dropped_light = -1;  // id of what the lists leave out, so that a check can be seen to fail
};

// The slices of the depths that lights in view space reach: a thousand z-bins, or 24 for clusters.
lightbin::Slices slices_for(DepthMethod method, bool orthographic, std::span<const GpuLight> lights);

class BinnedLights {
public:
    struct Grids {
        lightbin::LightGrid<std::uint32_t> opaque, glass;
    };

    // Keeps the scene, whose lights may move from frame to frame.
    explicit BinnedLights(const Scene& scene);

    bool has_spots() const { return has_spots_; }
    bool has_boxes() const { return !scene_.boxes.empty(); }

    // Has lights, boxes and suns where the camera has them. In double, as a scene can be far from the origin.
    void place(const glm::dmat4& world_to_view);

    // In view space, without boxes and suns.
    std::span<const GpuLight> lights() const { return {placed_.data(), scene_.lights.size()}; }

    // The lights, then entries for the boxes, then the suns.
    std::span<const GpuLight> lights_and_suns() const { return placed_; }

    std::span<const GpuBox> boxes() const { return boxes_; }

    // Of lights and boxes, which have the ids below this number: first all lights, then all boxes.
    std::size_t listed_count() const { return scene_.lights.size() + scene_.boxes.size(); }
    std::span<const GpuLight> listed() const { return {placed_.data(), listed_count()}; }

    // Lights, then the balls around boxes: for compute shaders, which list no boxes.
    std::vector<lightbin::Spot> as_spots(int dropped_light) const;

    // Which lights and boxes can reach which tile, and at what depths. Both grids are the same one where glass needs no
    // lists of its own. Valid until the next call.
    //
    // z_bounds        of what is opaque
    // glass_z_bounds  of what stands before that: maxima in which the background counts
    Grids bin(const lightbin::View& view, const BinSettings& settings, const lightbin::ZBounds& z_bounds,
              const lightbin::ZBounds& glass_z_bounds);

    // Of the last bin(), with z-bins or clusters.
    const std::optional<lightbin::Slices>& slices() const { return slices_; }

    // Lights and entries for boxes in the order of the ids of the last bin(), which are ranks with z-bins, and then the
    // suns.
    std::span<const GpuLight> in_order();

    // Returns the callable that makes a Spot of a light, and of the one to be dropped a Spot that is skipped.
    auto to_spot(int dropped_light) const {
        return [=, first = placed_.data()](const GpuLight& light) {
            lightbin::Spot spot = spot_of(light);
            if (&light - first == dropped_light) spot.radius = -1;
            return spot;
        };
    }

    // Calls visit with the lights, without boxes, as a Binner takes them: as spots where any is one, and by their spheres
    // alone where none is, which takes less time.
    template <class Visit> auto visit_lights(int dropped_light, Visit visit) const {
        const auto as_spot = to_spot(dropped_light);
        const auto as_sphere = [=](const GpuLight& light) {
            const lightbin::Spot spot = as_spot(light);
            return lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius};
        };
        return has_spots_ ? visit(lightbin::view_space(lights(), as_spot))
                          : visit(lightbin::view_space(lights(), as_sphere));
    }

private:
    template <class Lights>
    Grids bin(const lightbin::View& view, const Lights& lights, const BinSettings& settings,
              const lightbin::ZBounds& z_bounds, const lightbin::ZBounds& glass_z_bounds);

    const Scene& scene_;
    bool has_spots_;
    std::vector<GpuLight> placed_, ordered_;
    std::vector<GpuBox> boxes_;
    std::vector<std::uint32_t> order_;  // z-bins: of the ids, those out of view last
    std::optional<lightbin::Slices> slices_;
    lightbin::Binner<> binner_;
    lightbin::Binner<lightbin::Options{.depth_test = true}> bounded_binner_, glass_binner_;
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::z_bins}> bin_binner_;
    lightbin::Binner<lightbin::Options{.depth_test = true, .slicing = lightbin::Slicing::clusters}> cluster_binner_;
};
