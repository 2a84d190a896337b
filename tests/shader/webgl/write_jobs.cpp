// SPDX-License-Identifier: MIT
// Writes a page that runs the jobs of GLSL ES 3.00: every text to compile, and those of the small screens and of
// multiview to run.  write_jobs [FIRST COUNT]: takes a share of them.
#include "../job_json.hpp"
#include "../texts.hpp"

#include <cstdio>

int main(int count, char** arguments) {
    constexpr auto language = lightbin::ShaderLanguage::essl_300;
    const Share share = share_of(count, arguments);
    std::printf("<!DOCTYPE html><body><script src=\"run_jobs.js\"></script>\n<script>runAll([\n");
    const auto write = [](const Job& job, JobUse use) { std::printf("%s,\n", json(job, use).c_str()); };
    each_text(language, share,
              [&](const Job& job) { write(job, job.views > 1 ? JobUse::runs : JobUse::compiles); });
    const auto runs = reader_runs(language);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        if (runs[i].screen.width < 100) write(runs[i].job(), JobUse::runs);
    std::printf("]);</script>\n");
}
