// SPDX-License-Identifier: MIT
// TiledDeferred in one kernel, a group of threads a tile and a thread a pixel: the group finds its depths, tests the
// lights against them, a thread a light, and then each thread lights its pixel by those that passed (Tiled Shading,
// section 4; Andersson, "Parallel Graphics in Frostbite", SIGGRAPH 2009).
#include "passes.hpp"
#include "technique.hpp"

#include <lightbin/shader_build.hpp>

#include <stdexcept>
#include <string>

namespace {

// The lights that passed are bits, and not a list made with an atomic counter, so that every picture is the same: sums
// are in the order of the lights. And there is room for all.
const char* const tile_lights = R"(
struct Footprint { uint id, low, high; float reach2; vec4 sphere; };
layout(std430, binding = 0) readonly buffer Footprints { Footprint footprints[]; };
uniform uint footprint_count;

shared uint nearest, farthest;  // view depths, positive floats being in the order of their bits
shared uint passed[WORDS];

struct Passed { uint id, word, bits; };
bool next(inout Passed p) {
    while (p.bits == 0u) {
        p.word += 1u;
        if (p.word >= (footprint_count + 31u) / 32u) return false;
        p.bits = passed[p.word];
    }
    p.id = 32u * p.word + uint(findLSB(p.bits));
    p.bits &= p.bits - 1u;
    return true;
}
#define each_light(light, pixel, view_depth) for (Passed light = Passed(0u, 0xffffffffu, 0u); next(light);)
)";

const char* const kernel = R"(
layout(local_size_x = TILE, local_size_y = TILE) in;
layout(rgba8, binding = 0) writeonly uniform image2D picture;

void main() {
    uint thread = gl_LocalInvocationIndex;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, ivec2(picture_size)));
    if (thread == 0u) {
        nearest = 0xffffffffu;
        farthest = 0u;
    }
    for (uint word = thread; word < WORDS; word += THREADS) passed[word] = 0u;
    barrier();

    for (int i = 0; inside && i < SAMPLES; ++i) {
        float depth = stored_depth(pixel, i);
        if (depth == 1.0) continue;
        uint z = floatBitsToUint(-view_position(vec2(pixel) + 0.5, depth).z);
        atomicMin(nearest, z);
        atomicMax(farthest, z);
    }
    barrier();

    float z_min = uintBitsToFloat(nearest), z_max = uintBitsToFloat(farthest);
    uvec2 tile = gl_WorkGroupID.xy;
    for (uint i = thread; nearest <= farthest && i < footprint_count; i += THREADS) {
        Footprint f = footprints[i];
        uvec2 low = uvec2(f.low & 0xffffu, f.low >> 16u), high = uvec2(f.high & 0xffffu, f.high >> 16u);
        if (all(greaterThanEqual(tile, low)) && all(lessThanEqual(tile, high)) &&
            f.sphere.z - f.sphere.w <= z_max && f.sphere.z + f.sphere.w >= z_min)
            atomicOr(passed[i >> 5u], 1u << (i & 31u));
    }
    barrier();

    if (inside) {
        imageStore(picture, pixel, vec4(lit_pixel(pixel), 1.0));
        count();
    }
}
)";

}  // namespace

Technique tiled_deferred_kernel(int g_buffer_bits) {
    return {
        .name = "TiledDeferred in one kernel",
        .draw =
            [](Stage& stage) {
                const int tile = stage.settings().tile_size;
                GLint threads = 0;
                glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &threads);
                if (tile * tile > threads)
                    throw std::runtime_error("a thread a pixel of a tile: this OpenGL has at most " +
                                             std::to_string(threads));
                const lightbin::View view = stage.view();
                const auto footprints = value_of(lightbin::shader_footprints(view, stage.lights()));
                stage.lap("project");
                glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, stage.memory.buffer("footprints", footprints));
                stage.lap("upload");

                fill_g_buffer(stage, stage.depth());
                read_g_buffer(stage, stage.depth());
                const Shaders shaders = stage.shaders();
                const std::string constants = "#define TILE " + std::to_string(tile) + "\n#define THREADS " +
                                              std::to_string(tile * tile) + "u\n#define WORDS " +
                                              std::to_string(stage.lights().size() / 32 + 1) + "u\n";
                const LightLookup lights = {tile_lights, "int(footprints[light.id].id)"};
                const GLuint program = stage.use_compute(shaders.head() + constants +
                                                         shaders.deferred_functions(lights) + kernel);
                glUniform1ui(glGetUniformLocation(program, "footprint_count"),
                             static_cast<GLuint>(footprints.size()));
                glBindImageTexture(0, stage.shown(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
                glDispatchCompute(static_cast<GLuint>(view.tiles_x()), static_cast<GLuint>(view.tiles_y()),
                                  1);
                glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
                stage.lap("build and shade");
            },
        .tolerance = g_buffer_bits == 32 ? 1 : 3,
        .g_buffer_bits = g_buffer_bits,
        .glsl = 430};
}
