// SPDX-License-Identifier: MIT
#include "shading.hpp"

#include <lightbin/shader.hpp>

#include <string>

namespace {

// Of every shader.
const char* const common = R"(
layout(std140) uniform Frame {
    mat4 to_view;
    mat4 projection;
    vec2 picture_size;
    int light_count;
};

const vec3 sky = vec3(0.02, 0.025, 0.04);

struct Surface {
    vec3 position, normal;  // in view space
    vec3 diffuse, specular, ambient;
    float shininess;
};

// From a pixel's centre and its depth, the very numbers that tiles and Z bounds are made of.
vec3 view_position(vec2 pixel, float depth) {
    vec3 ndc = 2.0 * vec3(pixel / picture_size, depth) - 1.0;
    float z = (projection[3][2] - ndc.z * projection[3][3]) / (ndc.z * projection[2][3] - projection[2][2]);
    float w = projection[2][3] * z;
    vec2 offset = vec2(projection[2][0], projection[2][1]) * z;
    return vec3((ndc.xy * w - offset) / vec2(projection[0][0], projection[1][1]), z);
}

// What is shown of a radiance: white is never reached.
vec3 shown(vec3 radiance) {
    return pow(1.0 - exp(-radiance), vec3(1.0 / 2.2));
}
)";

// What lights surfaces.
const char* const lighting = R"(
uniform samplerBuffer lights;  // two texels each: centre and range, intensity

uint evaluations = 0u, words = 0u;

// Diffuse and specular.
vec3 reflected(Surface s, vec3 to_light, vec3 to_eye) {
    float facing = max(dot(s.normal, to_light), 0.0);
    vec3 between = to_light + to_eye;
    float highlight = max(dot(s.normal, between * inversesqrt(max(dot(between, between), 1e-12))), 0.0);
    return (s.diffuse / 3.14159265 + s.specular * pow(highlight, s.shininess)) * facing;
}

// What a light makes a surface send to the eye: inverse-square falloff, windowed to zero at the range.
vec3 from_light(Surface s, int id) {
    evaluations += 1u;
    vec4 sphere = texelFetch(lights, 2 * id);
    vec3 to_light = sphere.xyz - s.position;
    float square_distance = dot(to_light, to_light);
    float x = square_distance / (sphere.w * sphere.w);
    float falloff = clamp(1.0 - x * x, 0.0, 1.0) / max(square_distance, 1e-4);
    vec3 to_eye = -s.position * inversesqrt(max(dot(s.position, s.position), 1e-20));
    return texelFetch(lights, 2 * id + 1).rgb * falloff *
           reflected(s, to_light * inversesqrt(max(square_distance, 1e-20)), to_eye);
}
)";

const char* const lit_by_list = R"(
vec3 lit(Surface s, uvec2 pixel) {
    vec3 radiance = s.ambient;
    each_light(light, pixel, -s.position.z) radiance += from_light(s, int(light.id));
#if defined(COUNT) && defined(MASKS)
    lightbin_cursor masks = lightbin_begin(pixel, -s.position.z);
    words += masks.end - masks.at;
#endif
    return radiance;
}
)";

// Where early tests are not asked for, a shader that writes runs on what is hidden as well.
const char* const counter = R"(
#ifdef COUNT
layout(std430, binding = 7) buffer Counter { uvec2 sums[2]; } counter;  // low word, high word
void count(int place, uint number) {
    uint before = atomicAdd(counter.sums[place].x, number);
    if (before + number < before) atomicAdd(counter.sums[place].y, 1u);
}
void count() {
    count(0, evaluations);
    count(1, words);
}
#else
void count() {}
#endif
)";

const char* const made_surface = R"(
in vec3 surface_normal;
in vec3 base_colour;

Surface made_surface() {
    Surface s;
    s.position = view_position(gl_FragCoord.xy, gl_FragCoord.z);
    s.normal = normalize(gl_FrontFacing ? surface_normal : -surface_normal);
    s.diffuse = base_colour;
    s.specular = vec3(0.15);
    s.ambient = 0.02 * base_colour;
    s.shininess = 24.0;
    return s;
}
)";

const char* const stored_surface = R"(
uniform sampler2D depth_texture, diffuse_texture, specular_texture, ambient_texture, normal_texture;

// Where nothing is drawn, the depth is 1.
float stored_depth(ivec2 pixel) {
    return texelFetch(depth_texture, pixel, 0).x;
}

Surface stored_surface(ivec2 pixel, float depth) {
    vec4 specular = texelFetch(specular_texture, pixel, 0);
    Surface s;
    s.position = view_position(vec2(pixel) + 0.5, depth);
    s.normal = normalize(texelFetch(normal_texture, pixel, 0).xyz);
    s.diffuse = texelFetch(diffuse_texture, pixel, 0).rgb;
    s.specular = specular.rgb;
    s.ambient = texelFetch(ambient_texture, pixel, 0).rgb;
    s.shininess = specular.a;
    return s;
}
)";

}  // namespace

LightLookup every_light() {
    return {"\nstruct EveryLight { uint id; };\n"
            "#define each_light(light, pixel, view_depth) "  // on one line: GLSL 3.30 continues none
            "for (EveryLight light = EveryLight(0u); light.id < uint(light_count); light.id += 1u)\n"};
}

// Texel buffers, which OpenGL 3.3 has, are read the same way by all.
LightLookup listed_lights(const lightbin::SnippetOptions& options) {
    lightbin::SnippetOptions read = options;
    read.language = lightbin::ShaderLanguage::glsl_330;
    read.storage = lightbin::ListStorage::texel_buffer;
    return {lightbin::shader_snippet(read)->text + "\n#define each_light lightbin_for_each_light\n" +
            (options.masks ? "#define MASKS\n" : "")};
}

std::string Shaders::head() const {
    return "#version " + std::to_string(glsl_) + " core\n" + (settings_.count ? "#define COUNT\n" : "");
}

namespace {

// Early depth tests: without them, a shader that counts evaluations also counts those of hidden fragments.
const char* const seen_only = R"(
#ifdef COUNT
layout(early_fragment_tests) in;
#endif
)";

std::string lit_text(const LightLookup& lights) {
    return common + lights.text + lighting + counter;
}

}  // namespace

std::string Shaders::surface_vertex() const {
    return head() + common + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
out vec3 surface_normal;
out vec3 base_colour;
invariant gl_Position;  // the same bits in every pass

void main() {
    vec4 place = to_view * vec4(position, 1.0);
    surface_normal = mat3(to_view) * normal;
    base_colour = colour;
    gl_Position = projection * place;
}
)";
}

std::string Shaders::everywhere_vertex() const {
    return head() + R"(
void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
)";
}

std::string Shaders::depth_fragment() const {
    return head() + "void main() {}\n";
}

std::string Shaders::forward_fragment(const LightLookup& lights) const {
    return head() + seen_only + lit_text(lights) + lit_by_list + made_surface +
           "out vec4 pixel;\n\nvoid main() {\n"
           "    pixel = vec4(shown(lit(made_surface(), uvec2(gl_FragCoord.xy))), 1.0);\n    count();\n}\n";
}

std::string Shaders::g_buffer_fragment() const {
    return head() + common + made_surface + R"(
layout(location = 0) out vec4 diffuse;
layout(location = 1) out vec4 specular;
layout(location = 2) out vec4 ambient;
layout(location = 3) out vec4 normal;

void main() {
    Surface s = made_surface();
    diffuse = vec4(s.diffuse, 0.0);
    specular = vec4(s.specular, s.shininess);
    ambient = vec4(s.ambient, 0.0);
    normal = vec4(s.normal, 0.0);
}
)";
}

std::string Shaders::deferred_fragment(const LightLookup& lights) const {
    return head() + lit_text(lights) + lit_by_list + stored_surface + R"(
out vec4 pixel;

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    float depth = stored_depth(place);
    pixel = vec4(sky, 1.0);
    if (depth != 1.0) pixel.rgb = shown(lit(stored_surface(place, depth), uvec2(place)));
    count();
}
)";
}

std::string Shaders::ambient_fragment() const {
    return head() + common + stored_surface + R"(
out vec4 radiance;

void main() {
    radiance = vec4(texelFetch(ambient_texture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
)";
}

std::string Shaders::one_light_fragment() const {
    return head() + seen_only + lit_text({}) + stored_surface + R"(
flat in int light;
out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = stored_depth(pixel);
    radiance = vec4(0.0);
    if (depth != 1.0) radiance = vec4(from_light(stored_surface(pixel, depth), light), 0.0);
    count();
}
)";
}

std::string Shaders::show_fragment() const {
    return head() + common + R"(
uniform sampler2D radiance_texture, depth_texture;
out vec4 pixel;

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    bool nothing = texelFetch(depth_texture, place, 0).x == 1.0;
    pixel = vec4(nothing ? sky : shown(texelFetch(radiance_texture, place, 0).rgb), 1.0);
}
)";
}

std::string Shaders::rectangle_vertex() const {
    return head() + common + R"(
uniform usamplerBuffer footprints;  // in pixels, both ends included
flat out int light;

void main() {
    uvec4 footprint = texelFetch(footprints, gl_InstanceID);
    light = int(footprint.x);
    uvec2 low = uvec2(footprint.y & 0xffffu, footprint.y >> 16u);
    uvec2 high = uvec2(footprint.z & 0xffffu, footprint.z >> 16u) + 1u;
    vec2 corner = vec2((gl_VertexID & 1) != 0 ? high.x : low.x, (gl_VertexID & 2) != 0 ? high.y : low.y);
    gl_Position = vec4(2.0 * corner / picture_size - 1.0, 0.0, 1.0);
}
)";
}

std::string Shaders::ball_vertex() const {
    return head() + common + R"(
uniform samplerBuffer lights;
uniform int number;
layout(location = 0) in vec3 position;
flat out int light;
invariant gl_Position;  // what is marked and what takes the marks away are the same pixels

void main() {
    light = number;
    vec4 sphere = texelFetch(lights, 2 * number);
    float radius = min(sphere.w, 1e18);  // a light without an end has a ball that has all in it
    gl_Position = projection * vec4(sphere.xyz + radius * position, 1.0);
}
)";
}
