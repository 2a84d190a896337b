// SPDX-License-Identifier: MIT
// Runs the passes of lightbin/shader_cull.hpp on OpenGL or OpenGL ES, and compares their lists with a Binner's.
//
// cull_gl GLSL [FIRST COUNT]   430 or, of ES, 310; every COUNT-th case from FIRST on
#include "cull_cases.hpp"
#include "gl_device.hpp"
#include "run_jobs.hpp"

#include <cstdlib>

int main(int count, char** arguments) {
    const int glsl = std::atoi(arguments[1]);
    GlDevice device(glsl);
    CullTests tests{glsl_language(glsl), share_of(count, arguments)};
    return tests.run(device) ? 0 : 1;
}
