// SPDX-License-Identifier: MIT
#include "gpu_lists.hpp"

#include "../buffer_of.hpp"

#include <algorithm>
#include <span>
#include <string>

namespace {

bool same_sphere(const lightbin::Sphere& a, const lightbin::Sphere& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.radius == b.radius;
}

void run_passes(Stage& stage, const std::vector<lightbin::ShaderText>& texts,
                std::span<const lightbin::CullPass> passes, const lightbin::CullPlan& plan) {
    for (std::size_t i = 0; i < passes.size(); ++i) {
        for (const lightbin::ShaderBinding& binding : texts[i].bindings)
            glBindBufferBase(
                binding.resource == lightbin::ShaderResource::uniform_block ? GL_UNIFORM_BUFFER
                                                                            : GL_SHADER_STORAGE_BUFFER,
                static_cast<GLuint>(binding.slot.binding), stage.memory.known(buffer_of(binding)));
        stage.use_compute(texts[i].text);
        const lightbin::CullGroups groups = plan.groups_of(passes[i]);
        glDispatchCompute(groups.x, groups.y, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }
}

}  // namespace

GpuLists::GpuLists(const lightbin::CullShaderOptions& options) : options_(options) {
    options_.lights_at.stride = 8;  // of Stage's buffer, in words: centre, range, intensity
    for (const lightbin::CullPass pass : lightbin::cull_passes) {
        texts_.push_back(value_of(lightbin::cull_shader(pass, options_)));
        texts_.back().text.insert(0, "#version 430 core\n");
    }
}

void GpuLists::build(Stage& stage, const lightbin::Slices* slices) {
    const bool known = std::ranges::equal(seen_, stage.lights(), same_sphere);
    seen_.assign(stage.lights().begin(), stage.lights().end());
    for (bool done = false; !done;) {
        const auto plan = value_of(lightbin::plan_cull(
            stage.view(), options_, {static_cast<std::uint32_t>(seen_.size()), room_}, slices));
        stage.memory.buffer("grid", std::span(&plan.constants, 1));
        const auto make = [&](const char* name, std::uint64_t bytes) {
            return stage.memory.buffer(name, static_cast<std::size_t>(bytes), nullptr);
        };
        const GLuint scratch = make("scratch", plan.bytes.scratch), tiles = make("tiles", plan.bytes.tiles),
                     lists = make("lists", plan.bytes.lists);
        stage.memory.read_texels(unit_tiles, GL_RG32UI, tiles);
        stage.memory.read_texels(unit_lists, GL_R32UI, lists);
        run_passes(stage, texts_, lightbin::cull_passes, plan);
        stage.lap("build");
        done = known;
        if (known) continue;
        lightbin::CullTotals totals{};
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glBindBuffer(GL_COPY_READ_BUFFER, scratch);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof totals, &totals);
        done = totals.entries <= room_;
        room_ = std::max(room_, totals.entries);
    }
}
