// SPDX-License-Identifier: MIT
// The scalar tier: what every other tier must equal, byte for byte.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/sphere_bounds.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin::detail {

/// Writes the footprints of those of the `count` spheres that are in view to `out`. The first sphere has id
/// `first_id`.
template <bool with_depth>
ProjectCounts project_scalar(const Camera& camera, const Sphere* spheres, std::uint32_t count,
                             std::uint32_t first_id, FootprintArrays out) {
    ProjectCounts counts;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Sphere& light = spheres[i];
        const Visibility visibility = project_sphere(camera, light, out.rects[counts.visible]);
        out.ids[counts.visible] = first_id + i;
        if constexpr (with_depth) {
            const float z = camera.z_sign * light.z;
            out.depths[counts.visible] = {z - light.radius, z + light.radius};
        }
        counts.visible += visibility == Visibility::visible;
        counts.rejected += visibility == Visibility::rejected;
    }
    return counts;
}

/// Calls visit(tile, light) for each tile that footprint `light` reaches, lights in ascending order.
template <bool with_depth, class Visit>
void for_each_pair(const FootprintArrays& footprints, std::size_t count, std::size_t tiles_x,
                   const TileDepths& bounds, Visit visit) {
    for (std::size_t light = 0; light < count; ++light) {
        const TileRect rect = footprints.rects[light];
        for (std::size_t y = rect.y0; y <= rect.y1; ++y)
            for (std::size_t tile = y * tiles_x + rect.x0, last = y * tiles_x + rect.x1; tile <= last;
                 ++tile) {
                if constexpr (with_depth)
                    if (!bounds.meets(tile, footprints.depths[light])) continue;
                visit(tile, light);
            }
    }
}

/// Adds to counts[tile] the number of lights that reach it.
template <bool with_depth>
void count_scalar(const FootprintArrays& footprints, std::size_t count, std::size_t tiles_x,
                  const TileDepths& bounds, std::uint32_t* counts) {
    for_each_pair<with_depth>(footprints, count, tiles_x, bounds,
                              [counts](std::size_t tile, std::size_t) { ++counts[tile]; });
}

/// Writes each light's id at its tiles' cursors, and advances them. Reads nothing of `indices`: it may be
/// write-combined.
template <class Id, bool with_depth>
void emit_scalar(const FootprintArrays& footprints, std::size_t count, std::size_t tiles_x,
                 const TileDepths& bounds, std::uint32_t* cursors, Id* indices) {
    for_each_pair<with_depth>(footprints, count, tiles_x, bounds, [=](std::size_t tile, std::size_t light) {
        indices[cursors[tile]++] = static_cast<Id>(footprints.ids[light]);
    });
}

}  // namespace lightbin::detail
