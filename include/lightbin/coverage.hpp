// SPDX-License-Identifier: MIT
// Stability: may change.
// What each light covers: its tiles, its depths and its size in pixels; and in how many cells it is listed.
#pragma once

#include <lightbin/detail/project/spheres_around_shapes.hpp>
#include <lightbin/detail/stages/footprints.hpp>
#include <lightbin/light_grid.hpp>

#include <vector>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What a light in view covers.
struct LightCoverage {
    std::uint32_t id;  ///< the light's index in the caller's array
    /// The rectangle of the light's footprint: tile columns x0 to x1 and tile rows y0 to y1, ends included.
    std::uint16_t x0, y0, x1, y1;
    /// The light's least and greatest view depth, rounded outward. The light may reach in front of the view's near
    /// plane and beyond its far plane.
    float nearest, farthest;
    /// The light's size in the image, in pixels: the larger side of the rectangle around the projection of its sphere,
    /// or of a spot's bounding_sphere(). It is rounded up, so it exceeds 0, and not cut off at the viewport's edges. In
    /// a perspective view it is the size of the part beyond the near plane. It is +inf where no finite bound is known,
    /// as with an infinite radius.
    float pixels;
};

namespace detail {

/// A sphere around a light, and the view depths between which the light lies. The sphere's coordinates are negated
/// where needed: tile indices grow with x and y, and z is the view depth.
struct LightExtent {
    Sphere sphere;
    float nearest, farthest;
};

inline float enlarged(float radius, float by) {
    return float_above(static_cast<double>(radius) + static_cast<double>(by));
}

/// Returns the extent of the light with an id. Around a spot or a Box the sphere is that of bounding_sphere(),
/// enlarged by how far the light can reach outside of the spot or box that was rounded to float.
template <LightKind kind> LightExtent extent_of(const Camera& camera, const ViewLights& lights, std::uint32_t id) {
    if constexpr (kind == LightKind::mixed) {
        const LightKind own_kind = lights.kind_of(id);
        return own_kind == LightKind::sphere ? extent_of<LightKind::sphere>(camera, lights, id)
               : own_kind == LightKind::spot ? extent_of<LightKind::spot>(camera, lights, id)
                                             : extent_of<LightKind::box>(camera, lights, id);
    } else if constexpr (kind == LightKind::sphere) {
        const TestedLight light(camera, load_sphere(lights.spheres + id));
        return {{light.x, light.y, light.z, lights.spheres[id].radius}, light.nearest, light.farthest};
    } else {
        const auto& light = lights.template shape<kind>(id);
        Sphere sphere = {light.x, light.y, light.z, light.radius};
        if constexpr (kind == LightKind::box) {
            Box whole = light;
            whole.radius = infinity;
            Sphere corners = bounding_sphere(whole);
            if (!(corners.radius > 0))  // in float, all half axes are 0
                corners = {light.box_x, light.box_y, light.box_z, 0};
            corners.radius = enlarged(corners.radius, light.tolerance);
            if (corners.radius < sphere.radius) sphere = corners;
        } else if (light.tolerance > 0) {
            sphere = bounding_sphere(light);
            sphere.radius = enlarged(sphere.radius, light.tolerance);
        }
        return {sphere, light.nearest, light.farthest};
    }
}

/// Returns how many pixels the projection of a sphere is wide or high, whichever is more; +inf where it has no bound.
///
/// Rounding, with u = 2^-53: a slope of tangent_slopes() has a relative error of at most 10u, and an orthographic
/// bound, centre -+ r, of at most u. So high - low has an error of at most 12u (|low| + |high|), and 16u times this sum
/// are added. The camera's scale, the product with it, those with pixels a tile, and the product with 1 + 8u have a
/// relative error of u each, together 5u, which the factor 1 + 8u covers. What clipped_slopes() finds is rounded
/// outward.
inline double pixels_across(const Camera& camera, const Sphere& sphere) {
    const double of_sphere[] = {static_cast<double>(sphere.x), static_cast<double>(sphere.y),
                                static_cast<double>(sphere.z), static_cast<double>(sphere.radius)};
    double low[2], high[2], pixels = 0;
    bounds_in_double(camera, of_sphere, low, high);
    for (unsigned axis = 0; axis < 2; ++axis) {
        const double width =
            high[axis] - low[axis] + rounded((abs_of(low[axis]) + abs_of(high[axis])) * 0x1p-49);
        const ImageAxis& of = axis == 0 ? camera.x : camera.y;
        pixels = max_of(pixels, of.split.pixels_of(width * of.scale));
    }
    return pixels * (1 + 0x1p-50);
}

}  // namespace detail

/// Returns what each light in view covers, in ascending order of id: for shadow atlases and levels of detail. The
/// lights are projected for it, as Binner::bin() projects them for the lists.
///
/// lights, threads  as for Binner::bin()
/// isa              use no wider instructions than these. The result does not depend on it.
///
/// Errors: more than 2^30 lights; a world_space() matrix that is not affine.
template <class LightRange, std::convertible_to<Parallel> Threads = detail::Serial>
Result<std::vector<LightCoverage>> coverage(const View& view, const LightRange& lights, const Threads& threads = {},
                                            Isa isa = compiled_isa) {
    const auto& source = detail::as_lights(lights);
    if (const auto error = detail::refuse(source)) return *error;
    const detail::DefaultFloatEnvironment environment;
    detail::Footprints footprints;
    footprints.project(machine_isa(isa), view, source, threads, detail::Kept::lights);
    std::vector<LightCoverage> found(footprints.visible());
    const std::span<const detail::FootprintRun> runs = footprints.runs();
    const detail::FootprintArrays& from = footprints.arrays();
    const detail::Camera& camera = detail::camera_of(view);
    // The next float above a depth that was rounded to nearest, so that the exact depth is less; infinity as it is.
    const auto next_above = [](float depth) {
        return detail::is_finite(depth) ? -detail::next_below(-depth) : depth;
    };
    Parallel(threads).run(runs.size(), [&](std::size_t run) {
        LightCoverage* light = found.data();
        for (const detail::FootprintRun& before : runs.first(run))
            light += before.end - before.begin;
        for (std::uint32_t i = runs[run].begin; i < runs[run].end; ++i) {
            constexpr detail::LightKind kind = std::remove_cvref_t<decltype(source)>::kind;
            const detail::LightExtent extent = detail::extent_of<kind>(camera, from.view_lights, from.ids[i]);
            *light++ = {from.ids[i],
                        from.x0[i],
                        from.y0[i],
                        from.x1[i],
                        from.y1[i],
                        -next_above(-extent.nearest),
                        next_above(extent.farthest),
                        detail::float_above(detail::pixels_across(camera, extent.sphere))};
        }
    });
    return found;
}

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

#include <lightbin/detail/base/warnings_on.inl>
