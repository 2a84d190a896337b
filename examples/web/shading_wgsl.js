// SPDX-License-Identifier: MIT
// The shaders of the picture in WGSL, as examples/tiled_forward has them in GLSL. What they read is in group 1; group 0
// is lightbin's.

// Its constants come from frame_constants().
const resources = `
struct Frame {
    projection : mat4x4f,
    view : mat4x4f,
    moon : vec3f,  // the way to it, in view space
    exposure : f32,
    picture_size : vec2f,
    longest_list : f32,
    unused : f32,
    light_count : u32,
    sun_count : u32,  // the directional lights follow the others
}
struct Light {
    sphere : vec4f,  // centre, range; a sun: the way to it
    colour : vec4f,
    cone : vec4f,
}
@group(1) @binding(0) var<uniform> frame : Frame;
@group(1) @binding(1) var<storage, read> lights : array<Light>;
`;

export const frame_bindings = [
    {name: 'frame', resource: 'uniform-block', slot: {binding: 0}},
    {name: 'lights', resource: 'storage-buffer', slot: {binding: 1}},
];

// The words of `frame`.
export function frame_constants(frame, {exposure = 1, width, height}, longest_list) {
    const {projection, view, moon, light_count, sun_count} = frame;
    const floats = new Float32Array(
        [...projection, ...view, ...moon, exposure, width, height, Math.max(longest_list, 1), 0, 0, 0, 0, 0]);
    new Uint32Array(floats.buffer).set([light_count, sun_count], 40);
    return floats;
}

// `invariant`: the same bits in the depth pre-pass and in the shading pass.
const vertex = `
struct Surface {
    @builtin(position) @invariant at : vec4f,
    @location(0) normal : vec3f,
    @location(1) colour : vec3f,
}

@vertex fn vertex_main(@location(0) position : vec3f, @location(1) normal : vec3f,
                       @location(2) colour : vec3f) -> Surface {
    let place = frame.view * vec4f(position, 1.0);
    return Surface(frame.projection * place, (frame.view * vec4f(normal, 0.0)).xyz, colour);
}
`;

const lighting = `
// Inverse-square falloff, windowed to zero at the range, as KHR_lights_punctual recommends.
fn falloff(square_distance : f32, inverse_square_range : f32) -> f32 {
    let x = square_distance * inverse_square_range;
    return clamp(1.0 - x * x, 0.0, 1.0) / max(square_distance, 1e-4);
}

// What light \`id\` sends to the surface at \`position\`, all in view space.
fn irradiance(id : u32, position : vec3f, normal : vec3f) -> vec3f {
    let sphere = lights[id].sphere;
    let to_light = sphere.xyz - position;
    let square_distance = dot(to_light, to_light);
    let direction = to_light * inverseSqrt(max(square_distance, 1e-20));
    var facing = max(dot(normal, direction), 0.0);
    if (has_spots) {
        let cone = lights[id].cone;
        let angular = clamp(dot(cone.xyz, direction) + cone.w, 0.0, 1.0);
        facing *= angular * angular;
    }
    return lights[id].colour.rgb * (facing * falloff(square_distance, 1.0 / (sphere.w * sphere.w)));
}

fn displayed(surface_colour : vec3f, normal : vec3f, light : vec3f) -> vec3f {
    // Moonlight, so that nothing is all black.
    let night = surface_colour * vec3f(0.012, 0.015, 0.024) * (1.0 + dot(normal, frame.moon));
    let shown = 1.0 - exp(-frame.exposure * surface_colour * light / 3.14159265 - night);
    return pow(shown, vec3f(1.0 / 2.2));
}

fn sunlight(normal : vec3f) -> vec3f {
    var light = vec3f(0.0);
    for (var sun = frame.light_count; sun < frame.light_count + frame.sun_count; sun++) {
        light += lights[sun].colour.rgb * max(dot(normal, lights[sun].sphere.xyz), 0.0);
    }
    return light;
}
`;

const listed_light = `
fn light_at(pixel : vec2u, position : vec3f, normal : vec3f) -> vec3f {
    var light = sunlight(normal);
    var listed = lightbin_begin(pixel, -position.z);
    while (lightbin_next(&listed)) {
        light += irradiance(listed.id, position, normal);
    }
    return light;
}
`;

const every_light = `
fn light_at(pixel : vec2u, position : vec3f, normal : vec3f) -> vec3f {
    var light = sunlight(normal);
    for (var id = 0u; id < frame.light_count; id++) {
        light += irradiance(id, position, normal);
    }
    return light;
}
`;

const lit_look = `
fn look(pixel : vec2u, position : vec3f, normal : vec3f, colour : vec3f) -> vec3f {
    return displayed(colour, normal, light_at(pixel, position, normal));
}
`;

// The number of the fragment's lights as a colour, shaded by how the surface faces the eye.
const heat_look = `
fn look(pixel : vec2u, position : vec3f, normal : vec3f, colour : vec3f) -> vec3f {
    let facing = abs(dot(normal, normalize(position)));
    return lightbin_heat(pixel, -position.z, frame.longest_list) * (0.4 + 0.6 * facing);
}
`;

// Grey, and magenta what is not where the View has it, or whose list lacks a light that reaches it.
const check_look = `
fn look(pixel : vec2u, position : vec3f, normal : vec3f, colour : vec3f) -> vec3f {
    var wrong = !lightbin_check_view(pixel, position);
    var light = lightbin_begin_missing(pixel, -position.z);
    while (lightbin_next_missing(&light, frame.light_count)) {
        if (light.lacked && any(irradiance(light.id, position, normal) != vec3f(0.0))) {
            wrong = true;
        }
    }
    let shown = displayed(colour, normal, light_at(pixel, position, normal));
    return select(vec3f(dot(shown, vec3f(0.3, 0.6, 0.1))), vec3f(1.0, 0.0, 1.0), wrong);
}
`;

const fragment = `
// From the fragment's own place, the very numbers that tiles and Z bounds are made of: an interpolated position differs
// from the depth buffer's by the rasteriser's rounding, which can be much at a triangle seen edge-on.
fn view_position(at : vec4f) -> vec3f {
    let p = frame.projection;
    let ndc = vec2f(2.0, -2.0) * (at.xy / frame.picture_size) + vec2f(-1.0, 1.0);
    let z = (p[3][2] - at.z * p[3][3]) / (at.z * p[2][3] - p[2][2]);
    let w = p[2][3] * z + p[3][3];
    return vec3f((ndc * w - p[2].xy * z - p[3].xy) / vec2f(p[0][0], p[1][1]), z);
}

@fragment fn fragment_main(surface : Surface, @builtin(front_facing) front : bool) -> @location(0) vec4f {
    let normal = normalize(select(-surface.normal, surface.normal, front));
    return vec4f(look(vec2u(surface.at.xy), view_position(surface.at), normal, surface.colour), 1.0);
}
`;

// `look`: 'lit', 'heat', 'check', or 'every_light', which reads no list; `snippet`: lightbin's text, '' for
// 'every_light'.
export function surface_shader(look, snippet, has_spots) {
    const looks = {lit: lit_look, every_light: lit_look, heat: heat_look, check: check_look};
    return snippet + resources + `const has_spots = ${has_spots};\n` + vertex + lighting +
        (look === 'every_light' ? every_light : listed_light) + looks[look] + fragment;
}

export const depth_shader = resources + vertex;
