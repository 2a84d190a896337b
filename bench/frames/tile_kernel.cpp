// SPDX-License-Identifier: MIT
#include "tile_kernel.hpp"

#include "passes.hpp"

#include <algorithm>
#include <stdexcept>

namespace {

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

    for (int i = 0; inside && i < SAMPLES; ++i) {
        float depth = stored_depth(pixel, i);
        if (depth == 1.0) continue;
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

}  // namespace

void shade_in_one_kernel(Stage& stage, const LightLookup& lookup, const std::string& list_lights,
                         const std::function<void(GLuint program)>& set) {
    const int tile = stage.settings().tile_size;
    GLint threads = 0;
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &threads);
    if (tile * tile > threads)
        throw std::runtime_error("a thread a pixel of a tile: this OpenGL has at most " +
                                 std::to_string(threads));

    fill_g_buffer(stage, stage.depth());
    read_g_buffer(stage, stage.depth());
    const Shaders shaders = stage.shaders();
    const std::string constants = "#define TILE " + std::to_string(tile) + "\n#define THREADS " +
                                  std::to_string(tile * tile) + "u\n#define LIGHTS " +
                                  std::to_string(std::max<std::size_t>(stage.lights().size(), 1)) + "u\n";
    const GLuint program = stage.use_compute(shaders.head() + constants + shaders.deferred_functions(lookup) +
                                             list_lights + tile_kernel);
    set(program);
    glBindImageTexture(0, stage.shown(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    const lightbin::View view = stage.view();
    glDispatchCompute(static_cast<GLuint>(view.tiles_x()), static_cast<GLuint>(view.tiles_y()), 1);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    stage.lap("build and shade");
}
