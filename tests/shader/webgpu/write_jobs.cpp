// SPDX-License-Identifier: MIT
// Writes the jobs of WGSL, a line of JSON each: every text to compile, then those to run.
// write_jobs [FIRST COUNT]: takes a share of them.
#include "../job_json.hpp"
#include "../run_jobs.hpp"

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

/// A text to compile, and what it wants bound.
Job text_job(const std::string& name, const lightbin::ShaderText& shader, Stage stage) {
    Job job;
    job.name = name;
    job.text = shader.text;
    job.stage = stage;
    for (const lightbin::ShaderBinding& binding : shader.bindings) {
        Input input;
        input.binding = binding;
        job.inputs.push_back(input);
    }
    return job;
}

Job reader_text_job(const lightbin::ShaderOptions& options) {
    lightbin::ShaderText shader = *shader_snippet(options);
    shader.text = reader_text(options, shader, Stage::fragment, 100, 100);
    return text_job(name_of(options), shader, Stage::fragment);
}

Job reduction_text_job(const lightbin::ReduceShaderOptions& options) {
    const bool compute = options.stage == lightbin::ShaderStage::compute;
    Job job = text_job("reduction", *reduce_shader(options), compute ? Stage::compute : Stage::fragment);
    job.within = {{0, 0}};  // it writes floats
    for (Input& input : job.inputs)
        input.samples = static_cast<std::uint32_t>(options.samples);
    return job;
}

}  // namespace

int main(int count, char** arguments) {
    constexpr auto language = lightbin::ShaderLanguage::wgsl;
    const Share share = share_of(count, arguments);
    std::size_t turn = 0;
    const auto write = [&](bool runs, const auto& make_job) {
        if (turn++ % share.count == share.first) std::printf("%s\n", json(make_job(), runs).c_str());
    };
    for (const auto& options : every_reader(language))
        write(false, [&] { return reader_text_job(options); });
    for (const auto& options : every_reduction(language))
        write(false, [&] { return reduction_text_job(options); });
    for (const auto& options : every_build(language))
        write(false, [&] { return text_job("build", *build_shader(options), Stage::compute); });
    for (const ReaderRun& run : reader_runs(language, true, true))
        write(true, [&] { return run.job(); });
    for (const Job& job : build_jobs(language))
        write(true, [&] { return job; });
    for (const Job& job : reduce_jobs(language, true))
        write(true, [&] { return job; });
}
