// SPDX-License-Identifier: MIT
// Writes the shaders of this project to the current folder, for a GLSL front end to read: every form of the
// snippet and the shaders of tiled_forward.
#include "texts.hpp"

#include "shaders.hpp"

#include <fstream>

namespace {

void write(const std::string& name, const std::string& text) {
    std::ofstream(name) << text;
}

}  // namespace

int main() {
    for (const SnippetForm& form : snippet_forms())
        write("snippet_" + form.name + ".frag", list_reader(form));
    for (const int glsl : {330, 430}) {
        const std::string version = std::to_string(glsl);
        write("geometry_" + version + ".vert", geometry_vertex_shader(glsl));
        write("depth_" + version + ".frag", depth_fragment_shader(glsl));
        write("overlay_" + version + ".vert", overlay_vertex_shader(glsl));
        write("heat_map_" + version + ".frag", heat_map_fragment_shader(glsl));
        for (const bool spots : {false, true}) {
            const std::string suffix = (spots ? "_spots_" : "_") + version + ".frag";
            write("tile_list" + suffix, forward_fragment_shader(glsl, LightLoop::tile_list, spots));
            write("every_light" + suffix, forward_fragment_shader(glsl, LightLoop::every_light, spots));
        }
    }
}
