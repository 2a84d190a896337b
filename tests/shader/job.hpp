// SPDX-License-Identifier: MIT
// A shader to run, what it reads and what it must write. OpenGL, Vulkan and Direct3D each have a runner.
#pragma once

#include <lightbin/shader_text.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

enum class Stage : std::uint8_t { compute, fragment };

struct Input {
    lightbin::ShaderBinding binding;
    std::vector<std::byte> bytes;
    std::uint32_t width = 0, height = 0;  // texture_2d
    std::uint32_t samples = 1;            // texture_2d, those of a pixel side by side
};

struct FloatRange {
    float low, high;
};

struct Job {
    std::string name;
    std::string text;
    bool hlsl = false;
    Stage stage = Stage::compute;
    std::vector<Input> inputs;
    std::size_t result = 0;                        // compute: the input that the shader writes
    std::array<std::uint32_t, 2> groups = {1, 1};  // compute
    std::uint32_t width = 0, height = 0;           // fragment: of the viewport
    std::array<std::uint32_t, 2> corner = {0, 0};  // fragment: where in the picture the viewport begins
    std::uint32_t views = 1;  // fragment: drawn by multiview, if more than 1; each is a layer of the picture
    std::vector<std::uint32_t>
        expected;  // fragment: 4 words a pixel, rows as the shader counts them, view by view
    std::vector<FloatRange> within;  // where not empty: the words are floats in these ranges

    bool accepts(const std::vector<std::uint32_t>& words) const {
        if (within.empty()) return words == expected;
        bool all = words.size() == within.size();
        for (std::size_t i = 0; all && i < words.size(); ++i) {
            const float value = std::bit_cast<float>(words[i]);
            all = value >= within[i].low && value <= within[i].high;
        }
        return all;
    }
};

/// A share of the work: every count-th job from `first` on, given by the last two numbers of the command line.
struct Share {
    std::size_t first = 0, count = 1;
};

inline Share share_of(int count, char** arguments) {
    return count < 3 ? Share{} : Share{std::stoul(arguments[count - 2]), std::stoul(arguments[count - 1])};
}

/// Prefixes of names that texts use in turn: ordinary ones, and some that are almost reserved words or make one with a
/// name.
inline constexpr std::string_view prefixes[] = {"lightbin_", "my_", "vol", "volat", "Vola", "vola_",
                                                "ext",       "gl",  "GL",  "Gl_",   "x9",   "a_"};

/// What comes before a text.
inline std::string version_line(lightbin::ShaderLanguage language) {
    constexpr const char* lines[] = {"#version 430 core\n",
                                     "#version 330 core\n",
                                     "#version 450\n",
                                     "#version 300 es\n",
                                     "#version 310 es\n",
                                     "",
                                     "",
                                     ""};
    return lines[static_cast<int>(language)];
}

inline lightbin::ShaderLanguage glsl_language(int glsl) {
    using lightbin::ShaderLanguage;
    return glsl == 330   ? ShaderLanguage::glsl_330
           : glsl == 300 ? ShaderLanguage::essl_300
           : glsl == 310 ? ShaderLanguage::essl_310
                         : ShaderLanguage::glsl_430;
}
