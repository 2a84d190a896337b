// SPDX-License-Identifier: MIT
// Shader languages: one text, written in GLSL, becomes each of them.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/names.hpp>
#include <lightbin/result.hpp>
#include <lightbin/texel_format.hpp>

#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

enum class ShaderLanguage : std::uint8_t {
    glsl_330,     ///< OpenGL 3.3 to 4.2
    glsl_430,     ///< OpenGL 4.3 and later
    glsl_vulkan,  ///< GLSL 450 for Vulkan
    essl_300,     ///< OpenGL ES 3.0, WebGL 2
    essl_310,     ///< OpenGL ES 3.1 and later
    hlsl_5_0,     ///< shader model 5.0: Direct3D 11
    hlsl_5_1,     ///< shader models 5.1 and 6.x: Direct3D 12, and Vulkan by DXC
};

constexpr const char* to_string(ShaderLanguage value) {
    return detail::name_at(
        value, {"glsl_330", "glsl_430", "glsl_vulkan", "essl_300", "essl_310", "hlsl_5_0", "hlsl_5_1"});
}

/// What a name in the text is bound to.
enum class ShaderResource : std::uint8_t {
    uniform_vector,  ///< loose uniforms, in OpenGL: `grid` (uvec4), `corner` (ivec2), `image` (vec4) and the like
    uniform_block,    ///< GLSL: std140 block; HLSL: cbuffer, register b
    push_constants,   ///< Vulkan
    storage_buffer,   ///< GLSL: std430 block; HLSL: StructuredBuffer, register t
    byte_address,     ///< HLSL: ByteAddressBuffer, register t
    texel_buffer,     ///< GLSL: buffer texture, uniform texel buffer; HLSL: Buffer, register t
    texture_2d,       ///< read without a sampler; GLSL: NEAREST, no mipmaps
    writable_buffer,  ///< storage buffer that is written; HLSL: RWStructuredBuffer, register u
};

constexpr const char* to_string(ShaderResource value) {
    return detail::name_at(value, {"uniform_vector", "uniform_block", "push_constants", "storage_buffer",
                                   "byte_address", "texel_buffer", "texture_2d", "writable_buffer"});
}

/// Where a resource is bound. GLSL: binding and set; HLSL: register number and space. OpenGL 3.3 and ES 3.0
/// have no bindings in the text: set the sampler or block by its name.
struct ShaderSlot {
    int binding = 0;
    int set = 0;  ///< Vulkan and hlsl_5_1 only
};

/// Something to bind.
struct ShaderBinding {
    std::string name = {};  ///< of the uniform, sampler, block or buffer in the text
    ShaderResource resource = ShaderResource::uniform_vector;
    ShaderSlot slot = {};
    TexelFormat format = TexelFormat::none;  ///< gl_format(), vk_format(), dxgi_format()
    std::uint32_t stride = 0;  ///< bytes of one element or texel
    std::uint32_t bytes = 0;   ///< uniform blocks, push constants: size in the text; otherwise 0, as the data
    std::uint32_t width =
        0;  ///< texture_2d: texels a row, see texture_rows(); 0: as many as there are tiles across
};

/// A text and what it wants bound, in the order of the text.
struct ShaderText {
    std::string text;
    std::vector<ShaderBinding> bindings;
};

namespace detail {

/// What a language has.
struct Dialect {
    bool hlsl, es, vulkan;
    bool spaces;           ///< sets or register spaces
    bool storage_buffers;  ///< and with them compute shaders, bindings in the text, findLSB
};

inline Dialect dialect(ShaderLanguage language) {
    using enum ShaderLanguage;
    const bool hlsl = language == hlsl_5_0 || language == hlsl_5_1, vulkan = language == glsl_vulkan;
    return {hlsl, language == essl_300 || language == essl_310, vulkan, vulkan || language == hlsl_5_1,
            language != glsl_330 && language != essl_300};
}

/// The word of HLSL for a word of GLSL.
inline std::string_view hlsl_word(std::string_view word) {
    static constexpr std::string_view words[][2] = {
        {"uvec2", "uint2"},
        {"uvec4", "uint4"},
        {"ivec2", "int2"},
        {"vec2", "float2"},
        {"vec3", "float3"},
        {"vec4", "float4"},
        {"findLSB", "firstbitlow"},
        {"bitCount", "countbits"},
        {"floatBitsToUint", "asuint"},
        {"uintBitsToFloat", "asfloat"},
        {"shared", "groupshared"},
        {"atomicMin", "InterlockedMin"},
        {"atomicMax", "InterlockedMax"},
        {"atomicOr", "InterlockedOr"},
        {"subgroupMin", "WaveActiveMin"},
        {"sync_group", "GroupMemoryBarrierWithGroupSync"},
    };
    for (const auto& [glsl, hlsl] : words)
        if (word == glsl) return hlsl;
    return word;
}

/// Returns a GLSL text in a language, `$` being the prefix. Types are declared highp in ES: a fragment
/// shader's integers have 16 bits there otherwise, and no default precision is set, as it would reach the
/// user's code.
inline std::string translate(const Dialect& dialect, std::string_view prefix, std::string_view glsl) {
    constexpr std::string_view types[] = {"uint", "uvec2", "uvec4", "ivec2",      "int",       "float",
                                          "vec2", "vec3",  "vec4",  "usampler2D", "sampler2D", "sampler2DMS"};
    const auto of_a_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    std::string text;
    for (std::size_t at = 0; at < glsl.size();) {
        std::size_t end = at;
        while (end < glsl.size() && of_a_name(glsl[end]))
            ++end;
        const std::string_view word = glsl.substr(at, end - at);
        if (word.empty()) {
            const char c = glsl[at++];
            if (c == '$') {
                text += prefix;
                for (; at < glsl.size() && of_a_name(glsl[at]); ++at)
                    text += glsl[at];
            } else {
                text += c;
            }
            continue;
        }
        const bool declares = end < glsl.size() && glsl[end] != '(';
        if (dialect.es && declares)
            for (const std::string_view type : types)
                if (word == type) text += "highp ";
        text += dialect.hlsl           ? hlsl_word(word)
                : word == "sync_group" ? std::string_view("memoryBarrierShared();\n    barrier")
                                       : word;
        at = end;
    }
    return text;
}

/// A buffer of uint or uvec2 that a shader reads.
struct ShaderBuffer {
    std::string name;
    ShaderResource resource;
    ShaderSlot slot;
    TexelFormat format;     ///< rg32ui: elements are uvec2
    std::uint32_t vectors;  ///< uniform_block: its size in uvec4
    std::uint32_t width;    ///< texture_2d
};

/// A vector that the CPU sets.
struct ShaderConstant {
    const char* type;
    const char* name;
};

/// Puts a text together in one language.
class ShaderWriter {
public:
    ShaderWriter(ShaderLanguage language, std::string_view prefix)
        : dialect_(detail::dialect(language)), prefix_(prefix) {}

    const Dialect& dialect() const { return dialect_; }

    void add(std::string_view glsl) { shader_.text += translate(dialect_, prefix_, glsl); }

    /// Declares a read-only buffer and lists it among the bindings.
    void declare(const ShaderBuffer& buffer) {
        const bool pairs = buffer.format == TexelFormat::rg32ui;
        const std::string name = "$" + buffer.name, type = pairs ? "uvec2" : "uint";
        const std::uint32_t stride = pairs ? 8 : 4;
        if (buffer.resource == ShaderResource::uniform_block)
            return add_block(buffer.name + "_block",
                             "    uvec4 " + name + "[" + std::to_string(buffer.vectors) + "];\n", buffer.slot,
                             false, buffer.vectors * 16);
        if (buffer.resource == ShaderResource::storage_buffer)
            return declare_storage(buffer.name, type, "readonly", buffer.slot, stride);
        if (buffer.resource == ShaderResource::byte_address)
            return declare_opaque({buffer.name, buffer.resource, buffer.slot, TexelFormat::none, stride},
                                  "ByteAddressBuffer", "");
        const bool texture = buffer.resource == ShaderResource::texture_2d;
        declare_opaque({buffer.name, buffer.resource, buffer.slot, buffer.format, texel_bytes(buffer.format),
                        0, texture ? buffer.width : 0},
                       (texture ? "Texture2D<" : "Buffer<") + type + ">",
                       texture ? "usampler2D" : "usamplerBuffer");
    }

    /// Declares a read-only resource of a type that each language has its own name for. `binding` has its name
    /// without the prefix.
    void declare_opaque(ShaderBinding binding, const std::string& hlsl, const std::string& glsl) {
        add(dialect_.hlsl ? hlsl + " $" + binding.name + hlsl_register(binding.slot, 't') + ";\n"
                          : layout("", binding.slot) + "uniform " + glsl + " $" + binding.name + ";\n");
        bind(std::move(binding));
    }

    /// Returns the expression that reads an element: of a uvec2 buffer a uvec2, otherwise a uint.
    std::string read(const ShaderBuffer& buffer, const std::string& index) const {
        const bool pairs = buffer.format == TexelFormat::rg32ui;
        const std::string name = "$" + buffer.name;
        const auto word = [&](const std::string& i) {
            return name + "[(" + i + ") >> 2u][(" + i + ") & 3u]";
        };
        switch (buffer.resource) {
        case ShaderResource::uniform_block:
            if (!pairs) return word(index);
            return "uvec2(" + word("2u * " + index) + ", " + word("2u * " + index + " + 1u") + ")";
        case ShaderResource::byte_address:
            return name + (pairs ? ".Load2(8u * (" : ".Load(4u * (") + index + "))";
        case ShaderResource::texel_buffer:
            if (dialect_.hlsl) break;
            return "texelFetch(" + name + ", int(" + index + "))" + (pairs ? ".xy" : ".x");
        case ShaderResource::texture_2d: {
            const std::string width = std::to_string(buffer.width) + "u)";
            return read_texel(buffer, "int((" + index + ") % " + width + ", int((" + index + ") / " + width);
        }
        case ShaderResource::uniform_vector:
        case ShaderResource::push_constants:
        case ShaderResource::storage_buffer:
        case ShaderResource::writable_buffer:
            break;
        }
        return name + "[" + index + "]";
    }

    /// The same of a texture_2d, at "x, y".
    std::string read_texel(const ShaderBuffer& buffer, const std::string& texel) const {
        return (dialect_.hlsl ? "$" + buffer.name + ".Load(int3(" + texel + ", 0))"
                              : "texelFetch($" + buffer.name + ", ivec2(" + texel + "), 0)") +
               (buffer.format == TexelFormat::rg32ui ? ".xy" : ".x");
    }

    /// Declares constants that the CPU sets, each at the next multiple of 16 bytes: uniforms in OpenGL, one
    /// block named after the first elsewhere.
    void declare_constants(const std::vector<ShaderConstant>& constants, ShaderSlot slot, bool push) {
        const bool block = dialect_.hlsl || dialect_.vulkan;
        std::string lines;
        for (const ShaderConstant& constant : constants) {
            const std::string line = std::string(constant.type) + " $" + constant.name + ";";
            if (block) {
                lines += "    " + line + "\n";
                continue;
            }
            add("uniform " + line + "\n");
            const std::uint32_t bytes = constant.type == std::string_view("ivec2") ? 8 : 16;
            bind({.name = constant.name, .stride = bytes, .bytes = bytes});
        }
        if (!block) return;
        const std::string name = std::string(constants.front().name) + "_block";
        const auto bytes = static_cast<std::uint32_t>(16 * constants.size());
        add_block(name, lines, slot, push, bytes);
    }

    /// Declares a storage buffer of any element type: `access` is readonly, writeonly or nothing (both).
    void declare_storage(const std::string& name, const std::string& type, std::string_view access,
                         ShaderSlot slot, std::uint32_t stride) {
        const bool writable = access != "readonly";
        if (dialect_.hlsl)
            add((writable ? "RWStructuredBuffer<" : "StructuredBuffer<") + type + "> $" + name +
                hlsl_register(slot, writable ? 'u' : 't') + ";\n");
        else
            add(layout("std430", slot) + std::string(access) + (access.empty() ? "" : " ") + "buffer $" +
                name + "_block {\n    " + type + " $" + name + "[];\n};\n");
        bind({name + (dialect_.hlsl ? "" : "_block"),
              writable ? ShaderResource::writable_buffer : ShaderResource::storage_buffer, slot,
              TexelFormat::none, stride});
    }

    /// Returns the text, or an Error if two of its resources are bound to one slot.
    Result<ShaderText> finish() {
        for (const ShaderBinding& a : shader_.bindings)
            for (const ShaderBinding& b : shader_.bindings)
                if (&a < &b && same_place(a, b))
                    return Error{ErrorCode::bindings_overlap, static_cast<std::uint64_t>(a.slot.binding),
                                 static_cast<std::uint64_t>(a.slot.set)};
        return shader_;
    }

private:
    std::string layout(const std::string& packing, ShaderSlot slot) const {
        std::string inside = packing;
        const auto item = [&](const char* key, int value) {
            inside += (inside.empty() ? "" : ", ") + std::string(key) + " = " + std::to_string(value);
        };
        if (dialect_.spaces) item("set", slot.set);
        if (dialect_.storage_buffers) item("binding", slot.binding);
        return inside.empty() ? "" : "layout(" + inside + ") ";
    }

    std::string hlsl_register(ShaderSlot slot, char kind) const {
        return " : register(" + std::string(1, kind) + std::to_string(slot.binding) +
               (dialect_.spaces ? ", space" + std::to_string(slot.set) : "") + ")";
    }

    /// Lists a resource that add() declared; its name is given without the prefix.
    void bind(ShaderBinding binding) {
        binding.name.insert(0, prefix_);
        shader_.bindings.push_back(std::move(binding));
    }

    static std::uint32_t texel_bytes(TexelFormat format) {
        return format == TexelFormat::r8ui    ? 1
               : format == TexelFormat::r16ui ? 2
               : format == TexelFormat::r32ui ? 4
                                              : 8;
    }

    void add_block(const std::string& name, const std::string& lines, ShaderSlot slot, bool push,
                   std::uint32_t bytes) {
        add(push            ? "layout(push_constant) uniform $" + name
            : dialect_.hlsl ? "cbuffer $" + name + hlsl_register(slot, 'b')
                            : layout("std140", slot) + "uniform $" + name);
        add(" {\n" + lines + "};\n");
        bind({name, push ? ShaderResource::push_constants : ShaderResource::uniform_block, slot,
              TexelFormat::none, bytes, bytes});
    }

    /// Vulkan has one row of bindings a set; elsewhere each kind has its own, and a text without bindings has
    /// none to clash.
    bool same_place(const ShaderBinding& a, const ShaderBinding& b) const {
        const auto kind = [&](const ShaderBinding& binding) {
            switch (binding.resource) {
            case ShaderResource::uniform_vector:
            case ShaderResource::push_constants:
                return 0;
            case ShaderResource::uniform_block:
                return 1;
            case ShaderResource::writable_buffer:
                return dialect_.hlsl ? 3 : 2;
            case ShaderResource::storage_buffer:
                return 2;
            case ShaderResource::byte_address:
            case ShaderResource::texel_buffer:
            case ShaderResource::texture_2d:
                break;
            }
            return dialect_.hlsl ? 2 : 4;
        };
        const int kind_a = kind(a), kind_b = kind(b);
        return dialect_.storage_buffers && kind_a != 0 && kind_b != 0 &&
               (dialect_.vulkan || kind_a == kind_b) && a.slot.binding == b.slot.binding &&
               a.slot.set == b.slot.set;
    }

    Dialect dialect_;
    std::string prefix_;
    ShaderText shader_;
};

}  // namespace detail

}  // namespace lightbin

#include <lightbin/detail/warnings_on.inl>
