// SPDX-License-Identifier: MIT
// Stability: may change.
// A compute or fragment shader that reduces a depth buffer on the GPU to Z bounds. Its text is a whole shader except
// for `#version`.
#pragma once

#include <lightbin/shader.hpp>
#include <lightbin/z_bounds.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What reduce_shader() generates.
struct ReduceOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    bool fragment = false;      ///< a fragment shader, not a compute shader
    int samples = 1;            ///< samples per pixel of the depth texture, 1 to 8
    bool reversed_z = false;    ///< View::reversed_z()
    bool orthographic = false;  ///< View::orthographic()
    bool oblique = false;       ///< View::oblique()
    DepthFormat format = DepthFormat::float32;
    bool skip_background = false;  ///< ignores samples at the far plane: see DepthBuffer::skip_background
    bool flip_y = false;           ///< the texture's row 0 is at the image's opposite end to the view's WindowOrigin
    bool viewport_corner = false;  ///< the viewport begins at the texel `corner`, not at the texture's first one

    ShaderSlot depth = {0}, z_bounds = {1}, grid = {2};
    bool push_constants = false;            ///< Vulkan: the constants are push constants
    std::string_view prefix = "lightbin_";  ///< every name in the generated shader text begins with it
};

/// The values of the constants `grid`, `planes`, `corner` and `tilt` of reduce_shader(). A uniform block has this
/// layout: its first 32 bytes, with viewport_corner 48, with oblique all 64.
struct ReduceConstants {
    std::uint32_t tile_size, tiles_x, width, height;       ///< grid, as in GridConstants
    float far_end = 0, slope = 0, margin = 0, unused = 0;  ///< planes
    std::int32_t corner_x = 0, corner_y = 0;               ///< corner
    std::int32_t unused_corner[2] = {};
    float tilt_x = 0, tilt_y = 0, unused_tilt[2] = {};     ///< tilt
};
static_assert(sizeof(ReduceConstants) == 64);

/// Returns the values of the constants of reduce_shader() for a view. The corner is the texel of the depth texture at
/// the viewport's first column and row; only shaders with ReduceOptions::viewport_corner read it.
inline ReduceConstants reduce_constants(const View& view, int corner_x = 0, int corner_y = 0) {
    const GridConstants grid = grid_constants(view);
    ReduceConstants constants = {.tile_size = grid.tile_size, .tiles_x = grid.tiles_x, .width = grid.width,
                                 .height = grid.height, .corner_x = corner_x, .corner_y = corner_y};
    const detail::DepthMap& map = detail::projection_of(view).depth;
    // Let e be the distance of a window depth from the far plane's: 1 - depth, or with reversed Z the depth itself. A
    // perspective view depth is  1 / (far_end + slope e)  with far_end = 1 / far and slope = 1 / near - 1 / far:
    // positive terms, so nothing cancels. With far_end = far and slope = far - near, an orthographic one is
    // far_end - slope e;  `margin` covers its rounding.
    const double from = static_cast<double>(view.near_depth()), to = static_cast<double>(view.far_depth());
    const bool flat = view.orthographic();
    if (map.oblique()) {
        // Here the two are one over the view depth, or its negative where flat, for a point (x, y) of the image in
        // pixels from its centre:  far_end + tilt_x x + tilt_y y + slope e.  Terms cancel, so the margin covers the
        // rounding of their greatest values: up to 10 roundings of 2^-24.
        const double along = flat ? -map.z_scale : map.z_offset, w = flat ? map.w_offset : map.w_scale,
                     at_far = map.device_depth(map.reversed ? 0 : 1) * w - (flat ? map.z_offset : map.z_scale);
        const auto part = [&](double value) { return static_cast<float>(value / along); };
        const double half_width = 0.5 * detail::max_of(grid.width, 1u),
                     half_height = 0.5 * detail::max_of(grid.height, 1u),
                     slope = (map.zero_to_one ? 1 : 2) * w,
                     sum = std::fabs(at_far) + std::fabs(map.tilt_x) + std::fabs(map.tilt_y) + slope;
        constants.far_end = part(at_far);
        constants.slope = std::fabs(part(slope));
        constants.margin = static_cast<float>(0x1p-20) * std::fabs(part(sum));
        constants.tilt_x = part(-map.tilt_x / half_width);
        constants.tilt_y = part(-map.tilt_y / half_height);
        return constants;
    }
    constants.far_end = static_cast<float>(flat ? to : 1 / to);
    constants.slope = static_cast<float>(flat ? to - from : 1 / from - 1 / to);
    constants.margin = static_cast<float>(0x1p-20 * (std::fabs(from) + std::fabs(to)));
    return constants;
}

/// Returns a shader that reduces a depth texture to the minimum and maximum Z bounds of each tile, or an Error that
/// names the limit that the options exceed. The bounds enclose all depths of the tile, as those of reduce_depth() do,
/// and are wider by the rounding of 32-bit floats.
///
/// compute   one group of 64 threads per tile writes a vec2 to the storage buffer `z_bounds`: dispatch
///           (tiles_x, tiles_y, 1)
/// fragment  one fragment per tile loops over the tile's pixels: draw a triangle over a target of tiles_x by tiles_y
///           texels of two 32-bit floats, row 0 of which is row 0 of the tiles
///
/// Source: Tiled Shading, section 6.3.
inline Result<ShaderText> reduce_shader(const ReduceOptions& options = {});

}}  // namespace lightbin

// The definitions.
#include <lightbin/detail/shaders/reduce.hpp>
