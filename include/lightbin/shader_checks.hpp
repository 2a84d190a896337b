// SPDX-License-Identifier: MIT
// What tells, in the shader, that something is wrong: whether the View is that of the picture, and which lights a list
// lacks. Text on request: ShaderOptions::view_check and list_check.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/project/camera.hpp>
#include <lightbin/shader_text.hpp>
#include <lightbin/view.hpp>

#include <cmath>
#include <string>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What the constants `image` and `depths` of a text with view_check are set to. In a uniform block: this struct.
struct ShaderView {
    float scale_x, scale_y, offset_x, offset_y;      ///< image: pixel = scale * x / depth + offset
    float forward, perspective, nearest, tolerance;  ///< depths: depth = forward * z; 1 or 0; depth; pixels
};
static_assert(sizeof(ShaderView) == 32);  // so there is no padding

/// Returns the constants of a view.
///
/// tolerance  in pixels: how far from its pixel a position may be. Half a pixel is for one that is taken at a sample.
///            The rest is for rounding: interpolated over a triangle whose corners are r away, a position at depth d is
///            wrong by up to about 2^-22 r / d of the picture's height in pixels. Larger only where r / d exceeds some
///            thousand.
inline ShaderView shader_view(const View& view, float tolerance = 2) {
    const detail::Camera& camera = detail::camera_of(view);
    const auto pixels = [&](double tiles) { return static_cast<float>(tiles * view.tile_size()); };
    const auto scale = [&](const detail::ImageAxis& axis) {
        return pixels(axis.scale * static_cast<double>(axis.sign));
    };
    // A depth on the near plane comes out of the rasteriser as one beside it.
    const float near_depth = view.near_depth();
    const float slack = view.orthographic() ? 0x1p-10f * (std::fabs(near_depth) + std::fabs(view.far_depth()))
                                            : 0x1p-8f * near_depth;
    return {scale(camera.x),         scale(camera.y), pixels(camera.x.offset),
            pixels(camera.y.offset), camera.z_sign,   view.orthographic() ? 0.0f : 1.0f,
            near_depth - slack,      tolerance};
}

namespace detail {

/// `check_view`. `to_grid` turns the pixel as the shader counts it to that of the view.
inline void add_view_check(ShaderWriter& writer, const std::string& to_grid) {
    writer.add(
        "\n// Whether the View has a position of view space in this pixel, and not before its near plane.\n"
        "bool $check_view(uvec2 pixel, vec3 position) {\n" +
        to_grid + R"(    float depth = $depths.x * position.z;
    float w = 1.0;
    if ($depths.y > 0.0) { w = depth; }
    vec2 at = $image.xy * position.xy / w + $image.zw;
    vec2 apart = abs(at - (vec2(here) + 0.5));
    return apart.x < $depths.w && apart.y < $depths.w && depth >= $depths.z;
}
)");
}

/// `missing`, `begin_missing`, `next_missing` and their loop. As ids ascend, list and numbers are walked side by side.
inline void add_list_check(ShaderWriter& writer) {
    writer.add(R"(
// A light, and whether the pixel's list lacks it.
struct $missing {
    uint id;
    bool lacked;
    bool more;
    $own_cursor listed;
};

$missing $begin_missing(uvec2 pixel, float view_depth) {
    $own_cursor listed = $own_begin(pixel, view_depth);
    $missing m;
    m.id = 0xffffffffu;
    m.lacked = false;
    m.more = $own_next(&listed);
    m.listed = listed;
    return m;
}

bool $next_missing(inout $missing m, uint lights) {
    m.id += 1u;
    $own_cursor listed = m.listed;
    m.lacked = !(m.more && listed.id == m.id);
    if (!m.lacked) { m.more = $own_next(&listed); }
    m.listed = listed;
    return m.id < lights;
}
)");
    writer.add_macro(
        "for_each_missing(cursor, lights, pixel, view_depth)",
        "for ($missing cursor = $begin_missing(pixel, view_depth); $next_missing(cursor, lights);) "
        "if (cursor.lacked)");
}

}  // namespace detail
}}  // namespace lightbin
