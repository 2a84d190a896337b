// SPDX-License-Identifier: MIT
// Hands every text of the library, and the example's shaders, to glslang; what is for Vulkan or HLSL becomes
// SPIR-V, which the validator of SPIRV-Tools then reads. Of WGSL the words are read. And which prefixes names may have is
// held against the compilers and the languages' reserved words.  compile PART PARTS: takes every PARTS-th language.
#include "vulkan/compile.hpp"
#include "builders.hpp"
#include "cull.hpp"
#include "readers.hpp"
#include "reserved_words.hpp"
#include "shaders.hpp"
#include "wgsl_words.hpp"

#include <spirv-tools/libspirv.hpp>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
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

/// Returns the name of a loop's variable that an HLSL text declares twice, or nothing. Microsoft's compiler for shader
/// model 5 keeps such a variable to the end of the scope around its loop, warns of a second one (X3078), and may treat
/// warnings as errors; no other compiler minds. A text may switch this warning off.
std::string loop_variable_twice(const std::string& text) {
    static constexpr std::string_view loop = "for (uint ";
    if (text.find("#pragma warning(disable : 3078)") != text.npos) return {};
    std::vector<std::set<std::string>> scopes(1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '{') scopes.emplace_back();
        if (text[i] == '}' && scopes.size() > 1) scopes.pop_back();
        if (text.compare(i, loop.size(), loop) != 0) continue;
        const std::size_t begin = i + loop.size();
        const std::string name = text.substr(begin, text.find(' ', begin) - begin);
        for (const auto& scope : scopes)
            if (scope.count(name) != 0) return name;
        scopes.back().insert(name);
    }
    return {};
}

class Compiler {
public:
    Compiler() {
        glslang::InitializeProcess();
        for (spvtools::SpirvTools* const validator : {&validator_, &newer_validator_})
            validator->SetMessageConsumer([this](spv_message_level_t, const char*, const spv_position_t&,
                                                 const char* text) { error_ = text; });
    }

    void compile(ShaderLanguage language, EShLanguage stage, const std::string& text) {
        const bool good = takes(language, stage, text);
        ++texts;
        if (good) return;
        if (++refused <= 3) std::printf("refused: %s\n%s\n", error_.c_str(), text.c_str());
    }

    bool takes(ShaderLanguage language, EShLanguage stage, const std::string& text) {
        const lightbin::detail::Dialect dialect = lightbin::detail::Dialect{language};
        if (dialect.hlsl) {
            error_ = loop_variable_twice(text);
            if (!error_.empty()) return false;
        }
        if (dialect.hlsl || dialect.vulkan) {
            ++valid;
            return is_valid(text, stage, dialect.hlsl);
        }
        if (!dialect.webgpu) return compiles(text, stage, error_);
        error_ = WgslWords::problem(text);
        return error_.empty();
    }

    int texts = 0, valid = 0, refused = 0;

private:
    bool is_valid(const std::string& text, EShLanguage stage, bool hlsl) {
        try {
            return (needs_vulkan_1_1(text) ? newer_validator_ : validator_)
                .Validate(compile_spirv(text, stage, hlsl));
        } catch (const std::runtime_error& error) {
            error_ = error.what();
            return false;
        }
    }

    spvtools::SpirvTools validator_{SPV_ENV_VULKAN_1_0}, newer_validator_{SPV_ENV_VULKAN_1_1};
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
    const bool computes = lightbin::detail::Dialect{language}.storage_buffers;
    unsigned turn = 0;
    const auto compile = [&](EShLanguage stage, const std::string& text) {
        compiler.compile(language, stage, ++turn & 1 ? text : newest(text, language));
    };
    for (const lightbin::ShaderOptions& options : every_reader(language)) {
        const auto snippet = shader_snippet(options);
        compile(EShLangFragment, reader_text(options, *snippet, Stage::fragment, 9, 9));
        if (computes) compile(EShLangCompute, reader_text(options, *snippet, Stage::compute, 9, 9));
    }
    // glslang takes HLSL's SV_ViewID for any input, and knows of no multiview there; WGSL has none.
    const lightbin::detail::Dialect dialect = lightbin::detail::Dialect{language};
    if (!dialect.hlsl && !dialect.webgpu)
        for (const ReaderRun& run : multiview_runs(language))
            compile(EShLangFragment, run.job().text);
    for (const lightbin::ReduceShaderOptions& options : every_reduction(language))
        compile(options.stage == lightbin::ShaderStage::compute ? EShLangCompute : EShLangFragment,
                version_line(language) + reduce_shader(options)->text);
    for (const CullText& text : every_cull(language))
        compile(EShLangCompute, version_line(language) + text.shader().text);
}

/// A text of each generator for a language, with the same prefix; in `snippet` a whole shader.
struct PrefixedTexts {
    PrefixedTexts(ShaderLanguage language, std::string_view prefix) {
        lightbin::ShaderOptions options =
            with_switches(every_list(language, lightbin::Slicing::clusters)[0], 8);
        lightbin::ReduceShaderOptions reduction = every_reduction(language)[0];
        options.prefix = reduction.prefix = prefix;
        if (const auto made = shader_snippet(options)) {
            taken = true;
            snippet = reader_text(options, *made, Stage::fragment, 9, 9);
        }
        if (const auto made = reduce_shader(reduction)) reduce = version_line(language) + made->text;
        reduce_stage = reduction.stage == lightbin::ShaderStage::compute ? EShLangCompute : EShLangFragment;
        for (const lightbin::CullPass pass : lightbin::cull_passes) {
            lightbin::CullShaderOptions cull;
            cull.language = language;
            cull.kind = lightbin::CullKind::spot;
            cull.slicing = lightbin::Slicing::clusters;
            cull.prefix = prefix;
            if (const auto made = cull_shader(pass, cull)) passes.push_back(version_line(language) + made->text);
        }
    }

    bool taken = false;
    std::string snippet, reduce;
    EShLanguage reduce_stage;
    std::vector<std::string> passes;
};

/// The names of a text that begin with a prefix, without it.
void take_names(std::set<std::string>& names, const std::string& text, const std::string& prefix) {
    const auto in_name = [&](std::size_t at) {
        return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
    };
    for (std::size_t at = text.find(prefix); at != text.npos; at = text.find(prefix, at)) {
        const std::size_t begin = at += prefix.size();
        while (in_name(at))
            ++at;
        if (at > begin) names.insert(text.substr(begin, at - begin));
    }
}

/// Returns what is wrong with the rule for prefixes, or nothing.
std::string problem_of_prefixes(Compiler& compiler) {
    constexpr int languages = 8;
    // What is taken compiles in every language.
    for (const std::string& prefix :
         {std::string("vol"), std::string("volat"), std::string("Vola"), std::string("vola_"),
          std::string("ext"), std::string("gl"), std::string("GL"), std::string("Gl_"), std::string("x9"),
          std::string("a_"), std::string(1000, 'a')})
        for (int i = 0; i < languages; ++i) {
            const auto language = static_cast<ShaderLanguage>(i);
            const PrefixedTexts texts(language, prefix);
            if (!texts.taken) return prefix + " is refused as a prefix";
            compiler.compile(language, EShLangFragment, texts.snippet);
            compiler.compile(language, texts.reduce_stage, texts.reduce);
            for (const std::string& text : texts.passes)
                compiler.compile(language, EShLangCompute, text);
        }
    // What is refused would not, in one at least.
    for (const std::string& prefix : {std::string("vola"), std::string("GL_"), std::string("gl_a"),
                                      std::string("9"), std::string(1020, 'a')}) {
        if (PrefixedTexts(ShaderLanguage::glsl_430, prefix).taken) return prefix + " is taken as a prefix";
        int refused = 0;
        for (int i = 0; i < languages; ++i) {
            const auto language = static_cast<ShaderLanguage>(i);
            const std::string text =
                lightbin::detail::replaced(PrefixedTexts(language, "zzq_").snippet, "zzq_", prefix);
            refused += !compiler.takes(language, EShLangFragment, text);
        }
        if (refused == 0) return prefix + " is refused as a prefix for no reason";
    }
    // Reserved words that end as a name does.
    std::set<std::string> names;
    for (int i = 0; i < languages; ++i) {
        const auto language = static_cast<ShaderLanguage>(i);
        for (lightbin::ShaderOptions options : every_reader(language)) {
            options.prefix = "zzq_";
            take_names(names, shader_snippet(options)->text, "zzq_");
        }
        for (lightbin::ReduceShaderOptions options : every_reduction(language)) {
            options.prefix = "zzq_";
            take_names(names, reduce_shader(options)->text, "zzq_");
        }
        for (CullText text : every_cull(language)) {
            text.options.prefix = "zzq_";
            take_names(names, text.shader().text, "zzq_");
        }
    }
    int words = 0, made = 0;
    for (std::size_t at = 1; at < reserved_words.size(); ++words) {
        const std::string word(reserved_words.substr(at, reserved_words.find(' ', at) - at));
        at += word.size() + 1;
        for (const std::string& name : names)
            if (word.size() > name.size() && word.ends_with(name)) {
                ++made;
                const std::string prefix = word.substr(0, word.size() - name.size());
                if (lightbin::shader_snippet({.prefix = prefix}))
                    return prefix + " is taken, and makes " + word;
            }
    }
    for (const std::string& name : names)
        if (name[0] == '_' || std::isdigit(static_cast<unsigned char>(name.back())) ||
            name.starts_with("l_") || name.starts_with("L_") || name.find("__") != name.npos)
            return "the rule for prefixes does not allow for the name " + name;
    std::printf("%d names, %d reserved words, of which prefixes make %d\n", static_cast<int>(names.size()),
                words, made);
    return made == 0 ? "volatile is not found" : "";
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
        for (const LightKinds kinds : {LightKinds{}, LightKinds{true, false}, LightKinds{true, true}})
            compile(EShLangFragment, forward_fragment_shader(glsl, LightLoop::tile_list, kinds, slicing));
    }
    for (const LightKinds kinds : {LightKinds{}, LightKinds{true, false}, LightKinds{true, true}})
        compile(EShLangFragment, forward_fragment_shader(glsl, LightLoop::every_light, kinds));
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
    if (part == parts - 1)
        if (const std::string problem = problem_of_prefixes(compiler); !problem.empty()) {
            std::printf("%s\n", problem.c_str());
            return 1;
        }
    std::printf("%d texts, %d of them SPIR-V; %d refused\n", compiler.texts, compiler.valid,
                compiler.refused);
    return compiler.texts == 0 || compiler.refused > 0;
}
