// SPDX-License-Identifier: MIT
// Stage 4: the shader text that reads a light grid. Needs nothing but the view.
#pragma once

#include <lightbin/light_grid.hpp>
#include <lightbin/view.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lightbin {

/// Dialect of the snippet and where it reads the lists.
enum class ShaderLanguage : std::uint8_t {
    glsl_330,  ///< buffer textures: grid.tiles() as GL_RG32UI, grid.indices() as GL_R32UI (u16: GL_R16UI)
    glsl_430,  ///< shader storage buffers; u16 ids are read in pairs, so the buffer's size must be a multiple
               ///< of 4 bytes
};

struct ShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    Index index = Index::u32;                        ///< as the Binner's
    WindowOrigin origin = WindowOrigin::lower_left;  ///< as the view's
    std::string_view prefix = "lightbin_";           ///< of every name declared
    int tiles_binding = 0;                           ///< storage buffer bindings (glsl_430)
    int indices_binding = 1;
};

/// Returns GLSL declarations to insert after `#version` and before their use; `lightbin_` stands for
/// options.prefix.
///
///     uniform uvec4 lightbin_grid;               // shader_grid(view)
///     uvec2 lightbin_list(vec2 position);        // offset and count of the list for a window position
///     uint  lightbin_light(uint i);              // the id at place i of the light index list
///
/// `position` is gl_FragCoord.xy less the viewport's corner. glsl_330 also declares the samplers
/// lightbin_tiles and lightbin_indices. Use:
///
///     uvec2 list = lightbin_list(gl_FragCoord.xy);
///     for (uint i = 0u; i < list.y; ++i) { uint id = lightbin_light(list.x + i); ... }
///
/// Source: Tiled Shading, Listing 1.
inline std::string shader_snippet(const ShaderOptions& options = {}) {
    const bool storage = options.language == ShaderLanguage::glsl_430;
    const std::string prefix(options.prefix);
    const auto name = [&](const char* suffix) { return prefix + suffix; };
    const auto storage_buffer = [&](int binding, const char* suffix, const char* type) {
        return "layout(std430, binding = " + std::to_string(binding) + ") readonly buffer " + name(suffix) +
               "_buffer {\n    " + type + " " + name(suffix) + "[];\n};\n";
    };

    std::string text =
        "uniform uvec4 " + name("grid") + "; // tile size, tiles across, viewport width and height\n";
    if (storage) {
        text += storage_buffer(options.tiles_binding, "tiles", "uvec2");
        text += storage_buffer(options.indices_binding, "indices", "uint");
    } else {
        text += "uniform usamplerBuffer " + name("tiles") + ";\n";
        text += "uniform usamplerBuffer " + name("indices") + ";\n";
    }

    text += "\nuvec2 " + name("list") + "(vec2 position) {\n    uvec2 pixel = uvec2(position);\n";
    if (options.origin == WindowOrigin::upper_left)
        text += "    pixel.y = " + name("grid") + ".w - 1u - pixel.y;\n";
    text += "    uvec2 tile = pixel / " + name("grid") + ".x;\n    uint index = tile.y * " + name("grid") +
            ".y + tile.x;\n";
    text += storage ? "    return " + name("tiles") + "[index];\n}\n"
                    : "    return texelFetch(" + name("tiles") + ", int(index)).xy;\n}\n";

    text += "\nuint " + name("light") + "(uint i) {\n";
    if (!storage)
        text += "    return texelFetch(" + name("indices") + ", int(i)).x;\n}\n";
    else if (options.index == Index::u16)
        text += "    return (" + name("indices") + "[i >> 1u] >> ((i & 1u) * 16u)) & 0xffffu;\n}\n";
    else
        text += "    return " + name("indices") + "[i];\n}\n";
    return text;
}

/// Returns the value of the snippet's uniform `grid`: tile size, tiles across, viewport width and height.
inline std::array<std::uint32_t, 4> shader_grid(const View& view) {
    return {static_cast<std::uint32_t>(view.tile_size()), static_cast<std::uint32_t>(view.tiles_x()),
            static_cast<std::uint32_t>(view.viewport().width),
            static_cast<std::uint32_t>(view.viewport().height)};
}

}  // namespace lightbin
