// SPDX-License-Identifier: MIT
// TiledDeferred in one kernel as the paper has it (Tiled Shading, section 7): the CPU does nothing for it, and each group
// tests every light against the six planes of its tile, a thread a light.
#include "technique.hpp"
#include "tile_kernel.hpp"

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

}  // namespace

Technique tiled_deferred_planes(int g_buffer_bits) {
    return {.name = "TiledDeferred six planes",
            .draw =
                [](Stage& stage) {
                    GLint room = 0;
                    glGetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &room);
                    room = room / 4 - 3;  // two depths and the count
                    if (stage.lights().size() > static_cast<std::size_t>(room))
                        throw std::runtime_error("this OpenGL's groups have room for a list of " +
                                                 std::to_string(room) + " lights, and " +
                                                 std::to_string(stage.lights().size()) + " are in the scene");
                    shade_in_one_kernel(stage, {lights_within_planes, "int(listed[light.place])"},
                                        test_planes, [](GLuint) {});
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 3,
            .g_buffer_bits = g_buffer_bits,
            .glsl = 430};
}
