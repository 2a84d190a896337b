// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include <gl_program.hpp>
#include <renderer.hpp>

#include <lightbin/shader.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

// As the block `Frame` of the shaders.
struct FrameConstants {
    glm::mat4 to_view, projection;
    glm::vec2 picture_size;
    std::int32_t light_count, unused = 0;
};

}  // namespace

bool is_software_renderer() {
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos;
}

Stage::Stage(const Scene& scene, int glsl)
    : geometry(scene), scene_(scene), glsl_(glsl), software_(is_software_renderer()) {
    glGenBuffers(1, &constants_);
    glGenBuffers(1, &counter_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

void Stage::reset_state() {
    for (const int off : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_DEPTH_CLAMP})
        glDisable(static_cast<GLenum>(off));
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Stage::begin(const Camera& camera, const Settings& settings) {
    while (glGetError() != GL_NO_ERROR) {  // of a frame that was given up
    }
    if (camera.orthographic) throw std::runtime_error("frames of orthographic cameras are not drawn here");
    settings_ = settings;
    const glm::dmat4 to_view = glm::inverse(camera.to_world);
    projection_ = projection_of(camera, static_cast<double>(settings.width) / settings.height);

    struct Lit {
        lightbin::Sphere sphere;
        glm::vec3 intensity;
    };
    std::vector<Lit> lit;
    for (const Light& light : scene_.lights) {
        const glm::vec3 centre(to_view * glm::dvec4(light.position, 1.0));
        lit.push_back({{centre.x, centre.y, centre.z, light.range}, light.intensity * settings.exposure});
    }
    std::ranges::stable_sort(lit, {}, [](const Lit& l) { return -l.sphere.z - l.sphere.radius; });
    spheres_.clear();
    gpu_lights_.clear();
    for (const auto& [sphere, intensity] : lit) {
        spheres_.push_back(sphere);
        gpu_lights_.emplace_back(sphere.x, sphere.y, sphere.z, sphere.radius);
        gpu_lights_.emplace_back(intensity, 0);
    }
    memory.read_texels(unit_lights, GL_RGBA32F, memory.buffer("lights", gpu_lights_));

    const FrameConstants constants{glm::mat4(to_view),
                                   projection_,
                                   {static_cast<float>(settings.width), static_cast<float>(settings.height)},
                                   static_cast<std::int32_t>(spheres_.size())};
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, constants_);
    glBufferData(GL_UNIFORM_BUFFER, sizeof constants, &constants, GL_STREAM_DRAW);
    if (settings.count) {
        if (glsl_ < 430) throw std::runtime_error("counting evaluations needs OpenGL 4.3");
        const std::uint64_t zero[2] = {};
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, counter_);
        glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, zero, GL_DYNAMIC_READ);
    }
    glViewport(0, 0, settings.width, settings.height);
    reset_state();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);  // of surfaces in one place the last is seen, with a pre-pass and without
    glFinish();
    laps_.clear();
    lap("");
}

// Times are read from the GPU's clock. The flush makes it read the clock when the work before it is done, not when more
// work comes. A software renderer reads it too early, so it is waited for.
void Stage::lap(const char* pass) {
    if (laps_.size() == clocks_.size()) glGenQueries(1, &clocks_.emplace_back());
    if (software_) glFinish();
    glQueryCounter(clocks_[laps_.size()], GL_TIMESTAMP);
    glFlush();
    laps_.emplace_back(pass);
}

std::vector<Pass> Stage::end() {
    glFinish();
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL reports error " + std::to_string(error));
    std::vector<Pass> passes;
    GLuint64 before = 0;
    for (std::size_t i = 0; i < laps_.size(); ++i) {
        GLuint64 now = 0;
        glGetQueryObjectui64v(clocks_[i], GL_QUERY_RESULT, &now);
        const double milliseconds = static_cast<double>(now - before) * 1e-6;
        before = now;
        if (i == 0) continue;
        const auto known = std::ranges::find(passes, laps_[i], &Pass::name);
        if (known == passes.end())
            passes.push_back({laps_[i], milliseconds});
        else
            known->milliseconds += milliseconds;
    }
    return passes;
}

std::uint64_t Stage::counted(std::size_t place) const {
    std::uint32_t words[4] = {};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, counter_);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof words, words);
    return (std::uint64_t{words[2 * place + 1]} << 32) + words[2 * place];
}

lightbin::View Stage::view(int tile_size) const {
    return value_of(
        lightbin::View::from_projection(projection_, {settings_.width, settings_.height},
                                        {.tile_size = tile_size == 0 ? settings_.tile_size : tile_size}));
}

std::vector<LightFootprint> Stage::footprints(int tile_size) const {
    lightbin::detail::Footprints projected;
    projected.project(lightbin::machine_isa(), view(tile_size), lightbin::detail::as_lights(spheres_),
                      lightbin::Parallel{});
    const lightbin::detail::FootprintArrays& of = projected.arrays();
    std::vector<LightFootprint> footprints;
    for (std::uint32_t i = 0; i < projected.visible(); ++i)
        footprints.push_back({of.ids[i], of.x0[i], of.y0[i], of.x1[i], of.y1[i]});
    return footprints;
}

void Stage::order_lights(std::span<const std::uint32_t> order) {
    std::vector<glm::vec4> ordered;
    for (const std::uint32_t light : order)
        ordered.insert(ordered.end(), {gpu_lights_[2 * light], gpu_lights_[2 * light + 1]});
    memory.read_texels(unit_lights, GL_RGBA32F, memory.buffer("lights", ordered));
}

GLuint Stage::set(GLuint program) const {
    glUseProgram(program);
    const lightbin::GridConstants grid = lightbin::grid_constants(view());
    glUniform4uiv(glGetUniformLocation(program, "lightbin_grid"), 1, &grid.tile_size);  // if it has one
    return program;
}

GLuint Stage::use(const std::string& vertex, const std::string& fragment) {
    GLuint& made = programs_[vertex + fragment];
    if (made == 0) set_samplers(made = link_program(vertex, fragment));
    return set(made);
}

GLuint Stage::target(const char* name, GLenum format) {
    return memory.target(name, format, settings_.width, settings_.height);
}

std::vector<std::uint8_t> Stage::read_picture() {
    std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(settings_.width) *
                                   static_cast<std::size_t>(settings_.height));
    memory.draw_to({drawn()}, 0);
    glReadPixels(0, 0, settings_.width, settings_.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
}
