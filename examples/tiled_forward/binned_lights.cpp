// SPDX-License-Identifier: MIT
#include "binned_lights.hpp"

#include <algorithm>
#include <cstddef>

lightbin::Slices slices_for(DepthMethod method, bool orthographic, std::span<const GpuLight> lights) {
    float last = 0;  // as deep as any light reaches
    for (const GpuLight& light : lights)
        last = std::max(last, light.sphere.w - light.sphere.z);
    if (!(last < 1e30f)) last = 1e30f;  // a light without an end
    if (last == 0) last = 1;            // all lights are behind the eye
    if (method == DepthMethod::z_bins) return value_of(lightbin::Slices::linear(1024, 0, last));
    return value_of(orthographic ? lightbin::Slices::linear(24, 0, last)
                                 : lightbin::Slices::exponential(24, last / 40, last));
}

BinnedLights::BinnedLights(const Scene& scene)
    : scene_(scene), has_spots_(std::any_of(scene.lights.begin(), scene.lights.end(),
                                            [](const Light& light) { return light.spot; })) {}

void BinnedLights::place(const glm::dmat4& world_to_view) {
    placed_.clear();
    for (const Light& light : scene_.lights)
        placed_.push_back(gpu_light(light, world_to_view));
    boxes_.clear();
    for (const SceneBox& box : scene_.boxes) {
        boxes_.push_back(gpu_box(box, world_to_view));
        placed_.push_back(entry_of(boxes_.back(), boxes_.size() - 1));
    }
    const glm::dmat3 turn(world_to_view);
    for (const Sun& sun : scene_.suns)
        placed_.push_back({glm::vec4(-glm::vec3(turn * glm::dvec3(sun.direction)), 0),
                           glm::vec4(sun.illuminance, 0), glm::vec4(0)});
}

std::vector<lightbin::Spot> BinnedLights::as_spots(int dropped_light) const {
    std::vector<lightbin::Spot> spots;
    for (const GpuLight& light : lights())
        spots.push_back(spot_of(light));
    for (const GpuBox& box : boxes_)
        spots.push_back(lightbin::Spot::whole(bounding_sphere(box_of(box))));
    if (dropped_light >= 0 && static_cast<std::size_t>(dropped_light) < spots.size())
        spots[static_cast<std::size_t>(dropped_light)].radius = -1;
    return spots;
}

BinnedLights::Grids BinnedLights::bin(const lightbin::View& view, const BinSettings& settings,
                                      const lightbin::ZBounds& z_bounds,
                                      const lightbin::ZBounds& glass_z_bounds) {
    const auto bin_all = [&](const auto& lights) {
        return bin(view, lights, settings, z_bounds, glass_z_bounds);
    };
    if (!has_boxes()) return visit_lights(settings.dropped_light, bin_all);

    // In every list ids ascend, so the shader finds all lights before the first box. A Spot that is a whole sphere takes
    // no longer than a Sphere.
    const std::span<const GpuLight> lights = this->lights();
    const auto to_box = [&](const GpuBox& box) {
        lightbin::Box listed = box_of(box);
        if (static_cast<std::ptrdiff_t>(lights.size()) + (&box - boxes_.data()) == settings.dropped_light)
            listed.radius = -1;
        return listed;
    };
    return bin_all(lightbin::lights(lightbin::view_space(lights, to_spot(settings.dropped_light)),
                                    lightbin::view_space(boxes_, to_box)));
}

template <class Lights>
BinnedLights::Grids BinnedLights::bin(const lightbin::View& view, const Lights& lights,
                                      const BinSettings& settings, const lightbin::ZBounds& z_bounds,
                                      const lightbin::ZBounds& glass_z_bounds) {
    order_.clear();
    slices_.reset();
    const auto same = [](const lightbin::LightGrid<std::uint32_t>& grid) { return Grids{grid, grid}; };
    switch (settings.method) {
    case DepthMethod::none:
        return same(value_of(binner_.bin(view, lights)));
    case DepthMethod::z_bounds: {
        const auto opaque = value_of(bounded_binner_.bin(view, lights, {.bounds = z_bounds}));
        if (!settings.glass) return same(opaque);
        // Glass may stand anywhere before the opaque surfaces, so it has lists of its own.
        return {opaque, value_of(glass_binner_.bin(view, lights, {.bounds = glass_z_bounds}))};
    }
    case DepthMethod::z_bins:
    case DepthMethod::clusters:
        break;
    }

    // What is at any depth has its lights, glass too.
    slices_ = slices_for(settings.method, view.orthographic(), listed());
    if (settings.method == DepthMethod::clusters)
        return same(value_of(cluster_binner_.bin(view, lights, {.slices = *slices_})));
    const auto grid = value_of(bin_binner_.bin(view, lights, {.slices = *slices_}));
    order_.assign(grid.ranks().order.begin(), grid.ranks().order.end());
    std::vector<bool> ranked(listed_count());
    for (const std::uint32_t light : order_)
        ranked[light] = true;
    for (std::uint32_t light = 0; light < ranked.size(); ++light)
        if (!ranked[light]) order_.push_back(light);
    return same(grid);
}

std::span<const GpuLight> BinnedLights::in_order() {
    if (order_.empty()) return placed_;
    ordered_ = placed_;
    for (std::size_t rank = 0; rank < order_.size(); ++rank)
        ordered_[rank] = placed_[order_[rank]];
    return ordered_;
}
