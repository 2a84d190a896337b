// SPDX-License-Identifier: MIT
// Writes the functions of the pass project, as GLSL has them, for cull_twin.cpp to include as C++: of spheres in view
// space, in world space, of an orthographic view, and of spots.
#include <lightbin/shader_cull.hpp>

#include <cstdio>
#include <string>

int main() {
    for (int i = 0; i < 4; ++i) {
        lightbin::CullShaderOptions options;
        constexpr const char* prefixes[] = {"sphere_", "world_", "flat_", "spot_"};
        const std::string prefix = prefixes[i];
        options.prefix = prefix;
        options.world_space = i == 1;
        options.orthographic = i == 2;
        if (i == 3) {
            options.kind = lightbin::CullKind::spot;
            options.lights_at.stride = 8;
        }
        const std::string text = cull_shader(lightbin::CullPass::project, options)->text;
        const auto begin = text.find("uint " + prefix + "state_of("),
                   end = text.find("void " + prefix + "run(");
        if (begin == text.npos || end == text.npos) return 1;
        std::printf("%s\n", text.substr(begin, end - begin).c_str());
    }
}
