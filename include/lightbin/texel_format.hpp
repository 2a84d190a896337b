// SPDX-License-Identifier: MIT
// The texels of textures and buffer textures, by the numbers that OpenGL, Vulkan and DXGI have for them, and by WebGPU's
// names.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Texel of a texture or buffer texture: one or two unsigned integers of 8, 16 or 32 bits, or a float.
enum class TexelFormat : std::uint8_t { none, r8ui, r16ui, r32ui, rg32ui, r32f };

constexpr const char* to_string(TexelFormat value) {
    return detail::name_at(value, {"none", "r8ui", "r16ui", "r32ui", "rg32ui", "r32f"});
}

/// What glTexImage2D and glTexSubImage2D take; glTexBuffer and glTexStorage2D: internal.
struct GlFormat {
    std::uint32_t internal, layout, type;
};

/// GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE and so on; `none` is 0 in all.
constexpr GlFormat gl_format(TexelFormat format) {
    constexpr std::uint32_t red = 0x1903, red_integer = 0x8d94, rg_integer = 0x8228;
    constexpr std::uint32_t byte = 0x1401, half_word = 0x1403, word = 0x1405, real = 0x1406;
    constexpr GlFormat formats[] = {{0, 0, 0},
                                    {0x8232, red_integer, byte},
                                    {0x8234, red_integer, half_word},
                                    {0x8236, red_integer, word},
                                    {0x823c, rg_integer, word},
                                    {0x822e, red, real}};
    return formats[static_cast<std::size_t>(format)];
}

/// VK_FORMAT_R8_UINT and so on; `none` is VK_FORMAT_UNDEFINED.
constexpr std::uint32_t vk_format(TexelFormat format) {
    constexpr std::uint32_t formats[] = {0, 13, 74, 98, 101, 100};
    return formats[static_cast<std::size_t>(format)];
}

/// DXGI_FORMAT_R8_UINT and so on; `none` is DXGI_FORMAT_UNKNOWN.
constexpr std::uint32_t dxgi_format(TexelFormat format) {
    constexpr std::uint32_t formats[] = {0, 62, 57, 42, 17, 41};
    return formats[static_cast<std::size_t>(format)];
}

/// A GPUTextureFormat: "r8uint" and so on; `none` is empty.
constexpr const char* webgpu_format(TexelFormat format) {
    constexpr const char* formats[] = {"", "r8uint", "r16uint", "r32uint", "rg32uint", "r32float"};
    return formats[static_cast<std::size_t>(format)];
}

namespace detail {
constexpr std::uint32_t texel_bytes(TexelFormat format) {
    constexpr std::uint32_t bytes[] = {0, 1, 2, 4, 8, 4};
    return bytes[static_cast<std::size_t>(format)];
}
}  // namespace detail

/// Returns how many rows a 2D texture of `width` texels a row has where it holds `count`: at least 1. The last one may
/// be partly filled.
constexpr std::size_t texture_rows(std::size_t count, std::size_t width) {
    return count == 0 ? 1 : (count - 1) / width + 1;
}

}}  // namespace lightbin
