// SPDX-License-Identifier: MIT
// Texel formats of textures and buffer textures, with their names in OpenGL, Vulkan, DXGI (Direct3D) and WebGPU.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The components of a texel: one or two unsigned integers of 8, 16 or 32 bits, or one float.
enum class TexelFormat : std::uint8_t { none, r8ui, r16ui, r32ui, rg32ui, r32f };

constexpr const char* to_string(TexelFormat value) {
    return detail::name_at(value, {"none", "r8ui", "r16ui", "r32ui", "rg32ui", "r32f"});
}

/// The arguments of glTexImage2D and glTexSubImage2D. glTexBuffer and glTexStorage2D need `internal` alone.
struct GlFormat {
    std::uint32_t internal, layout, type;
};

namespace detail {

/// A texel format's size and its names in the graphics APIs.
struct TexelNames {
    std::uint32_t bytes;
    GlFormat gl;
    std::uint32_t vk, dxgi;
    const char* webgpu;
};

constexpr TexelNames texel_names(TexelFormat format) {
    constexpr std::uint32_t red = 0x1903, red_integer = 0x8d94, rg_integer = 0x8228;
    constexpr std::uint32_t byte = 0x1401, half_word = 0x1403, word = 0x1405, real = 0x1406;
    constexpr TexelNames names[] = {{0, {0, 0, 0}, 0, 0, ""},
                                    {1, {0x8232, red_integer, byte}, 13, 62, "r8uint"},
                                    {2, {0x8234, red_integer, half_word}, 74, 57, "r16uint"},
                                    {4, {0x8236, red_integer, word}, 98, 42, "r32uint"},
                                    {8, {0x823c, rg_integer, word}, 101, 17, "rg32uint"},
                                    {4, {0x822e, red, real}, 100, 41, "r32float"}};
    return names[static_cast<std::size_t>(format)];
}

}  // namespace detail

/// Returns GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE and so on; for `none` zeros.
constexpr GlFormat gl_format(TexelFormat format) {
    return detail::texel_names(format).gl;
}

/// Returns VK_FORMAT_R8_UINT and so on; for `none` VK_FORMAT_UNDEFINED.
constexpr std::uint32_t vk_format(TexelFormat format) {
    return detail::texel_names(format).vk;
}

/// Returns DXGI_FORMAT_R8_UINT and so on; for `none` DXGI_FORMAT_UNKNOWN.
constexpr std::uint32_t dxgi_format(TexelFormat format) {
    return detail::texel_names(format).dxgi;
}

/// Returns a GPUTextureFormat, "r8uint" and so on; for `none` an empty string.
constexpr const char* webgpu_format(TexelFormat format) {
    return detail::texel_names(format).webgpu;
}

/// Returns how many rows a 2D texture with `width` texels per row needs to hold `count` texels, at least 1. The last
/// row may be partly filled.
constexpr std::size_t texture_rows(std::size_t count, std::size_t width) {
    return count == 0 ? 1 : (count - 1) / width + 1;
}

}}  // namespace lightbin
