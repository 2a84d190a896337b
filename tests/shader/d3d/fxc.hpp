// SPDX-License-Identifier: MIT
// Microsoft's d3dcompiler_47.dll, which fxc is a shell of.
#pragma once

#include <d3dcompiler.h>
#include <windows.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

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

    /// Returns the byte code, or nothing with the reason in `error`; a warning is an error.
    std::vector<char> operator()(const std::string& text, const char* profile, std::string& error) const {
        ID3DBlob *code = nullptr, *messages = nullptr;
        const HRESULT result =
            compile_(text.data(), text.size(), "text", nullptr, nullptr, "main", profile,
                     D3DCOMPILE_ENABLE_STRICTNESS | D3DCOMPILE_WARNINGS_ARE_ERRORS, 0, &code, &messages);
        error = messages ? static_cast<const char*>(messages->GetBufferPointer()) : "";
        std::vector<char> bytes;
        if (SUCCEEDED(result)) {
            const auto* begin = static_cast<const char*>(code->GetBufferPointer());
            bytes.assign(begin, begin + code->GetBufferSize());
        }
        if (code) code->Release();
        if (messages) messages->Release();
        return bytes;
    }

private:
    pD3DCompile compile_ = nullptr;
};
