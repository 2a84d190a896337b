// SPDX-License-Identifier: MIT
// GLSL and HLSL to SPIR-V by glslang, in this process.
#pragma once

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

/// Whether a text needs Vulkan 1.1: wave loops and multiview do.
inline bool needs_vulkan_1_1(const std::string& text) {
    const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
    return has("subgroupMin") || has("WaveActiveMin") || has("GL_EXT_multiview");
}

/// Returns SPIR-V for Vulkan 1.0, or 1.1 where the text needs it, or throws std::runtime_error with what glslang says.
inline std::vector<std::uint32_t> compile_spirv(const std::string& text, EShLanguage stage, bool hlsl) {
    static const bool ready = glslang::InitializeProcess();
    const auto language = hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl;
    glslang::TShader shader(stage);
    const char* begin = text.c_str();
    shader.setStrings(&begin, 1);
    shader.setEntryPoint("main");
    shader.setEnvInput(language, stage, glslang::EShClientVulkan, 100);
    const bool newer = needs_vulkan_1_1(text);
    shader.setEnvClient(glslang::EShClientVulkan,
                        newer ? glslang::EShTargetVulkan_1_1 : glslang::EShTargetVulkan_1_0);
    shader.setEnvTarget(glslang::EShTargetSpv, newer ? glslang::EShTargetSpv_1_3 : glslang::EShTargetSpv_1_0);
    auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    if (hlsl) rules = static_cast<EShMessages>(rules | EShMsgReadHlsl);
    glslang::TProgram program;
    program.addShader(&shader);
    std::vector<std::uint32_t> spirv;
    if (ready && shader.parse(GetDefaultResources(), 100, false, rules) && program.link(rules))
        glslang::GlslangToSpv(*program.getIntermediate(stage), spirv);
    if (spirv.empty()) throw std::runtime_error(std::string(shader.getInfoLog()) + program.getInfoLog());
    return spirv;
}
