// SPDX-License-Identifier: MIT
// The rectangles that the library finds on every instruction set, and the bounds before its margin, which it has no
// interface for.
#pragma once

#include "conditions.hpp"

#include <lightbin/detail/stages/footprints.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace stability {

/// Tiles of a light, ends included; none if first > last.
struct TileRect {
    int first[2] = {0, 0}, last[2] = {-1, -1};
    bool operator==(const TileRect&) const = default;
};

/// What the widest instruction set finds for a scene.
struct Projected {
    std::vector<TileRect> rects;            ///< one for each light
    std::vector<lightbin::Sphere> in_view;  ///< the lights in view space, one each
};

/// Calls use(Lights) with a scene's lights in the form that the library takes.
template <class Use> auto with_lights(const Scene& scene, Use use) {
    if (scene.world) return use(lightbin::world_space(scene.lights, scene.world->entry));
    return use(lightbin::view_space(scene.lights));
}

inline Projected project_with(lightbin::Isa isa, const lightbin::View& view, const Scene& scene) {
    return with_lights(scene, [&](const auto& lights) {
        lightbin::detail::Footprints footprints;
        footprints.project(isa, view, lights, {}, lightbin::detail::Kept::lights);
        const auto& arrays = footprints.arrays();
        Projected all;
        all.rects.resize(scene.lights.size());
        for (const auto& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i)
                all.rects[arrays.ids[i]] = {{arrays.x0[i], arrays.y0[i]}, {arrays.x1[i], arrays.y1[i]}};
        for (std::size_t i = 0; i < scene.lights.size(); ++i)
            all.in_view.push_back(lightbin::detail::load_sphere(arrays.view_lights.spheres + i));
        return all;
    });
}

/// Projects lights by the machine's widest instruction set; throws an exception if another one gives anything else.
inline Projected project(const lightbin::View& view, const Scene& scene) {
    const lightbin::Isa widest = lightbin::machine_isa();
    const Projected all = project_with(widest, view, scene);
    for (int i = static_cast<int>(lightbin::Isa::scalar); i < static_cast<int>(widest); ++i) {
        const auto isa = static_cast<lightbin::Isa>(i);
        if (lightbin::machine_isa(isa) == isa && project_with(isa, view, scene).rects != all.rects)
            throw std::logic_error(std::string(to_string(isa)) + " and " + to_string(widest) + " differ");
    }
    return all;
}

/// How the library finds a sphere's rectangle of tiles.
struct Behind {
    double low[2] = {0, 0},
           high[2] = {0, 0};  ///< bounds in tiles, without the margin, if the light is not culled
    TileRect rect;
};

/// Computes like project() in detail/project.inl, by the library's own functions. The caller checks that the rectangle
/// is the library's own.
inline Behind behind(const lightbin::detail::Camera& camera, const lightbin::Sphere& sphere) {
    namespace scalar = lightbin::detail::scalar;
    const float x = sphere.x * camera.x.sign, y = sphere.y * camera.y.sign, z = sphere.z * camera.z_sign,
                r = sphere.radius;
    const float nearest = z - r, farthest = z + r, size = std::abs(x) + std::abs(y) + std::abs(z) + r;
    const bool usable = size <= lightbin::detail::float_safe_max && lightbin::detail::float_safe_min <= r;
    Behind result;
    if (usable && scalar::out_of_view(scalar::ViewLanes(camera), x, y, z, r, nearest, farthest, size))
        return result;
    const lightbin::detail::ImageAxis* const axes[] = {&camera.x, &camera.y};
    bool seen = true;
    std::uint32_t first[2], last[2];
    if (usable && camera.min_float_depth < nearest) {
        const float e = nearest * farthest, per_e = 1 / e;
        for (const std::size_t i : {0u, 1u}) {
            float low, high;
            scalar::tangent_slopes(i == 0 ? x : y, z, r, e, per_e, low, high);
            const float scale = static_cast<float>(axes[i]->scale),
                        offset = static_cast<float>(axes[i]->offset);
            result.low[i] = static_cast<double>(low * scale + offset);
            result.high[i] = static_cast<double>(high * scale + offset);
            seen = scalar::tile_span<float>(*axes[i], low, high, seen, first + i, last + i);
        }
    } else {
        const double signed_sphere[] = {static_cast<double>(x), static_cast<double>(y),
                                        static_cast<double>(z), static_cast<double>(r)};
        seen = signed_sphere[2] + signed_sphere[3] >= static_cast<double>(camera.near_depth) &&
               signed_sphere[2] - signed_sphere[3] <= static_cast<double>(camera.far_depth);
        double lows[2], highs[2];
        bounds_in_double(camera, signed_sphere, lows, highs);
        for (const std::size_t i : {0u, 1u}) {
            const double low = lows[i], high = highs[i];
            result.low[i] = low * axes[i]->scale + axes[i]->offset;
            result.high[i] = high * axes[i]->scale + axes[i]->offset;
            seen = scalar::tile_span<double>(*axes[i], low, high, seen, first + i, last + i);
        }
    }
    const auto tile = [](std::uint32_t number) { return static_cast<int>(number); };
    if (seen) result.rect = {{tile(first[0]), tile(first[1])}, {tile(last[0]), tile(last[1])}};
    return result;
}

}  // namespace stability
