// SPDX-License-Identifier: MIT
// ShaderWriter collects a shader text that is written in GLSL, and translates it to the wanted language in the end. The
// translation handles the part of GLSL that the texts keep to: a declaration holds one name, every branch and loop has
// braces, only `inout` parameters are assigned to, and there is no `?:`. Two signs are not GLSL's: `$` stands for the
// prefix of names, and `&` marks an argument for an `inout` parameter.
#pragma once

#include <lightbin/detail/base/platform.hpp>
#include <lightbin/result.hpp>
#include <lightbin/shader_text.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

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
        {"atomicAnd", "InterlockedAnd", "atomicAnd"},
        {"atomicAdd", "InterlockedAdd", "atomicAdd"},
        {"subgroupMin", "WaveActiveMin", "subgroupMin"},
        {"subgroupMax", "WaveActiveMax", "subgroupMax"},
        {"subgroupOr", "WaveActiveBitOr", "subgroupOr"},
        {"uniform_load", "", "workgroupUniformLoad"},
        {"sync_group", "GroupMemoryBarrierWithGroupSync", "workgroupBarrier"},
    };
    for (const ShaderWord& row : words)
        if (word == row.glsl) return row;
    return {word, word, word};
}

/// Returns `text` with every `from` replaced by `to`.
LIGHTBIN_SMALL inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

/// Translates the writer's GLSL, which is described at the head of this file, to HLSL or to the GLSL of OpenGL, Vulkan
/// or OpenGL ES. In OpenGL ES every declaration is marked highp, since a fragment shader's integers may have only 16
/// bits otherwise. (A default precision would change the user's code, too.)
LIGHTBIN_SMALL inline std::string translate(std::string_view glsl, bool hlsl, bool es) {
    std::string text;
    for (std::size_t at = 0; at < glsl.size();) {
        const std::string_view word = word_at(glsl, at);
        at += word.size();
        if (word.empty()) {
            const char sign = glsl[at++];
            if (sign != '&' || word_at(glsl, at).empty()) text += sign;
            continue;
        }
        // (&variable) or (&variable, value); only WGSL has them
        if (word == "atomicLoad" || word == "atomicStore" || word == "uniform_load") {
            const std::size_t end = glsl.find(')', at);
            text += replaced(std::string(glsl.substr(at + 2, end - at - 2)), ", ", " = ");
            at = end + 1;
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
    LIGHTBIN_SMALL WgslTranslation(std::string_view glsl, const std::vector<WgslName>& constants)
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
        // `&` marks an argument for an `inout` parameter, in WGSL a pointer, and makes one of a variable. A name that
        // renamed() changes is such a parameter itself, which is a pointer already and is passed on without `&`.
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
        // A type, a space and a name begin a declaration. Structs that the shader text declares have names with `$`.
        const ShaderWord row = shader_word(word);
        const std::string_view name = at_ < glsl_.size() && glsl_[at_] == ' ' ? word_at(glsl_, at_ + 1) : "";
        if ((row.is_type || word == "void" || word.starts_with('$')) && !name.empty()) {
            at_ += 1 + name.size();
            declare(word == "void" ? "" : row.wgsl, name);
        } else {
            wgsl_ += wgsl_.ends_with('.') ? row.wgsl : renamed(row.wgsl);
        }
    }

    LIGHTBIN_SMALL void declare(std::string_view type, std::string_view its_name) {
        const std::string what(type), name(its_name);
        if (depth_ == 0 && !in_parameters_) {
            wgsl_ += "fn " + name;
            result_ = what;
            in_parameters_ = true;
            names_.resize(constants_);
            return;
        }
        wgsl_ += (in_struct_ || in_parameters_ ? "" : "var ") + name + " : " +
                 (by_pointer_ ? "ptr<function, " + what + ">" : what);
        if (by_pointer_) names_.push_back({name, "(*" + name + ")"});
        by_pointer_ = false;
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

/// Which family of shader languages a language belongs to (HLSL, OpenGL ES, Vulkan, WebGPU), and which features it has.
struct Dialect {
    using enum ShaderLanguage;
    ShaderLanguage language;
    bool hlsl = language == hlsl_5_0 || language == hlsl_5_1, es = language == essl_300 || language == essl_310,
         vulkan = language == glsl_vulkan, webgpu = language == wgsl;
    /// A binding has a descriptor set, register space or bind group beside its number.
    bool spaces = vulkan || webgpu || language == hlsl_5_1;
    /// The language has storage buffers, compute shaders, bindings in the text, and findLSB.
    bool storage_buffers = language != glsl_330 && language != essl_300;
};

/// Whether `prefix` makes a valid identifier of every name in the shader texts. ES limits identifiers to 1024
/// characters, of which the texts' own names need fewer than 24. GLSL reserves names that contain `__` or begin with
/// `gl_`, and macros that begin with `GL_`. `vola` would make the keyword `volatile` of the name `tile`; no other
/// keyword of the languages ends in one of the names.
inline bool is_prefix(std::string_view prefix) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    return !prefix.empty() && prefix.size() <= 1000 && prefix.find_first_not_of(letters) == prefix.npos &&
           prefix.find_first_of("0123456789_") != 0 && prefix.find("__") == prefix.npos &&
           !prefix.starts_with("gl_") && !prefix.starts_with("GL_") && prefix != "vola";
}

/// Returns the first error among those of the options that all shader texts have (the prefix, push_constants and the
/// slots) and of `others`, which pairs an error with whether there is that error.
template <class Options>
std::optional<Error> refuse_common(const Options& options, std::initializer_list<ShaderSlot> all_slots,
                                   std::initializer_list<std::pair<bool, Error>> others) {
    const Dialect dialect = {options.language};
    if (!is_prefix(options.prefix)) return Error{ErrorCode::not_a_prefix};
    if constexpr (requires { options.push_constants; })
        if (options.push_constants && !dialect.vulkan) return Error{ErrorCode::no_push_constants};
    for (const ShaderSlot& slot : all_slots)
        for (const int number : {slot.binding, slot.set})
            if (number < 0) return Error{ErrorCode::slot_out_of_range, static_cast<std::uint64_t>(number)};
    for (const ShaderSlot& slot : all_slots)
        if (slot.set != 0 && !dialect.spaces)
            return Error{ErrorCode::no_sets, static_cast<std::uint64_t>(slot.set)};
    for (const auto& [refused, error] : others)
        if (refused) return error;
    return std::nullopt;
}

/// A read-only buffer whose elements are uint or uvec2.
struct ShaderBuffer {
    std::string name;
    ShaderResource resource;
    ShaderSlot slot;
    TexelFormat format;   ///< the format of an element: uvec2 if it is rg32ui, otherwise uint
    std::uint64_t bytes;  ///< if the resource is a uniform_block: its size, enough for all data that the options allow
    std::uint32_t width;  ///< the number of texels per row, if the resource is a texture_2d
};

/// The type and the name of a vector that the CPU sets, such as {"uvec4", "grid"}.
using ShaderConstant = std::pair<const char*, const char*>;

/// A declaration, or a part of one, as each of the three families of shader languages writes it.
struct ByLanguage {
    std::string glsl = {}, hlsl = {}, wgsl = {};
};

/// Collects one shader text and its bindings. The declare functions add a declaration to the text and the resource to
/// the bindings. In texts given to the writer, `$` stands for the prefix that all names in the result begin with.
class ShaderWriter {
public:
    ShaderWriter(ShaderLanguage language, std::string_view prefix)
        : dialect{language}, prefix_(prefix) {}

    const Dialect dialect;

    /// Sets the text that add() writes in place of `@name`.
    void set(std::string_view name, std::string_view text) { names_.emplace_back(name, text); }
    /// Sets by which conditions add() keeps lines.
    void set(std::initializer_list<std::pair<const char*, bool>> conditions) {
        for (const auto& [name, holds] : conditions)
            set(name, holds ? "1" : "0");
    }

    /// Appends text in the part of GLSL that the head of this file describes. `$name[i]` reads element i of the
    /// ShaderBuffer `name`, whatever kind of resource it is. `@name` stands for a text of set(), and a line that ends
    /// in `@if a !b` is kept if the condition a holds, and b does not.
    LIGHTBIN_SMALL void add(std::string_view text) {
        std::string glsl;
        for (std::size_t at = 0, end; at < text.size(); at = end) {
            end = (std::min)(text.find('\n', at), text.size() - 1) + 1;
            const std::string_view line = text.substr(at, end - at);
            const std::size_t condition = line.find("@if ");
            if (condition == line.npos)
                glsl += line;
            else if (holds(line.substr(condition + 4)))
                (glsl += line.substr(0, line.find_last_not_of(' ', condition - 1) + 1)) += '\n';
        }
        for (std::size_t at = 0; (at = glsl.find('@', at)) != glsl.npos;)
            if (const std::string_view name = word_at(glsl, at + 1); const std::string* const known = text_of(name))
                glsl.replace(at, name.size() + 1, *known);
            else
                ++at;
        for (const ShaderBuffer& buffer : buffers_) {
            const std::string name = "$" + buffer.name + "[";
            for (std::size_t at = 0; (at = glsl.find(name, at)) != glsl.npos;) {
                const std::size_t index = at + name.size(), end = glsl.find(']', index);
                const std::string element = read(buffer, glsl.substr(index, end - index));
                glsl.replace(at, end + 1 - at, element);
                at += element.size();
            }
        }
        shader_.text += glsl;
    }

    /// Declares a resource by the member of `text` in the language of the result. `@` in it stands for the layout,
    /// register or attribute that binds the resource. The prefix of names is added to binding.name.
    LIGHTBIN_SMALL void declare(ShaderBinding binding, const ByLanguage& text) {
        const std::string& own = dialect.hlsl ? text.hlsl : dialect.webgpu ? text.wgsl : text.glsl;
        shader_.text += replaced(own, "@", binding_text(binding)) + ";\n";
        binding.name.insert(0, prefix_);
        shader_.bindings.push_back(std::move(binding));
    }

    /// Declares a texture or another resource that has an opaque type.
    LIGHTBIN_SMALL void declare_opaque(ShaderBinding binding, const ByLanguage& type) {
        const std::string name = " $" + binding.name, highp = dialect.es ? "highp " : "";
        declare(std::move(binding), {.glsl = "@uniform " + highp + type.glsl + name,
                                     .hlsl = type.hlsl + name + "@",
                                     .wgsl = "@var" + name + " : " + type.wgsl});
    }

    /// Declares a storage buffer, an array of `type`. `access` is "readonly", "writeonly", or "" for both.
    LIGHTBIN_SMALL void declare_storage(const std::string& name, const std::string& type, const std::string& access,
                         ShaderSlot slot, std::uint32_t stride) {
        const bool writable = access != "readonly", block = !dialect.hlsl && !dialect.webgpu;
        const ShaderResource resource =
            writable ? ShaderResource::writable_buffer : ShaderResource::storage_buffer;
        declare({name + (block ? "_block" : ""), resource, slot, TexelFormat::none, stride},
                {.glsl = "@" + access + (access.empty() ? "" : " ") + "buffer $" + name + "_block {\n    " +
                         type + " $" + name + "[];\n}",
                 .hlsl = (writable ? "RWStructuredBuffer<" : "StructuredBuffer<") + type + "> $" + name + "@",
                 .wgsl = std::string("@var<storage, ") + (writable ? "read_write" : "read") + "> $" + name +
                         " : array<" + type + ">"});
    }

    /// Declares a read-only buffer, whatever kind of resource it is.
    LIGHTBIN_SMALL void declare(const ShaderBuffer& buffer) {
        buffers_.push_back(buffer);
        const std::string type = buffer.format == TexelFormat::rg32ui ? "uvec2" : "uint";
        const std::uint32_t stride = std::array{0u, 1u, 2u, 4u, 8u}[static_cast<std::size_t>(buffer.format)];
        if (buffer.resource == ShaderResource::storage_buffer)
            return declare_storage(buffer.name, type, "readonly", buffer.slot, stride);
        if (buffer.resource == ShaderResource::uniform_block) {
            // Each array element takes 16 bytes in a uniform block, so the array is one of uvec4.
            const auto vectors = static_cast<std::uint32_t>((buffer.bytes + 15) / 16);
            const std::string name = "$" + buffer.name, count = std::to_string(vectors);
            declare_block(buffer.name + (dialect.webgpu ? "" : "_block"), buffer.slot, false, 16 * vectors,
                          "    uvec4 " + name + "[" + count + "];\n",
                          "@var<uniform> " + name + " : array<vec4u, " + count + ">");
            // A function, as NVIDIA's compiler for OpenGL (driver 580) picks a wrong component where the index is a sum
            // that it folds into the address: `slices[(slice + 4u) >> 2u][(slice + 4u) & 3u]`.
            shader_.text += "uint " + name + "_word(uint at) {\n    return " + name + "[at >> 2u][at & 3u];\n}\n";
            return;
        }
        const bool texture = buffer.resource == ShaderResource::texture_2d;
        declare_opaque({buffer.name, buffer.resource, buffer.slot, buffer.format, stride, 0, buffer.width},
                       {.glsl = texture ? "usampler2D" : "usamplerBuffer",
                        .hlsl = (texture ? "Texture2D<" : "Buffer<") + type + ">",
                        .wgsl = "texture_2d<u32>"});
    }

    /// Declares constants. In OpenGL each is a uniform by itself, unless `block` is true. In the other APIs they form
    /// one block, named after the first one, in which each begins at a multiple of 16 bytes; `push` makes it a block of
    /// push constants. If `length` is more than 1, each constant is an array of so many vec4s.
    LIGHTBIN_SMALL void declare_constants(const std::vector<ShaderConstant>& constants, ShaderSlot slot, bool push,
                           std::uint32_t length = 1, bool block = false) {
        const bool loose = !block && !dialect.hlsl && !dialect.vulkan && !dialect.webgpu;
        const std::string name = std::string(constants.front().second) + "_block";
        std::string lines;
        for (const auto& [constant_type, constant_name] : constants) {
            const std::string own = constant_name, type = constant_type;
            const std::string array = length > 1 ? "[" + std::to_string(length) + "]" : "";
            lines += length > 1 && dialect.webgpu
                         ? "    " + own + " : array<vec4f, " + std::to_string(length) + ">;\n"
                         : "    " + type + (dialect.webgpu ? " " : " $") + own + array + ";\n";
            members_.push_back({"$" + own, "$" + name + "." + own});
            const std::uint32_t bytes = type == "ivec2" ? 8 : 16;
            if (loose)
                declare({.name = own, .stride = bytes, .bytes = bytes * length},
                        {.glsl = "uniform " + type + " $" + own + array});
        }
        if (!loose)
            declare_block(name, slot, push, static_cast<std::uint32_t>(16 * length * constants.size()), lines,
                          "struct $" + name + "_members {\n" + lines + "}\n@var<uniform> $" + name + " : $" +
                              name + "_members");
    }

    /// Returns the expression that reads a texel of a texture at `at`, an ivec2; of a multisampled texture, one sample.
    LIGHTBIN_SMALL std::string read_texel(const std::string& texture, const std::string& at,
                           const std::string& sample = "0") const {
        return dialect.hlsl
                   ? texture + ".Load(" + (sample == "0" ? "int3(" + at + ", 0)" : at + ", " + sample) + ")"
               : dialect.webgpu ? "textureLoad(" + texture + ", " + at + ", " + sample + ")"
                               : "texelFetch(" + texture + ", " + at + ", " + sample + ")";
    }

    /// Declares an array of uint in the memory that a work group shares. If `atomic`, WGSL makes it one of atomic<u32>,
    /// and so the text may use it only by atomicLoad(), atomicStore(), and GLSL's functions such as atomicMin().
    LIGHTBIN_SMALL void declare_shared(const std::string& name, int count, bool atomic) {
        const std::string size = std::to_string(count), type = atomic ? "atomic<uint>" : "uint";
        add(dialect.webgpu ? "var<workgroup> $" + name + " : array<" + type + ", " + size + ">;\n"
                          : "shared uint $" + name + "[" + size + "];\n");
    }

    /// Adds a compute shader's entry point, with `threads` threads per group. It calls the text's $run(group, thread).
    LIGHTBIN_SMALL void add_compute_main(unsigned threads) {
        const std::string count = std::to_string(threads);
        add(dialect.webgpu ? "\n@compute @workgroup_size(" + count + ")\nfn main(@builtin(workgroup_id) group : vec3u, "
                             "@builtin(local_invocation_index) thread : u32) {\n"
            : dialect.hlsl ? "\n[numthreads(" + count + ", 1, 1)]\n"
                             "void main(uint3 group : SV_GroupID, uint thread : SV_GroupIndex) {\n"
                           : "\nlayout(local_size_x = " + count + ") in;\nvoid main() {\n");
        add(dialect.webgpu || dialect.hlsl ? "    $run(group.xy, thread);\n}\n"
                                           : "    $run(gl_WorkGroupID.xy, gl_LocalInvocationIndex);\n}\n");
    }

    /// Returns the text in the writer's language, or an Error if two resources are bound to one slot. Languages without
    /// bindings in the text have no slots. The names that begin with `$own_` begin with `own` instead.
    Result<ShaderText> finish(std::string_view own = "$own_") {
        shader_.text = replaced(std::move(shader_.text), "$own_", own);
        shader_.text = replaced(dialect.webgpu ? WgslTranslation(shader_.text, members_).text()
                                              : translate(shader_.text, dialect.hlsl, dialect.es),
                                "$", prefix_);
        for (const ShaderBinding& a : shader_.bindings)
            for (const ShaderBinding& b : shader_.bindings)
                if (dialect.storage_buffers && &a < &b && numbering_of(a) != '-' &&
                    numbering_of(a) == numbering_of(b) && a.slot.binding == b.slot.binding && a.slot.set == b.slot.set)
                    return Error{ErrorCode::bindings_overlap, static_cast<std::uint64_t>(a.slot.binding),
                                 static_cast<std::uint64_t>(a.slot.set)};
        return shader_;
    }

private:
    /// Returns whether all names of a condition such as "masks !binned" are set so.
    bool holds(std::string_view condition) const {
        for (std::size_t at = 0; at < condition.size(); ++at) {
            const std::string_view name = word_at(condition, at);
            const bool negated = at > 0 && condition[at - 1] == '!';
            if (!name.empty() && *text_of(name) != (negated ? "0" : "1")) return false;
            at += name.size();
        }
        return true;
    }

    /// Returns the text that set() was given for a name, or null.
    const std::string* text_of(std::string_view name) const {
        for (const auto& [known, text] : names_)
            if (known == name) return &text;
        return nullptr;
    }

    /// Returns the expression that reads the element `index` of a buffer, a uint or a uvec2.
    LIGHTBIN_SMALL std::string read(const ShaderBuffer& buffer, const std::string& index) const {
        const bool pairs = buffer.format == TexelFormat::rg32ui;
        const std::string name = "$" + buffer.name;
        const auto word = [&](const std::string& i) { return name + "_word(" + i + ")"; };
        if (buffer.resource == ShaderResource::uniform_block)
            return pairs ? "uvec2(" + word("2u * " + index) + ", " + word("2u * " + index + " + 1u") + ")"
                         : word(index);
        const std::string components = pairs ? ".xy" : ".x";
        const std::string at = "int((" + index + ")", width = std::to_string(buffer.width) + "u)";
        if (buffer.resource == ShaderResource::texture_2d)
            return read_texel(name, "ivec2(" + at + " % " + width + ", " + at + " / " + width + ")") + components;
        if (buffer.resource == ShaderResource::texel_buffer && !dialect.hlsl)
            return "texelFetch(" + name + ", int(" + index + "))" + components;
        return name + "[" + index + "]";
    }

    LIGHTBIN_SMALL void declare_block(const std::string& name, ShaderSlot slot, bool push, std::uint32_t bytes,
                       const std::string& lines, const std::string& wgsl) {
        declare({name, push ? ShaderResource::push_constants : ShaderResource::uniform_block, slot,
                 TexelFormat::none, bytes, bytes},
                {.glsl = "@uniform $" + name + " {\n" + lines + "}",
                 .hlsl = "cbuffer $" + name + "@ {\n" + lines + "}",
                 .wgsl = wgsl});
    }

    /// Returns the layout, register or attribute by which a declaration says where the resource is bound.
    LIGHTBIN_SMALL std::string binding_text(const ShaderBinding& binding) const {
        const std::string number = std::to_string(binding.slot.binding),
                          set = std::to_string(binding.slot.set);
        if (dialect.webgpu) return "@group(" + set + ") @binding(" + number + ") ";
        if (dialect.hlsl)
            return std::string(" : register(") + numbering_of(binding) + number +
                   (dialect.spaces ? ", space" + set : "") + ")";
        if (binding.resource == ShaderResource::push_constants) return "layout(push_constant) ";
        const bool storage = binding.resource == ShaderResource::storage_buffer ||
                             binding.resource == ShaderResource::writable_buffer;
        std::string inside = storage ? "std430, " : "";
        if (binding.resource == ShaderResource::uniform_block) inside = "std140, ";
        if (dialect.spaces) inside += "set = " + set + ", ";
        if (dialect.storage_buffers) inside += "binding = " + number + ", ";
        return inside.empty() ? "" : "layout(" + inside.substr(0, inside.size() - 2) + ") ";
    }

    /// Returns a letter for the kind of binding that a resource has. Two resources with the same letter can't have the
    /// same number. HLSL: the register type. OpenGL: uniform blocks (b), storage buffers (s) and textures (t) are
    /// numbered apart. Vulkan and WebGPU: all resources of a set are numbered together. '-': no binding.
    char numbering_of(const ShaderBinding& binding) const {
        return (dialect.hlsl                      ? "-b-tttu"
                : dialect.vulkan || dialect.webgpu ? "-b-bbbb"
                                                   : "-b-stts")[static_cast<std::size_t>(binding.resource)];
    }

    std::string prefix_;
    ShaderText shader_;  // in GLSL until finish()
    std::vector<std::pair<std::string, std::string>> names_;  // what set() was given
    std::vector<ShaderBuffer> buffers_;
    std::vector<WgslName> members_;  // the names of the constants in WGSL
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
