// SPDX-License-Identifier: MIT
// Writes the jobs of WGSL, a line of JSON each: every text to compile, then those to run, then those whose results it asks
// for, to compare the light grids that several passes make. Lines that are not JSON are for people.
// write_jobs [FIRST COUNT]: takes a share of them.
#include "../cull_cases.hpp"
#include "../job_json.hpp"
#include "../run_jobs.hpp"
#include "piped_device.hpp"

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
    using enum JobUse;
    constexpr auto language = lightbin::ShaderLanguage::wgsl;
    const Share share = share_of(count, arguments);
    std::size_t turn = 0;
    const auto write = [&](JobUse use, const auto& make_job) {
        if (turn++ % share.count == share.first) std::printf("%s\n", json(make_job(), use).c_str());
    };
    for (const auto& options : every_reader(language))
        write(compiles, [&] { return reader_text_job(options); });
    for (const auto& options : every_reduction(language))
        write(compiles, [&] { return reduction_text_job(options); });
    for (const CullText& text : every_cull(language))
        write(compiles, [&] { return text_job(to_string(text.pass), text.shader(), Stage::compute); });
    for (const ReaderRun& run : reader_runs(language, true, true))
        write(runs, [&] { return run.job(); });
    for (const Job& job : reduce_jobs(language, true))
        write(runs, [&] { return job; });
    PipedDevice device;  // it takes long, so every fifth case must do
    return CullTests(language, {5 * share.first, 5 * share.count}).run(device) ? 0 : 1;
}
