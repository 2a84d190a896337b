// SPDX-License-Identifier: MIT
// How reduce_shader() and build_shader() make their texts, and the data that the shaders read.
#pragma once

#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/engine/cell_boxes.hpp>
#include <lightbin/detail/project/footprints.hpp>
#include <lightbin/detail/shader/writer.hpp>
#include <lightbin/shader_build.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

inline Result<ShaderText> reduce_shader(const ReduceShaderOptions& options) {
    using namespace detail;
    ShaderWriter writer(options.language, options.prefix);
    const Dialect& dialect = writer.dialect;
    const bool compute = options.stage == ShaderStage::compute, many = options.samples > 1;
    if (const auto error = refuse_common(
            options, {options.depth, options.z_bounds, options.grid},
            {{compute && !dialect.storage_buffers, {ErrorCode::no_storage_buffers}},
             {options.samples < 1 || options.samples > 8,
              {ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(options.samples), 8}},
             {many && options.language == ShaderLanguage::essl_300, {ErrorCode::no_multisample_textures}}}))
        return *error;

    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}, {"vec4", "planes"}};
    if (options.viewport_corner) constants.push_back({"ivec2", "corner"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    const std::string samples = std::to_string(options.samples);
    writer.declare_opaque({"depth", ShaderResource::texture_2d, options.depth, TexelFormat::r32f, 4},
                          {.glsl = many ? "sampler2DMS" : "sampler2D",
                           .hlsl = many ? "Texture2DMS<float, " + samples + ">" : "Texture2D<float>",
                           .wgsl = many ? "texture_multisampled_2d<f32>" : "texture_2d<f32>"});
    if (compute) writer.declare_storage("z_bounds", "vec2", "writeonly", options.z_bounds, 8);

    // `sample` widens a tile's range of depths by one depth, as reduce_depth() does. Depths are compared by the bits of
    // the float, taken as an integer: from 0 to 1 they are in the same order, and shader compilers may assume that no
    // float is NaN. Depths below 0 and above 1 (0x3f800000) are clamped. NaN, which without its sign has bits above
    // infinity's (0x7f800000), could be any depth and widens the range to 0..1.
    writer.add("\nvoid $sample(inout uvec2 range, float depth) {\n    uint bits = floatBitsToUint(depth);\n");
    if (options.skip_background)
        writer.add(options.reversed_z ? "    if (bits == 0u) { return; }\n"
                                      : "    if (bits == 0x3f800000u) { return; }\n");
    writer.add(R"(    uint low = bits;
    if ((bits & 0x7fffffffu) > 0x7f800000u) {
        low = 0u;
        bits = 0x3f800000u;
    } else if (bits > 0x7f800000u) {
        low = 0u;
        bits = 0u;
    }
    range = uvec2(min(range.x, min(low, 0x3f800000u)), max(range.y, min(bits, 0x3f800000u)));
}

vec2 $view_depths(uvec2 range) {
    uint infinity_bits = 0x7f800000u;
    float infinity = uintBitsToFloat(infinity_bits);
)");
    // The shader's function `view_depths` converts a tile's range of window depths to view depths, rounded outward. If
    // e is a window depth's distance from the far plane's, the view depth is 1 / (far_end + slope e) in perspective.
    // In units of u = 2^-24 the relative errors are: 3u in the constants `far_end` and `slope`, since View's depths are
    // floats; 2u in the product slope e and the sum; 1u in e, which is exact where e is small; up to 5u in the device's
    // reciprocal. That is 11u; the factors 0.999998 and 1.000002 allow 2^-19 = 32u. Orthographic views allow 2^-20
    // of the sum of the two planes' depths. Infinity is made from a variable, because WGSL refuses it as a constant.
    if (options.format == DepthFormat::float32)
        // Widens the range of window depths, given as the bits of floats, by two units in the last place: at least as
        // much as reduce_depth() does. Devices may flush denormals to zero, so a denormal lower end becomes 0 and a
        // denormal upper end the least normal float, 0x00800000.
        writer.add(R"(    uint first = 0u;
    if (range.x >= 0x00800002u) { first = range.x - 2u; }
    vec2 ends = vec2(uintBitsToFloat(first), uintBitsToFloat(clamp(range.y + 2u, 0x00800000u, 0x3f800000u)));
)");
    else  // widens the range by a step of the format, 2^-24 for its rounding, and with 16 bits 2^-25 for the sum's
        writer.add(std::string("    float step = ") +
                   (options.format == DepthFormat::unorm24 ? "1.1920931e-7" : "1.535e-5") + R"(;
    vec2 ends = vec2(max(uintBitsToFloat(range.x) - step, 0.0), min(uintBitsToFloat(range.y) + step, 1.0));
)");
    writer.add(options.reversed_z ? "    vec2 e = ends.yx;\n"
                                  : "    vec2 e = vec2(1.0 - ends.x, 1.0 - ends.y);\n");
    writer.add(options.orthographic
                   ? "    vec2 depths = vec2($planes.x - $planes.y * e.x - $planes.z, "
                     "$planes.x - $planes.y * e.y + $planes.z);\n"
                   : R"(    vec2 w = vec2($planes.x + $planes.y * e.x, $planes.x + $planes.y * e.y);
    vec2 depths = vec2(1.0 / w.x * 0.999998, infinity);
    if (w.y > 0.0) { depths.y = 1.0 / w.y * 1.000002; }
)");
    // `view_depths` has a single return statement, because the HLSL compiler fxc complains of functions that return
    // early. A range without samples has x > y. `pixel` widens a tile's `range` of window depths by the depth samples
    // of the tile's pixel i, counted row by row.
    writer.add(R"(    if (range.x > range.y) { depths = vec2(infinity, -infinity); }
    return depths;
}

void $pixel(inout uvec2 range, uvec2 first, uvec2 size, uint i) {
    uvec2 pixel = first + uvec2(i % size.x, i / size.x);
)");
    if (options.flip_y) writer.add("    pixel.y = $grid.w - 1u - pixel.y;\n");
    writer.add(std::string("    ivec2 at = ivec2(int(pixel.x), int(pixel.y))") +
               (options.viewport_corner ? " + $corner;\n" : ";\n"));
    if (many) writer.add("    for (int s = 0; s < " + samples + "; s += 1)");
    writer.add("    { $sample(&range, " + writer.read_texel("$depth", "at", many ? "s" : "0") + ".x); }\n}\n\n");

    if (compute) writer.declare_shared("range_ends", 2, true);
    writer.add(compute ? "\nvoid $run(uvec2 tile, uint thread) {\n" : "vec2 $reduce(uvec2 tile) {\n");
    writer.add(R"(    uvec2 first = tile * $grid.x;
    uvec2 size = min(uvec2($grid.x, $grid.x), $grid.zw - first);
    uvec2 range = uvec2(0xffffffffu, 0u);
)");
    if (compute) {
        writer.add(R"(    if (thread == 0u) {
        atomicStore(&$range_ends[0], range.x);
        atomicStore(&$range_ends[1], range.y);
    }
    sync_group();
    for (uint i = thread; i < size.x * size.y; i += 64u) { $pixel(&range, first, size, i); }
    atomicMin(&$range_ends[0], range.x);
    atomicMax(&$range_ends[1], range.y);
    sync_group();
    if (thread == 0u) {)"
                   " $z_bounds[tile.y * $grid.y + tile.x] = "
                   "$view_depths(uvec2(atomicLoad(&$range_ends[0]), atomicLoad(&$range_ends[1]))); }\n}\n");
        writer.add_compute_main(64);
        return writer.finish();
    }
    writer.add("    for (uint i = 0u; i < size.x * size.y; i += 1u) { $pixel(&range, first, size, i); }\n"
               "    return $view_depths(range);\n}\n\n");
    writer.add(dialect.webgpu
                   ? "@fragment\nfn main(@builtin(position) position : vec4f) -> @location(0) vec2f {\n"
                     "    return $reduce(vec2u(position.xy));\n}\n"
               : dialect.hlsl ? "float2 main(float4 position : SV_Position) : SV_Target {\n"
                                "    return $reduce(uint2(position.xy));\n}\n"
                              : std::string(dialect.vulkan ? "layout(location = 0) " : "") +
                                    "out vec2 $z_bounds;\n\nvoid main() {\n"
                                    "    $z_bounds = $reduce(uvec2(gl_FragCoord.xy));\n}\n");
    return writer.finish();
}

template <class LightRange>
Result<std::vector<ShaderFootprint>> shader_footprints(const View& view, const LightRange& lights) {
    const detail::DefaultFloatEnvironment environment;
    const auto& source = detail::as_lights(lights);
    constexpr detail::LightKind kind = std::remove_cvref_t<decltype(source)>::kind;
    static_assert(kind != detail::LightKind::mixed,
                  "lightbin: shader_footprints() takes one array of lights, not lights()");
    if (const auto error = detail::refuse(source)) return *error;
    Footprints<Footprint::rectangle, true> footprints;
    footprints.project(machine_isa(), view, source, Parallel{});
    const detail::FootprintArrays& in = footprints.arrays();
    const detail::Camera& camera = detail::camera_of(view);
    std::vector<ShaderFootprint> out;
    for (std::uint32_t i = 0; i < footprints.visible(); ++i) {
        Sphere sphere;
        if constexpr (kind != detail::LightKind::sphere)
            sphere = source.view_sphere(source.array[in.ids[i]]);  // a sphere around the spot or box
        else
            sphere = detail::load_sphere(in.view_lights.spheres + in.ids[i]);
        const detail::TestedLight light(camera, sphere);
        out.push_back({in.ids[i], in.x0[i], in.y0[i], in.x1[i], in.y1[i], light.reach2, light.x, light.y,
                       light.z, sphere.radius});
    }
    return out;
}

inline std::vector<ShaderEdges> shader_edges(const View& view) {
    const detail::DefaultFloatEnvironment environment;
    std::vector<ShaderEdges> edges;
    const detail::Camera& camera = detail::camera_of(view);
    for (const detail::ImageAxis* axis : {&camera.x, &camera.y})
        for (int tile = 0; tile < axis->tiles; ++tile) {
            edges.emplace_back();
            detail::tile_edges(*axis, tile, edges.back().low, edges.back().high);
        }
    return edges;
}

inline Result<ShaderText> build_shader(const BuildShaderOptions& options) {
    using namespace detail;
    ShaderWriter writer(options.language, options.prefix);
    const bool clusters = options.slicing == Slicing::clusters, box = options.depth_test == DepthTest::box,
               depths = clusters || options.depth_test != DepthTest::none,
               max_only = options.max_only && !clusters, fill = options.pass == BuildPass::fill;
    if (const auto error = refuse_common(
            options, {options.footprints, options.z_bounds, options.tiles, options.lists, options.total, options.grid},
            {{!writer.dialect.storage_buffers, {ErrorCode::no_storage_buffers}},
             {options.depth_test == DepthTest::split_box, {ErrorCode::no_split_box_shader}},
             {options.slicing == Slicing::z_bins || (clusters && options.depth_test == DepthTest::interval),
              {ErrorCode::no_such_slicing_shader}}}))
        return *error;

    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}};
    if ((box || clusters) && options.pass != BuildPass::offsets) constants.push_back({"vec4", "planes"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    if (options.pass == BuildPass::offsets) {
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
        writer.add_compute_main(128);
        return writer.finish();
    }

    writer.add("struct $footprint {\n    uint id;\n    uint low;\n    uint high;\n    float reach2;\n"
               "    vec4 sphere;\n};\n");
    writer.declare_storage("footprints", "$footprint", "readonly", options.footprints, 32);
    if (depths) writer.declare_storage("z_bounds", "vec2", "readonly", options.z_bounds, 8);
    writer.declare_storage("tiles", "uvec2", fill ? "readonly" : "writeonly", options.tiles, 8);
    if (fill) writer.declare_storage("lists", "uint", "writeonly", options.lists, 4);

    // `meets` tells whether a light may reach the cell of a tile.
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
    // In perspective the sides of a cell are slopes. `least` and `greatest` return the least and the greatest
    // view-space coordinate of a side over the cell's depths.
    if (box && !options.orthographic)
        for (const bool least : {true, false})
            writer.add(std::string(least ? "float $least(" : "float $greatest(") + R"(float side, vec2 z) {
    float depth = z.x;
    if (side )" + (least ? "<" : ">") + R"( 0.0) { depth = z.y; }
    return side * depth )" + (least ? "-" : "+") + " 7.5231638e-37;\n}\n\n");
    writer.declare_shared("hits", 2, true);
    writer.add("\nvoid $run(uvec2 group, uint thread) {\n    uvec2 tile = group;\n"
               "    uint place = tile.y * $grid.x + tile.x;\n");
    if (clusters) writer.add("    uint slice = tile.y / uint($planes.z);\n    tile.y %= uint($planes.z);\n");
    std::string arguments = "tile";
    if (depths) {
        // A Z bound that is NaN excludes nothing. NaN is recognised by its bits: compilers may assume no float is NaN.
        const std::string nan = ") & 0x7fffffffu) > 0x7f800000u) ";
        writer.add("    uint infinity_bits = 0x7f800000u;\n    float infinity = uintBitsToFloat(infinity_bits);\n"
                   "    vec2 z = $z_bounds[" + std::string(clusters ? "slice" : "place") + "];\n    " +
                   (max_only ? "z.x = -infinity;" : "if ((floatBitsToUint(z.x" + nan + "{ z.x = -infinity; }") +
                   "\n    if ((floatBitsToUint(z.y" + nan + "{ z.y = infinity; }\n    bool lit = z.x <= z.y;\n");
        arguments += ", z";
    }
    if (box) {  // the cell's view-space box, as engine/cell_boxes.hpp computes it
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
    writer.add(R"(    uint count = 0u;
    for (uint first = 0u; first < $grid.z; first += 64u) {
        if (thread < 2u) { atomicStore(&$hits[thread], 0u); }
        sync_group();
        uint i = first + thread;
        bool hit = false;
        if ()" + std::string(depths ? "lit && " : "") +
               "i < $grid.z) { hit = $meets($footprints[i], " + arguments + R"(); }
        if (hit) { atomicOr(&$hits[thread >> 5u], 1u << (thread & 31u)); }
        sync_group();
)");
    if (fill)
        writer.add(R"(        uint before = (1u << (thread & 31u)) - 1u;
        uint rank = count + uint(bitCount(atomicLoad(&$hits[thread >> 5u]) & before));
        if (thread >= 32u) { rank += uint(bitCount(atomicLoad(&$hits[0]))); }
        if (hit && rank < list.y) { $lists[list.x + rank] = $footprints[i].id; }
)");
    writer.add("        count += uint(bitCount(atomicLoad(&$hits[0]))) + uint(bitCount(atomicLoad(&$hits[1])));\n"
               "        sync_group();\n    }\n");
    if (!fill) writer.add("    if (thread == 0u) { $tiles[place] = uvec2(0u, count); }\n");
    writer.add("}\n");
    writer.add_compute_main(64);
    return writer.finish();
}

}}  // namespace lightbin
