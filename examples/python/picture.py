# SPDX-License-Identifier: MIT
"""python3 picture.py LIBRARY HEADER [PICTURE.ppm]: draws the lights of masks.py on a floor with moderngl (Debian:
python3-moderngl), off screen. Shaders read the masks from one uniform block. By every light the picture has the same bytes."""
import ctypes
import sys

import moderngl

import masks
from lightbin import Library

vertex_text = """#version 330
void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }"""

# Goes below lightbin's text. Each pixel shows the point of the floor, y = 0, that its ray from the eye meets.
fragment_text = """
uniform sampler2D lights;
uniform mat4 camera;
uniform vec2 scale;
uniform bool every_light;
out vec4 pixel;
vec3 shade(int light, vec3 position) {
    vec4 sphere = texelFetch(lights, ivec2(light, 0), 0);
    float apart = max(distance(sphere.xyz, position), 0.01);
    float strength = sphere.y / apart * lightbin_window(apart, sphere.w) / (0.5 + apart * apart);
    return strength * (1 + cos(light + vec3(0, 2.1, 4.2)));
}
void main() {
    vec3 eye = -transpose(mat3(camera)) * camera[3].xyz;
    vec3 ray = transpose(mat3(camera)) * vec3((gl_FragCoord.xy * 2 / lightbin_grid.zw - 1) * scale, -1);
    vec3 position = eye - ray * (eye.y / ray.y), sum = vec3(0.02);
    if (ray.y >= 0) sum = vec3(0);
    else if (every_light)
        for (int light = 0; light < textureSize(lights, 0).x; ++light) sum += shade(light, position);
    else
        lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), 0.0) sum += shade(int(light.id), position);
    pixel = vec4(pow(1 - exp(-sum), vec3(0.45)), 1);
}
"""

lib = Library(*sys.argv[1:3])
view, made, binner = masks.make(lib)
snippet = lib.create("shader_snippet", lib.struct(
    "snippet_options", language=lib.values["GLSL_330"], storage=lib.values["UNIFORM_BLOCK"], window=1, masks=1))
grid = lib.struct("grid_constants")
lib.call("get_grid_constants", view, 0, 0, grid)

gl = moderngl.create_context(standalone=True, backend="egl", require=330)
size = masks.width, masks.height
program = gl.program(vertex_shader=vertex_text, fragment_shader="#version 330\n" + lib.call(
    "shader_text", snippet).decode() + fragment_text)
block = gl.buffer(reserve=16384)
block.write(ctypes.string_at(made.words, made.word_count * 4))
block.bind_to_uniform_block(0)
program["lightbin_masks_block"].binding = 0
program["lightbin_grid"].value = grid.tile_size, grid.tiles_x, grid.width, grid.height
gl.texture((masks.count, 1), 4, bytes(masks.lights), dtype="f4").use(0)
program["camera"].write(bytes(masks.camera))
program["scale"].value = 1 / masks.projection[0], 1 / masks.projection[5]
triangle = gl.vertex_array(program, [])
target = gl.simple_framebuffer(size)
target.use()
pictures = []
for every_light in False, True:
    program["every_light"].value = every_light
    triangle.render(vertices=3)
    pictures.append(target.read(components=3, alignment=1))
bright = sum(byte > 80 for byte in pictures[1])
if len(sys.argv) > 3:
    lines = [pictures[0][y * size[0] * 3:][:size[0] * 3] for y in reversed(range(size[1]))]
    open(sys.argv[3], "wb").write(b"P6 %d %d 255\n" % size + b"".join(lines))
print(f"{masks.count} lights, {bright} bright bytes:", "identical" if pictures[0] == pictures[1] else "DIFFERENT")
sys.exit(pictures[0] != pictures[1] or bright < len(pictures[1]) / 10)
