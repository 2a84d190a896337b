// SPDX-License-Identifier: MIT
// Runs the jobs of a language on OpenGL: run_gl 330|430|300|310 FIRST COUNT takes a share of them. The same lists at every
// screen both flipped and not are run by tests/shaders.sh, on Vulkan, in WebGL and on Direct3D.
#include "gl_device.hpp"
#include "run_jobs.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int count, char** arguments) {
    try {
        const int glsl = count < 2 ? 430 : std::atoi(arguments[1]);
        const Share share = share_of(count, arguments);
        GlDevice device(glsl);
        Tally tally;
        run_readers(device, glsl_language(glsl), share, tally, false);
        run_reductions(device, glsl_language(glsl), true, share, tally);
        std::printf("%s\n", tally.text().c_str());
        return !tally.good();
    } catch (const std::exception& problem) {
        std::printf("%s\n", problem.what());
        return EXIT_FAILURE;
    }
}
