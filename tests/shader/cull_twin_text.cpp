// SPDX-License-Identifier: MIT
// Writes the functions of the GLSL pass `project` for cull_twin.cpp to include as C++, a namespace for each variant:
// spheres in view space, in world space, of an orthographic view, and spots.
#include <lightbin/shader_cull.hpp>

#include <cstdio>
#include <string>

int main() {
    for (const std::string name : {"sphere", "world", "flat", "spot"}) {
        lightbin::CullOptions options;
        options.prefix = "p_";
        options.world_space = name == "world";
        options.orthographic = name == "flat";
        if (name == "spot") {
            options.kind = lightbin::CullKind::spot;
            options.lights_at.stride = 8;
        }
        const std::string text = cull_shader(lightbin::CullPass::project, options)->text;
        const auto begin = text.find("uint p_state_of("), end = text.find("void p_run(");
        if (begin == text.npos || end == text.npos) return 1;
        std::printf("namespace %s {\n%s}\n", name.c_str(), text.substr(begin, end - begin).c_str());
    }
}
