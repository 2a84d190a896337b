// SPDX-License-Identifier: MIT
// Translates the shader texts from GLSL to each language. It handles the part of GLSL that the texts keep to: a
// declaration holds one name, every branch and loop has braces, only `inout` parameters are assigned to, and there is
// no `?:`. Two signs are not GLSL's: `$` stands for the prefix of names, and `&` marks an argument for an `inout`
// parameter.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns the name or number that begins at position `at` of a text; empty if none does. `$` is part of a name.
inline std::string_view word_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_' || text[end] == '$'))
        ++end;
    return text.substr(at, end - at);
}

/// A keyword, type or built-in function of GLSL and its equivalents.
struct ShaderWord {
    std::string_view glsl, hlsl, wgsl;
    bool is_type = false;
};

/// Returns the equivalents of a word. A word that the table lacks is the same in all languages.
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

/// Translates to HLSL, or to GLSL for OpenGL, Vulkan or ES. In ES every declaration is marked highp, since a fragment
/// shader's integers may have only 16 bits otherwise. (A default precision would change the user's code, too.)
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

/// What a name becomes in WGSL. Constants become members of their block, and `inout` parameters dereferenced pointers.
struct WgslName {
    std::string glsl, wgsl;
};

/// Translates a text from GLSL to WGSL in one pass over its words and signs. text() returns the result.
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
        if (sign == '/' && glsl_.substr(at_).starts_with('/')) {  // a comment is copied as it is
            const std::size_t end = glsl_.find('\n', at_);
            wgsl_ += glsl_.substr(at_ - 1, end - at_ + 1);
            at_ = end;
            return;
        }
        if (sign == '{') ++depth_;
        if (sign == '}') in_struct_ = --depth_ > 0 && in_struct_;
        // An inout parameter that is passed on as one is a pointer already, which needs no `&` in WGSL.
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
        // A type, a space and a name are a declaration. Types that the text itself declares begin with the prefix.
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
    std::vector<WgslName> names_;  // the constants, then the current function's inout parameters
    std::string wgsl_, result_;
    std::size_t constants_, at_ = 0;
    int depth_ = 0;
    bool in_struct_ = false, in_parameters_ = false, by_pointer_ = false;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
