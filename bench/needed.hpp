// SPDX-License-Identifier: MIT
// Which lights reach the point that a pixel shows: the least number of light evaluations, and the lights that no list
// may lack.
#pragma once

#include "built.hpp"
#include "tiled_view.hpp"

#include <lightbin/spot.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

/// Returns all lights as spots, so that one test does for both kinds.
inline Spots spots_of(const LightSet& lights) {
    if (const Spots* const spots = std::get_if<Spots>(&lights)) return *spots;
    Spots spots;
    for (const glm::vec4& s : std::get<Lights>(lights))
        spots.push_back(lightbin::Spot::whole({s.x, s.y, s.z, s.w}));
    return spots;
}

/// Returns how deep a point lies within a light, in view-space units; negative if outside. For the cone only the sign
/// of the result is right.
inline double depth_within(const lightbin::Spot& spot, const glm::dvec3& point) {
    const glm::dvec3 axis(spot.axis_x, spot.axis_y, spot.axis_z),
        d = point - glm::dvec3(spot.x, spot.y, spot.z);
    const double distance = glm::length(d), in_sphere = static_cast<double>(spot.radius) - distance;
    if (!(spot.cos_half_angle > 0)) return in_sphere;
    const double along = glm::dot(d, axis) / glm::length(axis);
    return std::min(in_sphere, along - static_cast<double>(spot.cos_half_angle) * distance);
}

/// The lights that reach every n-th drawn pixel in x and y; pixels are sorted by blocks of 8x8.
class Needed {
public:
    struct Pixel {
        std::uint32_t index;    ///< of the pixel in the picture
        std::uint32_t ids_end;  ///< end of its lights in ids(); they begin where the last pixel's end
        float view_depth;       ///< computed from the depth buffer's value
    };

    Needed(const SeenScene& seen, const Spots& lights, int every) : lights_(lights.size()) {
        const lightbin::ImageSize size = seen.picture.size;
        for (int y = 0; y < size.height; y += block)
            for (int x = 0; x < size.width; x += block)
                add_block(seen, lights, every, x, y);
    }

    const std::vector<Pixel>& pixels() const { return pixels_; }
    const std::vector<std::uint32_t>& ids() const { return ids_; }
    std::size_t lights() const { return lights_; }
    std::uint64_t evaluations() const { return evaluations_; }

private:
    static constexpr int block = 8;

    void add_block(const SeenScene& seen, const Spots& lights, int every, int x0, int y0) {
        const Frustum frustum(seen.scene.projection);
        const lightbin::ImageSize size = seen.picture.size;
        const double scale = static_cast<double>(seen.scene.projection[2][2]),
                     offset = static_cast<double>(seen.scene.projection[3][2]);
        const auto next = [&](int from) { return (from + every - 1) / every * every; };
        points_.clear();
        const std::size_t first = pixels_.size();
        glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
        for (int y = next(y0); y < std::min(y0 + block, size.height); y += every)
            for (int x = next(x0); x < std::min(x0 + block, size.width); x += every) {
                const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                      static_cast<std::size_t>(x);
                if (seen.picture.triangle[i] == Picture::nothing) continue;
                const double depth = offset / (2 * static_cast<double>(seen.picture.depth[i]) - 1 + scale);
                points_.push_back({((x + 0.5) / size.width * 2 - 1) * frustum.x * depth,
                                   ((y + 0.5) / size.height * 2 - 1) * frustum.y * depth, -depth});
                low = glm::min(low, points_.back()), high = glm::max(high, points_.back());
                pixels_.push_back({static_cast<std::uint32_t>(i), 0, static_cast<float>(depth)});
            }
        candidates_.clear();
        for (std::size_t id = 0; id < lights.size() && !points_.empty(); ++id) {
            const lightbin::Spot& light = lights[id];
            const glm::dvec3 centre(light.x, light.y, light.z),
                beside = glm::clamp(centre, low, high) - centre;
            const double reach = static_cast<double>(light.radius);
            if (glm::dot(beside, beside) <= reach * reach)
                candidates_.push_back(static_cast<std::uint32_t>(id));
        }
        for (std::size_t i = 0; i < points_.size(); ++i) {
            for (const std::uint32_t id : candidates_) {
                const double within = depth_within(lights[id], points_[i]);
                evaluations_ += within >= 0;
                // A shader rounds the point, so that a point on the light's surface may count as inside or outside.
                if (within > -1e-6 * points_[i].z) ids_.push_back(id);
            }
            pixels_[first + i].ids_end = static_cast<std::uint32_t>(ids_.size());
        }
    }

    std::size_t lights_;
    std::vector<Pixel> pixels_;
    std::vector<std::uint32_t> ids_;
    std::uint64_t evaluations_ = 0;
    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> candidates_;
};

/// Light evaluations and words of masks that a picture's pixels read, and the lights that these lack.
struct Reading {
    std::uint64_t evaluations = 0, words = 0;  ///< words are those of masks
    std::uint64_t misses = 0;            ///< lights that reach a pixel but are not in its list
    std::uint32_t pixel = 0, light = 0;  ///< an example: the last miss
};

inline Reading read_lists(const TiledView& view, const Picture& picture, const Built& built,
                          const Needed& needed) {
    const std::uint32_t width = static_cast<std::uint32_t>(picture.size.width),
                        t = static_cast<std::uint32_t>(view.view.tile_size()),
                        tiles_x = static_cast<std::uint32_t>(view.view.tiles_x());
    Reading reading;
    std::vector<std::uint32_t> listed(needed.lights(), 0);  // the number of the last list that has a light
    std::uint32_t list_number = 0, begin = 0;
    std::span<const std::uint32_t> before;
    for (const Needed::Pixel& pixel : needed.pixels()) {
        std::size_t cell = pixel.index / width / t * tiles_x + pixel.index % width / t;
        const std::size_t slice =
            built.slices == nullptr ? 0 : static_cast<std::size_t>(built.slices->slice_at(pixel.view_depth));
        if (built.bins.empty()) cell += slice * view.view.tile_count();
        std::span<const std::uint32_t> list =
            built.ids.subspan(built.ranges[cell].offset, built.ranges[cell].count);
        if (!built.bins.empty()) list = lightbin::lights_of_bin(list, built.bins[slice]);
        reading.evaluations += list.size();
        if (built.masks)
            reading.words += built.bins.empty()
                                 ? built.masks->mask_words()
                                 : built.bins[slice].greatest / 32 - built.bins[slice].least / 32 + 1;
        if (list.data() != before.data() || list.size() != before.size() || list_number == 0) {
            ++list_number;
            for (const std::uint32_t id : list)
                listed[built.order.empty() ? id : built.order[id]] = list_number;
            before = list;
        }
        for (; begin != pixel.ids_end; ++begin) {
            if (listed[needed.ids()[begin]] == list_number) continue;
            ++reading.misses;
            reading.pixel = pixel.index, reading.light = needed.ids()[begin];
        }
    }
    return reading;
}
