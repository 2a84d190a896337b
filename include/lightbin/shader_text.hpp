// SPDX-License-Identifier: MIT
// Stability: settled.
// What shader_snippet(), reduce_shader() and cull_shader() return: shader text in one of eight languages, and the list
// of resources to bind for it.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

enum class ShaderLanguage : std::uint8_t {
    glsl_430,     ///< OpenGL 4.3 and later
    glsl_330,     ///< OpenGL 3.3 to 4.2
    glsl_vulkan,  ///< GLSL 450 for Vulkan
    essl_300,     ///< OpenGL ES 3.0, WebGL 2
    essl_310,     ///< OpenGL ES 3.1 and later
    hlsl_5_0,     ///< shader model 5.0: Direct3D 11
    hlsl_5_1,     ///< shader models 5.1 and 6.x: Direct3D 12, and Vulkan by way of the compiler DXC
    wgsl,         ///< WebGPU
};

constexpr const char* to_string(ShaderLanguage value) {
    return detail::name_at(value, {"glsl_430", "glsl_330", "glsl_vulkan", "essl_300", "essl_310", "hlsl_5_0",
                                   "hlsl_5_1", "wgsl"});
}

/// The kind of GPU resource that a name in the shader text stands for.
enum class ShaderResource : std::uint8_t {
    uniform_vector,   ///< OpenGL and ES: a uniform outside of any block, such as `grid` (uvec4) or `corner` (ivec2)
    uniform_block,    ///< GLSL: std140 block; HLSL: cbuffer, register b; WGSL: var<uniform>
    push_constants,   ///< Vulkan only
    storage_buffer,   ///< read-only. GLSL: std430 block; HLSL: StructuredBuffer, register t; WGSL: var<storage, read>
    texel_buffer,     ///< GLSL: buffer texture, in Vulkan a uniform texel buffer; HLSL: Buffer, register t
    texture_2d,       ///< read without a sampler. GLSL: set NEAREST, no mipmaps; WGSL: depth is "unfilterable-float"
    writable_buffer,  ///< a storage buffer that is written. HLSL: RWStructuredBuffer, register u; WGSL: read_write
};

constexpr const char* to_string(ShaderResource value) {
    return detail::name_at(value, {"uniform_vector", "uniform_block", "push_constants", "storage_buffer",
                                   "texel_buffer", "texture_2d", "writable_buffer"});
}

/// The components of a texel: one or two unsigned integers of 8, 16 or 32 bits, or one float.
enum class TexelFormat : std::uint8_t { none, r8ui, r16ui, r32ui, rg32ui, r32f };

constexpr const char* to_string(TexelFormat value) {
    return detail::name_at(value, {"none", "r8ui", "r16ui", "r32ui", "rg32ui", "r32f"});
}

/// The arguments of glTexImage2D and glTexSubImage2D. glTexBuffer and glTexStorage2D need `internal` alone.
struct GlFormat {
    std::uint32_t internal, layout, type;
};

/// Returns OpenGL's names of a format, such as GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE; for `none` zeros.
constexpr GlFormat gl_format(TexelFormat format) {
    constexpr std::uint32_t red = 0x1903, red_integer = 0x8d94, rg_integer = 0x8228;
    constexpr std::uint32_t byte = 0x1401, half_word = 0x1403, word = 0x1405, real = 0x1406;
    constexpr GlFormat names[] = {{0, 0, 0},
                                  {0x8232, red_integer, byte},
                                  {0x8234, red_integer, half_word},
                                  {0x8236, red_integer, word},
                                  {0x823c, rg_integer, word},
                                  {0x822e, red, real}};
    return names[static_cast<std::size_t>(format)];
}

/// Returns Vulkan's name of a format, such as VK_FORMAT_R8_UINT; for `none` VK_FORMAT_UNDEFINED.
constexpr std::uint32_t vk_format(TexelFormat format) {
    constexpr std::uint32_t names[] = {0, 13, 74, 98, 101, 100};
    return names[static_cast<std::size_t>(format)];
}

/// Returns Direct3D's name of a format, such as DXGI_FORMAT_R8_UINT; for `none` DXGI_FORMAT_UNKNOWN.
constexpr std::uint32_t dxgi_format(TexelFormat format) {
    constexpr std::uint32_t names[] = {0, 62, 57, 42, 17, 41};
    return names[static_cast<std::size_t>(format)];
}

/// Returns WebGPU's name of a format, a GPUTextureFormat such as "r8uint"; for `none` an empty string.
constexpr const char* webgpu_format(TexelFormat format) {
    return detail::name_at(format, {"", "r8uint", "r16uint", "r32uint", "rg32uint", "r32float"});
}

/// Returns how many rows a 2D texture with `width` texels per row needs to hold `count` texels, at least 1. The last
/// row may be partly filled.
constexpr std::size_t texture_rows(std::size_t count, std::size_t width) {
    return count == 0 ? 1 : (count - 1) / width + 1;
}

/// Where a resource is bound: binding and set in GLSL, register number and space in HLSL, binding and group in WGSL.
/// Texts for OpenGL 3.3 and ES 3.0 contain no bindings; there the program assigns samplers and blocks by name.
struct ShaderSlot {
    int binding = 0;
    int set = 0;  ///< the descriptor set, register space or bind group in Vulkan, hlsl_5_1 and wgsl; else 0
};

/// One resource that the program has to bind before it uses the shader.
struct ShaderBinding {
    std::string name = {};  ///< the name of the uniform, sampler, block or buffer in the generated shader text
    ShaderResource resource = ShaderResource::uniform_vector;
    ShaderSlot slot = {};
    TexelFormat format = TexelFormat::none;  ///< the format of texels, if any; gl_format() etc. return its API names
    std::uint32_t stride = 0;                ///< the number of bytes per array element or texel
    std::uint32_t bytes = 0;  ///< uniform blocks and push constants: the declared size; others: 0, any size will do
    std::uint32_t width = 0;  ///< texture_2d: texels per row, see texture_rows(); 0: one per column of tiles
};

/// A shader text and its bindings, in the order of their declarations.
struct ShaderText {
    std::string text;
    std::vector<ShaderBinding> bindings;
};

}}  // namespace lightbin
