// SPDX-License-Identifier: MIT
// Every block of GLSL and HLSL in pages compiles below the text of shader_snippet():  shaders PAGE.md...
// Blocks with a #version of their own are run by tests/renderers/glsl_120.cpp.
#include "vulkan/compile.hpp"

#include <lightbin/shader.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace {

/// What a reader's shader has.
constexpr const char given[] = R"(
vec3 shade(uint id) { return vec3(float(id)); }
vec3 shade(uint id, vec3 position) { return shade(id) + position; }
vec3 shade(uint id, vec3 position, vec3 normal) { return shade(id, position) + normal; }
vec3 shade_point(uint id) { return shade(id); }
vec3 shade_spot(uint id) { return shade(id); }
vec3 blend_decal(vec3 colour, uint id) { return mix(colour, shade(id), 0.5); }
const uint first_spot = 10u, first_box = 20u, light_count = 30u;
)";

/// Returns a whole shader with a code block. A block without main() is the body of main().
std::string whole(lightbin::ShaderLanguage language, const std::string& block) {
    const bool multiview = block.find("gl_ViewID_OVR") != std::string::npos;
    const auto snippet = lightbin::shader_snippet({.language = language,
                                                   .views = multiview ? 2u : 1u,
                                                   .view_check = true,
                                                   .list_check = true,
                                                   .window = true});
    if (language == lightbin::ShaderLanguage::hlsl_5_0)
        return snippet->text + "float3 shade(uint id, float3 position) { return float3(id, 0, 0) + position; }\n" +
               block;
    const std::string start = std::string("#version 450\n") +
                              (multiview ? "#extension GL_OVR_multiview2 : require\n" : "") + snippet->text + given;
    if (block.find("main(") != std::string::npos) return start + block;
    return start + "in vec3 position;\nin vec3 normal;\nin float view_depth;\nout vec3 colour;\n"
                   "void main() {\ncolour = vec3(0);\n" + block + "}\n";
}

void compile_opengl(const std::string& text) {
    glslang::TShader shader(EShLangFragment);
    const char* begin = text.c_str();
    shader.setStrings(&begin, 1);
    if (!shader.parse(GetDefaultResources(), 100, false, EShMsgDefault))
        throw std::runtime_error(shader.getInfoLog());
}

/// Compiles the blocks of a language in a page, and returns how many there are.
int compile_blocks(const char* page, const std::string& text, lightbin::ShaderLanguage language,
                   const std::string& name) {
    const bool hlsl = language == lightbin::ShaderLanguage::hlsl_5_0;
    int blocks = 0;
    const std::string begin = "```" + name + "\n";
    for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
        at += begin.size();
        const std::string block = text.substr(at, text.find("```", at) - at);
        if (block.rfind("#version", 0) == 0) continue;
        ++blocks;
        const std::string shader = whole(language, block);
        try {
            hlsl ? (void)compile_spirv(shader, EShLangFragment, hlsl) : compile_opengl(shader);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(page + std::string(": ") + error.what() + "\n" + shader);
        }
    }
    return blocks;
}

}  // namespace

int main(int count, char** pages) try {
    glslang::InitializeProcess();
    int glsl = 0, hlsl = 0;
    for (int i = 1; i < count; ++i) {
        std::ifstream file(pages[i]);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        if (text.empty()) throw std::runtime_error(std::string("cannot read ") + pages[i]);
        glsl += compile_blocks(pages[i], text, lightbin::ShaderLanguage::glsl_430, "glsl");
        hlsl += compile_blocks(pages[i], text, lightbin::ShaderLanguage::hlsl_5_0, "hlsl");
    }
    std::printf("%d blocks of GLSL and %d of HLSL compile\n", glsl, hlsl);
    return glsl >= 3 && hlsl >= 1 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
