// SPDX-License-Identifier: MIT
// Runs the jobs of Vulkan GLSL, and of HLSL as SPIR-V: run_jobs [FIRST COUNT] takes a share of them.
#include "device.hpp"

#include "../run_jobs.hpp"

int main(int count, char** arguments) {
    const Share share = share_of(count, arguments);
    VulkanDevice device;
    if (!device.validates()) {
        std::printf("the validation layer does not complain of a buffer without bytes\n");
        return 1;
    }
    Tally tally;
    for (const auto language : {lightbin::ShaderLanguage::glsl_vulkan, lightbin::ShaderLanguage::hlsl_5_1}) {
        run_readers(device, language, share, tally, true, true);
        run_builders(device, language, false, share, tally);
    }
    std::printf("%s on %s, %d validation messages\n", tally.text().c_str(), device.name().c_str(),
                device.messages());
    return !tally.good() || device.messages() > 0;
}
