// SPDX-License-Identifier: MIT
// The shader of reader_glsl.hpp in WGSL.
#pragma once

#include "reader_glsl.hpp"

#include <lightbin/shader.hpp>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

/// The depth of `pixel`, of those in the array `depths`; without slicing none is read.
inline std::string wgsl_depth(const lightbin::ShaderOptions& options) {
    if (options.slicing == lightbin::Slicing::none) return "0.0";
    const std::string of_pixel = options.viewport_corner ? "(pixel - corner)" : "pixel";
    return "bitcast<f32>(depths[(5u * " + of_pixel + ".x + 3u * " + of_pixel + ".y) % " +
           std::to_string(reader_depths().size()) + "u])";
}

/// reader_checks() in WGSL, `$` being the prefix. Within, `@` is the argument for the view, where there are several.
inline std::string wgsl_checks(const lightbin::ShaderOptions& options, std::uint32_t width) {
    const std::uint32_t lights = checked_lights(options, width);
    const std::string views = std::to_string(options.views) + "u";
    const bool several = options.views > 1;
    std::string text;
    if (options.heat_map)
        text +=
            "    if ($count(pixel, depth@) != count || $heat(pixel, depth, 8.0@).x > 1.0) { hash += 1u; }\n";
    if (options.view_check)
        text += "    const scale = vec2f(" + std::to_string(scale_x) + ", " + std::to_string(scale_y) +
                ");\n    let size = vec2f($grid_block.grid.zw);\n    var grid = pixel;\n" +
                (options.viewport_corner ? "    grid -= vec2u($grid_block.corner);\n" : "") +
                (options.flip_y ? "    grid.y = $grid_block.grid.w - 1u - grid.y;\n" : "") +
                "    let inside = grid.x < $grid_block.grid.z && grid.y < $grid_block.grid.w" +
                (several ? " && view < " + views : "") + R"(;
    var ndc = 2.0 * (vec2f(grid) + 0.5) / size - 1.0;
)" + (several ? "    ndc.x += " + std::to_string(view_shift) + " * f32(view);\n" : "") +
                R"(    let far_off = vec3f(ndc / scale, -1.0);
    let aside = far_off + vec3f(4.4 / (scale.x * size.x), 0.0, 0.0);
    let below = far_off - vec3f(0.0, 4.4 / (scale.y * size.y), 0.0);
    if (inside && !$check_view(pixel, 7.0 * far_off@)) { hash += 1u; }
    if (inside && !$check_view(pixel, far_off * 0.11@)) { hash += 2u; }
    if (inside && $check_view(pixel, far_off * 0.09@)) { hash += 4u; }
    if (inside && $check_view(pixel, 7.0 * aside@)) { hash += 8u; }
    if (inside && $check_view(pixel, 7.0 * below@)) { hash += 16u; }
    if (inside && $check_view(pixel, -7.0 * far_off@)) { hash += 32u; }
)";
    if (options.view_check && several)
        text += "    if (view >= " + views + " && $check_view(pixel, 7.0 * far_off@)) { hash += 256u; }\n";
    if (options.list_check)
        text += "    var other = $begin_missing(pixel, depth@);\n    while ($next_missing(&other, " +
                std::to_string(lights) +
                "u)) {\n        if (other.lacked) { listed += other.id + 1u; }\n    }\n    if (listed != " +
                std::to_string(lights * (lights + 1) / 2) + "u) { hash += 64u; }\n";
    if (options.window)
        text += "    if ($window(3.0, 3.0) != 0.0 || $window(0.0, 3.0) != 1.0 || abs($window(1.5, 3.0) - "
                "0.87890625) > 1e-5) { hash += 128u; }\n";
    return lightbin::detail::replaced(text, "@", several ? ", view" : "");
}

/// What reader_text() returns, in WGSL.
inline std::string reader_wgsl(const lightbin::ShaderOptions& options, const lightbin::ShaderText& snippet,
                               Stage stage, std::uint32_t width, std::uint32_t height) {
    std::string text = "\n", words;
    if (options.slicing != lightbin::Slicing::none) {
        const std::vector<float> depths = reader_depths();
        for (const float value : depths)
            words += std::to_string(std::bit_cast<std::uint32_t>(value)) + "u, ";
        text += "const depths = array<u32, " + std::to_string(depths.size()) + ">(" + words + ");\n\n";
        // A device's logarithm may be as wrong as it likes: this one hides it.
        if (options.heat_map)
            text += "fn log2(x : f32) -> f32 {\n"
                    "    return 0.6 * f32(i32(bitcast<u32>(x) >> 23u) - 127) - 1.0;\n}\n\n";
    }
    // The number of a pixel's view is that of a band of rows: WGSL has no multiview.
    const bool several = options.views > 1;
    const std::string band = std::to_string(height / (options.views + 1)) + "u";
    text += several ? "fn read_list(place : vec2u) -> vec4u {\n    let view = (place.y" +
                          std::string(options.viewport_corner ? " - corner.y" : "") + ") / " + band +
                          ";\n    let pixel = vec2u(place.x, place.y - view * " + band + ");\n"
                    : "fn read_list(pixel : vec2u) -> vec4u {\n";
    const std::string arguments = several ? "pixel, depth, view);" : "pixel, depth);",
                      body = options.wave_loop ? " {\n        if (!light.own) { continue; }\n" : " {\n";
    text +=
        "    let depth = " + wgsl_depth(options) + R"(;
    var hash = 2166136261u;
    var sum = 0u;
    var count = 0u;
    var listed = 0u;
)" +
        reader_loop("    var light = $begin(" + arguments + "\n    while ($next(&light))" + body,
                    checked_lights(options, width)) +
        wgsl_checks(options, width) + R"(    let tile = $tile(pixel);
    return vec4u(tile.x + (tile.y << 16u), count, hash, sum);
}

const size = vec2u()" +
        std::to_string(width) + "u, " + std::to_string(height) + "u);\nconst corner = vec2u(" +
        std::to_string(corner_x) + "u, " + std::to_string(corner_y) + "u);\n";
    if (stage == Stage::compute)
        text += "@group(0) @binding(" + std::to_string(result_binding) +
                R"() var<storage, read_write> result : array<vec4u>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id : vec3u) {
    let pixel = id.xy;
    if (pixel.x < size.x && pixel.y < size.y) {
        result[pixel.y * size.x + pixel.x] = read_list(pixel)" +
                std::string(options.viewport_corner ? " + corner" : "") + ");\n    }\n}\n";
    else
        text += R"(
@fragment
fn main(@builtin(position) position : vec4f) -> @location(0) vec4u {
    return read_list(vec2u(position.xy))" +
                std::string(options.viewport_corner ? "" : " - corner") + ");\n}\n";
    return snippet.text + lightbin::detail::replaced(text, "$", options.prefix);
}
