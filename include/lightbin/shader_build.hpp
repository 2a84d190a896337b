// SPDX-License-Identifier: MIT
// Stages 2b and 3 on the GPU: shader text that reduces a depth buffer to Z bounds, and that builds the light
// grid. Each text is a whole shader but for `#version`.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/detail/project/footprints.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/shader_text.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

enum class ShaderStage : std::uint8_t { compute, fragment };

constexpr const char* to_string(ShaderStage value) {
    return detail::name_at(value, {"compute", "fragment"});
}

/// What reduce_shader() makes.
struct ReduceShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    ShaderStage stage = ShaderStage::compute;
    int samples = 1;            ///< samples a pixel of the depth texture, 1 to 8
    bool reversed_z = false;    ///< as View::reversed_z()
    bool orthographic = false;  ///< as View::orthographic()
    DepthFormat format = DepthFormat::float32;
    bool skip_background = false;  ///< as in DepthBuffer
    bool flip_y = false;           ///< the texture's rows count against those of the view's WindowOrigin
    bool viewport_corner = false;  ///< the viewport does not begin at the texture's first texel

    ShaderSlot depth = {0}, z_bounds = {1}, grid = {2};
    bool push_constants = false;
    std::string_view prefix = "lightbin_";
};

/// The constants of reduce_shader(): `grid`, `planes` and `corner`. In a uniform block: this struct, 32 bytes
/// of it without viewport_corner.
struct ShaderReduce {
    std::uint32_t tile_size, tiles_x, width, height;  ///< grid
    float far_end, slope, margin, unused;             ///< planes
    std::int32_t corner_x, corner_y;                  ///< corner
    std::int32_t unused_corner[2] = {};
};
static_assert(sizeof(ShaderReduce) == 48);

/// Returns the constants of a view; the corner is the texel at the viewport's first column and row.
inline ShaderReduce shader_reduce(const View& view, int corner_x = 0, int corner_y = 0) {
    const ShaderGrid grid = shader_grid(view);
    // With e the distance of a window depth from the far plane's (1 - depth, or depth with reversed Z), view
    // depth is  1 / (far_end + slope e)  or, orthographic,  far_end - slope e: terms of one sign.
    const double from = static_cast<double>(view.near_depth()), to = static_cast<double>(view.far_depth());
    const bool flat = view.orthographic();
    const float far_end = static_cast<float>(flat ? to : 1 / to),
                slope = static_cast<float>(flat ? to - from : 1 / from - 1 / to),
                margin = static_cast<float>(0x1p-20 * (std::fabs(from) + std::fabs(to)));
    return {grid.tile_size, grid.tiles_x, grid.width, grid.height, far_end,
            slope,          margin,       0,          corner_x,    corner_y};
}

/// One of the three shaders that build a light grid, in the order of their dispatches.
enum class BuildPass : std::uint8_t {
    count,  ///< tiles_x * tiles_y groups, with clusters tiles_x * (slices * tiles_y): the lights of each tile
    offsets,  ///< one group: where each list begins, and the length of the light index list
    fill,     ///< as many groups as count: the lists
};

constexpr const char* to_string(BuildPass value) {
    return detail::name_at(value, {"count", "offsets", "fill"});
}

/// What build_shader() makes. All passes take the same but for `pass`. Each has at most four storage buffers, at bindings
/// below 4 unless told, and at most 128 threads a group: as many as every device with OpenGL ES 3.1, Vulkan or WebGPU has.
struct BuildShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    BuildPass pass = BuildPass::count;
    DepthTest depth_test = DepthTest::none;  ///< none, interval or box
    Slicing slicing = Slicing::none;         ///< none or clusters (with none or box)
    bool max_only = false;                   ///< Z bounds, not clusters: no minimum is tested (transparency)
    bool orthographic = false;               ///< box: as View::orthographic()

    ShaderSlot footprints = {0}, z_bounds = {1}, tiles = {2}, lists = {3};
    ShaderSlot total = {3};  ///< no pass has both lists and total
    ShaderSlot grid = {4};
    bool push_constants = false;
    std::string_view prefix = "lightbin_";
};

/// The constants of build_shader(): `grid` and, for box or clusters, `planes`. In a uniform block: this struct, 16 bytes
/// of it with neither.
struct ShaderBuild {
    /// grid; rows: of all slices; room: ids that the buffer for lists holds
    std::uint32_t tiles_x, rows, footprints, room;
    float near_depth, far_depth, tiles_y, unused = {};  ///< planes
};
static_assert(sizeof(ShaderBuild) == 32);

/// slices  as Slices::count(), with clusters
inline ShaderBuild shader_build(const View& view, std::uint32_t footprints, std::uint32_t room,
                                int slices = 1) {
    return {static_cast<std::uint32_t>(view.tiles_x()),
            static_cast<std::uint32_t>(view.tiles_y() * slices),
            footprints,
            room,
            view.near_depth(),
            view.far_depth(),
            static_cast<float>(view.tiles_y())};
}

/// A light in view, as build_shader() reads it: tiles x0..x1, y0..y1, both ends included, and the sphere with
/// its axes turned so that the tile index grows with x and y, and z is the view depth.
struct ShaderFootprint {
    std::uint32_t id;
    std::uint16_t x0, y0, x1, y1;
    float reach2;  ///< the squared radius, rounded up
    float x, y, z, radius;
};
static_assert(sizeof(ShaderFootprint) == 32);

namespace detail {

/// Lines that declare `endless`, infinity. By way of a variable, as WGSL refuses it as a constant.
inline constexpr const char* endless_lines = R"(    uint endless_bits = 0x7f800000u;
    float endless = uintBitsToFloat(endless_bits);
)";

/// main() of a compute shader: hands its group's place and the thread's number to `$run`.
inline void add_compute_main(ShaderWriter& writer, unsigned threads) {
    const std::string count = std::to_string(threads);
    const Dialect& dialect = writer.dialect();
    writer.add(dialect.wgsl ? "\n@compute @workgroup_size(" + count +
                                  ")\nfn main(@builtin(workgroup_id) group : vec3u, "
                                  "@builtin(local_invocation_index) thread : u32) {\n"
                                  "    $run(group.xy, thread);\n}\n"
               : dialect.hlsl
                   ? "\n[numthreads(" + count +
                         ", 1, 1)]\nvoid main(uint3 group : SV_GroupID, uint thread : SV_GroupIndex) {\n"
                         "    $run(group.xy, thread);\n}\n"
                   : "\nlayout(local_size_x = " + count +
                         ") in;\nvoid main() {\n    $run(gl_WorkGroupID.xy, gl_LocalInvocationIndex);\n}\n");
}

inline std::optional<Error> refuse(const ReduceShaderOptions& options) {
    const Dialect dialect = detail::dialect(options.language);
    if (auto error = refuse_names(options, {options.depth, options.z_bounds, options.grid})) return error;
    if (options.stage == ShaderStage::compute && !dialect.storage_buffers)
        return Error{ErrorCode::no_storage_buffers};
    if (options.samples < 1 || options.samples > 8)
        return Error{ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(options.samples), 8};
    if (options.samples > 1 && options.language == ShaderLanguage::essl_300)
        return Error{ErrorCode::no_multisample_textures};
    return std::nullopt;
}

inline std::optional<Error> refuse(const BuildShaderOptions& options) {
    if (auto error = refuse_names(options, {options.footprints, options.z_bounds, options.tiles,
                                            options.lists, options.total, options.grid}))
        return error;
    if (!detail::dialect(options.language).storage_buffers) return Error{ErrorCode::no_storage_buffers};
    if (options.depth_test == DepthTest::split_box) return Error{ErrorCode::no_split_box_shader};
    if (options.slicing == Slicing::z_bins ||
        (options.slicing == Slicing::clusters && options.depth_test == DepthTest::interval))
        return Error{ErrorCode::no_such_slicing_shader};
    return std::nullopt;
}

/// The depth of a sample widens what is known of a tile, as in reduce_depth(). In bits, as depths in 0..1
/// order as their bits do, and compilers may take it that no float is NaN. 0x3f800000 is 1, 0x7f800000
/// infinity; below 0 and above 1 is clamped, and NaN could be any depth.
inline void add_depth_sample(ShaderWriter& writer, const ReduceShaderOptions& options) {
    writer.add(std::string("\nvoid $sample(inout uvec2 range, float depth) {\n") +
               "    uint bits = floatBitsToUint(depth);\n" +
               (options.skip_background ? std::string("    if (bits == ") +
                                              (options.reversed_z ? "0u" : "0x3f800000u") + ") { return; }\n"
                                        : "") +
               R"(    uint low = bits;
    if ((bits & 0x7fffffffu) > 0x7f800000u) {
        low = 0u;
        bits = 0x3f800000u;
    } else if (bits > 0x7f800000u) {
        low = 0u;
        bits = 0u;
    }
    range = uvec2(min(range.x, min(low, 0x3f800000u)), max(range.y, min(bits, 0x3f800000u)));
}
)");
}

/// View depths of a tile's range of window depths, rounded outward. Relative errors, u = 2^-24: `far_end` and
/// `slope` 3u (View's depths are floats), their product and sum 2u more, e 1u (exact where it is small), a
/// reciprocal up to 5u: 11u, and 2^-19 = 32u is allowed. Orthographic: 2^-20 of the two planes' depths.
inline void add_view_depths(ShaderWriter& writer, const ReduceShaderOptions& options) {
    writer.add(std::string("\nvec2 $view_depths(uvec2 range) {\n") + endless_lines);
    if (options.format == DepthFormat::float32)
        // Two units in the last place, and no denormals: no less than reduce_depth().
        writer.add(R"(    uint first = 0u;
    if (range.x >= 0x00800002u) { first = range.x - 2u; }
    vec2 ends = vec2(uintBitsToFloat(first), uintBitsToFloat(clamp(range.y + 2u, 0x00800000u, 0x3f800000u)));
)");
    else  // one step and 2^-24 for the texel's rounding, and 2^-25 for the sum's, which with steps of 24 bits is exact
        writer.add(std::string("    float step = ") +
                   (options.format == DepthFormat::unorm24 ? "1.1920931e-7" : "1.535e-5") +
                   ";\n    vec2 ends = vec2(max(uintBitsToFloat(range.x) - step, 0.0), "
                   "min(uintBitsToFloat(range.y) + step, 1.0));\n");
    writer.add(options.reversed_z ? "    vec2 e = ends.yx;\n"
                                  : "    vec2 e = vec2(1.0 - ends.x, 1.0 - ends.y);\n");
    if (options.orthographic)
        writer.add(
            "    vec2 depths = vec2($planes.x - $planes.y * e.x - $planes.z, $planes.x - $planes.y * e.y + "
            "$planes.z);\n");
    else
        writer.add(R"(    vec2 w = vec2($planes.x + $planes.y * e.x, $planes.x + $planes.y * e.y);
    vec2 depths = vec2(1.0 / w.x * 0.999998, endless);
    if (w.y > 0.0) { depths.y = 1.0 / w.y * 1.000002; }
)");
    // One return, as in shader_snippet().
    writer.add("    if (range.x > range.y) { depths = vec2(endless, -endless); }\n    return depths;\n}\n");
}

}  // namespace detail

/// Returns a shader that reduces a depth texture to Z bounds, minimum and maximum, or an Error that names the
/// limit that the options break. What holds after it is what holds after reduce_depth(), the rounding being
/// that of floats.
///
/// compute   one group of 64 threads a tile writes a vec2 to the storage buffer `z_bounds`: dispatch
///           (tiles_x, tiles_y, 1)
/// fragment  one fragment a tile, a loop over its pixels: draw a triangle over a tiles_x by tiles_y target of
///           two 32-bit floats, whose row 0 is the tiles' row 0
///
/// Source: Tiled Shading, section 6.3.
inline Result<ShaderText> reduce_shader(const ReduceShaderOptions& options = {}) {
    using namespace detail;
    if (const auto error = refuse(options)) return *error;
    ShaderWriter writer(options.language, options.prefix);
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}, {"vec4", "planes"}};
    if (options.viewport_corner) constants.push_back({"ivec2", "corner"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    const std::string samples = std::to_string(options.samples);
    const bool compute = options.stage == ShaderStage::compute, many = options.samples > 1;
    writer.declare_opaque({"depth", ShaderResource::texture_2d, options.depth, TexelFormat::r32f, 4},
                          {.glsl = many ? "sampler2DMS" : "sampler2D",
                           .hlsl = many ? "Texture2DMS<float, " + samples + ">" : "Texture2D<float>",
                           .wgsl = many ? "texture_multisampled_2d<f32>" : "texture_2d<f32>"});
    if (compute) writer.declare_storage("z_bounds", "vec2", "writeonly", options.z_bounds, 8);
    add_depth_sample(writer, options);
    add_view_depths(writer, options);

    // The samples of one pixel of a tile, in the order of rows.
    const Dialect& dialect = writer.dialect();
    writer.add("\nvoid $pixel(inout uvec2 range, uvec2 first, uvec2 size, uint i) {\n"
               "    uvec2 pixel = first + uvec2(i % size.x, i / size.x);\n");
    if (options.flip_y) writer.add("    pixel.y = $grid.w - 1u - pixel.y;\n");
    writer.add(std::string("    ivec2 at = ivec2(int(pixel.x), int(pixel.y))") +
               (options.viewport_corner ? " + $corner;\n" : ";\n"));
    if (many) writer.add("    for (int s = 0; s < " + samples + "; s += 1)");
    writer.add("    { $sample(&range, " + writer.read_texel("$depth", "at", many ? "s" : "0") +
               ".x); }\n}\n");

    const std::string area = "    uvec2 first = tile * $grid.x;\n"
                             "    uvec2 size = min(uvec2($grid.x, $grid.x), $grid.zw - first);\n"
                             "    uvec2 range = uvec2(0xffffffffu, 0u);\n";
    if (compute) {
        writer.add("\n");
        writer.declare_shared("range_ends", 2, true);
        writer.add("\nvoid $run(uvec2 tile, uint thread) {\n" + area + "    if (thread == 0u) {\n        " +
                   writer.store_atomic("$range_ends[0]", "range.x") + ";\n        " +
                   writer.store_atomic("$range_ends[1]", "range.y") +
                   R"(;
    }
    sync_group();
    for (uint i = thread; i < size.x * size.y; i += 64u) { $pixel(&range, first, size, i); }
    atomicMin(&$range_ends[0], range.x);
    atomicMax(&$range_ends[1], range.y);
    sync_group();
    if (thread == 0u) { $z_bounds[tile.y * $grid.y + tile.x] = $view_depths(uvec2()" +
                   writer.load_atomic("$range_ends[0]") + ", " + writer.load_atomic("$range_ends[1]") +
                   ")); }\n}\n");
        add_compute_main(writer, 64);
    } else {
        writer.add("\nvec2 $reduce(uvec2 tile) {\n" + area +
                   "    for (uint i = 0u; i < size.x * size.y; i += 1u) { $pixel(&range, first, size, i); }\n"
                   "    return $view_depths(range);\n}\n\n");
        writer.add(dialect.wgsl
                       ? "@fragment\nfn main(@builtin(position) position : vec4f) -> @location(0) vec2f {\n"
                         "    return $reduce(vec2u(position.xy));\n}\n"
                   : dialect.hlsl ? "float2 main(float4 position : SV_Position) : SV_Target {\n"
                                    "    return $reduce(uint2(position.xy));\n}\n"
                                  : std::string(dialect.vulkan ? "layout(location = 0) " : "") +
                                        "out vec2 $z_bounds;\n\nvoid main() {\n"
                                        "    $z_bounds = $reduce(uvec2(gl_FragCoord.xy));\n}\n");
    }
    return writer.finish();
}

/// Returns the footprints of the lights in view, in ascending order of id: the input of build_shader(). A spot's has its
/// own rectangle and its least sphere.
/// `lights` as for Binner::bin(). Errors as there.
template <class LightRange>
Result<std::vector<ShaderFootprint>> shader_footprints(const View& view, const LightRange& lights) {
    const detail::DefaultFloatEnvironment environment;
    const auto& source = detail::as_lights(lights);
    if (const auto error = detail::refuse(source)) return *error;
    Footprints<Footprint::rectangle, true> footprints;
    footprints.project(machine_isa(), view, source, Parallel{});
    const detail::FootprintArrays& in = footprints.arrays();
    const detail::Camera& camera = detail::camera_of(view);
    std::vector<ShaderFootprint> out;
    for (std::uint32_t i = 0; i < footprints.visible(); ++i) {
        Sphere sphere;
        if constexpr (std::remove_cvref_t<decltype(source)>::spots)
            sphere = source.view_sphere(source.array[in.ids[i]]);  // the least one
        else
            sphere = detail::load_sphere(in.spheres + in.ids[i]);
        const detail::TestedLight light(camera, sphere);
        out.push_back({in.ids[i], in.x0[i], in.y0[i], in.x1[i], in.y1[i], light.reach2, light.x, light.y,
                       light.z, sphere.radius});
    }
    return out;
}

/// The two sides of a column or row of tiles, as slopes (perspective) or view-space coordinates.
struct ShaderEdges {
    float low, high;
};

/// Returns the sides of all columns and then of all rows: what build_shader() reads for box, in the buffer `z_bounds`
/// behind the bounds of all tiles, or with clusters behind the slices' depths.
inline std::vector<ShaderEdges> shader_edges(const View& view) {
    const detail::DefaultFloatEnvironment environment;
    std::vector<ShaderEdges> edges;
    const detail::Camera& camera = detail::camera_of(view);
    for (const detail::ImageAxis* axis : {&camera.x, &camera.y})
        for (int tile = 0; tile < axis->tiles; ++tile) {
            ShaderEdges sides;
            detail::tile_edges(*axis, tile, sides.low, sides.high);
            edges.push_back(sides);
        }
    return edges;
}

/// Returns the depths of the slices: with clusters, what build_shader() reads in place of the tiles' Z bounds. A margin of
/// the slices is in them; a light that just reaches its end may then be listed by only one of the shader and the Binner.
inline std::vector<ShaderEdges> shader_slabs(const Slices& slices) {
    const detail::SliceTable& table = detail::table_of(slices);
    std::vector<ShaderEdges> slabs;
    float low = -detail::infinity;
    for (const float boundary : table.boundaries()) {
        slabs.push_back({low, table.farther(boundary)});
        low = table.nearer(boundary);
    }
    slabs.push_back({low, detail::infinity});
    return slabs;
}

/// Returns one of the shaders that build the grid of the footprints, a group of 64 threads a tile testing
/// every light, or an Error that names the limit that the options break. After the three passes, with a
/// barrier between them, `tiles` and `lists` hold what Binner's grid has in ranges() and ids() (32-bit
/// ids), and `total` the number of entries that there are; 2^32 - 1 stands for that many and more. Where `room` is
/// less, the first `room` entries are listed and the other total - room are not: the tiles from the one that does not
/// fit on have shorter lists or none, and nothing is written beyond `room`. Build again with more room, or where no
/// buffer has as much, with larger tiles or fewer slices.
///
/// none      the same entries as the Binner's
/// interval  the same, the device's sums being correctly rounded
/// box       the same but for the device's rounding of sums and products: no light of the exact set is
///           missing, and none is listed whose distance from the box exceeds its radius by more than 2^-19 of it
/// clusters  the same of cells of tiles and slices; `none` tests the slices' depths as interval does
///
/// That is of spheres. Spots have the Binner's rectangles, but in these the least sphere around each is tested, see
/// least_sphere(), where a Binner tests the cone. No spot that meets a cell is missing. Without depth test and clusters
/// the entries are the Binner's. With interval, or clusters without box, they are the Binner's (but for those that only
/// its margins for rounding list) and more. With box neither has all of the other's: a box beyond the least sphere, which
/// is not listed here, may meet both the ball and the half spaces around the cone, which is what a Binner tests.
inline Result<ShaderText> build_shader(const BuildShaderOptions& options = {}) {
    using namespace detail;
    if (const auto error = refuse(options)) return *error;
    ShaderWriter writer(options.language, options.prefix);
    const bool clusters = options.slicing == Slicing::clusters, box = options.depth_test == DepthTest::box,
               depths = clusters || options.depth_test != DepthTest::none,
               max_only = options.max_only && !clusters, fill = options.pass == BuildPass::fill;
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}};
    if (options.pass == BuildPass::offsets) {
        writer.declare_constants(constants, options.grid, options.push_constants);
        writer.declare_storage("tiles", "uvec2", "", options.tiles, 8);
        writer.declare_storage("total", "uint", "writeonly", options.total, 4);
        writer.add("\n");
        writer.declare_shared("sums", 128, false);
        writer.add(R"(
// Each thread sums a run of tiles; the sums of the runs before it are added up (Hillis, Steele 1986). A sum that 32 bits
// don't hold stays at the greatest that they do: min(number, ~sum) is what can be added.
void $run(uvec2 group, uint thread) {
    uint tiles = $grid.x * $grid.y;
    uint each = (tiles + 127u) / 128u;
    uint first = min(thread * each, tiles);
    uint last = min(first + each, tiles);
    uint sum = 0u;
    for (uint i = first; i < last; i += 1u) { sum += min($tiles[i].y, ~sum); }
    $sums[thread] = sum;
    sync_group();
    for (uint distance = 1u; distance < 128u; distance *= 2u) {
        uint before = 0u;
        if (thread >= distance) { before = $sums[thread - distance]; }
        sync_group();
        $sums[thread] += min(before, ~$sums[thread]);
        sync_group();
    }
    uint offset = 0u;
    if (thread > 0u) { offset = $sums[thread - 1u]; }
    for (uint tile = first; tile < last; tile += 1u) {
        uint count = $tiles[tile].y;
        uint begin = min(offset, $grid.w);
        $tiles[tile] = uvec2(begin, min(count, $grid.w - begin));
        offset += min(count, ~offset);
    }
    if (thread == 127u) { $total[0] = offset; }
}
)");
        add_compute_main(writer, 128);
        return writer.finish();
    }

    if (box || clusters) constants.push_back({"vec4", "planes"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    writer.add(
        "struct $footprint {\n    uint id;\n    uint low;\n    uint high;\n    float reach2;\n    vec4 "
        "sphere;\n};\n");
    writer.declare_storage("footprints", "$footprint", "readonly", options.footprints, 32);
    if (depths) writer.declare_storage("z_bounds", "vec2", "readonly", options.z_bounds, 8);
    writer.declare_storage("tiles", "uvec2", fill ? "readonly" : "writeonly", options.tiles, 8);
    if (fill) writer.declare_storage("lists", "uint", "writeonly", options.lists, 4);

    // Whether a light may reach a tile's cell.
    writer.add(std::string("\nbool $meets($footprint f, uvec2 tile") + (depths ? ", vec2 z" : "") +
               (box ? ", vec4 cell" : "") + ") {\n" + R"(    uvec2 low = uvec2(f.low & 0xffffu, f.low >> 16u);
    uvec2 high = uvec2(f.high & 0xffffu, f.high >> 16u);
    bool met = tile.x >= low.x && tile.x <= high.x && tile.y >= low.y && tile.y <= high.y;
)");
    if (depths)
        writer.add(std::string("    if (f.sphere.z - f.sphere.w > z.y") +
                   (max_only ? "" : " || f.sphere.z + f.sphere.w < z.x") + ") { met = false; }\n");
    if (box)
        writer.add(R"(    float x = max(max(cell.x - f.sphere.x, f.sphere.x - cell.y), 0.0);
    float y = max(max(cell.z - f.sphere.y, f.sphere.y - cell.w), 0.0);
    float d = max(max(z.x - f.sphere.z, f.sphere.z - z.y), 0.0);
    if (x * x + y * y + d * d > f.reach2) { met = false; }
)");
    writer.add("    return met;\n}\n\n");
    if (box && !options.orthographic)  // the sides are slopes
        writer.add(R"(float $least(float side, vec2 z) {
    float depth = z.x;
    if (side < 0.0) { depth = z.y; }
    return side * depth - 7.5231638e-37;
}

float $greatest(float side, vec2 z) {
    float depth = z.x;
    if (side > 0.0) { depth = z.y; }
    return side * depth + 7.5231638e-37;
}

)");
    writer.declare_shared("hits", 2, true);
    writer.add("\nvoid $run(uvec2 group, uint thread) {\n    uvec2 tile = group;\n"
               "    uint place = tile.y * $grid.x + tile.x;\n");
    if (clusters) writer.add("    uint slice = tile.y / uint($planes.z);\n    tile.y %= uint($planes.z);\n");
    std::string arguments = "tile";
    if (depths) {
        // NaN tests nothing. It is told by its bits, as compilers may take it that no float is one.
        const auto if_nan = [](const char* end) {
            return "if ((floatBitsToUint(z." + std::string(end) + ") & 0x7fffffffu) > 0x7f800000u) ";
        };
        writer.add(endless_lines + ("    vec2 z = $z_bounds[" + std::string(clusters ? "slice" : "place")) +
                   "];\n    " + (max_only ? "z.x = -endless;" : if_nan("x") + "{ z.x = -endless; }") +
                   "\n    " + if_nan("y") + "{ z.y = endless; }\n    bool lit = z.x <= z.y;\n");
        arguments += ", z";
    }
    if (box) {  // see detail/cell_boxes.hpp
        writer.add(R"(    z.x = min(max(z.x, $planes.x), 3.4028234e38);
    z.y = min(z.y, $planes.y);
    uint edges = )" +
                   std::string(clusters ? "$grid.y / uint($planes.z)" : "$grid.x * $grid.y") +
                   R"(;
    vec4 cell = vec4($z_bounds[edges + tile.x], $z_bounds[edges + $grid.x + tile.y]);
)");
        if (!options.orthographic)
            writer.add("    cell = vec4($least(cell.x, z), $greatest(cell.y, z), $least(cell.z, z), "
                       "$greatest(cell.w, z));\n");
        arguments += ", cell";
    }
    if (fill) writer.add("    uvec2 list = $tiles[place];\n");
    writer.add("    uint count = 0u;\n    for (uint first = 0u; first < $grid.z; first += 64u) {\n"
               "        if (thread < 2u) { " +
               writer.store_atomic("$hits[thread]", "0u") + R"(; }
        sync_group();
        uint i = first + thread;
        bool hit = false;
        if ()" +
               (depths ? "lit && " : "") + "i < $grid.z) { hit = $meets($footprints[i], " + arguments +
               R"(); }
        if (hit) { atomicOr(&$hits[thread >> 5u], 1u << (thread & 31u)); }
        sync_group();
)");
    const std::string low_hits = writer.load_atomic("$hits[0]"), high_hits = writer.load_atomic("$hits[1]");
    if (fill)
        writer.add(
            "        uint before = (1u << (thread & 31u)) - 1u;\n        uint rank = count + uint(bitCount(" +
            writer.load_atomic("$hits[thread >> 5u]") +
            " & before));\n        if (thread >= 32u) { rank += uint(bitCount(" + low_hits +
            ")); }\n        if (hit && rank < list.y) { $lists[list.x + rank] = $footprints[i].id; }\n");
    writer.add("        count += uint(bitCount(" + low_hits + ")) + uint(bitCount(" + high_hits +
               "));\n        sync_group();\n    }\n");
    if (!fill) writer.add("    if (thread == 0u) { $tiles[place] = uvec2(0u, count); }\n");
    writer.add("}\n");
    add_compute_main(writer, 64);
    return writer.finish();
}

}}  // namespace lightbin
