// SPDX-License-Identifier: MIT
#include "shaders.hpp"

namespace {

bool is_es(int glsl) {
    return glsl < 330;
}

std::string version_line(int glsl) {
    const std::string version = "#version " + std::to_string(glsl);
    return version + (is_es(glsl) ? " es\nprecision highp float;\nprecision highp int;\n" : " core\n");
}

lightbin::ShaderOptions list_options(int glsl) {
    using namespace lightbin;
    ShaderOptions options;
    options.language = glsl == 430   ? ShaderLanguage::glsl_430
                       : glsl == 330 ? ShaderLanguage::glsl_330
                       : glsl == 310 ? ShaderLanguage::essl_310
                                     : ShaderLanguage::essl_300;
    options.storage = glsl == 330   ? ListStorage::texel_buffer
                      : glsl == 300 ? ListStorage::texture_2d
                                    : ListStorage::storage_buffer;
    return options;
}

// Declares lightbin_for_each_light() and what it reads.
std::string tile_lists(int glsl, lightbin::Slicing slicing, bool heat_map = false, ShaderChecks checks = {}) {
    lightbin::ShaderOptions options = list_options(glsl);
    options.slicing = slicing;
    options.heat_map = heat_map;
    options.view_check = checks.view;
    options.list_check = checks.lists;
    return lightbin::shader_snippet(options)->text;
}

// What light `id` sends to the surface at `position`, all in view space.
const char* const lighting = R"(
uniform highp sampler2D lights;  // three texels each, see GpuLight
uniform int light_count;

vec4 light_texel(int i) {
    return texelFetch(lights, ivec2(i % LIGHTS_WIDTH, i / LIGHTS_WIDTH), 0);
}

// Inverse-square falloff, windowed to zero at the range, as KHR_lights_punctual recommends.
float falloff(float square_distance, float inverse_square_range) {
    float x = square_distance * inverse_square_range;
    return clamp(1.0 - x * x, 0.0, 1.0) / max(square_distance, 1e-4);
}

vec3 irradiance(int id, vec3 position, vec3 normal) {
    vec4 sphere = light_texel(3 * id);
    vec4 colour = light_texel(3 * id + 1);
    vec3 to_light = sphere.xyz - position;
    float square_distance = dot(to_light, to_light);
    vec3 direction = to_light * inversesqrt(max(square_distance, 1e-20));
    float facing = max(dot(normal, direction), 0.0);
    float inverse_square_range = 1.0 / (sphere.w * sphere.w);
#ifdef SPOTS
    vec4 cone = light_texel(3 * id + 2);
    float angular = clamp(dot(cone.xyz, direction) + cone.w, 0.0, 1.0);
    facing *= angular * angular;
#endif
    return colour.rgb * (facing * falloff(square_distance, inverse_square_range));
}
)";

const char* const surface = R"(
uniform mat4 projection;
uniform vec2 picture_size;

// From gl_FragCoord, the very numbers that tiles and Z bounds are made of: an interpolated position differs
// from the depth buffer's by the rasteriser's rounding, which can be much at a triangle seen edge-on. With several
// samples a pixel the triangle need not reach the pixel's middle, and its plane may there leave the depths that are drawn;
// a depth of 1 may be infinitely far.
vec3 view_position() {
    vec3 ndc = 2.0 * vec3(gl_FragCoord.xy / picture_size, clamp(gl_FragCoord.z, 0.0, 0.99999994)) - 1.0;
    float z = (projection[3][2] - ndc.z * projection[3][3]) / (ndc.z * projection[2][3] - projection[2][2]);
    float w = projection[2][3] * z + projection[3][3];
    vec2 offset = vec2(projection[2][0], projection[2][1]) * z + vec2(projection[3][0], projection[3][1]);
    return vec3((ndc.xy * w - offset) / vec2(projection[0][0], projection[1][1]), z);
}
)";

const char* const forward_main = R"(
uniform vec3 moon;       // the way to it, in view space
uniform float exposure;  // 0: write linear radiance, for the light meter
uniform int sun_count;   // the directional lights follow the others

in vec3 surface_normal;
in vec3 base_colour;
out vec4 pixel;

void main() {
    vec3 position = view_position();
    vec3 normal = normalize(gl_FrontFacing ? surface_normal : -surface_normal);

    vec3 light = vec3(0.0);
    for (int sun = light_count; sun < light_count + sun_count; ++sun)
        light += light_texel(3 * sun + 1).rgb * max(dot(normal, light_texel(3 * sun).xyz), 0.0);
#ifdef EVERY_LIGHT
    for (int id = 0; id < light_count; ++id)
        light += irradiance(id, position, normal);
#else
    lightbin_for_each_light(listed, uvec2(gl_FragCoord.xy), -position.z)
        light += irradiance(int(listed.id), position, normal);
#endif

    vec3 radiance = base_colour * light / 3.14159265;
    if (exposure == 0.0) {
        pixel = vec4(radiance, 1.0);
    } else {
        // Moonlight, so that nothing is all black.
        vec3 night = base_colour * vec3(0.012, 0.015, 0.024) * (1.0 + dot(normal, moon));
        vec3 display = 1.0 - exp(-exposure * radiance - night);
        pixel = vec4(pow(display, vec3(1.0 / 2.2)), 1.0);
    }
    check(pixel, position, normal);
}
)";

// Grey, so that what is magenta can be counted.
std::string check_function(ShaderChecks checks) {
    std::string text = "\nvoid check(inout vec4 pixel, vec3 position, vec3 normal) {\n";
    if (checks.view || checks.lists)
        text += "    const vec4 magenta = vec4(1.0, 0.0, 1.0, 1.0);\n"
                "    pixel.rgb = vec3(dot(pixel.rgb, vec3(0.3, 0.6, 0.1)));\n"
                "    uvec2 here = uvec2(gl_FragCoord.xy);\n";
    if (checks.view) text += "    if (!lightbin_check_view(here, position)) pixel = magenta;\n";
    if (checks.lists)
        text += "    lightbin_for_each_missing(light, uint(light_count), here, -position.z)\n"
                "        if (irradiance(int(light.id), position, normal) != vec3(0.0)) pixel = magenta;\n";
    return text + "}\n";
}

}  // namespace

lightbin::ShaderBinding list_binding(int glsl) {
    return lightbin::shader_snippet(list_options(glsl))->bindings.back();
}

std::string reduce_fragment_shader(int glsl, int samples, bool orthographic, bool skip_background) {
    lightbin::ReduceShaderOptions options;
    options.language = list_options(glsl).language;
    options.stage = lightbin::ShaderStage::fragment;
    options.samples = samples;
    options.orthographic = orthographic;
    options.skip_background = skip_background;
    return version_line(glsl) + lightbin::reduce_shader(options)->text;
}

std::string geometry_vertex_shader(int glsl) {
    return version_line(glsl) + R"(
uniform mat4 view;
uniform mat4 projection;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
out vec3 surface_normal;
out vec3 base_colour;
invariant gl_Position;  // the same bits in the depth pre-pass and in the shading pass

void main() {
    surface_normal = mat3(view) * normal;
    base_colour = colour;
    gl_Position = projection * (view * vec4(position, 1.0));
}
)";
}

std::string depth_fragment_shader(int glsl) {
    return version_line(glsl) + "void main() {}\n";
}

std::string forward_fragment_shader(int glsl, LightLoop loop, bool has_spots, lightbin::Slicing slicing,
                                    ShaderChecks checks) {
    std::string text = version_line(glsl) + "#define LIGHTS_WIDTH " + std::to_string(lights_width) + "\n";
    if (has_spots) text += "#define SPOTS\n";
    if (loop == LightLoop::every_light)
        text += "#define EVERY_LIGHT\n";
    else
        text += tile_lists(glsl, slicing, false, checks);
    return text + lighting + surface + check_function(checks) + forward_main;
}

std::string overlay_vertex_shader(int glsl) {
    return version_line(glsl) + R"(
void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)";
}

std::string heat_map_fragment_shader(int glsl, lightbin::Slicing slicing) {
    const bool sliced = slicing != lightbin::Slicing::none;
    return version_line(glsl) + tile_lists(glsl, slicing, true) + (sliced ? surface : "") + R"(
uniform float longest_list;
out vec4 pixel;

void main() {
    uvec2 here = uvec2(gl_FragCoord.xy);
    float depth = )" +
           (sliced ? "-view_position().z" : "0.0") +
           R"(;
    pixel = vec4(lightbin_heat(here, depth, longest_list), lightbin_count(here, depth) > 0u ? 0.6 : 0.0);
}
)";
}
