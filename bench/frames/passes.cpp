// SPDX-License-Identifier: MIT
#include "passes.hpp"

#include <gl_program.hpp>

#include <lightbin/shader.hpp>
#include <lightbin/shader_reduce.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

void begin_picture(Stage& stage) {
    stage.memory.draw_to({stage.drawn()}, stage.depth());
    glClearColor(0.02f, 0.025f, 0.04f, 1);  // as `sky` of the shaders
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void depth_pre_pass(Stage& stage) {
    stage.use(stage.shaders().surface_vertex(), stage.shaders().depth_fragment());
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    stage.geometry.draw_opaque();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    stage.lap("pre-Z");
}

void shade_forward(Stage& stage, const LightLookup& lights) {
    stage.memory.draw_to({stage.drawn()}, stage.depth());
    stage.use(stage.shaders().surface_vertex(), stage.shaders().forward_fragment(lights));
    stage.geometry.draw_opaque();
    stage.lap("shade");
}

GLuint surface_target(Stage& stage, const char* name) {
    return stage.target(name, stage.settings().wide ? GL_RGBA32F : GL_RGBA16F);
}

void fill_g_buffer(Stage& stage, GLuint depth) {
    stage.memory.draw_to({surface_target(stage, "diffuse"), surface_target(stage, "specular"),
                          surface_target(stage, "ambient"), surface_target(stage, "normal")},
                         depth);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    stage.use(stage.shaders().surface_vertex(), stage.shaders().g_buffer_fragment());
    stage.geometry.draw_opaque();
    stage.lap("G-buffer");
}

void read_g_buffer(Stage& stage, GLuint depth) {
    stage.memory.read_from(unit_depth, depth);
    stage.memory.read_from(unit_diffuse, surface_target(stage, "diffuse"));
    stage.memory.read_from(unit_specular, surface_target(stage, "specular"));
    stage.memory.read_from(unit_ambient, surface_target(stage, "ambient"));
    stage.memory.read_from(unit_normal, surface_target(stage, "normal"));
}

void shade_deferred(Stage& stage, const LightLookup& lights) {
    read_g_buffer(stage, stage.depth());
    stage.memory.draw_to({stage.drawn()}, 0);
    stage.use(stage.shaders().everywhere_vertex(), stage.shaders().deferred_fragment(lights));
    stage.geometry.draw_everywhere();
    stage.lap("shade");
}

lightbin::ZBounds DepthBounds::reduce(Stage& stage) {
    const lightbin::View view = stage.view();
    lightbin::ReduceOptions options;
    options.language = lightbin::ShaderLanguage::glsl_330;
    options.stage = lightbin::ShaderStage::fragment;
    options.skip_background = true;
    const GLuint program = stage.use(stage.shaders().everywhere_vertex(),
                                     "#version 330 core\n" + value_of(lightbin::reduce_shader(options)).text);
    const lightbin::ReduceConstants constants = lightbin::reduce_constants(view);
    glUniform4uiv(uniform(program, "lightbin_grid"), 1, &constants.tile_size);
    glUniform4fv(uniform(program, "lightbin_planes"), 1, &constants.far_end);
    stage.memory.read_from(unit_depth, stage.depth());
    const GLuint reduced = stage.memory.target("Z bounds", GL_RG32F, view.tiles_x(), view.tiles_y());
    stage.memory.draw_to({reduced}, 0);
    glViewport(0, 0, view.tiles_x(), view.tiles_y());
    stage.geometry.draw_everywhere();
    glViewport(0, 0, stage.settings().width, stage.settings().height);
    stage.lap("reduce");

    depth_.resize(2 * view.tile_count());
    glReadPixels(0, 0, view.tiles_x(), view.tiles_y(), GL_RG, GL_FLOAT, depth_.data());
    min_.resize(view.tile_count());
    max_.resize(view.tile_count());
    for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
        min_[tile] = depth_[2 * tile];
        max_[tile] = depth_[2 * tile + 1];
    }
    stage.lap("read back");
    return {.min = min_, .max = max_};
}

lightbin::LightGrid<std::uint32_t> IntervalLists::bin(Stage& stage, const lightbin::ZBounds& bounds) {
    const auto& lights = stage.lights();
    const auto grid = value_of(binner_.bin(stage.view(), lights));
    ranges_.clear();
    ids_.clear();
    for (std::size_t tile = 0; tile < grid.ranges().size(); ++tile) {
        const double min = bounds.min.empty() ? -HUGE_VAL : static_cast<double>(bounds.min[tile]),
                     max = bounds.max.empty() ? HUGE_VAL : static_cast<double>(bounds.max[tile]);
        const lightbin::ListRange all = grid.ranges()[tile];
        const auto offset = static_cast<std::uint32_t>(ids_.size());
        for (const std::uint32_t id : grid.ids().subspan(all.offset, all.count)) {
            const double z = static_cast<double>(lights[id].z),
                         radius = static_cast<double>(lights[id].radius);
            if (min <= max && radius - z >= min && -radius - z <= max) ids_.push_back(id);
        }
        ranges_.push_back({offset, static_cast<std::uint32_t>(ids_.size()) - offset});
    }
    return {grid.tiles_x(), grid.tiles_y(), ranges_, ids_, grid.light_counts()};
}

void upload_lists(Stage& stage, const lightbin::LightGrid<std::uint32_t>& grid) {
    stage.memory.read_texels(unit_tiles, GL_RG32UI, stage.memory.buffer("tiles", grid.ranges()));
    stage.memory.read_texels(unit_lists, GL_R32UI, stage.memory.buffer("lists", grid.ids()));
    stage.lap("upload");
}

void upload_slices(Stage& stage, const lightbin::Slices& slices, const lightbin::LightRanks& ranks) {
    const std::vector<std::uint32_t> words = lightbin::shader_slices(slices);
    stage.memory.read_texels(unit_slices, GL_R32UI, stage.memory.buffer("slices", words));
    stage.memory.read_texels(unit_bins, GL_RG32UI, stage.memory.buffer("bins", ranks.bins));
}

float depth_of_lights(const Stage& stage) {
    float last = 1;
    for (const lightbin::Sphere& light : stage.lights())
        last = std::max(last, light.radius - light.z);
    return std::min(last, 1e30f);
}
