// SPDX-License-Identifier: MIT
// TiledDeferred with the grid made by compute passes: Z bounds, and lists by shader_cull. The CPU has no part in it.
#include "gpu_lists.hpp"
#include "passes.hpp"
#include "technique.hpp"

#include <lightbin/shader_reduce.hpp>

#include <memory>
#include <string>
#include <vector>

namespace {

/// The Z bounds of all tiles to the buffer "z_bounds".
void reduce(Stage& stage) {
    const lightbin::View view = stage.view();
    const lightbin::ReduceShaderOptions options{.samples = stage.settings().samples, .skip_background = true};
    const GLuint program =
        stage.use_compute("#version 430 core\n" + value_of(lightbin::reduce_shader(options)).text);
    set_reduction(stage, program, stage.depth());
    std::vector<lightbin::ShaderEdges> bounds(view.tile_count());  // the shader writes these
    const std::vector<lightbin::ShaderEdges> edges = lightbin::shader_edges(view);
    bounds.insert(bounds.end(), edges.begin(), edges.end());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(options.z_bounds.binding),
                     stage.memory.buffer("z_bounds", bounds));
    glDispatchCompute(static_cast<GLuint>(view.tiles_x()), static_cast<GLuint>(view.tiles_y()), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    stage.lap("reduce");
}

}  // namespace

Technique tiled_deferred_passes(int g_buffer_bits) {
    const auto lists =
        std::make_shared<GpuLists>(lightbin::CullShaderOptions{.depth_test = true});
    return {.name = "TiledDeferred by passes",
            .draw =
                [lists](Stage& stage) {
                    fill_g_buffer(stage, stage.depth());
                    reduce(stage);
                    lists->build(stage);
                    shade_deferred(stage, listed_lights());
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 3,
            .g_buffer_bits = g_buffer_bits,
            .glsl = 430};
}
