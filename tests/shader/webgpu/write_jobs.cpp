// SPDX-License-Identifier: MIT
// Writes the jobs of WGSL, a line of JSON each: every text to compile, then those to run, then those whose results it asks
// for, to compare the light grids that several passes make. Lines that are not JSON are for people.
// write_jobs [FIRST COUNT]: takes a share of them.
#include "../cull_cases.hpp"
#include "../texts.hpp"
#include "piped_device.hpp"

#include <cstdio>

int main(int count, char** arguments) {
    constexpr auto language = lightbin::ShaderLanguage::wgsl;
    const Share share = share_of(count, arguments);
    const auto write = [](const Job& job, JobUse use) { std::printf("%s\n", json(job, use).c_str()); };
    each_text(language, share, [&](const Job& job) { write(job, JobUse::compiles); });
    const auto runs = reader_runs(language, true, true);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        write(runs[i].job(), JobUse::runs);
    const auto reductions = reduce_jobs(language, true);
    for (std::size_t i = share.first; i < reductions.size(); i += share.count)
        write(reductions[i], JobUse::runs);
    PipedDevice device;  // it takes long, so every fifth case must do
    return CullTests(language, {5 * share.first, 5 * share.count}).run(device) ? 0 : 1;
}
