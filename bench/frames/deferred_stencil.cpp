// SPDX-License-Identifier: MIT
// DeferredStencil (Tiled Shading, section 6.3; Arvo, Aila 2003): like Deferred, but a light's sphere first marks the
// pixels whose surface lies in it, and only those are lit.
#include "deferred.hpp"
#include "technique.hpp"

#include <gl_program.hpp>

#include <string>

namespace {

// Copies the depth buffer, because a shader cannot read the one that is tested against.
GLuint copy_depth(Stage& stage, GLuint from) {
    const GLuint to = stage.target("depth and stencil", GL_DEPTH32F_STENCIL8);
    const GLuint source = stage.memory.framebuffer({}, from), target = stage.memory.framebuffer({}, to);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, source);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    const auto [width, height] = stage.view().viewport();
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT,
                      GL_NEAREST);
    stage.lap("copy depth");
    return to;
}

// Counts in the stencil: the back of the light's sphere adds one where it lies behind the surface, and the front takes
// one away where it does. What remains marks surfaces inside the sphere.
void mark(const Stage& stage) {
    glEnable(GL_DEPTH_TEST);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_CULL_FACE);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    stage.geometry.draw_ball();
}

// Lights the marked pixels, and removes their marks.
void light_marked(const Stage& stage) {
    glDisable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glStencilFunc(GL_NOTEQUAL, 0, 0xff);
    glStencilOp(GL_KEEP, GL_ZERO, GL_ZERO);
    stage.geometry.draw_ball();
}

}  // namespace

Technique deferred_stencil(int g_buffer_bits) {
    return {.name = "DeferredStencil",
            .draw =
                [](Stage& stage) {
                    const GLuint depth = stage.target("surface depth", GL_DEPTH32F_STENCIL8);
                    fill_g_buffer(stage, depth);
                    const GLuint tested = copy_depth(stage, depth);
                    const auto footprints = stage.footprints();
                    stage.lap("project");
                    begin_radiance(stage, depth, tested);
                    glEnable(GL_STENCIL_TEST);
                    glEnable(GL_DEPTH_CLAMP);  // or the near plane would cut balls open
                    const std::string vertex = stage.shaders().ball_vertex();
                    const GLuint marking = stage.use(vertex, stage.shaders().depth_fragment()),
                                 lighting = stage.use(vertex, stage.shaders().one_light_fragment());
                    const GLint marking_number = uniform(marking, "number"),
                                lighting_number = uniform(lighting, "number");
                    for (const LightFootprint& f : footprints) {
                        glUseProgram(marking);
                        glUniform1i(marking_number, static_cast<GLint>(f.id));
                        mark(stage);
                        glUseProgram(lighting);
                        glUniform1i(lighting_number, static_cast<GLint>(f.id));
                        light_marked(stage);
                    }
                    for (const int off : {GL_STENCIL_TEST, GL_DEPTH_CLAMP, GL_CULL_FACE})
                        glDisable(static_cast<GLenum>(off));
                    stage.lap("shade");
                    show_radiance(stage);
                },
            .tolerance = g_buffer_bits == 32 ? 1 : 6,
            .g_buffer_bits = g_buffer_bits};
}
