// SPDX-License-Identifier: MIT
// TiledDeferred in one kernel as the paper has it (Tiled Shading, section 7): the CPU does nothing for it. A group of
// threads, one a pixel, finds between which depths its tile's surfaces lie, tests every light against the six planes of the
// tile, a thread a light, and then each thread lights its pixel.
#include "passes.hpp"
#include "technique.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace {

// In no order, so that sums of the same lights may be rounded otherwise from frame to frame.
const char* const lights_within_planes = R"(
shared uint listed_count, listed[LIGHTS];

struct Listed { uint place; };
#define each_light(light, pixel, view_depth) \
    for (Listed light = Listed(0u); light.place < listed_count; light.place += 1u)
)";

const char* const test_planes = R"(
void clear_list(uint thread) {
    if (thread == 0u) listed_count = 0u;
}

void list_lights(uint thread, uvec2 tile, float z_min, float z_max) {
    // Four planes through the eye and two of the tile's corners, whose order goes around it; then the depths. A point is
    // within where none is negative.
    vec2 low = vec2(tile * uint(TILE)), high = min(low + float(TILE), picture_size);
    vec3 corners[4] = vec3[4](view_position(low, 0.5), view_position(vec2(high.x, low.y), 0.5),
                              view_position(high, 0.5), view_position(vec2(low.x, high.y), 0.5));
    vec4 planes[6];
    for (int i = 0; i < 4; ++i) {
        vec3 normal = normalize(cross(corners[i], corners[(i + 1) & 3]));
        planes[i] = vec4(dot(normal, corners[(i + 2) & 3]) < 0.0 ? -normal : normal, 0.0);
    }
    planes[4] = vec4(0.0, 0.0, -1.0, -z_min);
    planes[5] = vec4(0.0, 0.0, 1.0, z_max);

    for (uint i = thread; i < uint(light_count); i += THREADS) {
        vec4 sphere = texelFetch(lights, int(2u * i));
        bool within = true;
        for (int k = 0; k < 6; ++k) within = within && dot(planes[k], vec4(sphere.xyz, 1.0)) >= -sphere.w;
        if (within) listed[atomicAdd(listed_count, 1u)] = i;
    }
}
)";

const char* const tile_kernel = R"(
layout(local_size_x = TILE, local_size_y = TILE) in;
layout(rgba8, binding = 0) writeonly uniform image2D picture;

shared uint nearest, farthest;  // view depths, positive floats being in the order of their bits

void main() {
    uint thread = gl_LocalInvocationIndex;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, ivec2(picture_size)));
    if (thread == 0u) {
        nearest = 0xffffffffu;
        farthest = 0u;
    }
    clear_list(thread);
    barrier();

    float depth = inside ? stored_depth(pixel) : 1.0;
    if (depth != 1.0) {
        uint z = floatBitsToUint(-view_position(vec2(pixel) + 0.5, depth).z);
        atomicMin(nearest, z);
        atomicMax(farthest, z);
    }
    barrier();

    if (nearest <= farthest)
        list_lights(thread, gl_WorkGroupID.xy, uintBitsToFloat(nearest), uintBitsToFloat(farthest));
    barrier();

    if (inside) {
        imageStore(picture, pixel, vec4(lit_pixel(pixel), 1.0));
        count();
    }
}
)";

GLint limit(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

void draw(Stage& stage) {
    const int tile = stage.settings().tile_size;
    const std::size_t lights = stage.lights().size();
    const GLint room = limit(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE) / 4 - 3,  // two depths and the count
        threads = limit(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    if (lights > static_cast<std::size_t>(room))
        throw std::runtime_error("this OpenGL's groups have room for a list of " + std::to_string(room) +
                                 " lights, and " + std::to_string(lights) + " are in the scene");
    if (tile * tile > threads)
        throw std::runtime_error("a thread a pixel of a tile: this OpenGL has at most " +
                                 std::to_string(threads));

    fill_g_buffer(stage, stage.depth());
    read_g_buffer(stage, stage.depth());
    const Shaders shaders = stage.shaders();
    const std::string constants = "#define TILE " + std::to_string(tile) + "\n#define THREADS " +
                                  std::to_string(tile * tile) + "u\n#define LIGHTS " +
                                  std::to_string(std::max<std::size_t>(lights, 1)) + "u\n";
    stage.use_compute(shaders.head() + constants +
                      shaders.deferred_functions({lights_within_planes, "int(listed[light.place])"}) +
                      test_planes + tile_kernel);
    glBindImageTexture(0, stage.drawn(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    const lightbin::View view = stage.view();
    glDispatchCompute(static_cast<GLuint>(view.tiles_x()), static_cast<GLuint>(view.tiles_y()), 1);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    stage.lap("build and shade");
}

}  // namespace

Technique tiled_deferred_planes(int g_buffer_bits) {
    return {.name = "TiledDeferred six planes",
            .draw = draw,
            .tolerance = g_buffer_bits == 32 ? 1 : 3,
            .g_buffer_bits = g_buffer_bits,
            .glsl = 430};
}
