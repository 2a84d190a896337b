// SPDX-License-Identifier: MIT
// Runs the jobs of Vulkan GLSL, and of HLSL as SPIR-V: run_jobs [FIRST COUNT] takes a share of them, and
// run_jobs multiview [FIRST COUNT] a share of those that draw two views at once.
#include "device.hpp"

#include "../cull_cases.hpp"
#include "../run_jobs.hpp"

#include <string>

int main(int count, char** arguments) {
    const Share share = share_of(count, arguments);
    VulkanDevice device;
    if (!device.validates()) {
        std::printf("the validation layer does not complain of a buffer without bytes\n");
        return 1;
    }
    Tally tally;
    bool culls = true;
    using enum lightbin::ShaderLanguage;
    if (count > 1 && std::string(arguments[1]) == "multiview")
        run_readers(device, multiview_runs(glsl_vulkan), share, tally);
    else
        for (const auto language : {glsl_vulkan, hlsl_5_1}) {
            run_readers(device, reader_runs(language, true, true), share, tally);
            run_reductions(device, language, false, share, tally);
            culls = CullTests(language, share).run(device) && culls;
        }
    std::printf("%s on %s, %d validation messages\n", tally.text().c_str(), device.name().c_str(),
                device.messages());
    return !tally.good() || !culls || device.messages() > 0;
}
