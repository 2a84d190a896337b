// SPDX-License-Identifier: MIT
// What can be told of a WGSL text without a compiler: that every word is WGSL's or declared in the text, that brackets
// match and that branches and loops have braces. Debian has no compiler of WGSL; tests/shaders.sh asks two.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

class WgslWords {
public:
    /// Returns what is wrong, or nothing.
    static std::string problem(const std::string& text) {
        WgslWords words;
        words.split(text);
        words.find_declared();
        for (std::size_t at = 0; at < words.tokens_.size(); ++at)
            if (const std::string what = words.problem_at(at); !what.empty())
                return what + ": " + words.around(at);
        return words.open_.empty() ? "" : "no end of " + words.open_;
    }

private:
    static bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
    static bool is_number(const std::string& token) {
        return std::isdigit(static_cast<unsigned char>(token[0])) != 0;
    }
    static bool is_word(const std::string& token) { return in_word(token[0]) && !is_number(token); }

    /// Into words, numbers and signs, without spaces and comments.
    void split(const std::string& text) {
        for (std::size_t at = 0; at < text.size();) {
            std::size_t end = at;
            while (end < text.size() && in_word(text[end]))
                ++end;
            if (text.compare(at, 2, "//") == 0)
                at = (std::min)(text.find('\n', at), text.size());
            else if (end > at)
                tokens_.push_back(text.substr(at, end - at));
            else if (!std::isspace(static_cast<unsigned char>(text[at])))
                tokens_.emplace_back(1, text[at]);
            at = (std::max)(end, at + 1);
        }
        tokens_.resize(tokens_.size() + 2, ";");  // so that there is always a next one
    }

    void find_declared() {
        for (std::size_t at = 1; at + 1 < tokens_.size(); ++at)
            if (is_word(tokens_[at]) && (tokens_[at + 1] == ":" || is_one_of(declares_, tokens_[at - 1])))
                declared_.insert(tokens_[at]);
    }

    std::string problem_at(std::size_t at) {
        const auto earlier = [&](std::size_t by) { return at < by ? ";" : tokens_[at - by]; };
        const std::string &token = tokens_[at], before = earlier(1);
        if (is_number(token)) return "";
        if (!is_word(token)) return problem_of_sign(token[0]);
        if (before == ".")
            return declared_.count(token) || token.find_first_not_of("xyzw") == token.npos ? "" : "no member";
        if (before != "@" && !declared_.count(token) && !is_one_of(known_, token)) return "no word of WGSL";
        if (is_word(before) && !is_one_of(" fn struct var let const return else enable ", before) &&
            earlier(2) != "@")
            return "two words";
        if ((token == "if" || token == "while" || token == "for") && tokens_[after_brackets(at + 1)] != "{")
            return "no braces";
        return token == "else" && tokens_[at + 1] != "{" && tokens_[at + 1] != "if" ? "no braces" : "";
    }

    std::string problem_of_sign(char sign) {
        constexpr std::string_view opening = "([{", closing = ")]}";
        if (opening.find(sign) != opening.npos) open_ += sign;
        if (const auto kind = closing.find(sign); kind != closing.npos) {
            if (open_.empty() || open_.back() != opening[kind]) return "no such bracket is open";
            open_.pop_back();
        }
        return std::string_view("?#$'\"\\`").find(sign) != std::string_view::npos ? "no sign of WGSL" : "";
    }

    /// The place after the brackets that open at `at`.
    std::size_t after_brackets(std::size_t at) const {
        int depth = 0;
        do {
            depth += tokens_[at] == "(" ? 1 : tokens_[at] == ")" ? -1 : 0;
            ++at;
        } while (depth > 0 && at + 1 < tokens_.size());
        return at;
    }

    std::string around(std::size_t at) const {
        std::string text;
        for (std::size_t i = at < 8 ? 0 : at - 8; i < tokens_.size() && i < at + 4; ++i)
            text += (i == at ? " >>" : " ") + tokens_[i];
        return text;
    }

    static bool is_one_of(std::string_view words, const std::string& token) {
        return words.find(" " + token + " ") != words.npos;
    }

    // ">" closes var<...>.
    static constexpr std::string_view declares_ = " fn struct var let const > ";
    static constexpr std::string_view known_ =
        " fn struct var let const return if else while for continue true false enable subgroups diagnostic "
        "off "
        "subgroup_uniformity uniform storage read read_write workgroup function ptr array atomic bool i32 "
        "u32 "
        "f32 vec2i vec2u vec3u vec4u vec2f vec3f vec4f texture_2d texture_multisampled_2d abs bitcast clamp "
        "countOneBits firstTrailingBit log2 max min sqrt textureLoad atomicAdd atomicAnd atomicLoad atomicMax "
        "atomicMin atomicOr atomicStore workgroupBarrier subgroupMin position workgroup_id global_invocation_id "
        "local_invocation_index ";
    std::vector<std::string> tokens_;
    std::set<std::string> declared_;
    std::string open_;
};
