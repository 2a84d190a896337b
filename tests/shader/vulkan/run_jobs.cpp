// SPDX-License-Identifier: MIT
// Runs the shaders' jobs on Vulkan: run_jobs [PART PARTS] takes every PARTS-th job from PART on.
#include "compile.hpp"
#include "device.hpp"

#include "../readers.hpp"

namespace {

constexpr const char* vertex_text = R"(#version 450
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

}  // namespace

int main(int count, char** arguments) {
    const std::size_t part = count == 3 ? std::stoul(arguments[1]) : 0;
    const std::size_t parts = count == 3 ? std::stoul(arguments[2]) : 1;
    VulkanDevice device;
    if (!device.validates()) {
        std::printf("the validation layer does not complain of a buffer without bytes\n");
        return 1;
    }
    std::string error;
    const auto vertex = compile_spirv(vertex_text, EShLangVertex, false, error);
    int runs = 0, refused = 0, wrong = 0;
    std::vector<ReaderRun> jobs = reader_runs(lightbin::ShaderLanguage::glsl_vulkan);
    for (const ReaderRun& run : reader_runs(lightbin::ShaderLanguage::hlsl_5_1))
        jobs.push_back(run);
    for (std::size_t i = part; i < jobs.size(); i += parts) {
        const Job job = jobs[i].job();
        ++runs;
        const auto kind = job.stage == Stage::compute ? EShLangCompute : EShLangFragment;
        const auto spirv = compile_spirv(job.text, kind, job.hlsl, error);
        if (spirv.empty()) {
            std::printf("%s is refused: %s\n%s\n", job.name.c_str(), error.c_str(), job.text.c_str());
            ++refused;
        } else if (device.run(job, spirv, vertex) != job.expected) {
            std::printf("%s is wrong\n", job.name.c_str());
            ++wrong;
        }
    }
    std::printf("%d runs on %s: %d refused, %d wrong, %d validation messages\n", runs, device.name().c_str(),
                refused, wrong, device.messages());
    return runs == 0 || refused + wrong + device.messages() > 0;
}
