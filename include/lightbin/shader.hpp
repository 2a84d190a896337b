// SPDX-License-Identifier: MIT
// Stability: settled.
// Shader text that reads the lists of a light grid, in GLSL, HLSL and WGSL. docs/shader.md shows its use.
#pragma once

#include <lightbin/list_format.hpp>
#include <lightbin/options.hpp>
#include <lightbin/shader_text.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>

#include <cmath>
#include <string_view>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The kind of resource that holds the lists.
enum class ListStorage : std::uint8_t {
    storage_buffer,  ///< storage buffers (GLSL 4.30, Vulkan, ES 3.10, WGSL); StructuredBuffer in HLSL
    texel_buffer,    ///< buffer textures in GLSL, Buffer in HLSL; ES and WGSL have none
    texture_2d,      ///< the lists are in 2D textures, in every language (as in Tiled Shading, Listing 1)
    uniform_block,   ///< the lists are in uniform blocks, in HLSL cbuffers (as in Tiled Forward Shading, Listing 4.1)
};

constexpr const char* to_string(ListStorage value) {
    return detail::name_at(value, {"storage_buffer", "texel_buffer", "texture_2d", "uniform_block"});
}

/// What shader_snippet() generates. The text contains code only for what the options ask for.
struct SnippetOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    ListStorage storage = ListStorage::storage_buffer;
    /// The format of the lists: the one given to encode(), or {.ids = Options::ids} for the lists of a Binner itself.
    ListFormat format = {};
    /// With ListEncoding::offset_count: reads {offset, count} from a uniform block, and only the ids from `storage`.
    bool tiles_in_uniform_block = false;
    /// With texel_buffer and texture_2d: reads ids of 8 and 16 bits from texels of 32 bits, in which they are packed as
    /// in a storage buffer. By default each id has a texel of its own width.
    bool packed_ids = false;

    Slicing slicing = Slicing::none;  ///< the same as Options::slicing of the Binner that makes the lists
    /// Reads LightMasks::words(), bound at `lists`, in place of lists: with Slicing::z_bins those that were made with
    /// slices. Nothing is bound at `tiles` and `bins`, and what is said of lists' formats above is not read. The size
    /// of a uniform block is uniform_block_bytes.
    bool masks = false;
    /// The number of views whose lists lie one after another in the buffers, 1 to 512: see shader_snippet().
    std::uint32_t views = 1;

    int tile_size = 0;             ///< in pixels, a literal in the shader text; 0: read from the shader constant `grid`
    bool columns_and_rows = false;  ///< for views whose tile_size() is 0, with numbers of tiles; tile_size is not read
    bool flip_y = false;           ///< the shader counts pixel rows from the opposite end to the view's WindowOrigin
    bool turned = false;           ///< for views whose turned() is true
    bool viewport_corner = false;  ///< pixels are counted in the window; the constant `corner` is subtracted from them
    bool heat_map = false;         ///< adds the functions `count` and `heat`, which show a pixel's number of lights
    /// With masks: the lanes of a wave (subgroup) loop together over the lights that any lane has, so that a light's
    /// data is read once for all of them. On a console this took 0.72 of the time, and over lists 0.98 (Drobot,
    /// "Improved Culling for Tiled and Clustered Rendering", SIGGRAPH 2017). GLSL 4.30 and ES 3.10 need
    /// GL_KHR_shader_subgroup_arithmetic, Vulkan 1.1, HLSL 6.0, WGSL the device's feature `subgroups`.
    bool wave_loop = false;
    bool view_check = false;  ///< adds the function `check_view`, which reads ViewConstants, bound at `view`
    bool list_check = false;  ///< adds the loop `for_each_missing` over the lights that a pixel's list lacks
    bool window = false;      ///< adds the function `window`, a light's falloff at its range: see light_window()

    std::uint32_t texture_width = 2048;  ///< texture_2d: texels per row, 1 to 16384; a power of two is fastest
    std::uint32_t max_tiles = 0;    ///< with uniform_block: the most tiles in all slices of all views together
    std::uint32_t max_entries = 0;  ///< with uniform_block and offset_count: the most ids in all lists together
    std::uint32_t max_slices = 0;   ///< with uniform_block and slicing: the greatest number of slices
    std::uint32_t uniform_block_bytes = 16384;  ///< the device's limit for one block; every device allows 16384

    ShaderSlot tiles = {0}, lists = {1}, grid = {2}, slices = {3}, bins = {4}, view = {5};
    bool push_constants = false;            ///< Vulkan: GridConstants (`grid` and `corner`) is push constants
    std::string_view prefix = "lightbin_";  ///< every name in the generated shader text begins with it
};

namespace detail {
inline constexpr std::uint32_t most_tile_size = (1u << 30) - 1;  ///< in shaders; larger than any viewport
}

/// The values of the shader's constants `grid` and `corner`. A uniform block and push constants have this layout;
/// without viewport_corner, its first 16 bytes.
struct GridConstants {
    /// The constant `grid`. Of a turned view, width and height are exchanged, and 2^30 is added to tile_size. Of a view
    /// with numbers of columns and rows, tile_size is the number of rows, and 2^31 is added to it.
    std::uint32_t tile_size, tiles_x, width, height;
    std::int32_t corner_x, corner_y;                  ///< corner
    std::int32_t unused[2] = {};
};
static_assert(sizeof(GridConstants) == 32 && sizeof(ListRange) == 8);  // neither has padding

/// Returns the values of the shader's constants for a view. The corner is the least x and y of the viewport's pixels in
/// the shader's own pixel coordinates; only shaders with SnippetOptions::viewport_corner read it.
inline GridConstants grid_constants(const View& view, int corner_x = 0, int corner_y = 0) {
    const detail::Camera& camera = detail::camera_of(view);
    const auto u = [](int n) { return static_cast<std::uint32_t>(n); };
    const std::uint32_t tiles = view.tile_size() == 0 ? 1u << 31 | u(view.tiles_y())
                                                      : detail::min_of(u(view.tile_size()), detail::most_tile_size);
    return {tiles | u(view.turned()) << 30, u(view.tiles_x()), u(camera.x.split.side), u(camera.y.split.side),
            corner_x, corner_y};
}

/// Returns the content of the buffer `slices`, slices.count() + 3 words of 32 bits: three coefficients and the index of
/// the last slice, by which the shader guesses a depth's slice, and the boundaries, by which it corrects the guess.
inline std::vector<std::uint32_t> shader_slices(const Slices& slices);

/// The values of the constants that the shader function `check_view` reads. A uniform block has this layout.
struct ViewConstants {
    /// The vec4 constant `image`: a point's pixel is  scale * x / depth + offset;  orthographic:  scale * x + offset.
    float scale_x, scale_y, offset_x, offset_y;
    /// The vec4 constant `depths`: a point's view depth is  forward * z  and must be at least `nearest`; `perspective`
    /// is 1, or 0 in orthographic views; the point may be projected up to `tolerance` pixels away from its pixel.
    float forward, perspective, nearest, tolerance;
};
static_assert(sizeof(ViewConstants) == 32);  // it has no padding

/// Returns the values of the constants with which the shader's `check_view` checks pixels against a view.
///
/// tolerance  in pixels: how far from the pixel's centre, in x and in y, the position passed to `check_view` may be
///            projected. Half a pixel is needed for positions taken at a sample. The rest is for rounding: a position
///            at depth d, interpolated over a triangle whose corners are at a distance r, is wrong by up to about
///            2^-22 r / d of the image's height in pixels. A larger tolerance is only needed where r / d exceeds some
///            thousand
inline ViewConstants view_constants(const View& view, float tolerance = 2) {
    const detail::Camera& camera = detail::camera_of(view);
    const auto scale = [&](const detail::ImageAxis& axis) {
        return static_cast<float>(axis.split.pixels_of(axis.scale * static_cast<double>(axis.sign)));
    };
    const auto offset = [](const detail::ImageAxis& axis) {
        return static_cast<float>(axis.split.pixels_of(axis.offset));
    };
    // The rasteriser rounds: a point on the near plane may reach the shader with a slightly smaller depth.
    const float near_depth = view.near_depth();
    const float slack = view.orthographic() ? 0x1p-10f * (std::fabs(near_depth) + std::fabs(view.far_depth()))
                                            : 0x1p-8f * near_depth;
    return {scale(camera.x),    scale(camera.y), offset(camera.x),
            offset(camera.y),   camera.z_sign,   view.orthographic() ? 0.0f : 1.0f,
            near_depth - slack, tolerance};
}

/// Returns shader text that reads the lists, to be inserted after `#version` and before its first use, or an Error that
/// names the limit that the options exceed. The text declares (`lightbin_` stands for options.prefix):
///
///     uvec2 lightbin_tile(uvec2 pixel);                   // the tile that contains the pixel
///     uint lightbin_slice(float view_depth);              // with slicing: the slice that contains the depth
///     struct lightbin_cursor { uint id; ... };            // a position in a list: the id of the light there
///     lightbin_cursor lightbin_begin(uvec2 pixel, float view_depth);  // a cursor before the pixel's first light
///     bool lightbin_next(inout lightbin_cursor cursor);   // moves on to the next light; false: there is none
///     #define lightbin_for_each_light(cursor, pixel, view_depth)      // a loop over the pixel's lights
///     uint lightbin_count(uvec2 pixel, float view_depth);             // with heat_map: the number of lights
///     vec3 lightbin_heat(uvec2 pixel, float view_depth, float most);  // and as a colour from blue to red (`most`)
///     float lightbin_window(float apart, float range);                // with window: see light_window()
///     bool lightbin_check_view(uvec2 pixel, vec3 position);           // with view_check
///     #define lightbin_for_each_missing(cursor, lights, pixel, view_depth)  // with list_check
///
/// In GLSL and HLSL, a shader loops over a pixel's lights like this, with every encoding, storage and slicing:
///
///     lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), depth) { colour += shade(light.id, position); }
///
/// WGSL has no macros. There the loops are written out, and lightbin_next takes a pointer:
///
///     var light = lightbin_begin(vec2u(pixel.xy), depth);
///     while (lightbin_next(&light)) { colour += shade(light.id, position); }
///     var other = lightbin_begin_missing(vec2u(pixel.xy), depth);
///     while (lightbin_next_missing(&other, light_count)) { if (other.lacked) { ... } }
///
/// view_depth is the view depth of the shaded point, as Slices defines it; it is only read with slicing. With clusters
/// the loop runs over the list of the pixel's tile in the slice of that depth. With z_bins it runs over the part of the
/// tile's list between the least and the greatest rank of the depth's bin.
///
/// `break`, `continue` and `return` work in the loop bodies, and loops can be nested. Ids ascend; each comes once. The
/// list is empty for a pixel outside of the viewport, and for every pixel where `grid` is unset or of a view that the
/// options tile_size, columns_and_rows and turned are not for, so nothing outside of the table of tiles that `grid`
/// describes is read. Tiles and lists must be of one build: what a table that points beyond the lists reads is up to
/// the graphics API (Direct3D: 0; WebGPU: 0 or another entry; OpenGL, Vulkan: robust access has to be enabled).
///
/// With wave_loop, `begin` and `next` step through the lights of the whole wave, so what depends on the id alone is
/// uniform in it; cursor.own tells whether the lane's own masks contain the light. No `else` can follow the loop body,
/// and in WGSL the text must come first in its module.
///
/// With several views (options.views is 2 or more), every function and loop above that takes a pixel, except `tile`,
/// takes the number of the pixel's view, a uint counted from 0, as its last parameter. The buffers of tiles, lists and
/// bins hold the data of view 0, then of view 1, and so on, as LightGrid::copy_to() writes tiles and lists. All views
/// have the same `grid`, `corner` and slices. The list of a view whose number is options.views or more is empty.
/// `check_view` has one array `image` of constants: each view's ViewConstants in turn.
///
/// With masks the lights come in the order of LightMasks::ids(), which with z_bins is that of depth, and light.id is
/// the position in the caller's array. Masks are of one view and have no clusters.
///
/// Two checks find pixels where the set-up is wrong. lightbin_check_view tells whether the View projects `position`, in
/// view space, into this pixel (within the tolerance of view_constants()) and not before its near plane.
/// lightbin_for_each_missing loops over every id below `lights` that the pixel's list lacks, which is slow; no `else`
/// can follow its body.
inline Result<ShaderText> shader_snippet(const SnippetOptions& options = {});

}}  // namespace lightbin

// The definitions.
#include <lightbin/detail/shaders/snippet.hpp>
