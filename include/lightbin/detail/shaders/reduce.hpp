// SPDX-License-Identifier: MIT
// How reduce_shader() makes its text.
#pragma once

#include <lightbin/detail/shaders/writer.hpp>
#include <lightbin/shader_reduce.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

inline Result<ShaderText> reduce_shader(const ReduceOptions& options) {
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

}}  // namespace lightbin
