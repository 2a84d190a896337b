// SPDX-License-Identifier: MIT
#include "shaders.hpp"

namespace {

bool is_es(int glsl) {
    return glsl < 330;
}

lightbin::SnippetOptions list_options(int glsl) {
    using namespace lightbin;
    SnippetOptions options;
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
    lightbin::SnippetOptions options = list_options(glsl);
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
uniform int listed_count;  // of lights and boxes

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

#ifdef BOXES
uniform highp sampler2D boxes;  // five texels each, see GpuBox

vec4 box_texel(int i) {
    return texelFetch(boxes, ivec2(i % LIGHTS_WIDTH, i / LIGHTS_WIDTH), 0);
}

// What a decal, a probe or a projector does to the surface at `position`, if it is in the box.
void apply_box(int box, vec3 position, vec3 normal, inout vec3 albedo, inout vec3 light) {
    vec4 x_row = box_texel(5 * box), y_row = box_texel(5 * box + 1), z_row = box_texel(5 * box + 2);
    vec4 colour = box_texel(5 * box + 3), eye_taper = box_texel(5 * box + 4);
    vec4 point = vec4(position, 1.0);
    vec3 place = vec3(dot(x_row, point), dot(y_row, point), dot(z_row, point));
    float width = 0.5 * (1.0 + eye_taper.w + place.z * (1.0 - eye_taper.w));  // 1 but for a projector
    if (any(greaterThanEqual(abs(place), vec3(width, width, 1.0)))) return;

    vec3 axis = normalize(z_row.xyz);
    if (colour.w == 0.0) {  // a decal: a ring around a disc
        float radius = length(place.xy);
        float paint = (1.0 - smoothstep(0.94, 1.0, radius)) *
                      (1.0 - smoothstep(0.5, 0.56, radius) + smoothstep(0.7, 0.76, radius));
        albedo *= mix(vec3(1.0), colour.rgb, paint * clamp(2.0 * dot(normal, axis), 0.0, 1.0));
    } else if (colour.w == 1.0) {  // a probe: light from where the eye's ray is reflected to, less towards the faces
        vec3 inward = clamp(4.0 - 4.0 * abs(place), 0.0, 1.0);
        float surroundings = 1.0 + dot(reflect(normalize(position), normal), axis);
        light += colour.rgb * (inward.x * inward.y * inward.z * surroundings);
    } else {  // a projector: the light that six panes let through
        vec2 from_middle = abs(fract(vec2(1.5, 1.0) * (place.xy / width + 1.0)) - 0.5);
        vec2 glass = 1.0 - smoothstep(0.4, 0.46, from_middle);
        vec3 to_eye = eye_taper.xyz - position;
        float square_distance = dot(to_eye, to_eye);
        float facing = max(dot(normal, to_eye * inversesqrt(max(square_distance, 1e-20))), 0.0);
        float square_share = width * width / max(square_distance, 1e-20);  // 1 over the square of the range
        light += colour.rgb * (facing * glass.x * glass.y * falloff(square_distance, square_share));
    }
}
#endif

// What an entry of the array of lights does to the surface, be it a light or a box.
void shade(int id, vec3 position, vec3 normal, inout vec3 albedo, inout vec3 light) {
#ifdef BOXES
    int box = int(light_texel(3 * id + 1).w) - 1;
    if (box >= 0) {
        apply_box(box, position, normal, albedo, light);
        return;
    }
#endif
    light += irradiance(id, position, normal);
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
uniform int sun_count;   // the directional lights follow lights and boxes

in vec3 surface_normal;
in vec3 base_colour;
out vec4 pixel;

void main() {
    vec3 position = view_position();
    vec3 normal = normalize(gl_FrontFacing ? surface_normal : -surface_normal);

    vec3 light = vec3(0.0);
    vec3 albedo = base_colour;
    for (int sun = listed_count; sun < listed_count + sun_count; ++sun)
        light += light_texel(3 * sun + 1).rgb * max(dot(normal, light_texel(3 * sun).xyz), 0.0);
#if defined(EVERY_LIGHT)
    for (int id = 0; id < listed_count; ++id)
        shade(id, position, normal, albedo, light);
#elif defined(BOXES) && !defined(RANKS)
    // Kind by kind: ids ascend, and those of all lights are below those of all boxes.
    lightbin_cursor listed = lightbin_begin(uvec2(gl_FragCoord.xy), -position.z);
    bool more = lightbin_next(listed);
    for (; more && int(listed.id) < light_count; more = lightbin_next(listed))
        light += irradiance(int(listed.id), position, normal);
    for (; more; more = lightbin_next(listed))
        apply_box(int(listed.id) - light_count, position, normal, albedo, light);
#else
    // Without boxes each entry is a light. With z-bins ids are ranks in order of depth, so each entry says what it is.
    lightbin_for_each_light(listed, uvec2(gl_FragCoord.xy), -position.z)
        shade(int(listed.id), position, normal, albedo, light);
#endif

    vec3 radiance = albedo * light / 3.14159265;
    if (exposure == 0.0) {
        pixel = vec4(radiance, 1.0);
    } else {
        // Moonlight, so that nothing is all black.
        vec3 night = albedo * vec3(0.012, 0.015, 0.024) * (1.0 + dot(normal, moon));
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
        text += "    lightbin_for_each_missing(missing, uint(listed_count), here, -position.z) {\n"
                "        vec3 albedo = vec3(1.0), light = vec3(0.0);\n"
                "        shade(int(missing.id), position, normal, albedo, light);\n"
                "        if (albedo != vec3(1.0) || light != vec3(0.0)) pixel = magenta;\n"
                "    }\n";
    return text + "}\n";
}

}  // namespace

std::string version_line(int glsl) {
    const std::string version = "#version " + std::to_string(glsl);
    return version + (is_es(glsl) ? " es\nprecision highp float;\nprecision highp int;\n" : " core\n");
}

lightbin::ShaderBinding list_binding(int glsl) {
    return lightbin::shader_snippet(list_options(glsl))->bindings.back();
}

std::string reduce_fragment_shader(int glsl, int samples, bool orthographic, bool skip_background) {
    lightbin::ReduceOptions options;
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

std::string forward_fragment_shader(int glsl, LightLoop loop, LightKinds kinds, lightbin::Slicing slicing,
                                    ShaderChecks checks) {
    std::string text = version_line(glsl) + "#define LIGHTS_WIDTH " + std::to_string(lights_width) + "\n";
    if (kinds.spots) text += "#define SPOTS\n";
    if (kinds.boxes) text += "#define BOXES\n";
    if (slicing == lightbin::Slicing::z_bins) text += "#define RANKS\n";
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
