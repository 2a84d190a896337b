// SPDX-License-Identifier: MIT
// The sphere around a light in view, its depths, and how many tiles it is wide or high.
#pragma once

#include <lightbin/detail/project/spheres_around_shapes.hpp>
#include <lightbin/detail/project/spheres_in_double.hpp>
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

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
