// SPDX-License-Identifier: MIT
// Shader languages: one text, written in GLSL, becomes each of them.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/shader/translate.hpp>
#include <lightbin/result.hpp>
#include <lightbin/texel_format.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

enum class ShaderLanguage : std::uint8_t {
    glsl_330,     ///< OpenGL 3.3 to 4.2
    glsl_430,     ///< OpenGL 4.3 and later
    glsl_vulkan,  ///< GLSL 450 for Vulkan
    essl_300,     ///< OpenGL ES 3.0, WebGL 2
    essl_310,     ///< OpenGL ES 3.1 and later
    hlsl_5_0,     ///< shader model 5.0: Direct3D 11
    hlsl_5_1,     ///< shader models 5.1 and 6.x: Direct3D 12, and Vulkan by DXC
    wgsl,         ///< WebGPU
};

constexpr const char* to_string(ShaderLanguage value) {
    return detail::name_at(value, {"glsl_330", "glsl_430", "glsl_vulkan", "essl_300", "essl_310", "hlsl_5_0",
                                   "hlsl_5_1", "wgsl"});
}

/// What a name in the text is bound to.
enum class ShaderResource : std::uint8_t {
    uniform_vector,  ///< loose uniforms, in OpenGL: `grid` (uvec4), `corner` (ivec2), `image` (vec4) and the like
    uniform_block,   ///< GLSL: std140 block; HLSL: cbuffer, register b; WGSL: var<uniform>
    push_constants,  ///< Vulkan
    storage_buffer,  ///< GLSL: std430 block; HLSL: StructuredBuffer, register t; WGSL: var<storage, read>
    byte_address,    ///< HLSL: ByteAddressBuffer, register t
    texel_buffer,    ///< GLSL: buffer texture, uniform texel buffer; HLSL: Buffer, register t
    texture_2d,  ///< read without a sampler; GLSL: NEAREST, no mipmaps; WGSL: of depth "unfilterable-float"
    writable_buffer,  ///< storage buffer that is written; HLSL: RWStructuredBuffer, register u; WGSL: read_write
};

constexpr const char* to_string(ShaderResource value) {
    return detail::name_at(value, {"uniform_vector", "uniform_block", "push_constants", "storage_buffer",
                                   "byte_address", "texel_buffer", "texture_2d", "writable_buffer"});
}

/// Where a resource is bound. GLSL: binding and set; HLSL: register number and space; WGSL: binding and group. OpenGL
/// 3.3 and ES 3.0 have no bindings in the text: set the sampler or block by its name.
struct ShaderSlot {
    int binding = 0;
    int set = 0;  ///< Vulkan, hlsl_5_1 and wgsl only
};

/// Something to bind.
struct ShaderBinding {
    std::string name = {};  ///< of the uniform, sampler, block or buffer in the text
    ShaderResource resource = ShaderResource::uniform_vector;
    ShaderSlot slot = {};
    TexelFormat format = TexelFormat::none;  ///< gl_format(), vk_format(), dxgi_format(), webgpu_format()
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
    bool hlsl, es, vulkan, wgsl;
    bool spaces;           ///< sets, register spaces or groups
    bool storage_buffers;  ///< and with them compute shaders, bindings in the text, findLSB
};

inline Dialect dialect(ShaderLanguage language) {
    using enum ShaderLanguage;
    return {.hlsl = language == hlsl_5_0 || language == hlsl_5_1,
            .es = language == essl_300 || language == essl_310,
            .vulkan = language == glsl_vulkan,
            .wgsl = language == wgsl,
            .spaces = language == glsl_vulkan || language == hlsl_5_1 || language == wgsl,
            .storage_buffers = language != glsl_330 && language != essl_300};
}

/// Puts `to` wherever `from` stands.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

/// A buffer of uint or uvec2 that a shader reads.
struct ShaderBuffer {
    std::string name;
    ShaderResource resource;
    ShaderSlot slot;
    TexelFormat format;   ///< rg32ui: elements are uvec2
    std::uint64_t bytes;  ///< uniform_block: what it has room for
    std::uint32_t width;  ///< texture_2d
};

/// A vector that the CPU sets.
struct ShaderConstant {
    const char* type;
    const char* name;
};

/// What each language says in its own way.
struct ByLanguage {
    std::string glsl = {}, hlsl = {}, wgsl = {};
};

/// Puts a text together in one language.
class ShaderWriter {
public:
    ShaderWriter(ShaderLanguage language, std::string_view prefix)
        : dialect_(detail::dialect(language)), prefix_(prefix) {}

    const Dialect& dialect() const { return dialect_; }

    /// Adds text in GLSL, see detail/translate.hpp.
    void add(std::string_view glsl) { shader_.text += glsl; }

    /// Puts `to` wherever `from` stands in what was added.
    void replace(std::string_view from, std::string_view to) {
        shader_.text = replaced(std::move(shader_.text), from, to);
    }

    /// A macro, where the language has them.
    void add_macro(const std::string& call, const std::string& text) {
        if (!dialect_.wgsl) add("\n#define $" + call + " " + text + "\n");
    }

    /// Declares a resource and lists it among the bindings. `binding` has its name without the prefix; `@` in the text
    /// stands for where it is bound.
    void declare(ShaderBinding binding, const ByLanguage& text) {
        const std::string& own = dialect_.hlsl ? text.hlsl : dialect_.wgsl ? text.wgsl : text.glsl;
        add(replaced(own, "@", place_of(binding)) + ";\n");
        binding.name.insert(0, prefix_);
        shader_.bindings.push_back(std::move(binding));
    }

    /// The same of one with a type of its own: a texture or the like.
    void declare_opaque(ShaderBinding binding, const ByLanguage& type) {
        const std::string name = " $" + binding.name, highp = dialect_.es ? "highp " : "";
        declare(std::move(binding), {.glsl = "@uniform " + highp + type.glsl + name,
                                     .hlsl = type.hlsl + name + "@",
                                     .wgsl = "@var" + name + " : " + type.wgsl});
    }

    /// The same of a storage buffer of any element type: `access` is readonly, writeonly or nothing (both).
    void declare_storage(const std::string& name, const std::string& type, const std::string& access,
                         ShaderSlot slot, std::uint32_t stride) {
        const bool writable = access != "readonly", block = !dialect_.hlsl && !dialect_.wgsl;
        const ShaderResource resource =
            writable ? ShaderResource::writable_buffer : ShaderResource::storage_buffer;
        declare({name + (block ? "_block" : ""), resource, slot, TexelFormat::none, stride},
                {.glsl = "@" + access + (access.empty() ? "" : " ") + "buffer $" + name + "_block {\n    " +
                         type + " $" + name + "[];\n}",
                 .hlsl = (writable ? "RWStructuredBuffer<" : "StructuredBuffer<") + type + "> $" + name + "@",
                 .wgsl = std::string("@var<storage, ") + (writable ? "read_write" : "read") + "> $" + name +
                         " : array<" + type + ">"});
    }

    /// The same of a read-only buffer.
    void declare(const ShaderBuffer& buffer) {
        buffers_.push_back(buffer);
        const std::string type = buffer.format == TexelFormat::rg32ui ? "uvec2" : "uint";
        const std::uint32_t stride = texel_bytes(buffer.format);
        if (buffer.resource == ShaderResource::storage_buffer)
            return declare_storage(buffer.name, type, "readonly", buffer.slot, stride);
        if (buffer.resource == ShaderResource::uniform_block) {
            // As vectors, since elements of arrays take 16 bytes there.
            const auto vectors = static_cast<std::uint32_t>((buffer.bytes + 15) / 16);
            const std::string name = "$" + buffer.name, count = std::to_string(vectors);
            return declare_block(buffer.name + (dialect_.wgsl ? "" : "_block"), buffer.slot, false,
                                 16 * vectors, "    uvec4 " + name + "[" + count + "];\n",
                                 "@var<uniform> " + name + " : array<vec4u, " + count + ">");
        }
        const bool texture = buffer.resource == ShaderResource::texture_2d,
                   untyped = buffer.resource == ShaderResource::byte_address;
        declare_opaque(
            {buffer.name, buffer.resource, buffer.slot, untyped ? TexelFormat::none : buffer.format, stride,
             0, buffer.width},
            {.glsl = texture ? "usampler2D" : "usamplerBuffer",
             .hlsl = untyped ? "ByteAddressBuffer" : (texture ? "Texture2D<" : "Buffer<") + type + ">",
             .wgsl = "texture_2d<u32>"});
    }

    /// The same of constants that the CPU sets, each at the next multiple of 16 bytes: uniforms in OpenGL, one block
    /// named after the first elsewhere.
    void declare_constants(const std::vector<ShaderConstant>& constants, ShaderSlot slot, bool push) {
        const bool loose = !dialect_.hlsl && !dialect_.vulkan && !dialect_.wgsl;
        const std::string name = std::string(constants.front().name) + "_block";
        std::string lines;
        for (const ShaderConstant& constant : constants) {
            const std::string own = constant.name, type = constant.type;
            lines += "    " + type + (dialect_.wgsl ? " " : " $") + own + ";\n";
            members_.push_back({"$" + own, "$" + name + "." + own});
            const std::uint32_t bytes = type == "ivec2" ? 8 : 16;
            if (loose)
                declare({.name = own, .stride = bytes, .bytes = bytes},
                        {.glsl = "uniform " + type + " $" + own});
        }
        if (!loose)
            declare_block(name, slot, push, static_cast<std::uint32_t>(16 * constants.size()), lines,
                          "struct $" + name + "_members {\n" + lines + "}\n@var<uniform> $" + name + " : $" +
                              name + "_members");
    }

    /// Returns the expression that reads an element of a buffer that was declared: of a uvec2 buffer a uvec2, otherwise
    /// a uint.
    std::string read(std::string_view of, const std::string& index) const {
        const ShaderBuffer* found = buffers_.data();
        while (found->name != of)
            ++found;
        const ShaderBuffer& buffer = *found;
        const bool pairs = buffer.format == TexelFormat::rg32ui;
        const std::string name = "$" + buffer.name;
        const auto word = [&](const std::string& i) {
            return name + "[(" + i + ") >> 2u][(" + i + ") & 3u]";
        };
        if (buffer.resource == ShaderResource::uniform_block)
            return pairs ? "uvec2(" + word("2u * " + index) + ", " + word("2u * " + index + " + 1u") + ")"
                         : word(index);
        if (buffer.resource == ShaderResource::byte_address)
            return name + (pairs ? ".Load2(8u * (" : ".Load(4u * (") + index + "))";
        if (buffer.resource == ShaderResource::texture_2d) {
            const std::string width = std::to_string(buffer.width) + "u)";
            return read_texel(name, "ivec2(int((" + index + ") % " + width + ", int((" + index + ") / " +
                                        width + ")") +
                   (pairs ? ".xy" : ".x");
        }
        if (buffer.resource == ShaderResource::texel_buffer && !dialect_.hlsl)
            return "texelFetch(" + name + ", int(" + index + "))" + (pairs ? ".xy" : ".x");
        return name + "[" + index + "]";
    }

    /// The expression that reads a texel of a texture, at an ivec2: of one with samples, the sample's.
    std::string read_texel(const std::string& texture, const std::string& at,
                           const std::string& sample = "0") const {
        return dialect_.hlsl
                   ? texture + ".Load(" + (sample == "0" ? "int3(" + at + ", 0)" : at + ", " + sample) + ")"
               : dialect_.wgsl ? "textureLoad(" + texture + ", " + at + ", " + sample + ")"
                               : "texelFetch(" + texture + ", " + at + ", " + sample + ")";
    }

    /// Declares uints that the threads of a group share. What is atomic is read and written by the functions below, and
    /// by GLSL's.
    void declare_shared(const std::string& name, int count, bool atomic) {
        const std::string places = std::to_string(count), type = atomic ? "atomic<uint>" : "uint";
        add(dialect_.wgsl ? "var<workgroup> $" + name + " : array<" + type + ", " + places + ">;\n"
                          : "shared uint $" + name + "[" + places + "];\n");
    }

    std::string load_atomic(const std::string& place) const {
        return dialect_.wgsl ? "atomicLoad(&" + place + ")" : place;
    }

    std::string store_atomic(const std::string& place, const std::string& value) const {
        return dialect_.wgsl ? "atomicStore(&" + place + ", " + value + ")" : place + " = " + value;
    }

    /// Returns the text, or an Error if two of its resources are bound to one slot.
    Result<ShaderText> finish() {
        shader_.text = replaced(dialect_.wgsl ? WgslTranslation(shader_.text, members_).text()
                                              : translate(shader_.text, dialect_.hlsl, dialect_.es),
                                "$", prefix_);
        for (const ShaderBinding& a : shader_.bindings)
            for (const ShaderBinding& b : shader_.bindings)
                if (&a < &b && same_place(a, b))
                    return Error{ErrorCode::bindings_overlap, static_cast<std::uint64_t>(a.slot.binding),
                                 static_cast<std::uint64_t>(a.slot.set)};
        return shader_;
    }

private:
    void declare_block(const std::string& name, ShaderSlot slot, bool push, std::uint32_t bytes,
                       const std::string& lines, const std::string& wgsl) {
        declare({name, push ? ShaderResource::push_constants : ShaderResource::uniform_block, slot,
                 TexelFormat::none, bytes, bytes},
                {.glsl = "@uniform $" + name + " {\n" + lines + "}",
                 .hlsl = "cbuffer $" + name + "@ {\n" + lines + "}",
                 .wgsl = wgsl});
    }

    /// Where a resource is bound, in the words of its declaration.
    std::string place_of(const ShaderBinding& binding) const {
        const std::string number = std::to_string(binding.slot.binding),
                          set = std::to_string(binding.slot.set);
        if (dialect_.wgsl) return "@group(" + set + ") @binding(" + number + ") ";
        if (dialect_.hlsl)
            return std::string(" : register(") + row_of(binding) + number +
                   (dialect_.spaces ? ", space" + set : "") + ")";
        if (binding.resource == ShaderResource::push_constants) return "layout(push_constant) ";
        std::string inside = binding.resource == ShaderResource::uniform_block ? "std140, "
                             : binding.resource == ShaderResource::storage_buffer ||
                                     binding.resource == ShaderResource::writable_buffer
                                 ? "std430, "
                                 : "";
        if (dialect_.spaces) inside += "set = " + set + ", ";
        if (dialect_.storage_buffers) inside += "binding = " + number + ", ";
        return inside.empty() ? "" : "layout(" + inside.substr(0, inside.size() - 2) + ") ";
    }

    /// Resources whose bindings are counted together have one letter: those of HLSL's registers, and in OpenGL textures
    /// apart from buffers; Vulkan has one row of bindings a set, WebGPU a group. '-' has no binding.
    char row_of(const ShaderBinding& binding) const {
        return (dialect_.hlsl                      ? "-b-ttttu"
                : dialect_.vulkan || dialect_.wgsl ? "-b-bbbbb"
                                                   : "-b-s-tts")[static_cast<std::size_t>(binding.resource)];
    }

    /// A text without bindings has none to clash.
    bool same_place(const ShaderBinding& a, const ShaderBinding& b) const {
        return dialect_.storage_buffers && row_of(a) != '-' && row_of(a) == row_of(b) &&
               a.slot.binding == b.slot.binding && a.slot.set == b.slot.set;
    }

    Dialect dialect_;
    std::string prefix_;
    ShaderText shader_;  // its text in GLSL until finish()
    std::vector<ShaderBuffer> buffers_;
    std::vector<WgslName> members_;
};

}  // namespace detail

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
