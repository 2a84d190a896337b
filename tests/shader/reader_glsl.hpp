// SPDX-License-Identifier: MIT
// A shader around the snippet that tells what every pixel reads, in GLSL or HLSL, and what it is of in every language.
#pragma once

#include "job.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Where depth is cut, by no law.
inline lightbin::Slices reader_slices() {
    constexpr float boundaries[] = {-1, 0, 2.5f, 4, 4.5f, 8, 12, 13};
    return *lightbin::Slices::from_boundaries(boundaries);
}

/// The depths that pixels have in turns: the boundaries, the floats beside them, and others.
inline std::vector<float> reader_depths() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> depths = {-0.0f, 1e-41f, -1e-41f, 3.3f, 7, 10, 1e30f, infinity, -infinity};
    const lightbin::Slices slices = reader_slices();
    for (const float boundary : slices.boundaries()) {
        depths.push_back(boundary);
        depths.push_back(std::nextafter(boundary, -infinity));
        depths.push_back(std::nextafter(boundary, infinity));
    }
    return depths;
}

/// Where in the window the viewport begins.
constexpr int corner_x = 3, corner_y = 5;

constexpr int result_binding = 2;  // compute

/// What is drawn is wider and higher than the viewport by so many pixels, which have no lights.
constexpr int beyond = 3;

/// The lights that a check goes through: in large pictures few, as it does so in every pixel. Masks with z-bins are
/// searched for each of them, and Mesa's llvmpipe ends a shader's loops after 65,535 rounds.
inline std::uint32_t checked_lights(const lightbin::ShaderOptions& options, std::uint32_t width) {
    return width > 100 ? 8 : options.masks ? 100 : 3000;
}

/// How many lights there are.
inline std::uint32_t reader_light_count(const lightbin::ShaderOptions& options) {
    using lightbin::IdWidth;
    if (options.masks) return 2000;
    return options.format.ids == IdWidth::u8 ? 200 : options.format.ids == IdWidth::u16 ? 50000 : 100000;
}

/// Lines that loop over a pixel's list. `loop` begins the loop.
inline std::string reader_loop(const std::string& loop, std::uint32_t lights) {
    return loop + R"(        hash = (hash ^ light.id) * 16777619u;
        count += 1u;
        sum += count * light.id;
        if (light.id < )" + std::to_string(lights) +
           "u) { listed += light.id + 1u; }\n    }\n";
}

/// The scales of the projection of reader_job(), and how far to the side in NDC each view is from the one before it.
constexpr float scale_x = 1.2f, scale_y = 1.7f, view_shift = 0.25f;

/// Lines that add to `hash` where a check or the window function says what is not so. `grid` is the pixel as the view
/// counts it. `listed` is the sum of 1 + id of the lights listed.
inline std::string reader_checks(const lightbin::ShaderOptions& options, std::uint32_t width) {
    const std::string prefix(options.prefix), lights = std::to_string(checked_lights(options, width)) + "u";
    const bool several = options.views > 1;
    const std::string view = several ? ", view)" : ")";
    std::string text;
    if (options.view_check)
        text += "    highp vec2 size = vec2(" + prefix + "grid.zw);\n    highp uvec2 grid = pixel;\n" +
                (options.viewport_corner ? "    grid -= uvec2(" + prefix + "corner);\n" : "") +
                (options.flip_y ? "    grid.y = " + prefix + "grid.w - 1u - grid.y;\n" : "") +
                "    bool inside = grid.x < " + prefix + "grid.z && grid.y < " + prefix + "grid.w" +
                (several ? " && view < " + std::to_string(options.views) + "u" : "") + R"(;
    highp vec2 ndc = 2.0 * (vec2(grid) + 0.5) / size - 1.0;
)" + (several ? "    ndc.x += " + std::to_string(view_shift) + " * float(view);\n" : "") +
                R"(    highp vec3 far_off = vec3(ndc / vec2()" + std::to_string(scale_x) + ", " +
                std::to_string(scale_y) + R"(), -1.0);
    highp vec3 aside = far_off + vec3(4.4 / ()" +
                std::to_string(scale_x) + R"( * size.x), 0.0, 0.0);
    highp vec3 below = far_off - vec3(0.0, 4.4 / ()" +
                std::to_string(scale_y) + R"( * size.y), 0.0);
    if (inside && !)" +
                prefix + "check_view(pixel, 7.0 * far_off" + view + ") hash += 1u;\n    if (inside && !" +
                prefix + "check_view(pixel, far_off * 0.11" + view + ") hash += 2u;\n    if (inside && " +
                prefix + "check_view(pixel, far_off * 0.09" + view + ") hash += 4u;\n    if (inside && " +
                prefix + "check_view(pixel, 7.0 * aside" + view + ") hash += 8u;\n    if (inside && " +
                prefix + "check_view(pixel, 7.0 * below" + view + ") hash += 16u;\n    if (inside && " +
                prefix + "check_view(pixel, -7.0 * far_off" + view + ") hash += 32u;\n";
    if (options.view_check && several)
        text += "    if (view >= " + std::to_string(options.views) + "u && " + prefix +
                "check_view(pixel, 7.0 * far_off, view)) hash += 256u;\n";
    if (options.list_check)
        text += "    " + prefix + "for_each_missing(other, " + lights + ", pixel, depth" + view +
                " listed += other.id + 1u;\n    if (listed != " +
                std::to_string(checked_lights(options, width) * (checked_lights(options, width) + 1) / 2) +
                "u) hash += 64u;\n";
    if (options.window)
        text += "    if (" + prefix + "window(3.0, 3.0) != 0.0 || " + prefix +
                "window(0.0, 3.0) != 1.0 || abs(" + prefix +
                "window(1.5, 3.0) - 0.87890625) > 1e-5) hash += 128u;\n";
    return text;
}

/// What reader_text() returns, in GLSL or HLSL.
inline std::string reader_glsl(const lightbin::ShaderOptions& options, const lightbin::ShaderText& snippet,
                               Stage stage, std::uint32_t width, std::uint32_t height, bool multiview) {
    const lightbin::detail::Dialect dialect = lightbin::detail::Dialect{options.language};
    const std::string prefix(options.prefix), binding = std::to_string(result_binding);
    const auto pair = [](auto x, auto y) {
        return "uvec2(" + std::to_string(x) + "u, " + std::to_string(y) + "u)";
    };
    std::string text = version_line(options.language);
    if (multiview && !dialect.hlsl)
        text += std::string("#extension ") + (dialect.vulkan ? "GL_EXT_multiview" : "GL_OVR_multiview2") +
                " : require\n";
    const bool sliced = options.slicing != lightbin::Slicing::none;
    // A device's logarithm may be as wrong as it likes.
    if (sliced && options.heat_map) text += "#define log2(x) (0.6 * log2(x) - 1.0)\n";
    text += snippet.text + "\n";
    if (dialect.hlsl)
        text += "#define highp\n#define uvec2 uint2\n#define uvec4 uint4\n#define uintBitsToFloat asfloat\n"
                "#define vec2 float2\n#define vec3 float3\n";
    const std::vector<float> depths = reader_depths();
    std::string depth = "0.0", words;
    for (const float value : depths)
        words += (words.empty() ? "" : ", ") + std::to_string(std::bit_cast<std::uint32_t>(value)) + "u";
    if (sliced) {
        const std::string count = std::to_string(depths.size());
        const std::string of_pixel =
            options.viewport_corner ? "(pixel - " + pair(corner_x, corner_y) + ")" : "pixel";
        text += dialect.hlsl
                    ? "static const uint depths[" + count + "] = {" + words + "};\n"
                    : "const highp uint depths[" + count + "] = uint[" + count + "](" + words + ");\n";
        depth =
            "uintBitsToFloat(depths[(5u * " + of_pixel + ".x + 3u * " + of_pixel + ".y) % " + count + "u])";
    }
    const bool several = options.views > 1;
    const std::string view = several ? ", view" : "";
    text += several ? "\nuvec4 read_list(highp uvec2 pixel, highp uint view) {\n"
                    : "\nuvec4 read_list(highp uvec2 pixel) {\n";
    text += "    highp float depth = " + depth + R"(;
    highp uint hash = 2166136261u;
    highp uint sum = 0u;
    highp uint count = 0u;
    highp uint listed = 0u;
)" +
            reader_loop("    " + prefix + "for_each_light(light, pixel, depth" + view + ") {\n",
                        checked_lights(options, width));
    if (options.heat_map)
        text += "    if (" + prefix + "count(pixel, depth" + view + ") != count || " + prefix +
                "heat(pixel, depth, 8.0" + view + ").x > 1.0) hash += 1u;\n";
    text += reader_checks(options, width);
    text += "    highp uvec2 tile = " + prefix +
            "tile(pixel);\n    return uvec4(tile.x + (tile.y << 16u), count, hash, sum);\n}\n\n";

    // Without multiview, the number of a pixel's view is that of a band of rows.
    const std::string read = several && !multiview ? "read_band" : "read_list",
                      band = std::to_string(height / (options.views + 1)) + "u",
                      first_row = options.viewport_corner ? std::to_string(corner_y) + "u" : "0u";
    if (several && !multiview)
        text += "uvec4 read_band(highp uvec2 place) {\n    highp uint view = (place.y - " + first_row +
                ") / " + band + ";\n    return read_list(uvec2(place.x, place.y - view * " + band +
                "), view);\n}\n\n";
    if (stage == Stage::compute) {
        const std::string add_corner = options.viewport_corner ? " + " + pair(corner_x, corner_y) : "";
        const std::string size = pair(width, height);
        if (dialect.hlsl)
            text += "RWStructuredBuffer<uint4> result : register(u" + binding + ");\n" +
                    "[numthreads(8, 8, 1)] void main(uint3 id : SV_DispatchThreadID) {\n" +
                    "    uint2 pixel = id.xy;\n";
        else
            text += "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(std430, binding = " + binding +
                    ") writeonly buffer result_block {\n    highp uvec4 result[];\n};\n" +
                    "void main() {\n    highp uvec2 pixel = gl_GlobalInvocationID.xy;\n";
        return text + "    highp uvec2 size = " + size +
               ";\n    if (pixel.x < size.x && pixel.y < size.y)\n"
               "        result[pixel.y * size.x + pixel.x] = " +
               read + "(pixel" + add_corner + ");\n}\n";
    }
    const std::string less_corner = options.viewport_corner ? "" : " - " + pair(corner_x, corner_y);
    if (dialect.hlsl)
        return text + "uint4 main(float4 position : SV_Position" +
               (multiview ? ", uint view : SV_ViewID" : "") + ") : SV_Target {\n    return " + read +
               "(uint2(position.xy)" + less_corner + (multiview ? ", view" : "") + ");\n}\n";
    return text + (dialect.vulkan ? "layout(location = 0) " : "") +
           "out highp uvec4 colour;\nvoid main() {\n    colour = " + read + "(uvec2(gl_FragCoord.xy)" +
           less_corner +
           (!multiview       ? ""
            : dialect.vulkan ? ", uint(gl_ViewIndex)"
                             : ", gl_ViewID_OVR") +
           ");\n}\n";
}
