// SPDX-License-Identifier: MIT
// Hands every text of the library, and the example's shaders, to glslang; what is for Vulkan or HLSL becomes
// SPIR-V, which the validator of SPIRV-Tools then reads. Of WGSL the words are read.  compile PART PARTS: takes every
// PARTS-th language.
#include "vulkan/compile.hpp"
#include "builders.hpp"
#include "readers.hpp"
#include "shaders.hpp"
#include "wgsl_words.hpp"

#include <spirv-tools/libspirv.hpp>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using lightbin::ShaderLanguage;

/// Whether glslang takes a GLSL text for OpenGL or OpenGL ES.
bool compiles(const std::string& text, EShLanguage stage, std::string& error) {
    glslang::TShader shader(stage);
    const char* begin = text.c_str();
    shader.setStrings(&begin, 1);
    glslang::TProgram program;
    program.addShader(&shader);
    const bool good =
        shader.parse(GetDefaultResources(), 100, false, EShMsgDefault) && program.link(EShMsgDefault);
    error = std::string(shader.getInfoLog()) + program.getInfoLog();
    return good;
}

class Compiler {
public:
    Compiler() {
        glslang::InitializeProcess();
        for (spvtools::SpirvTools* const validator : {&validator_, &wave_validator_})
            validator->SetMessageConsumer([this](spv_message_level_t, const char*, const spv_position_t&,
                                                 const char* text) { error_ = text; });
    }

    void compile(ShaderLanguage language, EShLanguage stage, const std::string& text) {
        const lightbin::detail::Dialect dialect = lightbin::detail::dialect(language);
        bool good;
        if (dialect.hlsl || dialect.vulkan) {
            good = is_valid(text, stage, dialect.hlsl);
            ++valid;
        } else if (dialect.wgsl) {
            error_ = WgslWords::problem(text);
            good = error_.empty();
        } else {
            good = compiles(text, stage, error_);
        }
        ++texts;
        if (good) return;
        if (++refused <= 3) std::printf("refused: %s\n%s\n", error_.c_str(), text.c_str());
    }

    int texts = 0, valid = 0, refused = 0;

private:
    bool is_valid(const std::string& text, EShLanguage stage, bool hlsl) {
        try {
            return (needs_waves(text) ? wave_validator_ : validator_)
                .Validate(compile_spirv(text, stage, hlsl));
        } catch (const std::runtime_error& error) {
            error_ = error.what();
            return false;
        }
    }

    spvtools::SpirvTools validator_{SPV_ENV_VULKAN_1_0}, wave_validator_{SPV_ENV_VULKAN_1_1};
    std::string error_;
};

/// The text in the newest version that the language stands for.
std::string newest(std::string text, ShaderLanguage language) {
    const std::string line = version_line(language);
    const char* newer = language == ShaderLanguage::glsl_430   ? "#version 460 core\n"
                        : language == ShaderLanguage::essl_310 ? "#version 320 es\n"
                                                               : line.c_str();
    return newer + text.substr(line.size());
}

void compile_language(Compiler& compiler, ShaderLanguage language) {
    const bool computes = lightbin::detail::dialect(language).storage_buffers;
    unsigned turn = 0;
    const auto compile = [&](EShLanguage stage, const std::string& text) {
        compiler.compile(language, stage, ++turn & 1 ? text : newest(text, language));
    };
    for (const lightbin::ShaderOptions& options : every_reader(language)) {
        const auto snippet = shader_snippet(options);
        compile(EShLangFragment, reader_text(options, *snippet, Stage::fragment, 9, 9));
        if (computes) compile(EShLangCompute, reader_text(options, *snippet, Stage::compute, 9, 9));
    }
    for (const lightbin::ReduceShaderOptions& options : every_reduction(language))
        compile(options.stage == lightbin::ShaderStage::compute ? EShLangCompute : EShLangFragment,
                version_line(language) + reduce_shader(options)->text);
    for (const lightbin::BuildShaderOptions& options : every_build(language))
        compile(EShLangCompute, version_line(language) + build_shader(options)->text);
}

void compile_example(Compiler& compiler, int glsl) {
    const auto compile = [&](EShLanguage stage, const std::string& text) {
        compiler.compile(glsl_language(glsl), stage, text);
    };
    for (const bool orthographic : {false, true})
        for (const bool skip_background : {false, true})
            for (const int samples : {1, 4}) {
                if (samples > 1 && glsl == 300) continue;  // it has no multisampled textures
                compile(EShLangFragment,
                        reduce_fragment_shader(glsl, samples, orthographic, skip_background));
            }
    compile(EShLangVertex, geometry_vertex_shader(glsl));
    compile(EShLangFragment, depth_fragment_shader(glsl));
    compile(EShLangVertex, overlay_vertex_shader(glsl));
    using lightbin::Slicing;
    for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins}) {
        compile(EShLangFragment, heat_map_fragment_shader(glsl, slicing));
        for (const bool spots : {false, true})
            compile(EShLangFragment, forward_fragment_shader(glsl, LightLoop::tile_list, spots, slicing));
    }
    for (const bool spots : {false, true})
        compile(EShLangFragment, forward_fragment_shader(glsl, LightLoop::every_light, spots));
}

}  // namespace

int main(int count, char** arguments) {
    const int part = count == 3 ? std::atoi(arguments[1]) : 0,
              parts = count == 3 ? std::atoi(arguments[2]) : 1;
    Compiler compiler;
    for (int language = part; language < 8; language += parts)
        compile_language(compiler, static_cast<ShaderLanguage>(language));
    if (part == 0)
        for (const int glsl : {330, 430, 300, 310})
            compile_example(compiler, glsl);
    std::printf("%d texts, %d of them SPIR-V; %d refused\n", compiler.texts, compiler.valid,
                compiler.refused);
    return compiler.texts == 0 || compiler.refused > 0;
}
