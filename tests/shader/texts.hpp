// SPDX-License-Identifier: MIT
// Every form of the snippet, and a fragment shader around it that tells what it reads.
#pragma once

#include <lightbin/shader.hpp>

#include <string>
#include <vector>

struct SnippetForm {
    std::string name;
    int glsl;
    lightbin::ShaderOptions options;
};

inline std::vector<SnippetForm> snippet_forms() {
    using namespace lightbin;
    std::vector<SnippetForm> forms;
    for (const int glsl : {330, 430})
        for (const Index index : {Index::u16, Index::u32})
            for (const WindowOrigin origin : {WindowOrigin::lower_left, WindowOrigin::upper_left})
                for (const bool custom : {false, true}) {
                    ShaderOptions options;
                    options.language = glsl == 330 ? ShaderLanguage::glsl_330 : ShaderLanguage::glsl_430;
                    if (glsl == 330) options.storage = ListStorage::texel_buffer;
                    options.format.ids = index == Index::u16 ? IdWidth::u16 : IdWidth::u32;
                    options.flip_y = origin == WindowOrigin::upper_left;
                    if (custom) {
                        options.prefix = "my";
                        options.tiles = {5};
                        options.lists = {3};
                    }
                    forms.push_back({std::to_string(glsl) + (index == Index::u16 ? "_u16" : "_u32") +
                                         (origin == WindowOrigin::lower_left ? "_lower" : "_upper") +
                                         (custom ? "_my" : ""),
                                     glsl, options});
                }
    return forms;
}

// Writes to each pixel: its tile and the length of its list, and two sums over the ids that depend on their
// order.
inline std::string list_reader(const SnippetForm& form) {
    const std::string prefix(form.options.prefix);
    return "#version " + std::to_string(form.glsl) + " core\n" +
           lightbin::shader_snippet(form.options)->text + R"(
uniform vec2 corner;  // of the viewport
out uvec4 pixel;

void main() {
    uint hash = 2166136261u;
    uint sum = 0u;
    uint count = 0u;
    uvec2 here = uvec2(gl_FragCoord.xy - corner);
    )" + prefix +
           R"(for_each_light(light, here) {
        hash = (hash ^ light.id) * 16777619u;
        count += 1u;
        sum += count * light.id;
    }
    uvec2 tile = )" +
           prefix + R"(tile(here);
    pixel = uvec4(tile.x + (tile.y << 16u), count, hash, sum);
}
)";
}
