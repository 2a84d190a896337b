// SPDX-License-Identifier: MIT
// Every text of the library for a language.
#pragma once

#include "builders.hpp"
#include "cull.hpp"
#include "readers.hpp"

#include <string>
#include <utility>

/// Returns a job to compile a text, with its bindings but without data.
inline Job text_job(std::string name, lightbin::ShaderLanguage language, Stage stage,
                    lightbin::ShaderText shader, int samples = 1) {
    Job job;
    job.name = std::move(name);
    job.text = std::move(shader.text);
    job.hlsl = lightbin::detail::Dialect{language}.hlsl;
    job.stage = stage;
    for (lightbin::ShaderBinding& binding : shader.bindings)
        job.inputs.push_back({std::move(binding), {}, 0, 0, static_cast<std::uint32_t>(samples)});
    return job;
}

inline Job reader_text_job(const lightbin::SnippetOptions& options, Stage stage) {
    lightbin::ShaderText shader = *shader_snippet(options);
    shader.text = reader_text(options, shader, stage, 99, 99);
    Job job = text_job("a snippet", options.language, stage, std::move(shader));
    if (stage == Stage::compute) job.inputs.push_back(result_input(0));
    return job;
}

inline Job reduction_text_job(const lightbin::ReduceOptions& options) {
    lightbin::ShaderText shader = *reduce_shader(options);
    shader.text = version_line(options.language) + shader.text;
    Job job = text_job("a reduction", options.language,
                       options.fragment ? Stage::fragment : Stage::compute,
                       std::move(shader), options.samples);
    job.within = {{0, 0}};  // it writes floats
    return job;
}

inline Job cull_text_job(const CullText& text) {
    lightbin::ShaderText shader = text.shader();
    shader.text = version_line(text.options.language) + shader.text;
    return text_job(std::string("the pass ") + to_string(text.pass), text.options.language, Stage::compute,
                    std::move(shader));
}

/// Calls visit(job) for a share of all texts of a language.
template <class Visit>
void each_text(lightbin::ShaderLanguage language, const Share& share, const Visit& visit) {
    const lightbin::detail::Dialect dialect{language};
    std::size_t turn = 0;
    const auto add = [&](const auto& make) {
        if (turn++ % share.count == share.first) visit(make());
    };
    for (const lightbin::SnippetOptions& options : every_reader(language))
        for (const Stage stage : {Stage::fragment, Stage::compute})
            if (stage == Stage::fragment || dialect.storage_buffers)
                add([&] { return reader_text_job(options, stage); });
    if (!dialect.webgpu)  // it has no multiview
        for (const ReaderRun& run : multiview_runs(language))
            add([&] { return run.job(); });
    for (const lightbin::ReduceOptions& options : every_reduction(language))
        add([&] { return reduction_text_job(options); });
    for (const CullText& text : every_cull(language))
        add([&] { return cull_text_job(text); });
}
