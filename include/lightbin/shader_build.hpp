// SPDX-License-Identifier: MIT
// Compute and fragment shaders that do the library's work on the GPU: reduce_shader() reduces a depth buffer to Z
// bounds, build_shader() makes the light grid. Each text is a whole shader except for `#version`.
#pragma once

#include <lightbin/shader.hpp>
#include <lightbin/z_bounds.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

enum class ShaderStage : std::uint8_t { compute, fragment };

constexpr const char* to_string(ShaderStage value) {
    return detail::name_at(value, {"compute", "fragment"});
}

/// What reduce_shader() generates.
struct ReduceShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    ShaderStage stage = ShaderStage::compute;
    int samples = 1;            ///< samples per pixel of the depth texture, 1 to 8
    bool reversed_z = false;    ///< View::reversed_z()
    bool orthographic = false;  ///< View::orthographic()
    DepthFormat format = DepthFormat::float32;
    bool skip_background = false;  ///< ignores samples at the far plane: see DepthBuffer::skip_background
    bool flip_y = false;           ///< the texture's row 0 is at the image's opposite end to the view's WindowOrigin
    bool viewport_corner = false;  ///< the viewport begins at the texel `corner`, not at the texture's first one

    ShaderSlot depth = {0}, z_bounds = {1}, grid = {2};
    bool push_constants = false;            ///< Vulkan: the constants are push constants
    std::string_view prefix = "lightbin_";  ///< every name in the generated shader text begins with it
};

/// The values of the constants `grid`, `planes` and `corner` of reduce_shader(). A uniform block has this layout;
/// without viewport_corner, its first 32 bytes.
struct ShaderReduce {
    std::uint32_t tile_size, tiles_x, width, height;  ///< grid
    float far_end, slope, margin, unused;             ///< planes
    std::int32_t corner_x, corner_y;                  ///< corner
    std::int32_t unused_corner[2] = {};
};
static_assert(sizeof(ShaderReduce) == 48);

/// Returns the values of the constants of reduce_shader() for a view. The corner is the texel of the depth texture at
/// the viewport's first column and row; only shaders with ReduceShaderOptions::viewport_corner read it.
inline ShaderReduce shader_reduce(const View& view, int corner_x = 0, int corner_y = 0) {
    const ShaderGrid grid = shader_grid(view);
    // Let e be the distance of a window depth from the far plane's: 1 - depth, or with reversed Z the depth itself. A
    // perspective view depth is  1 / (far_end + slope e)  with far_end = 1 / far and slope = 1 / near - 1 / far:
    // positive terms, so nothing cancels. With far_end = far and slope = far - near, an orthographic one is
    // far_end - slope e;  `margin` covers its rounding.
    const double from = static_cast<double>(view.near_depth()), to = static_cast<double>(view.far_depth());
    const bool flat = view.orthographic();
    const float far_end = static_cast<float>(flat ? to : 1 / to),
                slope = static_cast<float>(flat ? to - from : 1 / from - 1 / to),
                margin = static_cast<float>(0x1p-20 * (std::fabs(from) + std::fabs(to)));
    return {grid.tile_size, grid.tiles_x, grid.width, grid.height, far_end,
            slope,          margin,       0,          corner_x,    corner_y};
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
inline Result<ShaderText> reduce_shader(const ReduceShaderOptions& options = {});

/// The three shaders that build a light grid, in the order of their dispatches.
enum class BuildPass : std::uint8_t {
    /// Counts the lights of each tile. Dispatch tiles_x by tiles_y (with clusters, slices * tiles_y) work groups.
    count,
    offsets,  ///< adds the counts up to each tile's list offset and to the total; dispatch one work group
    fill,     ///< writes the lists; dispatch as many work groups as for the pass `count`
};

constexpr const char* to_string(BuildPass value) {
    return detail::name_at(value, {"count", "offsets", "fill"});
}

/// What build_shader() generates. The three passes need the same options except for `pass`. Every device with OpenGL ES
/// 3.1, Vulkan or WebGPU can run them: each uses at most four storage buffers, by default at bindings below 4, and at
/// most 128 threads per group.
struct BuildShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    BuildPass pass = BuildPass::count;
    DepthTest depth_test = DepthTest::none;  ///< split_box is an error; with clusters, interval is, too
    Slicing slicing = Slicing::none;         ///< z_bins is an error: build_shader() makes no z-bins
    bool max_only = false;      ///< tests with the maximum Z bound alone, for transparent surfaces; not with clusters
    bool orthographic = false;  ///< whether the view is orthographic: View::orthographic(); read with DepthTest::box

    ShaderSlot footprints = {0}, z_bounds = {1}, tiles = {2}, lists = {3};
    ShaderSlot total = {3};  ///< for the lists' total length; by default the slot of `lists`, as no pass uses both
    ShaderSlot grid = {4};
    bool push_constants = false;            ///< Vulkan: the constants are push constants
    std::string_view prefix = "lightbin_";  ///< every name in the generated shader text begins with it
};

/// The values of the shader constants `grid` and `planes` of build_shader(). A uniform block has this layout. Without
/// DepthTest::box and Slicing::clusters there is no `planes`, and the block is the first 16 bytes.
struct ShaderBuild {
    /// The constant `grid`: tile columns; tile rows, summed over the slices; lights in view; ids that fit in `lists`.
    std::uint32_t tiles_x, rows, footprints, capacity;
    float near_depth, far_depth, tiles_y, unused = {};  ///< planes
};
static_assert(sizeof(ShaderBuild) == 32);

/// Returns the values of the constants of build_shader() for a view.
///
/// footprints  how many footprints shader_footprints() returned
/// capacity    how many ids fit in the buffer `lists`
/// slices      Slices::count() with clusters, otherwise 1
inline ShaderBuild shader_build(const View& view, std::uint32_t footprints, std::uint32_t capacity,
                                int slices = 1) {
    return {static_cast<std::uint32_t>(view.tiles_x()),
            static_cast<std::uint32_t>(view.tiles_y() * slices),
            footprints,
            capacity,
            view.near_depth(),
            view.far_depth(),
            static_cast<float>(view.tiles_y())};
}

/// A light in view, as build_shader() reads it: its tiles x0..x1 by y0..y1, both ends included, and its sphere. The
/// sphere's x and y are view-space coordinates, negated where tile indices decrease as they grow; z is its view depth.
struct ShaderFootprint {
    std::uint32_t id;  ///< the light's position in the caller's array
    std::uint16_t x0, y0, x1, y1;
    float reach2;  ///< the sphere's squared radius, rounded up
    float x, y, z, radius;
};
static_assert(sizeof(ShaderFootprint) == 32);

/// Returns the footprints of the lights in view by ascending id, the input of build_shader(). A spot's footprint has
/// the rectangle of the cone and the least sphere around it, a Box's the rectangle of the box and the sphere of
/// bounding_sphere(). `lights` and errors are those of Binner::bin().
template <class LightRange>
Result<std::vector<ShaderFootprint>> shader_footprints(const View& view, const LightRange& lights);

/// Two ends of an interval: the sides of a tile column or row as slopes (perspective) or view-space coordinates
/// (orthographic), or the view depths of a slice.
struct ShaderEdges {
    float low, high;
};

/// Returns the two sides of each tile column and then of each tile row. With DepthTest::box, upload them in the buffer
/// `z_bounds` that build_shader() reads: after the Z bounds of all tiles, or with clusters after shader_slabs().
inline std::vector<ShaderEdges> shader_edges(const View& view);

/// Returns the depths of the slices. With clusters, build_shader() reads them in `z_bounds` in place of the tiles' Z
/// bounds. They include the slices' margin (see Slices::with_margin()); a light that just touches such a widened slice
/// may be listed by only one of build_shader() and the Binner.
inline std::vector<ShaderEdges> shader_slabs(const Slices& slices) {
    const detail::SliceTable& table = table_of(slices);
    std::vector<ShaderEdges> slabs;
    float low = -detail::infinity;
    for (const float boundary : table.boundaries()) {
        slabs.push_back({low, table.farther(boundary)});
        low = table.nearer(boundary);
    }
    slabs.push_back({low, detail::infinity});
    return slabs;
}

/// Returns one of the three shaders that build a light grid from footprints, or an Error that names the limit that the
/// options exceed. A group of 64 threads tests every light against its tile. After the three passes, with a barrier
/// between them, `tiles` and `lists` contain what LightGrid has in ranges() and ids() (32-bit ids), and `total` the
/// number of entries of the complete lists; 2^32 - 1 stands for that number and every greater one.
///
/// If `total` exceeds ShaderBuild::capacity, the last total - capacity entries are missing: the list of the first tile
/// that does not fit is cut, and the lists of all tiles after it are empty. Nothing is written beyond the capacity.
/// Build again with a larger buffer; where no buffer is large enough, with larger tiles or fewer slices.
///
/// For spheres, the entries compare with those of the Binner as follows, by depth test or slicing:
///
/// none      the same entries
/// interval  the same entries, if the device rounds sums correctly
/// box       the same entries but for the device's rounding of sums and products: no light that meets the cell is
///           missing, and no light is listed whose distance from the box exceeds its radius by over 2^-19 of the radius
/// clusters  as for box if the depth test is box, as for interval if it is none; the depths of a cell are its slice's
///
/// Of a spot, these shaders test the least sphere around it (see least_sphere()), where the Binner tests the cone; the
/// rectangle of tiles is the same. No spot that meets a cell is missing. Without depth test and clusters the entries
/// are the Binner's. With interval, or clusters without box, every entry of the Binner is there, except those that only
/// its rounding margins add, and there are more. With box neither has all entries of the other: the Binner tests the
/// ball and the half spaces around the cone, which may both meet a box that lies beyond the least sphere. Of a Box they
/// test its bounding_sphere() in the Box's own rectangle of tiles; no Box that meets a cell is missing.
inline Result<ShaderText> build_shader(const BuildShaderOptions& options = {});

}}  // namespace lightbin

// The definitions.
#include <lightbin/detail/shader/build.hpp>
