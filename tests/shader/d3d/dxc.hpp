// SPDX-License-Identifier: MIT
// Microsoft's dxcompiler.dll. Its interfaces as far as they are called, as MinGW lacks dxcapi.h.
#pragma once

#include <unknwn.h>
#include <windows.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

class Dxc {
public:
    Dxc() {
        constexpr CLSID compiler_class = {
            0x73e22d93, 0xe6ce, 0x47f3, {0xb5, 0xbf, 0xf0, 0x66, 0x4f, 0x39, 0xc1, 0xb0}};
        constexpr IID compiler_interface = {
            0x228b4687, 0x5a6a, 0x4730, {0x90, 0x0c, 0x97, 0x02, 0xb2, 0x20, 0x3f, 0x54}};
        using Create = HRESULT(WINAPI*)(REFCLSID, REFIID, void**);
        Create create = nullptr;
        if (const HMODULE library = LoadLibraryA("dxcompiler.dll"))
            create = reinterpret_cast<Create>(
                reinterpret_cast<void*>(GetProcAddress(library, "DxcCreateInstance")));
        void* made = nullptr;
        if (!create || FAILED(create(compiler_class, compiler_interface, &made))) {
            std::printf("dxcompiler.dll cannot be loaded\n");
            std::exit(1);
        }
        compiler_ = static_cast<Compiler*>(made);
    }

    /// Compiles, and throws std::runtime_error with what the compiler says; a warning is an error.
    void operator()(const std::string& text, const std::string& profile) const {
        const std::wstring target(profile.begin(), profile.end());
        const Text source = {text.data(), text.size(), 65001};  // UTF-8
        const wchar_t* arguments[] = {L"-T", target.c_str(), L"-E", L"main", L"-WX"};
        void* made = nullptr;
        HRESULT status = compiler_->compile(&source, arguments, 5, nullptr, result_interface, &made);
        if (FAILED(status)) throw std::runtime_error("the compiler itself failed");
        auto* const result = static_cast<Result*>(made);
        result->status(&status);
        std::string said;
        Blob* messages = nullptr;
        if (SUCCEEDED(result->messages(&messages)) && messages) {
            said.assign(static_cast<const char*>(messages->data()), messages->size());
            messages->Release();
        }
        result->Release();
        if (FAILED(status)) throw std::runtime_error(said);
    }

private:
    static constexpr IID result_interface = {
        0xcedb484a, 0xd4e9, 0x445a, {0xb9, 0x91, 0xca, 0x21, 0xca, 0x15, 0x7d, 0xc2}};

    struct Text {
        const void* data;
        SIZE_T size;
        UINT code_page;
    };
    struct Blob : IUnknown {
        virtual void* WINAPI data() = 0;
        virtual SIZE_T WINAPI size() = 0;
    };
    struct Result : IUnknown {
        virtual HRESULT WINAPI status(HRESULT*) = 0;
        virtual HRESULT WINAPI code(Blob**) = 0;
        virtual HRESULT WINAPI messages(Blob**) = 0;
    };
    struct Compiler : IUnknown {
        virtual HRESULT WINAPI compile(const Text*, const wchar_t**, UINT32, IUnknown*, REFIID, void**) = 0;
    };

    Compiler* compiler_ = nullptr;
};
