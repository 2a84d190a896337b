// SPDX-License-Identifier: MIT
#include "culled_lights.hpp"

#include "gl_program.hpp"
#include "shaders.hpp"
#include "value_of.hpp"

#include <lightbin/shader_reduce.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace {

lightbin::ShaderLanguage language_of(int glsl) {
    return glsl == 310 ? lightbin::ShaderLanguage::essl_310 : lightbin::ShaderLanguage::glsl_430;
}

void dispatch(std::uint32_t x, std::uint32_t y) {
    glDispatchCompute(x, y, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

template <class T> std::vector<T> read(GLuint buffer, std::size_t count) {
    std::vector<T> values(count);
    const auto bytes = static_cast<GLsizeiptr>(count * sizeof(T));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, buffer);
    const void* const mapped = glMapBufferRange(GL_COPY_READ_BUFFER, 0, bytes, GL_MAP_READ_BIT);
    if (mapped) std::copy_n(static_cast<const T*>(mapped), count, values.begin());
    glUnmapBuffer(GL_COPY_READ_BUFFER);
    return values;
}

void allocate(GLuint buffer, std::size_t bytes, const void* data = nullptr) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_COPY);
}

}  // namespace

GLuint CulledLights::buffer(const char* name, std::size_t bytes, const void* data) {
    GLuint& buffer = buffers_[name];
    if (buffer == 0) glGenBuffers(1, &buffer);
    if (bytes < 16)  // none is empty
        allocate(buffer, 16);
    else
        allocate(buffer, bytes, data);
    return buffer;
}

void CulledLights::upload(std::span<const lightbin::Spot> lights) {
    light_count_ = static_cast<std::uint32_t>(lights.size());
    buffer("lights", lights.size_bytes(), lights.data());
}

void CulledLights::reduce(const lightbin::View& view, const FrameBuffer& drawn, bool skip_background) {
    const lightbin::ReduceOptions options{.language = language_of(glsl_),
                                                .samples = drawn.samples(),
                                                .orthographic = view.orthographic(),
                                                .skip_background = skip_background};
    GLuint& program = reduce_programs_[{options.samples, options.orthographic, skip_background}];
    if (program == 0)
        program = link_compute_program(version_line(glsl_) + value_of(lightbin::reduce_shader(options)).text);
    glUseProgram(program);
    const lightbin::ReduceConstants constants = lightbin::reduce_constants(view);
    glUniform4uiv(uniform(program, "lightbin_grid"), 1, &constants.tile_size);
    glUniform4fv(uniform(program, "lightbin_planes"), 1, &constants.far_end);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(options.depth.binding));
    drawn.bind_depth();
    // The depth test reads the sides of the tiles behind their bounds.
    const std::vector<lightbin::ShaderEdges> edges = lightbin::shader_edges(view);
    std::vector<lightbin::ShaderEdges> content(view.tile_count());
    content.insert(content.end(), edges.begin(), edges.end());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(options.z_bounds.binding),
                     buffer("z_bounds", sizeof(lightbin::ShaderEdges) * content.size(), content.data()));
    dispatch(static_cast<std::uint32_t>(view.tiles_x()), static_cast<std::uint32_t>(view.tiles_y()));
}

const std::vector<CulledLights::Pass>& CulledLights::passes(const lightbin::CullOptions& options) {
    std::vector<Pass>& made = passes_[{options.depth_test, options.max_only,
                                       options.slicing == lightbin::Slicing::clusters, options.orthographic}];
    if (!made.empty()) return made;
    for (const lightbin::CullPass which : lightbin::cull_passes) {
        const lightbin::ShaderText shader = value_of(lightbin::cull_shader(which, options));
        made.push_back({which, shader.bindings, link_compute_program(version_line(glsl_) + shader.text)});
    }
    return made;
}

CulledLights::Made CulledLights::build(const lightbin::View& view, const Lists& wanted, GLuint tiles,
                                       GLuint lists) {
    using enum lightbin::Slicing;
    lightbin::CullOptions options;
    options.language = language_of(glsl_);
    options.kind = has_spots_ ? lightbin::CullKind::spot : lightbin::CullKind::sphere;
    options.lights_at.stride = sizeof(lightbin::Spot) / 4;
    options.depth_test = wanted.depth_test;
    options.max_only = wanted.max_only;
    options.slicing = wanted.slices ? clusters : none;
    options.orthographic = view.orthographic();
    if (wanted.slices) {
        const std::vector<std::uint32_t> words = lightbin::shader_slices(*wanted.slices);
        buffer("slices", 4 * words.size(), words.data());
        std::vector<lightbin::ShaderEdges> depths = lightbin::shader_slabs(*wanted.slices);
        const std::vector<lightbin::ShaderEdges> edges = lightbin::shader_edges(view);
        depths.insert(depths.end(), edges.begin(), edges.end());
        buffer("z_bounds", sizeof(lightbin::ShaderEdges) * depths.size(), depths.data());
    }
    buffers_["tiles"] = tiles;
    buffers_["lists"] = lists;
    for (;;) {
        const lightbin::CullPlan plan =
            value_of(lightbin::plan_cull(view, options, {light_count_, room_}, wanted.slices));
        buffer("grid", sizeof plan.constants, &plan.constants);
        const GLuint scratch = buffer("scratch", static_cast<std::size_t>(plan.bytes.scratch));
        allocate(tiles, static_cast<std::size_t>(plan.bytes.tiles));
        allocate(lists, static_cast<std::size_t>(plan.bytes.lists));
        for (const Pass& pass : passes(options)) {
            glUseProgram(pass.program);
            for (const lightbin::ShaderBinding& binding : pass.bindings) {
                std::string name = binding.name.substr(options.prefix.size());
                name.erase(name.rfind("_block"));
                glBindBufferBase(binding.resource == lightbin::ShaderResource::uniform_block
                                     ? GL_UNIFORM_BUFFER
                                     : GL_SHADER_STORAGE_BUFFER,
                                 static_cast<GLuint>(binding.slot.binding), buffers_.at(name));
            }
            const lightbin::CullGroups groups = plan.groups_of(pass.which);
            dispatch(groups.x, groups.y);
        }
        const auto totals = read<lightbin::CullTotals>(scratch, 1)[0];
        if (totals.entries <= room_)
            return {totals, read<lightbin::ListRange>(tiles, static_cast<std::size_t>(plan.bytes.tiles) /
                                                                 sizeof(lightbin::ListRange))};
        room_ = totals.entries;
    }
}
