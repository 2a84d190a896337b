// SPDX-License-Identifier: MIT
// run_gl 330|430|300|310 compile: hands every text of the library for a language to the compiler of this machine's OpenGL.
// run_gl 330|430|300|310 FIRST COUNT: runs a share of the jobs. The same lists at every screen both flipped and not are
// run by tests/shaders.sh, on Vulkan, in WebGL and on Direct3D.
#include "gl_device.hpp"
#include "run_jobs.hpp"
#include "texts.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int count, char** arguments) {
    if (count < 3) return 2;
    try {
        const int glsl = std::atoi(arguments[1]);
        const lightbin::ShaderLanguage language = glsl_language(glsl);
        GlDevice device(glsl);
        Tally tally;
        if (count == 3) {
            each_text(language, {}, [&](const Job& job) {
                // Mesa's software renderer lacks subgroups and multiview in OpenGL.
                if (job.views > 1 || job.text.find("subgroupMin") != std::string::npos) return;
                tally.count(job, [&] {
                    glDeleteProgram(device.program(job));
                    return true;
                });
            });
        } else {
            const Share share = share_of(count, arguments);
            run_readers(device, reader_runs(language, false, false), share, tally);
            run_reductions(device, language, false, share, tally);  // of several samples: tests/gl
        }
        std::printf("%s\n", tally.text().c_str());
        return !tally.good();
    } catch (const std::exception& problem) {
        std::printf("%s\n", problem.what());
        return EXIT_FAILURE;
    }
}
