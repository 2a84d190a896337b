// SPDX-License-Identifier: MIT
// Calls Microsoft's d3dcompiler_47.dll, the compiler behind the program fxc.
#pragma once

#include <lightbin/shader.hpp>

#include <d3dcompiler.h>
#include <windows.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

/// Changes a multiview text for models before 6.1, where the view is the layer of the target.
inline std::string with_layers(const std::string& text) {
    return lightbin::detail::replaced(text, "SV_ViewID", "SV_RenderTargetArrayIndex");
}

class Fxc {
public:
    Fxc() {
        const HMODULE library = LoadLibraryA("d3dcompiler_47.dll");
        if (library)
            compile_ =
                reinterpret_cast<pD3DCompile>(reinterpret_cast<void*>(GetProcAddress(library, "D3DCompile")));
        if (!compile_) {
            std::printf("d3dcompiler_47.dll cannot be loaded\n");
            std::exit(1);
        }
    }

    /// Returns the byte code. Throws std::runtime_error with what the compiler says; a warning is an error.
    std::vector<char> operator()(const std::string& text, const std::string& profile) const {
        ID3DBlob *code = nullptr, *messages = nullptr;
        compile_(text.data(), text.size(), "text", nullptr, nullptr, "main", profile.c_str(),
                 D3DCOMPILE_ENABLE_STRICTNESS | D3DCOMPILE_WARNINGS_ARE_ERRORS, 0, &code, &messages);
        const std::string said = messages ? static_cast<const char*>(messages->GetBufferPointer()) : "";
        if (messages) messages->Release();
        if (!code) throw std::runtime_error(said);
        const auto* begin = static_cast<const char*>(code->GetBufferPointer());
        std::vector<char> bytes(begin, begin + code->GetBufferSize());
        code->Release();
        return bytes;
    }

private:
    pD3DCompile compile_ = nullptr;
};
