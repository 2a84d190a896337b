// SPDX-License-Identifier: MIT
// TiledDeferred in one kernel, whose groups test the lights' footprints and depths, which lightbin made, against their
// tile's, a thread a light (Tiled Shading, section 7; Andersson, "Parallel Graphics in Frostbite", SIGGRAPH 2009).
#include "technique.hpp"
#include "tile_kernel.hpp"

namespace {

// The lights that passed are bits, and not a list made with an atomic counter, so that every picture is the same: sums
// are in the order of the lights. And there is room for all.
const char* const lights_by_footprints = R"(
struct Footprint { uint id, low, high; float nearest, farthest; uint unused[3]; };
layout(std430, binding = 0) readonly buffer Footprints { Footprint footprints[]; };
uniform uint footprint_count;

#define WORDS ((LIGHTS + 31u) / 32u)
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

const char* const test_footprints = R"(
void clear_list(uint thread) {
    for (uint word = thread; word < WORDS; word += THREADS) passed[word] = 0u;
}

void list_lights(uint thread, uvec2 tile, float z_min, float z_max) {
    for (uint i = thread; i < footprint_count; i += THREADS) {
        Footprint f = footprints[i];
        uvec2 low = uvec2(f.low & 0xffffu, f.low >> 16u), high = uvec2(f.high & 0xffffu, f.high >> 16u);
        if (all(greaterThanEqual(tile, low)) && all(lessThanEqual(tile, high)) &&
            f.nearest <= z_max && f.farthest >= z_min)
            atomicOr(passed[i >> 5u], 1u << (i & 31u));
    }
}
)";

}  // namespace

Technique tiled_deferred_kernel(int g_buffer_bits) {
    return {
        .name = "TiledDeferred in one kernel",
        .draw =
            [](Stage& stage) {
                const auto footprints = stage.footprints();
                stage.lap("project");
                glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, stage.memory.buffer("footprints", footprints));
                stage.lap("upload");
                shade_in_one_kernel(stage, {lights_by_footprints, "int(footprints[light.id].id)"},
                                    test_footprints, [&](GLuint program) {
                                        glUniform1ui(glGetUniformLocation(program, "footprint_count"),
                                                     static_cast<GLuint>(footprints.size()));
                                    });
            },
        .tolerance = g_buffer_bits == 32 ? 1 : 3,
        .g_buffer_bits = g_buffer_bits,
        .glsl = 430};
}
