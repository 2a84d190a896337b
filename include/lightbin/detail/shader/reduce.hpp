// SPDX-License-Identifier: MIT
// How reduce_shader() makes its text.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/shader/writer.hpp>
#include <lightbin/shader_build.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

inline std::optional<Error> refuse(const ReduceShaderOptions& options) {
    const Dialect dialect = detail::dialect(options.language);
    if (auto error = refuse_common(options, {options.depth, options.z_bounds, options.grid})) return error;
    if (options.stage == ShaderStage::compute && !dialect.storage_buffers)
        return Error{ErrorCode::no_storage_buffers};
    if (options.samples < 1 || options.samples > 8)
        return Error{ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(options.samples), 8};
    if (options.samples > 1 && options.language == ShaderLanguage::essl_300)
        return Error{ErrorCode::no_multisample_textures};
    return std::nullopt;
}

/// Adds the function `sample`, which widens a tile's range of depths by one depth, as reduce_depth() does. Depths are compared
/// by the bits of the float, taken as an integer: from 0 to 1 they are in the same order, and shader compilers may assume that
/// no float is NaN. Depths below 0 and above 1 (0x3f800000) are clamped. NaN, whose bits are above infinity's (0x7f800000) but
/// for the sign, could be any depth and widens the range to 0..1.
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

/// Adds the function `view_depths`, which converts a tile's range of window depths to view depths, rounded outward. In units of
/// u = 2^-24 the relative errors are: 3u in `far_end` and `slope`, since View's depths are floats; 2u in their product and
/// sum; 1u in e, which is exact where it is small; up to 5u in the device's reciprocal. That is 11u, and the factors allow
/// 2^-19 = 32u. Orthographic views allow 2^-20 of the sum of the two planes' depths.
inline void add_view_depths(ShaderWriter& writer, const ReduceShaderOptions& options) {
    writer.add(std::string("\nvec2 $view_depths(uvec2 range) {\n") + infinity_lines);
    if (options.format == DepthFormat::float32)
        // Widens the range by two units in the last place, which is at least what reduce_depth() allows. Denormal depths,
        // which devices may flush to zero, become 0 or the least normal float.
        writer.add(R"(    uint first = 0u;
    if (range.x >= 0x00800002u) { first = range.x - 2u; }
    vec2 ends = vec2(uintBitsToFloat(first), uintBitsToFloat(clamp(range.y + 2u, 0x00800000u, 0x3f800000u)));
)");
    else  // widens the range by a step, 2^-24 for the texel's rounding, 2^-25 for the sum's (exact with 24 bits)
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
    // A single return statement: the compiler fxc takes an early return for a result that was not set, see add_next().
    writer.add("    if (range.x > range.y) { depths = vec2(endless, -endless); }\n    return depths;\n}\n");
}

}  // namespace detail

inline Result<ShaderText> reduce_shader(const ReduceShaderOptions& options) {
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

    // `pixel` widens a tile's range by the samples of pixel i. The tile's pixels are numbered row by row.
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
        writer.add_compute_main(64);
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

}}  // namespace lightbin
