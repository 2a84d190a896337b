// SPDX-License-Identifier: MIT
// Runs the HLSL jobs on Direct3D 11: run_jobs [PART PARTS] takes every PARTS-th job from PART on.
#include "device.hpp"
#include "fxc.hpp"

#include "../readers.hpp"

namespace {

// Clockwise seen from the viewer, as Direct3D culls the others.
constexpr const char* vertex_text = R"(
float4 main(uint index : SV_VertexID) : SV_Position {
    return float4(float2(index >> 1, index & 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

}  // namespace

int main(int count, char** arguments) {
    const std::size_t part = count == 3 ? std::stoul(arguments[1]) : 0;
    const std::size_t parts = count == 3 ? std::stoul(arguments[2]) : 1;
    const Fxc fxc;
    D3d11Device device;
    std::string error;
    const auto vertex = fxc(vertex_text, "vs_5_0", error);
    int runs = 0, refused = 0, wrong = 0;
    const std::vector<ReaderRun> jobs = reader_runs(lightbin::ShaderLanguage::hlsl_5_0);
    for (std::size_t i = part; i < jobs.size(); i += parts) {
        const Job job = jobs[i].job();
        ++runs;
        const auto code = fxc(job.text, job.stage == Stage::compute ? "cs_5_0" : "ps_5_0", error);
        if (code.empty()) {
            std::printf("%s is refused: %s\n%s\n", job.name.c_str(), error.c_str(), job.text.c_str());
            ++refused;
        } else if (device.run(job, code, vertex) != job.expected) {
            std::printf("%s is wrong\n", job.name.c_str());
            ++wrong;
        }
    }
    std::printf("%d runs on Direct3D 11: %d refused, %d wrong\n", runs, refused, wrong);
    return runs == 0 || refused + wrong > 0;
}
