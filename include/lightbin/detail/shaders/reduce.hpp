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
    const bool compute = !options.fragment, many = options.samples > 1,
               given = options.format == DepthFormat::view_depth, tilted = options.oblique && !given,
               window = !given && !tilted;
    if (const auto error = refuse_common(
            options, {options.depth, options.z_bounds, options.grid},
            {{compute && !dialect.storage_buffers, {ErrorCode::no_storage_buffers}},
             {options.samples < 1 || options.samples > 8,
              {ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(options.samples), 8}},
             {many && options.language == ShaderLanguage::essl_300, {ErrorCode::no_multisample_textures}}}))
        return *error;

    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}, {"vec4", "planes"}};
    if (options.viewport_corner || tilted) constants.push_back({"ivec2", "corner"});
    if (tilted) constants.push_back({"vec4", "tilt"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    const std::string samples = std::to_string(options.samples);
    writer.declare_opaque({"depth", ShaderResource::texture_2d, options.depth, TexelFormat::r32f, 4},
                          {.glsl = many ? "sampler2DMS" : "sampler2D",
                           .hlsl = many ? "Texture2DMS<float, " + samples + ">" : "Texture2D<float>",
                           .wgsl = many ? "texture_multisampled_2d<f32>" : "texture_2d<f32>"});
    if (compute) writer.declare_storage("z_bounds", "vec2", "writeonly", options.z_bounds, 8);

    writer.set({{"many", many}, {"skip_background", options.skip_background},
                {"reversed_z", options.reversed_z}, {"orthographic", options.orthographic},
                {"float32", options.format == DepthFormat::float32}, {"flip_y", options.flip_y},
                {"viewport_corner", options.viewport_corner}, {"given", given}, {"tilted", tilted},
                {"window", window}, {"inverse", tilted && !options.orthographic},
                {"negative", tilted && options.orthographic}});
    writer.set("background", given ? "0x7f800000u" : options.reversed_z ? "0u" : "0x3f800000u");
    // A step of the format, 2^-24 for its rounding, and with 16 bits 2^-25 for the sum's.
    writer.set("step", options.format == DepthFormat::unorm16 ? "1.535e-5" : "1.1920931e-7");
    writer.set("last", "clamp(range.y + 2u, 0x00800000u, 0x3f800000u)");
    writer.set("most", "min(uintBitsToFloat(range.y) + step, 1.0)");
    writer.set("nearest", "$planes.x - $planes.y * e.x - $planes.z");
    writer.set("farthest", "$planes.x - $planes.y * e.y + $planes.z");
    writer.set("ends", "uvec2(atomicLoad(&$range_ends[0]), atomicLoad(&$range_ends[1]))");
    writer.set("samples", samples);
    writer.set("parameter", tilted ? ", vec2 place" : "");
    writer.set("place", tilted ? ", place" : "");
    writer.set("texel", writer.read_texel("$depth", "at", many ? "s" : "0"));

    // `sample` widens a tile's range of depths by one depth, as reduce_depth() does. Depths are compared by the bits of
    // the float, taken as an integer: from 0 to 1 they are in the same order, and shader compilers may assume that no
    // float is NaN. Depths below 0 and above 1 (0x3f800000) are clamped. NaN, which without its sign has bits above
    // infinity's (0x7f800000), could be any depth and widens the range to 0..1.
    //
    // `view_depths` converts a tile's range of window depths to view depths, rounded outward. It has a single return
    // statement, because the HLSL compiler fxc complains of functions that return early. Floats are widened by two
    // units in the last place: at least as much as reduce_depth() does. Devices may flush denormals to zero, so a
    // denormal lower end becomes 0 and a denormal upper end the least normal float, 0x00800000. If e is a window
    // depth's distance from the far plane's, the view depth is 1 / (far_end + slope e) in perspective. In units of u =
    // 2^-24 the relative errors are: 3u in the constants `far_end` and `slope`, since View's depths are floats; 2u in
    // the product slope e and the sum; 1u in e, which is exact where e is small; up to 5u in the device's reciprocal.
    // That is 11u; the factors 0.999998 and 1.000002 allow 2^-19 = 32u. Orthographic views allow 2^-20 of the sum of
    // the two planes' depths. Infinity is made from a variable, because WGSL refuses it as a constant. A range without
    // samples has x > y.
    //
    // `pixel` widens a tile's range of window depths by the samples of the tile's pixel i, counted row by row.
    // `first_pixel` is TileSplit::first_pixel(). GridConstants says what the upper bits of `grid` tell of the view.
    //
    // View depths, and with an oblique near plane what reduce_constants() says, are compared as they are, negative ones
    // too. So `order` makes integers of floats, in the same order, and `number` floats of them.
    if (window)
        writer.add(R"(
void $sample(inout uvec2 range, float depth) {
    uint bits = floatBitsToUint(depth);
    if (bits == @background) { return; }        @if skip_background
    uint low = bits;
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
    else
        writer.add(R"(
uint $order(float value) {
    uint bits = floatBitsToUint(value);
    uint order = ~bits;
    if (bits < 0x80000000u) { order = bits + 0x80000000u; }
    return order;
}

float $number(uint order) {
    uint bits = ~order;
    if (order >= 0x80000000u) { bits = order - 0x80000000u; }
    return uintBitsToFloat(bits);
}

void $sample(inout uvec2 range, float depth@parameter) {
    uint bits = floatBitsToUint(depth);
    if (bits == @background) { return; }                                                @if skip_background
    bool known = (bits & 0x7fffffffu) <= 0x7f800000u;
    uvec2 orders = uvec2(0x007fffffu, 0xff800000u);                                     @if given
    if (known) { orders = uvec2($order(depth), $order(depth)); }                        @if given
    vec2 e = vec2(0.0, 1.0);                                                            @if tilted
    if (known) { e = vec2(clamp(depth, 0.0, 1.0), clamp(depth, 0.0, 1.0)); }            @if tilted reversed_z
    if (known) { e = vec2(1.0 - clamp(depth, 0.0, 1.0), 1.0 - clamp(depth, 0.0, 1.0)); }    @if tilted !reversed_z
    float far_end = $planes.x + $tilt.x * place.x + $tilt.y * place.y;                  @if tilted
    uvec2 orders = uvec2($order(far_end + $planes.y * e.x), $order(far_end + $planes.y * e.y));    @if tilted
    range = uvec2(min(range.x, orders.x), max(range.y, orders.y));
}
)");
    writer.add(R"(
vec2 $view_depths(uvec2 range) {
    uint infinity_bits = 0x7f800000u;
    float infinity = uintBitsToFloat(infinity_bits);
    vec2 ends = vec2($number(range.x), $number(range.y));                                       @if !window
    vec2 depths = ends * 0.999996;                                                              @if given
    if (ends.x < 0.0) { depths.x = ends.x * 1.000004; }                                         @if given
    if (ends.y > 0.0) { depths.y = ends.y * 1.000004; }                                         @if given
    float margin = $planes.z + $planes.y * @step;                                               @if tilted
    margin += 0.5 * (abs($tilt.x) + abs($tilt.y));                                              @if tilted many
    ends += vec2(-margin, margin);                                                              @if tilted
    vec2 depths = vec2(-ends.y, -ends.x);                                                       @if negative
    vec2 depths = vec2(infinity, infinity);                                                     @if inverse
    if (ends.y > 0.0) { depths.x = 1.0 / ends.y * 0.999998; }                                   @if inverse
    if (ends.x > 0.0) { depths.y = 1.0 / ends.x * 1.000002; }                                   @if inverse
    uint first = 0u;                                                                            @if window float32
    if (range.x >= 0x00800002u) { first = range.x - 2u; }                                       @if window float32
    vec2 ends = vec2(uintBitsToFloat(first), uintBitsToFloat(@last));                           @if window float32
    float step = @step;                                                                         @if window !float32
    vec2 ends = vec2(max(uintBitsToFloat(range.x) - step, 0.0), @most);                     @if window !float32
    vec2 e = ends.yx;                                                                           @if window reversed_z
    vec2 e = vec2(1.0 - ends.x, 1.0 - ends.y);                                                  @if window !reversed_z
    vec2 depths = vec2(@nearest, @farthest);                                                    @if window orthographic
    vec2 w = vec2($planes.x + $planes.y * e.x, $planes.x + $planes.y * e.y);                    @if window !orthographic
    vec2 depths = vec2(1.0 / w.x * 0.999998, infinity);                                         @if window !orthographic
    if (w.y > 0.0) { depths.y = 1.0 / w.y * 1.000002; }                                         @if window !orthographic
    if (range.x > range.y) { depths = vec2(infinity, -infinity); }
    return depths;
}

void $pixel(inout uvec2 range, uvec2 first, uvec2 size, uint i) {
    uvec2 pixel = first + uvec2(i % size.x, i / size.x);
    vec2 place = vec2(float(pixel.x), float(pixel.y)) + 0.5 - 0.5 * vec2(float($grid.z), float($grid.w));    @if tilted
    uint height = $grid.w;
    if (($grid.x & 0x40000000u) != 0u) {
        pixel = pixel.yx;
        height = $grid.z;
    }
    pixel.y = height - 1u - pixel.y;                                @if flip_y
    ivec2 at = ivec2(int(pixel.x), int(pixel.y));                   @if !viewport_corner
    ivec2 at = ivec2(int(pixel.x), int(pixel.y)) + $corner;         @if viewport_corner
    { $sample(&range, @texel.x@place); }                                          @if !many
    for (int s = 0; s < @samples; s += 1) { $sample(&range, @texel.x@place); }    @if many
}

uvec2 $first_pixel(uvec2 tile) {
    uint size = $grid.x & 0x3fffffffu;
    uvec2 first = tile * size;
    if ($grid.x >= 0x80000000u) {
        uvec2 tiles = uvec2($grid.y, size);
        first = (2u * tile * $grid.zw + tiles - uvec2(1u, 1u)) / (2u * tiles);
    }
    return min(first, $grid.zw);
}

)");
    if (!compute) {
        writer.add(R"(vec2 $reduce(uvec2 tile) {
    uvec2 first = $first_pixel(tile);
    uvec2 size = $first_pixel(tile + uvec2(1u, 1u)) - first;
    uvec2 range = uvec2(0xffffffffu, 0u);
    for (uint i = 0u; i < size.x * size.y; i += 1u) { $pixel(&range, first, size, i); }
    return $view_depths(range);
}

)");
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
    writer.declare_shared("range_ends", 2, true);
    writer.add(R"(
void $run(uvec2 tile, uint thread) {
    uvec2 first = $first_pixel(tile);
    uvec2 size = $first_pixel(tile + uvec2(1u, 1u)) - first;
    uvec2 range = uvec2(0xffffffffu, 0u);
    if (thread == 0u) {
        atomicStore(&$range_ends[0], range.x);
        atomicStore(&$range_ends[1], range.y);
    }
    sync_group();
    for (uint i = thread; i < size.x * size.y; i += 64u) { $pixel(&range, first, size, i); }
    atomicMin(&$range_ends[0], range.x);
    atomicMax(&$range_ends[1], range.y);
    sync_group();
    if (thread == 0u) { $z_bounds[tile.y * $grid.y + tile.x] = $view_depths(@ends); }
}
)");
    writer.add_compute_main(64);
    return writer.finish();
}

}}  // namespace lightbin
