// SPDX-License-Identifier: MIT
// Writes the functions of the GLSL pass `project` for cull_twin.cpp to include as C++, a namespace for each variant:
// spheres in view space, in world space, of an orthographic view, spots, and boxes in these three ways.
#include <lightbin/shader_cull.hpp>

#include <cstdio>
#include <string>

int main() {
    using lightbin::CullKind;
    for (const std::string name : {"sphere", "world", "flat", "spot", "box", "world_box", "flat_box"}) {
        lightbin::CullOptions options;
        options.prefix = "p_";
        options.world_space = name.starts_with("world");
        options.orthographic = name.starts_with("flat");
        options.kind = name == "spot" ? CullKind::spot : name.ends_with("box") ? CullKind::box : CullKind::sphere;
        options.lights_at.stride = name == "spot" ? 8 : name.ends_with("box") ? 17 : 4;
        const std::string text = cull_shader(lightbin::CullPass::project, options)->text;
        const auto begin = text.find(name.ends_with("box") ? "uint p_largest(" : "uint p_state_of("),
                   end = text.find("void p_run(");
        if (begin == text.npos || end == text.npos) return 1;
        std::printf("namespace %s {\n%s}\n", name.c_str(), text.substr(begin, end - begin).c_str());
    }
}
