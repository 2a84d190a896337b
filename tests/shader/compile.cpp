// SPDX-License-Identifier: MIT
// Hands every text of the library but WGSL to glslang; what is for Vulkan or HLSL becomes
// SPIR-V, which the validator of SPIRV-Tools then reads. And which prefixes names may have is held against the
// compilers and the languages' reserved words.
//   compile WORDS LANGUAGE: its number; WORDS: a file of keywords and reserved words of GLSL 4.60,
//   GLSL ES 3.20, Vulkan's GLSL, HLSL and WGSL, but for those that end with a digit, as no name of the texts does
#include "vulkan/compile.hpp"
#include "texts.hpp"

#include <spirv-tools/libspirv.hpp>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using lightbin::ShaderLanguage;

/// Returns whether glslang accepts a GLSL text for OpenGL or OpenGL ES.
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
        for (spvtools::SpirvTools* const validator : {&validator_, &newer_validator_})
            validator->SetMessageConsumer([this](spv_message_level_t, const char*, const spv_position_t&,
                                                 const char* text) { error_ = text; });
    }

    void compile(ShaderLanguage language, EShLanguage stage, const std::string& text) {
        ++texts;
        if (!takes(language, stage, text) && ++refused <= 3)
            std::printf("refused: %s\n%s\n", error_.c_str(), text.c_str());
    }

    bool takes(ShaderLanguage language, EShLanguage stage, const std::string& text) {
        const lightbin::detail::Dialect dialect = lightbin::detail::Dialect{language};
        if (dialect.hlsl || dialect.vulkan) {
            ++valid;
            return is_valid(text, stage, dialect.hlsl);
        }
        return compiles(text, stage, error_);
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

/// Returns the text with the newest #version of its language.
std::string newest(std::string text, ShaderLanguage language) {
    const std::string line = version_line(language);
    const char* newer = language == ShaderLanguage::glsl_430   ? "#version 460 core\n"
                        : language == ShaderLanguage::essl_310 ? "#version 320 es\n"
                                                               : line.c_str();
    return newer + text.substr(line.size());
}

EShLanguage stage_of(const Job& job) {
    return job.stage == Stage::compute ? EShLangCompute : EShLangFragment;
}

bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Collects the names in a text that begin with the prefix, without the prefix.
void take_names(std::set<std::string>& names, const std::string& text) {
    for (const std::string prefix : {"my_", "lightbin_"})
        for (std::size_t at = text.find(prefix); at != text.npos; at = text.find(prefix, at)) {
            const bool begins = at == 0 || !in_name(text[at - 1]);
            const std::size_t begin = at += prefix.size();
            while (at < text.size() && in_name(text[at]))
                ++at;
            if (begins && at > begin) names.insert(text.substr(begin, at - begin));
        }
}

/// Compiles all texts of a language and collects their names. WGSL is skipped: there is no compiler for it here.
void compile_language(Compiler& compiler, ShaderLanguage language, std::set<std::string>& names) {
    unsigned turn = 0;
    each_text(language, {}, [&](const Job& job) {
        take_names(names, job.text);
        // glslang accepts any input as HLSL's SV_ViewID and does not know multiview in HLSL.
        if (language == ShaderLanguage::wgsl || (job.hlsl && job.views > 1)) return;
        compiler.compile(language, stage_of(job), ++turn & 1 ? job.text : newest(job.text, language));
    });
}

/// Returns what is wrong with the rule for name prefixes in a language, or nothing. `names` are the names in its texts
/// without the prefix.
std::string problem_of_prefixes(Compiler& compiler, ShaderLanguage language,
                                const std::set<std::string>& names, const std::vector<std::string>& words) {
    lightbin::SnippetOptions options = with_switches(every_list(language, lightbin::Slicing::clusters)[0], 8);
    const std::string longest(1000, 'a');
    options.prefix = longest;
    if (language != ShaderLanguage::wgsl)
        compiler.compile(language, EShLangFragment, reader_text_job(options, Stage::fragment).text);
    // Where shader_snippet() refuses a prefix, the text with it must not compile; tested in OpenGL ES.
    options = with_switches(every_list(ShaderLanguage::essl_300, lightbin::Slicing::clusters)[0], 8);
    options.prefix = "zzq_";
    const std::string text = reader_text_job(options, Stage::fragment).text;
    for (const std::string& prefix : {std::string("vola"), std::string("GL_"), std::string("gl_a"),
                                      std::string("9"), std::string(1020, 'a')}) {
        if (lightbin::shader_snippet({.prefix = prefix})) return prefix + " is taken as a prefix";
        if (compiler.takes(ShaderLanguage::essl_300, EShLangFragment,
                           lightbin::detail::replaced(text, "zzq_", prefix)))
            return prefix + " is refused as a prefix for no reason";
    }
    int made = 0;
    for (const std::string& word : words)
        for (const std::string& name : names)
            if (word.size() > name.size() && word.ends_with(name)) {
                ++made;
                const std::string prefix = word.substr(0, word.size() - name.size());
                if (lightbin::shader_snippet({.prefix = prefix}))
                    return prefix + " is taken, and makes " + word;
            }
    for (const std::string& name : names)
        if (name[0] == '_' || std::isdigit(static_cast<unsigned char>(name.back())) ||
            name.starts_with("l_") || name.starts_with("L_") || name.find("__") != name.npos)
            return "the rule for prefixes does not allow for the name " + name;
    std::printf("%d names, %d reserved words, of which prefixes make %d\n", static_cast<int>(names.size()),
                static_cast<int>(words.size()), made);
    return made == 0 ? "volatile is not found" : "";
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) return 2;
    std::ifstream file(arguments[1]);
    const std::vector<std::string> words{std::istream_iterator<std::string>(file), {}};
    const auto language = static_cast<ShaderLanguage>(std::atoi(arguments[2]));
    Compiler compiler;
    std::set<std::string> names;
    compile_language(compiler, language, names);
    if (const std::string problem = problem_of_prefixes(compiler, language, names, words); !problem.empty()) {
        std::printf("%s\n", problem.c_str());
        return 1;
    }
    std::printf("%d texts, %d of them SPIR-V; %d refused\n", compiler.texts, compiler.valid,
                compiler.refused);
    return (compiler.texts == 0) != (language == ShaderLanguage::wgsl) || compiler.refused > 0;
}
