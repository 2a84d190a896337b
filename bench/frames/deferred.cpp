// SPDX-License-Identifier: MIT
// Deferred (Tiled Shading): one light after another, a rectangle of pixels each, added up in a target; every
// light reads the whole G-buffer again.
#include "deferred.hpp"

#include "technique.hpp"

void begin_radiance(Stage& stage, GLuint surface_depth, GLuint test_depth) {
    read_g_buffer(stage, surface_depth);
    stage.memory.draw_to({surface_target(stage, "radiance")}, test_depth);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    stage.use(stage.shaders().everywhere_vertex(), stage.shaders().ambient_fragment());
    stage.geometry.draw_everywhere();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
}

void show_radiance(Stage& stage) {
    glDisable(GL_BLEND);
    stage.memory.read_from(unit_radiance, surface_target(stage, "radiance"));
    stage.memory.draw_to({stage.drawn()}, 0);
    stage.use(stage.shaders().everywhere_vertex(), stage.shaders().show_fragment());
    stage.geometry.draw_everywhere();
    stage.lap("show");
}

Technique deferred(int g_buffer_bits) {
    return {.name = "Deferred",
            .draw =
                [](Stage& stage) {
                    fill_g_buffer(stage, stage.depth());
                    const auto footprints = stage.footprints(1);  // of tiles that are pixels
                    stage.lap("project");
                    stage.memory.read_texels(unit_footprints, GL_RGBA32UI,
                                             stage.memory.buffer("footprints", footprints));
                    stage.lap("upload");
                    begin_radiance(stage, stage.depth(), 0);
                    stage.use(stage.shaders().rectangle_vertex(), stage.shaders().one_light_fragment());
                    stage.geometry.draw_quads(footprints.size());
                    stage.lap("shade");
                    show_radiance(stage);
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 6,
            .g_buffer_bits = g_buffer_bits};
}
