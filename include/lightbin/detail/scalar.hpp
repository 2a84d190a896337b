// SPDX-License-Identifier: MIT
// The scalar tier: what every other tier must equal, byte for byte.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lightbin::detail {
inline namespace LIGHTBIN_FLAVOUR {

namespace scalar {

#define LIGHTBIN_TARGET

using Floats = float;
using Doubles = double;
inline constexpr std::uint32_t lanes = 1, double_lanes = 1;

inline float sqrt(float a) {
    return std::sqrt(a);
}
inline double sqrt(double a) {
    return std::sqrt(a);
}

#include <lightbin/detail/vectors.inl>

inline unsigned bits(bool mask) {
    return mask;
}
inline double widened(float a, unsigned) {
    return static_cast<double>(a);
}
inline void load_spheres(const Sphere* spheres, float& x, float& y, float& z, float& radius) {
    const Sphere sphere = load_sphere(spheres);
    x = sphere.x;
    y = sphere.y;
    z = sphere.z;
    radius = sphere.radius;
}
template <class Real> void store_tiles(std::uint16_t* tiles, Real value) {
    *tiles = static_cast<std::uint16_t>(value);
}

#include <lightbin/detail/project.inl>

#undef LIGHTBIN_TARGET

}  // namespace scalar

/// Calls visit(tile, light) for each tile that footprint `light` reaches, lights in ascending order.
template <bool with_depth, class Id, class Visit> void for_each_pair(const BinJob<Id>& job, Visit visit) {
    const FootprintArrays& lights = job.lights;
    const std::size_t width = static_cast<std::size_t>(job.tiles_x);
    for (std::size_t light = 0; light < job.count; ++light)
        for (std::size_t y = lights.y0[light]; y <= lights.y1[light]; ++y)
            for (std::size_t tile = y * width + lights.x0[light], last = y * width + lights.x1[light];
                 tile <= last; ++tile) {
                if constexpr (with_depth)
                    if (!job.bounds.meets(tile,
                                          job.bounds.of(load_sphere(lights.spheres + lights.ids[light]))))
                        continue;
                visit(tile, light);
            }
}

/// Writes how many lights reach each tile to `counts`. Returns their sum.
///
/// Without Z a rectangle costs four corners of a difference array, whose prefix sums along both axes are the
/// counts.
template <bool with_depth, class Id>
std::uint64_t count_scalar(const BinJob<Id>& job, Scratch& scratch, std::uint32_t* counts) {
    const std::size_t width = static_cast<std::size_t>(job.tiles_x),
                      height = static_cast<std::size_t>(job.tiles_y);
    std::uint64_t entries = 0;
    if constexpr (with_depth) {
        std::fill_n(counts, width * height, 0u);
        for_each_pair<true>(job, [&](std::size_t tile, std::size_t) {
            ++counts[tile];
            ++entries;
        });
    } else {
        const std::size_t pitch = width + 1;
        std::int32_t* corners = scratch.corners.room(pitch * (height + 1));
        std::fill_n(corners, pitch * (height + 1), 0);
        const FootprintArrays& lights = job.lights;
        for (std::size_t light = 0; light < job.count; ++light) {
            const std::size_t left = lights.x0[light], right = lights.x1[light] + 1u;
            const std::size_t top = lights.y0[light] * pitch, bottom = (lights.y1[light] + 1u) * pitch;
            ++corners[top + left];
            --corners[top + right];
            --corners[bottom + left];
            ++corners[bottom + right];
        }
        for (std::size_t y = 0; y < height; ++y) {
            std::uint32_t row = 0;  // sums wrap, and come out right
            for (std::size_t x = 0; x < width; ++x) {
                row += static_cast<std::uint32_t>(corners[y * pitch + x]);
                counts[y * width + x] = row + (y > 0 ? counts[(y - 1) * width + x] : 0);
                entries += counts[y * width + x];
            }
        }
    }
    return entries;
}

/// Count, prefix, fill (Tiled Shading, section 3). Returns the number of entries. Never writes past the end.
template <bool with_depth, class Id> std::uint64_t bin_scalar(const BinJob<Id>& job, Scratch& scratch) {
    const std::size_t tiles = static_cast<std::size_t>(job.tiles_x) * static_cast<std::size_t>(job.tiles_y);
    std::uint32_t* cursors = scratch.cursors.room(tiles);
    count_scalar<with_depth>(job, scratch, cursors);
    std::uint32_t offset = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const std::uint32_t count = cursors[tile];
        job.offsets[tile] = cursors[tile] = offset;
        offset += count;
    }
    for_each_pair<with_depth>(job, [&](std::size_t tile, std::size_t light) {
        job.indices[cursors[tile]++] = static_cast<Id>(job.lights.ids[light]);
    });
    return offset;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
