// SPDX-License-Identifier: MIT
// Runs the HLSL jobs on Direct3D 11: run_jobs [FIRST COUNT] takes a share of them.
#include "device.hpp"

#include "../cull_cases.hpp"
#include "../run_jobs.hpp"

int main(int count, char** arguments) {
    const Share share = share_of(count, arguments);
    constexpr auto language = lightbin::ShaderLanguage::hlsl_5_0;
    D3d11Device device;
    Tally tally;
    run_readers(device, reader_runs(language), share, tally);
    run_readers(device, multiview_runs(language), share, tally);
    run_reductions(device, language, false, share, tally);
    // Grids made on the GPU take many runs each, so that only every fifth of these cases is run.
    const bool culls = CullTests(language, {5 * share.first, 5 * share.count}).run(device);
    std::printf("%s\n", tally.text().c_str());
    return !tally.good() || !culls;
}
