// SPDX-License-Identifier: MIT
// The shader texts of the WebGL 2 renderer, but for what lightbin makes: how lists are read, and depth is reduced.

const head = '#version 300 es\nprecision highp float;\nprecision highp int;\n';

// Texels a row of the lights' texture: as many as every device has.
export const lights_width = 2048;

export const vertex_text = head + `
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
`;

// A triangle that covers the picture.
export const overlay_text = head + `
void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}
`;

export const depth_text = head + 'void main() {}\n';

export const reduce_text = text => head + text;

// What light `id` sends to the surface at `position`, all in view space.
const lighting = `
uniform highp sampler2D lights;  // three texels each: centre and range; colour; cone. A sun: the way to it; colour
uniform int light_count;

vec4 light_texel(int i) {
    return texelFetch(lights, ivec2(i & ${lights_width - 1}, i / ${lights_width}), 0);
}

// Inverse-square falloff, windowed to zero at the range, as KHR_lights_punctual recommends. What is out of reach ends
// early: adding nothing is the same as not adding.
vec3 irradiance(int id, vec3 position, vec3 normal) {
    vec4 sphere = light_texel(3 * id);
    vec3 to_light = sphere.xyz - position;
    float square_distance = dot(to_light, to_light);
    float x = square_distance * (1.0 / (sphere.w * sphere.w));
    float facing = dot(normal, to_light);
    if (x >= 1.0 || facing <= 0.0) return vec3(0.0);
    float falloff = (1.0 - x * x) / max(square_distance, 1e-4);
    float over_distance = inversesqrt(max(square_distance, 1e-20));
    facing *= over_distance;
#ifdef SPOTS
    vec4 cone = light_texel(3 * id + 2);
    float angular = clamp(dot(cone.xyz, to_light) * over_distance + cone.w, 0.0, 1.0);
    facing *= angular * angular;
#endif
    return light_texel(3 * id + 1).rgb * (facing * falloff);
}
`;

// From gl_FragCoord, the very numbers that tiles and Z bounds are made of: an interpolated position differs from the
// depth buffer's by the rasteriser's rounding, which can be much at a triangle seen edge-on.
const surface = `
uniform mat4 projection;
uniform vec2 picture_size;
in vec3 surface_normal;
in vec3 base_colour;
out vec4 pixel;

vec3 view_position() {
    vec3 ndc = 2.0 * vec3(gl_FragCoord.xy / picture_size, gl_FragCoord.z) - 1.0;
    float z = (projection[3][2] - ndc.z * projection[3][3]) / (ndc.z * projection[2][3] - projection[2][2]);
    float w = projection[2][3] * z + projection[3][3];
    vec2 offset = vec2(projection[2][0], projection[2][1]) * z + vec2(projection[3][0], projection[3][1]);
    return vec3((ndc.xy * w - offset) / vec2(projection[0][0], projection[1][1]), z);
}
`;

const every_light = 'for (int id = 0; id < light_count; ++id) light += irradiance(id, position, normal);';
const listed_lights = `lightbin_for_each_light(listed, uvec2(gl_FragCoord.xy), -position.z)
        light += irradiance(int(listed.id), position, normal);`;

// Grey, so that the magenta of what is wrong stands out: a fragment that is not where the View has it, or whose list
// lacks a light that reaches it.
const check = `
    const vec4 magenta = vec4(1.0, 0.0, 1.0, 1.0);
    uvec2 here = uvec2(gl_FragCoord.xy);
    pixel.rgb = vec3(dot(pixel.rgb, vec3(0.3, 0.6, 0.1)));
    if (!lightbin_check_view(here, position)) pixel = magenta;
    lightbin_for_each_missing(listed, uint(light_count), here, -position.z)
        if (irradiance(int(listed.id), position, normal) != vec3(0.0)) pixel = magenta;
`;

const lit_main = (loop, end) => `
uniform vec3 moon;  // the way to it, in view space
uniform float exposure;
uniform int sun_count;  // the directional lights follow the others

void main() {
    vec3 position = view_position();
    vec3 normal = normalize(gl_FrontFacing ? surface_normal : -surface_normal);

    vec3 light = vec3(0.0);
    for (int sun = light_count; sun < light_count + sun_count; ++sun)
        light += light_texel(3 * sun + 1).rgb * max(dot(normal, light_texel(3 * sun).xyz), 0.0);
    ${loop}

    vec3 radiance = base_colour * light / 3.14159265;
    // Moonlight, so that nothing is all black.
    vec3 night = base_colour * vec3(0.012, 0.015, 0.024) * (1.0 + dot(normal, moon));
    vec3 display = 1.0 - exp(-exposure * radiance - night);
    pixel = vec4(pow(display, vec3(1.0 / 2.2)), 1.0);
${end}}
`;

// How many lights each fragment goes through, as a colour; shaded a little, so that the shapes can be seen.
const heat_main = `
uniform float longest_list;

void main() {
    vec3 position = view_position();
    float facing = abs(dot(normalize(surface_normal), normalize(position)));
    pixel = vec4(lightbin_heat(uvec2(gl_FragCoord.xy), -position.z, longest_list) * (0.4 + 0.6 * facing), 1.0);
}
`;

// look: 'lit', 'heat', 'check', or 'every' for brute force. snippet: lightbin's text for that look; 'every' needs none.
export function fragment_text(look, snippet, has_spots) {
    const main = look === 'heat' ? heat_main
        : look === 'every' ? lit_main(every_light, '')
        : lit_main(listed_lights, look === 'check' ? check : '');
    const text = head + (has_spots ? '#define SPOTS\n' : '') + snippet;
    return text + (look === 'heat' ? '' : lighting) + surface + main;
}
