// SPDX-License-Identifier: MIT
// The other error of tiled shading: a light ends at its range, where inverse-square light never does. What a picture
// loses by the cutoff: the illuminance at which a light is ended, so range = sqrt(intensity / cutoff).
//
// White surfaces (Lambert) under the scene's lights, their intensity the square of the scene's range, without shadows. The
// reference sums every light everywhere, I cos / max(d^2, 0.01^2). Against it: the same times (1 - (d / range)^4)^2, which
// ends without an edge (Karis, "Real Shading in Unreal Engine 4", 2013; Lagarde and de Rousiers, "Moving Frostbite to
// PBR", 2014). Linear light; 1 is white, which 95 % of the drawn pixels of the reference do not exceed.
#pragma once

#include "needed.hpp"
#include "raster.hpp"
#include "scenes.hpp"
#include "tiled_view.hpp"

#include <lightbin/lightbin.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

/// How a picture differs from the reference, in parts of white.
struct Difference {
    double rmse = 0;
    double rmse_restored = 0;  ///< error once the mean of the lost light is added to every pixel, like an ambient term
};

class CutoffStudy {
public:
    explicit CutoffStudy(const BenchScene& scene)
        : picture_(rasterise(scene, {480, 270})), view_(scene, picture_, 4), surface_(scene, picture_),
          lights_(scene.light_set(0)), truth_(surface_.size()) {
        for (const lightbin::Spot& light : spots_of(lights_)) {
            intensity_.push_back(light.radius * light.radius);
            for (std::size_t i = 0; i < truth_.size(); ++i)
                truth_[i] += endless_light_at(i, light, intensity_.back());
        }
        std::vector<float> sorted = truth_;
        std::sort(sorted.begin(), sorted.end());
        white_ = sorted.empty() ? 0 : static_cast<double>(sorted[sorted.size() * 95 / 100]);
    }

    /// Returns the brightness that counts as white; 0 if no light reaches the picture.
    double white() const { return white_; }

    /// Returns the lights with ranges that end where they give this part of white.
    LightSet ended(LightSet lights, double part) const {
        const auto range = [&](float own) {
            return lightbin::light_range(own * own, static_cast<float>(part * white_));
        };
        if (auto* const spots = std::get_if<Spots>(&lights))
            for (lightbin::Spot& spot : *spots)
                spot.radius = range(spot.radius);
        else
            for (glm::vec4& light : std::get<Lights>(lights))
                light.w = range(light.w);
        return lights;
    }

    /// Compares the picture of lights that end where they give this part of white with the reference.
    Difference difference(double part) {
        const LightSet lights = ended(lights_, part);
        const Spots spots = spots_of(lights);
        const Built built = build(binner_, view_, lights, view_.bounds());
        const int t = view_.view.tile_size(), width = picture_.size.width;
        double lost = 0, squares = 0;
        for (std::size_t i = 0; i < truth_.size(); ++i) {
            const int tile =
                surface_.pixel[i] / width / t * view_.view.tiles_x() + surface_.pixel[i] % width / t;
            const lightbin::ListRange list = built.ranges[static_cast<std::size_t>(tile)];
            float light = 0;
            for (const std::uint32_t id : built.ids.subspan(list.offset, list.count))
                light += light_at(i, spots[id], intensity_[id]);
            const double less = static_cast<double>(truth_[i] - light) / white_;
            lost += less, squares += less * less;
        }
        lost /= static_cast<double>(truth_.size()), squares /= static_cast<double>(truth_.size());
        return {std::sqrt(squares), std::sqrt(std::max(squares - lost * lost, 0.0))};
    }

private:
    /// Positions and normals of the drawn pixels.
    struct Surface {
        std::vector<int> pixel;
        std::vector<glm::vec3> point, normal;

        Surface(const BenchScene& scene, const Picture& picture) {
            const Frustum frustum(scene.projection);
            for (int py = 0, i = 0; py < picture.size.height; ++py)
                for (int px = 0; px < picture.size.width; ++px, ++i) {
                    const std::size_t at = static_cast<std::size_t>(i);
                    if (picture.triangle[at] == Picture::nothing) continue;
                    const glm::vec3* const corner = &scene.triangles[3 * std::size_t{picture.triangle[at]}];
                    const glm::vec3 seen = point_at(frustum, picture.size, px, py, picture.view_depth[at]),
                                    up = glm::normalize(
                                        glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
                    pixel.push_back(i);
                    point.push_back(seen);
                    normal.push_back(glm::dot(up, seen) > 0 ? -up : up);  // both sides are drawn
                }
        }
        std::size_t size() const { return pixel.size(); }
    };

    /// Returns the light that pixel i gets from one light without a range.
    float endless_light_at(std::size_t i, const lightbin::Spot& light, float intensity) const {
        const glm::vec3 d = glm::vec3(light.x, light.y, light.z) - surface_.point[i];
        const float squared = std::max(glm::dot(d, d), 1e-4f), distance = std::sqrt(squared);
        if (light.cos_half_angle > -1) {
            const glm::vec3 axis(light.axis_x, light.axis_y, light.axis_z);
            if (-glm::dot(d, axis) < light.cos_half_angle * distance * glm::length(axis)) return 0;
        }
        return intensity * std::max(glm::dot(d, surface_.normal[i]), 0.0f) / (squared * distance);
    }
    float light_at(std::size_t i, const lightbin::Spot& light, float intensity) const {
        const glm::vec3 d = glm::vec3(light.x, light.y, light.z) - surface_.point[i];
        const float part = glm::dot(d, d) / (light.radius * light.radius),
                    rest = std::max(1 - part * part, 0.0f);
        return endless_light_at(i, light, intensity) * rest * rest;
    }

    Picture picture_;
    TiledView view_;
    Surface surface_;
    LightSet lights_;
    std::vector<float> intensity_, truth_;
    double white_ = 0;
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner_;
};
