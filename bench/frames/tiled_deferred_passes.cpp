// SPDX-License-Identifier: MIT
// TiledDeferred with the grid made by compute passes: Z bounds, lights counted a tile, offsets, lists. The CPU only
// projects the lights.
#include "passes.hpp"
#include "technique.hpp"

#include <lightbin/shader_build.hpp>

#include <gl_program.hpp>

#include <string>

namespace {

void dispatch(const lightbin::View& view) {
    glDispatchCompute(static_cast<GLuint>(view.tiles_x()), static_cast<GLuint>(view.tiles_y()), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void reduce(Stage& stage, const lightbin::View& view) {
    const auto text =
        value_of(lightbin::reduce_shader({.samples = stage.settings().samples, .skip_background = true}));
    const GLuint program = stage.use_compute("#version 430 core\n" + text.text);
    set_reduction(stage, program, stage.depth());
    dispatch(view);
    stage.lap("reduce");
}

std::string text_of(lightbin::BuildPass pass) {
    const auto text = value_of(
        lightbin::build_shader({.pass = pass, .depth_test = lightbin::DepthTest::interval, .total = {4}}));
    return "#version 430 core\n" + text.text;
}

void build(Stage& stage, const lightbin::View& view, const lightbin::ShaderBuild& constants) {
    using enum lightbin::BuildPass;
    // Making the texts takes as long as a GPU has to run them.
    static const std::string texts[] = {text_of(count), text_of(offsets), text_of(fill)};
    for (const auto pass : {count, offsets, fill}) {
        const GLuint program = stage.use_compute(texts[static_cast<int>(pass)]);
        glUniform4uiv(uniform(program, "lightbin_grid"), 1, &constants.tiles_x);
        if (pass == offsets) {
            glDispatchCompute(1, 1, 1);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        } else {
            dispatch(view);
        }
    }
    stage.lap("build");
}

}  // namespace

Technique tiled_deferred_passes(int g_buffer_bits) {
    return {.name = "TiledDeferred by passes",
            .draw =
                [](Stage& stage) {
                    const lightbin::View view = stage.view();
                    const auto footprints = value_of(lightbin::shader_footprints(view, stage.lights()));
                    std::uint32_t room = 0;  // as many as without depths
                    for (const lightbin::ShaderFootprint& f : footprints)
                        room += static_cast<std::uint32_t>((f.x1 - f.x0 + 1) * (f.y1 - f.y0 + 1));
                    stage.lap("project");
                    const std::size_t tiles = view.tile_count();
                    const GLuint buffers[] = {stage.memory.buffer("footprints", footprints),
                                              stage.memory.buffer("Z bounds", 8 * tiles, nullptr),
                                              stage.memory.buffer("tiles", 8 * tiles, nullptr),
                                              stage.memory.buffer("lists", 4 * std::size_t{room}, nullptr),
                                              stage.memory.buffer("total", 4, nullptr)};
                    for (GLuint i = 0; i < std::size(buffers); ++i)
                        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]);
                    stage.lap("upload");

                    fill_g_buffer(stage, stage.depth());
                    reduce(stage, view);
                    build(stage, view,
                          lightbin::shader_build(view, static_cast<std::uint32_t>(footprints.size()), room));
                    stage.memory.read_texels(unit_tiles, GL_RG32UI, buffers[2]);
                    stage.memory.read_texels(unit_lists, GL_R32UI, buffers[3]);
                    shade_deferred(stage, listed_lights());
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 3,
            .g_buffer_bits = g_buffer_bits,
            .glsl = 430};
}
