// SPDX-License-Identifier: MIT
// Finds the LightCoverage of each light in view, its tiles, depths and size in pixels, from its footprint.
#pragma once

#include <lightbin/coverage.hpp>
#include <lightbin/detail/project/spheres_around_shapes.hpp>
#include <lightbin/detail/project/spheres_in_double.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/view.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// A sphere around a light, and the view depths between which the light lies. The sphere's coordinates are negated
/// where needed: tile indices grow with x and y, and z is the view depth.
struct LightExtent {
    Sphere sphere;
    float nearest, farthest;
};

inline float enlarged(float radius, float by) {
    return float_above(static_cast<double>(radius) + static_cast<double>(by));
}

/// Returns the extent of the light with an id. Around a spot or a Box the sphere is that of least_sphere() or
/// bounding_sphere(), enlarged by how far the light can reach outside of the spot or box that was rounded to float.
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
        Sphere sphere = light.ball;
        if constexpr (kind == LightKind::box) {
            Box whole = {0, 0, 0, infinity, light.centre[0], light.centre[1], light.centre[2], {}, light.taper};
            copy_items(&light.half_axes[0][0], 9, &whole.half_axes[0][0]);
            Sphere corners = bounding_sphere(whole);
            if (!(corners.radius > 0))  // in float, all half axes are 0
                corners = {light.centre[0], light.centre[1], light.centre[2], 0};
            corners.radius = enlarged(corners.radius, light.tolerance);
            if (corners.radius < sphere.radius) sphere = corners;
        } else if (light.tolerance > 0) {
            sphere = least_sphere({sphere.x, sphere.y, sphere.z, sphere.radius, light.axis_x, light.axis_y, light.axis_z,
                                   light.cosine});
            sphere.radius = enlarged(sphere.radius, light.tolerance);
        }
        return {sphere, light.nearest, light.farthest};
    }
}

/// Returns how many tiles the projection of a sphere is wide or high, whichever is more; +inf where it has no bound.
///
/// Rounding, with u = 2^-53: a slope of tangent_slopes() has a relative error of at most 10u, and an orthographic
/// bound, centre -+ r, of at most u. So high - low has an error of at most 12u (|low| + |high|), and 16u times this sum
/// are added. The camera's scale, the product with it and the product with 1 + 8u have a relative error of u each,
/// which the factor 1 + 8u covers. What clipped_slopes() finds is rounded outward.
inline double tiles_across(const Camera& camera, const Sphere& sphere) {
    const double of_sphere[] = {static_cast<double>(sphere.x), static_cast<double>(sphere.y),
                                static_cast<double>(sphere.z), static_cast<double>(sphere.radius)};
    double low[2], high[2], tiles = 0;
    bounds_in_double(camera, of_sphere, low, high);
    for (unsigned axis = 0; axis < 2; ++axis) {
        const double width =
            high[axis] - low[axis] + rounded((abs_of(low[axis]) + abs_of(high[axis])) * 0x1p-49);
        tiles = max_of(tiles, width * (axis == 0 ? camera.x : camera.y).scale);
    }
    return tiles * (1 + 0x1p-50);
}

/// The LightCoverage of all lights in view, and its memory, which is kept from call to call.
class CoverageList {
public:
    void clear() { count_ = 0; }
    std::span<const LightCoverage> all() const { return {lights_.data(), count_}; }

    /// Stores the LightCoverage of each light in view: its tiles, its depths and its size in pixels.
    ///
    /// footprints  the footprints of the lights, which are of the LightKind `kind`, with the lights in view space
    template <LightKind kind, class AnyFootprints>
    void find(const View& view, const AnyFootprints& footprints, const Parallel& parallel) {
        const std::span<const FootprintRun> runs = footprints.runs();
        LightCoverage* const lights = lights_.reserve(footprints.visible());
        parallel.run(runs.size(), [&](std::size_t i) {
            LightCoverage* to = lights;
            for (const FootprintRun& run : runs.first(i))
                to += run.end - run.begin;
            for (std::uint32_t light = runs[i].begin; light < runs[i].end; ++light)
                *to++ = coverage_of<kind>(view, footprints.arrays(), light);
        });
        count_ = footprints.visible();
    }

private:
    template <LightKind kind>
    static LightCoverage coverage_of(const View& view, const FootprintArrays& from, std::uint32_t i) {
        const LightExtent extent = extent_of<kind>(camera_of(view), from.view_lights, from.ids[i]);
        return {from.ids[i],
                from.x0[i],
                from.y0[i],
                from.x1[i],
                from.y1[i],
                -next_above(-extent.nearest),
                next_above(extent.farthest),
                float_above(tiles_across(camera_of(view), extent.sphere) * view.tile_size() * (1 + 0x1p-50))};
    }

    /// Returns the next float above a depth that was rounded to nearest, so that the exact depth is less. Returns an
    /// infinite depth as it is.
    static float next_above(float depth) { return is_finite(depth) ? -next_below(-depth) : depth; }

    Buffer<LightCoverage> lights_;
    std::size_t count_ = 0;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
