// SPDX-License-Identifier: MIT
// Writes a page that runs the jobs of GLSL ES 3.00: every text to compile, and those of the small screens to
// run.  write_jobs [FIRST COUNT]: takes a share of them.
#include "../job_json.hpp"
#include "../run_jobs.hpp"

#include <cstdio>

int main(int count, char** arguments) {
    constexpr auto language = lightbin::ShaderLanguage::essl_300;
    const Share share = share_of(count, arguments);
    std::printf("<!DOCTYPE html><body><script src=\"run_jobs.js\"></script>\n<script>runAll([\n");
    const auto readers = every_reader(language);
    for (std::size_t i = share.first; i < readers.size(); i += share.count) {
        const auto snippet = lightbin::shader_snippet(readers[i]);
        Job job;
        job.name = name_of(readers[i]);
        if (snippet) job.text = reader_text(readers[i], *snippet, Stage::fragment, 100, 100);
        std::printf("%s,\n", json(job, JobUse::compiles).c_str());
    }
    const auto runs = reader_runs(language);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        if (runs[i].screen.width < 100) std::printf("%s,\n", json(runs[i].job(), JobUse::runs).c_str());
    const auto multiview = multiview_runs(language);
    for (std::size_t i = share.first; i < multiview.size(); i += share.count)
        std::printf("%s,\n", json(multiview[i].job(), JobUse::runs).c_str());
    std::printf("]);</script>\n");
}
