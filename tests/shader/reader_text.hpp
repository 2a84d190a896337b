// SPDX-License-Identifier: MIT
// A test shader around the snippet, which writes what each pixel reads from the lists. It is written once, in the GLSL
// that detail/shaders/writer.hpp describes, and translated to each language; only loops, result and entry point are
// written for each.
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

/// Returns the depths that pixels have in turn: the slices' boundaries, the floats beside them, and others.
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

/// The picture is wider and higher than the viewport by this many pixels, which have no lights.
constexpr int beyond = 3;

/// Returns how many lights a check goes through in every pixel: few in large pictures. Masks with z-bins are searched
/// for each light, and Mesa's llvmpipe ends a shader's loops after 65,535 rounds.
inline std::uint32_t checked_lights(const lightbin::SnippetOptions& options, std::uint32_t width) {
    return width > 100 ? 8 : options.masks ? 100 : 3000;
}

/// How many lights there are.
inline std::uint32_t reader_light_count(const lightbin::SnippetOptions& options) {
    using lightbin::IdWidth;
    if (options.masks) return 2000;
    return options.format.ids == IdWidth::u8 ? 200 : options.format.ids == IdWidth::u16 ? 50000 : 100000;
}

/// The projection's scales in reader_job(), and the distance in NDC from one view to the next.
constexpr float scale_x = 1.2f, scale_y = 1.7f, view_shift = 0.25f;

class ReaderText {
public:
    ReaderText(const lightbin::SnippetOptions& options, Stage stage, std::uint32_t width, std::uint32_t height,
               bool multiview)
        : options_(options), dialect_{options.language}, stage_(stage), width_(width), height_(height),
          multiview_(multiview), several_(options.views > 1), view_(several_ ? ", view" : "") {}

    /// Returns a whole shader. It writes for every pixel: its tile, the length of its list, and two sums over the ids that
    /// depend on their order. With several views the picture has a band of rows for each view, and one more for a number
    /// that no view has; with multiview, a fragment shader in GLSL or HLSL is told its view by the graphics API.
    std::string around(const std::string& snippet) const {
        const std::string own = translated(read_list() + read());
        return lightbin::detail::replaced(head() + snippet + "\n" + own + entry_point(), "$",
                                          options_.prefix);
    }

private:
    using Slicing = lightbin::Slicing;

    static std::string number(std::uint32_t value) { return std::to_string(value) + "u"; }
    static std::string corner() { return "uvec2(" + number(corner_x) + ", " + number(corner_y) + ")"; }

    std::string translated(const std::string& glsl) const {
        using namespace lightbin::detail;
        if (dialect_.webgpu)
            return WgslTranslation(glsl, {{"$grid", "$grid_block.grid"}, {"$corner", "$grid_block.corner"}})
                .text();
        return translate(glsl, dialect_.hlsl, dialect_.es);
    }

    /// Returns the lines above a snippet. For heat maps the logarithm is made inaccurate, as a device's may be.
    std::string head() const {
        std::string text = version_line(options_.language);
        if (multiview_ && !dialect_.hlsl)
            text += std::string("#extension ") +
                    (dialect_.vulkan ? "GL_EXT_multiview" : "GL_OVR_multiview2") + " : require\n";
        if (options_.slicing != Slicing::none && options_.heat_map && !dialect_.webgpu)
            text += "#define log2(x) (0.6 * log2(x) - 1.0)\n";
        return text;
    }

    /// Returns the expression for a pixel's depth. Its bits come from a table, as WGSL has no infinite constants.
    std::string depth() const {
        if (options_.slicing == Slicing::none) return "0.0";
        const std::string own = options_.viewport_corner ? "(pixel - " + corner() + ")" : "pixel";
        return "uintBitsToFloat(depth_bits((5u * " + own + ".x + 3u * " + own + ".y) % " +
               number(static_cast<std::uint32_t>(reader_depths().size())) + "))";
    }

    std::string depth_bits() const {
        if (options_.slicing == Slicing::none) return "";
        std::string text = "\nuint depth_bits(uint at) {\n    uint bits = 0u;\n";
        for (std::uint32_t at = 0; const float value : reader_depths())
            text += "    if (at == " + number(at++) +
                    ") { bits = " + number(std::bit_cast<std::uint32_t>(value)) + "; }\n";
        return text + "    return bits;\n}\n";
    }

    /// Returns the beginning of a loop over a pixel's list, or over all lights with the question whether the list lacks
    /// them: a macro, or in WGSL two functions.
    std::string begin_loop() const {
        const std::string arguments = "pixel, depth" + view_;
        if (!dialect_.webgpu) return "    $for_each_light(light, " + arguments + ") {\n";
        return "    $cursor light = $begin(" + arguments + ");\n    while ($next(&light)) {\n" +
               (options_.wave_loop ? "        if (!light.own) { continue; }\n" : "");
    }
    std::string begin_missing(const std::string& lights) const {
        const std::string arguments = "pixel, depth" + view_;
        if (!dialect_.webgpu)
            return "    $for_each_missing(other, " + lights + ", " + arguments + ") {\n        {\n";
        return "    $missing other = $begin_missing(" + arguments + ");\n    while ($next_missing(&other, " +
               lights + ")) {\n        if (other.lacked) {\n";
    }

    std::string read_list() const {
        const std::string lights = number(checked_lights(options_, width_));
        std::string text = depth_bits();
        if (options_.slicing != Slicing::none && options_.heat_map && dialect_.webgpu)  // it hides WGSL's
            text += "\nfloat log2(float x) {\n"
                    "    return 0.6 * float(int(floatBitsToUint(x) >> 23u) - 127) - 1.0;\n}\n";
        text += std::string("\nuvec4 read_list(uvec2 pixel") + (several_ ? ", uint view" : "") +
                ") {\n    float depth = " + depth() + R"(;
    uint hash = 2166136261u;
    uint sum = 0u;
    uint count = 0u;
    uint listed = 0u;
)" + begin_loop() +
                R"(        hash = (hash ^ light.id) * 16777619u;
        count += 1u;
        sum += count * light.id;
        if (light.id < )" +
                lights + ") { listed += light.id + 1u; }\n    }\n" + checks(lights) +
                "    uvec2 tile = $tile(pixel);\n    return uvec4(tile.x + (tile.y << 16u), count, hash, "
                "sum);\n}\n";
        return text;
    }

    /// Returns lines that add to `hash` where a check or the window function gives a wrong answer. `here` is the pixel
    /// as the view counts it; `listed` is the sum of 1 + id over the listed lights.
    std::string checks(const std::string& lights) const {
        const std::string views = number(options_.views);
        std::string text;
        if (options_.heat_map)
            text += "    if ($count(pixel, depth@) != count || $heat(pixel, depth, 8.0@).x > 1.0) { hash += "
                    "1u; }\n";
        if (options_.view_check)
            text += std::string("    vec2 scale = vec2(") + std::to_string(scale_x) + ", " +
                    std::to_string(scale_y) + ");\n    vec2 size = vec2($grid.zw);\n    uvec2 here = pixel" +
                    (options_.viewport_corner ? " - uvec2($corner);\n" : ";\n") +
                    (options_.flip_y ? std::string("    here.y = $grid.") + (options_.turned ? "z" : "w") +
                                           " - 1u - here.y;\n"
                                     : "") +
                    (options_.turned ? "    here = here.yx;\n" : "") +
                    "    bool inside = here.x < $grid.z && here.y < $grid.w" +
                    (several_ ? " && view < " + views : "") +
                    ";\n    vec2 ndc = 2.0 * (vec2(here) + 0.5) / size - 1.0;\n" +
                    (several_ ? "    ndc.x += " + std::to_string(view_shift) + " * float(view);\n" : "") +
                    R"(    vec3 far_off = vec3(ndc / scale, -1.0);
    vec3 aside = far_off + vec3(4.4 / (scale.x * size.x), 0.0, 0.0);
    vec3 below = far_off - vec3(0.0, 4.4 / (scale.y * size.y), 0.0);
    if (inside && !$check_view(pixel, 7.0 * far_off@)) { hash += 1u; }
    if (inside && !$check_view(pixel, far_off * 0.11@)) { hash += 2u; }
    if (inside && $check_view(pixel, far_off * 0.09@)) { hash += 4u; }
    if (inside && $check_view(pixel, 7.0 * aside@)) { hash += 8u; }
    if (inside && $check_view(pixel, 7.0 * below@)) { hash += 16u; }
    if (inside && $check_view(pixel, -7.0 * far_off@)) { hash += 32u; }
)" +
                    (several_ ? "    if (view >= " + views +
                                    " && $check_view(pixel, 7.0 * far_off@)) { hash += 256u; }\n"
                              : "");
        if (options_.list_check)
            text += begin_missing(lights) +
                    "            listed += other.id + 1u;\n        }\n    }\n    if (listed != " +
                    number(checked_lights(options_, width_) * (checked_lights(options_, width_) + 1) / 2) +
                    ") { hash += 64u; }\n";
        if (options_.window)
            text += "    if ($window(3.0, 3.0) != 0.0 || $window(0.0, 3.0) != 1.0 || "
                    "abs($window(1.5, 3.0) - 0.87890625) > 1e-5) { hash += 128u; }\n";
        return lightbin::detail::replaced(text, "@", view_);
    }

    /// Without multiview, the picture has a band of rows for each view, so a pixel's row gives the number of its view.
    std::string read() const {
        if (!several_ || multiview_) return "";
        const std::string band = number(height_ / (options_.views + 1)),
                          first_row = number(options_.viewport_corner ? corner_y : 0);
        return "\nuvec4 read_band(uvec2 place) {\n    uint view = (place.y - " + first_row + ") / " + band +
               ";\n    return read_list(uvec2(place.x, place.y - view * " + band + "), view);\n}\n";
    }

    std::string entry_point() const {
        const std::string reader = several_ && !multiview_ ? "read_band(" : "read_list(",
                          binding = std::to_string(result_binding);
        if (stage_ == Stage::compute) {
            const std::string store =
                translated("\nvoid store(uvec2 pixel) {\n    if (pixel.x < " + number(width_) +
                           " && pixel.y < " + number(height_) + ") {\n        result[pixel.y * " +
                           number(width_) + " + pixel.x] = " + reader + "pixel" +
                           (options_.viewport_corner ? " + " + corner() : "") + ");\n    }\n}\n\n");
            if (dialect_.webgpu)
                return "@group(0) @binding(" + binding +
                       ") var<storage, read_write> result : array<vec4u>;\n" + store +
                       "@compute @workgroup_size(8, 8)\n"
                       "fn main(@builtin(global_invocation_id) id : vec3u) {\n    store(id.xy);\n}\n";
            if (dialect_.hlsl)
                return "RWStructuredBuffer<uint4> result : register(u" + binding + ");\n" + store +
                       "[numthreads(8, 8, 1)] void main(uint3 id : SV_DispatchThreadID) {\n    "
                       "store(id.xy);\n}\n";
            return "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(std430, binding = " + binding +
                   ") writeonly buffer result_block {\n    highp uvec4 result[];\n};\n" + store +
                   "void main() {\n    store(gl_GlobalInvocationID.xy);\n}\n";
        }
        const std::string less_corner = translated(options_.viewport_corner ? "" : " - " + corner()),
                          start = " {\n    return " + reader;
        if (dialect_.webgpu)
            return "\n@fragment\nfn main(@builtin(position) position : vec4f) -> @location(0) vec4u" + start +
                   "vec2u(position.xy)" + less_corner + ");\n}\n";
        if (dialect_.hlsl)
            return std::string("\nuint4 main(float4 position : SV_Position") +
                   (multiview_ ? ", uint view : SV_ViewID" : "") + ") : SV_Target" + start +
                   "uint2(position.xy)" + less_corner + (multiview_ ? ", view" : "") + ");\n}\n";
        return std::string(dialect_.vulkan ? "\nlayout(location = 0) " : "\n") +
               "out highp uvec4 colour;\nvoid main() {\n    colour = " + reader + "uvec2(gl_FragCoord.xy)" +
               less_corner +
               (!multiview_       ? ""
                : dialect_.vulkan ? ", uint(gl_ViewIndex)"
                                  : ", gl_ViewID_OVR") +
               ");\n}\n";
    }

    const lightbin::SnippetOptions& options_;
    lightbin::detail::Dialect dialect_;
    Stage stage_;
    std::uint32_t width_, height_;
    bool multiview_, several_;
    std::string view_;  // the last argument of what takes a view's number
};

inline std::string reader_text(const lightbin::SnippetOptions& options, const lightbin::ShaderText& snippet,
                               Stage stage, std::uint32_t width, std::uint32_t height,
                               bool multiview = false) {
    return ReaderText(options, stage, width, height, multiview).around(snippet.text);
}

/// What a compute shader writes.
inline Input result_input(std::size_t bytes) {
    using namespace lightbin;
    Input result;
    result.binding = {
        "result_block", ShaderResource::writable_buffer, {result_binding, 0}, TexelFormat::none, 16, 0, 0};
    result.bytes.resize(bytes, std::byte{0xee});
    return result;
}
