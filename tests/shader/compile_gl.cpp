// SPDX-License-Identifier: MIT
// Hands every text of the library for a language to the compiler of this machine's OpenGL:
// compile_gl 330|430|300|310.
#include "builders.hpp"
#include "cull.hpp"
#include "readers.hpp"

#include "gl_context.hpp"

#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace {

int texts = 0, refused = 0;

void compile(Stage stage, const std::string& text) {
    const GLuint shader = glCreateShader(stage == Stage::compute ? GL_COMPUTE_SHADER : GL_FRAGMENT_SHADER);
    const char* const lines = text.c_str();
    glShaderSource(shader, 1, &lines, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    ++texts;
    if (!compiled && ++refused <= 3) {
        std::array<char, 1024> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        std::printf("refused: %s\n%s\n", log.data(), text.c_str());
    }
    glDeleteShader(shader);
}

}  // namespace

int main(int count, char** arguments) {
    using lightbin::ShaderLanguage;
    try {
        const int glsl = count == 2 ? std::atoi(arguments[1]) : 430;
        const OffscreenContext context(glsl);
        const ShaderLanguage language = glsl_language(glsl);
        const bool computes = lightbin::detail::Dialect{language}.storage_buffers;
        for (const lightbin::ShaderOptions& options : every_reader(language)) {
            if (options.wave_loop) continue;  // Mesa's software renderer has no subgroups in OpenGL
            const auto snippet = shader_snippet(options);
            compile(Stage::fragment, reader_text(options, *snippet, Stage::fragment, 9, 9));
            if (computes) compile(Stage::compute, reader_text(options, *snippet, Stage::compute, 9, 9));
        }
        for (const lightbin::ReduceShaderOptions& options : every_reduction(language))
            compile(options.stage == lightbin::ShaderStage::compute ? Stage::compute : Stage::fragment,
                    version_line(language) + reduce_shader(options)->text);
        for (const CullText& text : every_cull(language))
            compile(Stage::compute, version_line(language) + text.shader().text);
    } catch (const std::exception& problem) {
        std::printf("%s\n", problem.what());
        return EXIT_FAILURE;
    }
    std::printf("%d texts, %d refused\n", texts, refused);
    return texts == 0 || refused > 0;
}
