// SPDX-License-Identifier: MIT
// What each light covers: its tiles, its depths and its size in pixels; and in how many cells it is listed.
#pragma once

#include <lightbin/light_grid.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What a light in view covers. Binner::coverage() returns one for each light in view, with Options{.coverage = true}.
struct LightCoverage {
    std::uint32_t id;  ///< the light's index in the array that was binned, with Slicing::z_bins too
    /// The rectangle of the light's footprint: tile columns x0 to x1 and tile rows y0 to y1, ends included.
    std::uint16_t x0, y0, x1, y1;
    /// The light's least and greatest view depth, rounded outward. The light may reach in front of the view's near
    /// plane and beyond its far plane.
    float nearest, farthest;
    /// The light's size in the image, in pixels: the larger side of the rectangle around the projection of its sphere,
    /// or of a spot's least_sphere(). It is rounded up, so it exceeds 0, and not cut off at the viewport's edges. In a
    /// perspective view it is the size of the part beyond the near plane. It is +inf where no finite bound is known, as
    /// with an infinite radius.
    float pixels;
};

/// Writes to `entries` the number of cells that list each light, in the order of the array that was binned. Returns how
/// many lights are listed in at least one cell. A light in view that no cell lists reaches nothing that is drawn: the
/// Binner's depth test kept it out of all tiles of its footprint.
///
/// grid     a grid of a Binner, also with clusters or z-bins, or a copy that copy_to() made of one
/// entries  one element per light; elements beyond these keep their values
///
/// Errors, after which nothing was written: `entries` has fewer elements than grid.light_counts().lights.
template <class Id>
Result<std::uint32_t> count_entries(const LightGrid<Id>& grid, std::span<std::uint32_t> entries) {
    const std::uint32_t lights = grid.light_counts().lights;
    if (entries.size() < lights) return Error{ErrorCode::light_buffer_too_small, lights, entries.size()};
    detail::fill_items(entries.data(), lights, 0);
    const std::span<const std::uint32_t> by_rank = grid.ranks().order;
    for (const Id id : grid.ids()) {
        const std::uint32_t light = by_rank.empty() ? id : by_rank[id];
        LIGHTBIN_ASSERT(light < lights);
        ++entries[light];
    }
    std::uint32_t listed = 0;
    for (const std::uint32_t count : entries.first(lights))
        listed += count > 0;
    return listed;
}

}}  // namespace lightbin
