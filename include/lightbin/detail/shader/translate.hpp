// SPDX-License-Identifier: MIT
// From the GLSL that the shader texts are written in to each language. It knows what they need, not all of GLSL: a
// declaration holds one name, every branch and loop has braces, nothing is assigned to a parameter but through `inout`,
// no `?:`. `$` stands for the prefix, `&` before a name for a variable that is handed over to be written.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// A character of a name or number. `$` stands for the prefix.
inline bool in_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$';
}

/// The word that begins at `at`; empty if none does.
inline std::string_view word_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && in_word(text[end]))
        ++end;
    return text.substr(at, end - at);
}

/// A word of the texts in each language.
struct ShaderWord {
    std::string_view glsl, hlsl, wgsl;
    bool is_type = false;
};

/// The row of a word. What is in no row is the same in all languages.
inline ShaderWord shader_word(std::string_view word) {
    static constexpr ShaderWord words[] = {
        {"bool", "bool", "bool", true},
        {"int", "int", "i32", true},
        {"uint", "uint", "u32", true},
        {"float", "float", "f32", true},
        {"ivec2", "int2", "vec2i", true},
        {"uvec2", "uint2", "vec2u", true},
        {"uvec4", "uint4", "vec4u", true},
        {"vec2", "float2", "vec2f", true},
        {"vec3", "float3", "vec3f", true},
        {"vec4", "float4", "vec4f", true},
        {"findLSB", "firstbitlow", "firstTrailingBit"},
        {"bitCount", "countbits", "countOneBits"},
        {"floatBitsToUint", "asuint", "bitcast<u32>"},
        {"uintBitsToFloat", "asfloat", "bitcast<f32>"},
        {"shared", "groupshared", ""},
        {"atomicMin", "InterlockedMin", "atomicMin"},
        {"atomicMax", "InterlockedMax", "atomicMax"},
        {"atomicOr", "InterlockedOr", "atomicOr"},
        {"subgroupMin", "WaveActiveMin", "subgroupMin"},
        {"sync_group", "GroupMemoryBarrierWithGroupSync", "workgroupBarrier"},
    };
    for (const ShaderWord& row : words)
        if (word == row.glsl) return row;
    return {word, word, word};
}

/// Returns a text in GLSL or HLSL. Types are declared highp in ES: a fragment shader's integers have 16 bits there
/// otherwise, and no default precision is set, as it would reach the user's code.
inline std::string translate(std::string_view glsl, bool hlsl, bool es) {
    std::string text;
    for (std::size_t at = 0; at < glsl.size();) {
        const std::string_view word = word_at(glsl, at);
        at += word.size();
        if (word.empty()) {
            const char sign = glsl[at++];
            if (sign != '&' || word_at(glsl, at).empty()) text += sign;
            continue;
        }
        const ShaderWord row = shader_word(word);
        const bool declares = row.is_type && word != "bool" && at < glsl.size() && glsl[at] != '(';
        if (es && declares) text += "highp ";
        text += hlsl ? row.hlsl : word == "sync_group" ? "memoryBarrierShared();\n    barrier" : word;
    }
    return text;
}

/// A name of the text that WGSL has in another way: a constant is a member of its block, what is handed over to be
/// written is where a pointer points.
struct WgslName {
    std::string glsl, wgsl;
};

/// Goes through a text once, sign by sign and word by word; text() is what came out.
class WgslTranslation {
public:
    WgslTranslation(std::string_view glsl, const std::vector<WgslName>& constants)
        : glsl_(glsl), names_(constants), constants_(constants.size()) {
        while (at_ < glsl_.size())
            if (const std::string_view word = word_at(glsl_, at_); word.empty())
                take_sign(glsl_[at_++]);
            else
                take_word(word);
    }

    const std::string& text() const { return wgsl_; }

private:
    void take_sign(char sign) {
        if (sign == '/' && glsl_.substr(at_).starts_with('/')) {  // a comment, whose words are no code
            const std::size_t end = glsl_.find('\n', at_);
            wgsl_ += glsl_.substr(at_ - 1, end - at_ + 1);
            at_ = end;
            return;
        }
        if (sign == '{') ++depth_;
        if (sign == '}') in_struct_ = --depth_ > 0 && in_struct_;
        // A pointer is handed on as it is.
        if (const std::string_view word = word_at(glsl_, at_); sign == '&' && renamed(word) != word) {
            wgsl_ += word;
            at_ += word.size();
            return;
        }
        wgsl_ += sign == ';' && in_struct_ ? ',' : sign;
        if (sign == ')' && in_parameters_) {
            in_parameters_ = false;
            if (!result_.empty()) wgsl_ += " -> " + result_;
        }
    }

    void take_word(std::string_view word) {
        at_ += word.size();
        if (word == "struct") in_struct_ = true;
        if (word == "inout") {
            by_pointer_ = true;
            ++at_;
            return;
        }
        // A type, a space and a name declare something. Types of the text's own begin with the prefix.
        const ShaderWord row = shader_word(word);
        const std::string_view name = at_ < glsl_.size() && glsl_[at_] == ' ' ? word_at(glsl_, at_ + 1) : "";
        if ((row.is_type || word == "void" || word.starts_with('$')) && !name.empty()) {
            at_ += 1 + name.size();
            declare(word == "void" ? "" : row.wgsl, name);
        } else {
            wgsl_ += wgsl_.ends_with('.') ? row.wgsl : renamed(row.wgsl);
        }
    }

    void declare(std::string_view type, std::string_view name) {
        const std::string what(type);
        if (in_struct_) {
            wgsl_ += std::string(name) + " : " + what;
        } else if (in_parameters_) {
            wgsl_ += std::string(name) + " : " + (by_pointer_ ? "ptr<function, " + what + ">" : what);
            if (by_pointer_) names_.push_back({std::string(name), "(*" + std::string(name) + ")"});
            by_pointer_ = false;
        } else if (depth_ == 0) {
            wgsl_ += "fn " + std::string(name);
            result_ = what;
            in_parameters_ = true;
            names_.resize(constants_);
        } else {
            wgsl_ += "var " + std::string(name) + " : " + what;
        }
    }

    std::string_view renamed(std::string_view word) const {
        for (const WgslName& name : names_)
            if (word == name.glsl) return name.wgsl;
        return word;
    }

    std::string_view glsl_;
    std::vector<WgslName> names_;  // the constants and the function's inout parameters
    std::string wgsl_, result_;
    std::size_t constants_, at_ = 0;
    int depth_ = 0;
    bool in_struct_ = false, in_parameters_ = false, by_pointer_ = false;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
