// SPDX-License-Identifier: MIT
// Bytes to the shader generator's options: refused with a text, or a text that is sound as far as can be told
// without a compiler (tests/shader has those): brackets pair, and every name that others see has the prefix.
#include "bytes.hpp"

#include <lightbin/shader.hpp>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

using namespace lightbin;

namespace {

void require(bool condition, const char* what, const std::string& text) {
    if (condition) return;
    std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
    std::abort();
}

template <class Enum> Enum take_enum(Bytes& bytes, Enum last) {
    return static_cast<Enum>(bytes.byte() % (static_cast<unsigned>(last) + 1));
}

/// Small numbers as often as any.
std::uint32_t take_size(Bytes& bytes) {
    return bytes.flag() ? bytes.byte() : bytes.take<std::uint32_t>();
}

ShaderOptions take_options(Bytes& bytes, std::string& prefix) {
    ShaderOptions options;
    options.language = take_enum(bytes, ShaderLanguage::hlsl_5_1);
    options.storage = take_enum(bytes, ListStorage::byte_address);
    options.format.encoding = take_enum(bytes, ListEncoding::bitmask);
    options.format.ids = static_cast<IdWidth>(1u << bytes.byte() % 3);
    options.format.capacity = take_size(bytes);
    options.format.max_lights = take_size(bytes);
    const unsigned flags = bytes.byte();
    options.tiles_in_uniform_block = (flags & 1) != 0;
    options.packed_ids = (flags & 2) != 0;
    options.flip_y = (flags & 4) != 0;
    options.viewport_corner = (flags & 8) != 0;
    options.heat_map = (flags & 16) != 0;
    options.push_constants = (flags & 32) != 0;
    options.tile_size = static_cast<int>(take_size(bytes));
    options.texture_width = take_size(bytes);
    options.max_tiles = take_size(bytes);
    options.max_entries = take_size(bytes);
    if ((flags & 64) != 0) options.uniform_block_bytes = take_size(bytes);
    for (ShaderSlot* slot : {&options.tiles, &options.lists, &options.grid})
        *slot = {static_cast<int>(bytes.byte()), bytes.flag() ? static_cast<int>(bytes.byte()) : 0};
    if ((flags & 128) != 0)
        for (unsigned n = bytes.byte() % 20; n > 0; --n)
            prefix += static_cast<char>(bytes.byte());
    else
        prefix = "lightbin_";
    options.prefix = prefix;
    return options;
}

bool of_a_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Words of the languages that may stand outside of functions.
const std::set<std::string, std::less<>> language_words = {"uniform",
                                                           "layout",
                                                           "buffer",
                                                           "readonly",
                                                           "restrict",
                                                           "struct",
                                                           "highp",
                                                           "const",
                                                           "uint",
                                                           "uvec2",
                                                           "uvec4",
                                                           "ivec2",
                                                           "int",
                                                           "bool",
                                                           "float",
                                                           "vec3",
                                                           "void",
                                                           "uint2",
                                                           "uint4",
                                                           "int2",
                                                           "float3",
                                                           "cbuffer",
                                                           "register",
                                                           "StructuredBuffer",
                                                           "Texture2D",
                                                           "inout",
                                                           "static",
                                                           "Buffer",
                                                           "in",
                                                           "out",
                                                           "usampler2D",
                                                           "usamplerBuffer",
                                                           "utextureBuffer",
                                                           "ByteAddressBuffer",
                                                           "utexture2D",
                                                           "vk",
                                                           "push_constant",
                                                           "ConstantBuffer",
                                                           "flat",
                                                           "precision",
                                                           "mediump"};

/// Brackets pair; names at the outermost level, and those of members that blocks put there, have the prefix.
void check_text(const std::string& text, const std::string& prefix) {
    require(text.find('$') == std::string::npos, "a placeholder is left", text);
    std::string open, word, last_outer;
    bool in_block = false, in_comment = false, in_macro = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        require(c == '\n' || (c >= ' ' && c <= '~'), "not a printable character", text);
        if (c == '\n' && (at == 0 || text[at - 1] != '\\')) {
            in_comment = false;
            in_macro = false;
        }
        if (in_comment || in_macro) continue;
        if (text.compare(at, 2, "//") == 0) in_comment = true;
        if (text.compare(at, 8, "#define ") == 0) {
            in_macro = true;
            require(text.compare(at + 8, prefix.size(), prefix) == 0, "a macro without the prefix", text);
        }
        if (c == '#') in_macro = true;
        if (in_comment || in_macro) continue;
        if (of_a_name(c)) {
            word += c;
            continue;
        }
        if (!word.empty()) {
            const bool outer = open.empty() || (in_block && open == "{");
            const bool number = std::isdigit(static_cast<unsigned char>(word.front())) != 0;
            if (outer && !number && !language_words.contains(word))
                require(word.compare(0, prefix.size(), prefix) == 0, ("no prefix: " + word).c_str(), text);
            if (open.empty()) {
                if (word == "buffer" || word == "uniform" || word == "cbuffer") in_block = true;
                if (word == "struct") in_block = false;
            }
            word.clear();
        }
        if (c == '(' || c == '[' || c == '{') open += c;
        if (c == ')' || c == ']' || c == '}') {
            require(!open.empty() && open.back() == (c == ')'   ? '('
                                                     : c == ']' ? '['
                                                                : '{'),
                    "brackets do not pair", text);
            open.pop_back();
        }
        if (c == ';' && open.empty()) in_block = false;
    }
    require(open.empty(), "a bracket is left open", text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    std::string prefix;
    const ShaderOptions options = take_options(bytes, prefix);
    const Result<ShaderText> made = shader_snippet(options);
    if (!made) {
        require(made.error().message().size() > 10, "refused without a text", "");
        return 0;
    }
    check_text(made->text, prefix);
    for (const ShaderBinding& binding : made->bindings) {
        require(made->text.find(binding.name) != std::string::npos && binding.name.starts_with(prefix),
                "a binding that is not in the text", made->text + binding.name);
        if (binding.resource == ShaderResource::uniform_block)
            require(binding.bytes <= std::max<std::uint64_t>(options.uniform_block_bytes + 15ull, 32),
                    "a block larger than allowed", made->text);
    }
    for (const char* name : {"tile", "cursor", "begin", "next", "for_each_light"})
        require(made->text.find(prefix + name) != std::string::npos, "a name is missing", made->text);
    return 0;
}
