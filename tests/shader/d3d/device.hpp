// SPDX-License-Identifier: MIT
// A Direct3D 11 device that runs one shader at a time.
#pragma once

#include "../job.hpp"
#include "fxc.hpp"

#include <d3d11.h>
#include <wrl/client.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

inline void check(HRESULT result, const char* what) {
    if (SUCCEEDED(result)) return;
    std::printf("%s: HRESULT %08lx\n", what, static_cast<unsigned long>(result));
    std::exit(1);
}

using Microsoft::WRL::ComPtr;

class D3d11Device {
public:
    D3d11Device() {
        const D3D_FEATURE_LEVEL level = D3D_FEATURE_LEVEL_11_0;
        check(D3D11CreateDevice(nullptr, D3D_DRIVER_TYPE_HARDWARE, nullptr, 0, &level, 1, D3D11_SDK_VERSION,
                                &device_, nullptr, &context_),
              "a Direct3D 11 device of feature level 11_0");
        // The triangle is clockwise, otherwise it would be culled; with several views an instance draws to each layer.
        vertex_ = fxc_(R"(
struct Corner {
    float4 position : SV_Position;
    uint layer : SV_RenderTargetArrayIndex;
};
Corner main(uint index : SV_VertexID, uint view : SV_InstanceID) {
    Corner corner = {float4(float2(index >> 1, index & 1) * 4.0 - 1.0, 0.0, 1.0), view};
    return corner;
}
)",
                       "vs_5_0");
    }

    /// Returns what the job's shader wrote: the words of its result buffer, or four words a pixel of its
    /// picture. Throws std::runtime_error where fxc refuses the text.
    std::vector<std::uint32_t> run(const Job& job) {
        const std::vector<char>& code = code_of(job);
        context_->ClearState();
        std::vector<ComPtr<ID3D11Buffer>> buffers(job.inputs.size());
        for (std::size_t i = 0; i < job.inputs.size(); ++i)
            bind(job.inputs[i], buffers[i]);
        if (job.stage == Stage::fragment) return draw(job, code);
        ComPtr<ID3D11ComputeShader> shader;
        check(device_->CreateComputeShader(code.data(), code.size(), nullptr, &shader), "compute shader");
        context_->CSSetShader(shader.Get(), nullptr, 0);
        context_->Dispatch(job.groups[0], job.groups[1], 1);
        return read(buffers[job.result].Get(), job.inputs[job.result].bytes.size());
    }

private:
    // Compiles each text once, however often it runs, because fxc takes longer than most runs.
    const std::vector<char>& code_of(const Job& job) {
        const bool compute = job.stage == Stage::compute;
        const std::string text = job.views > 1 ? with_layers(job.text) : job.text;
        std::vector<char>& code = (compute ? compute_codes_ : pixel_codes_)[text];
        if (code.empty()) code = fxc_(text, compute ? "cs_5_0" : "ps_5_0");
        return code;
    }

    void bind(const Input& input, ComPtr<ID3D11Buffer>& buffer) {
        using lightbin::ShaderResource;
        const auto slot = static_cast<UINT>(input.binding.slot.binding);
        if (input.binding.resource == ShaderResource::texture_2d) {
            bind_texture(input, slot);
            return;
        }
        const bool structured = input.binding.resource == ShaderResource::writable_buffer ||
                                input.binding.resource == ShaderResource::storage_buffer;
        // Direct3D wants buffers of whole elements, and constants of whole vectors.
        const std::size_t unit = structured ? input.binding.stride
                                 : input.binding.resource == ShaderResource::uniform_block ? 16
                                                                                           : 1;
        std::vector<std::byte> content = input.bytes;
        content.resize((content.size() + unit - 1) / unit * unit, std::byte{0xee});
        const auto bytes = static_cast<UINT>(content.size());
        const D3D11_SUBRESOURCE_DATA data{content.data(), 0, 0};
        D3D11_BUFFER_DESC info{};
        info.ByteWidth = bytes;
        D3D11_SHADER_RESOURCE_VIEW_DESC view{};
        view.ViewDimension = D3D11_SRV_DIMENSION_BUFFEREX;
        switch (input.binding.resource) {
        case ShaderResource::uniform_block:
            info.BindFlags = D3D11_BIND_CONSTANT_BUFFER;
            break;
        case ShaderResource::writable_buffer:
            info.BindFlags = D3D11_BIND_UNORDERED_ACCESS;
            break;
        case ShaderResource::storage_buffer:
            info.BindFlags = D3D11_BIND_SHADER_RESOURCE;
            break;
        default:  // texel_buffer
            info.BindFlags = D3D11_BIND_SHADER_RESOURCE;
            view.Format = static_cast<DXGI_FORMAT>(lightbin::dxgi_format(input.binding.format));
            view.ViewDimension = D3D11_SRV_DIMENSION_BUFFER;
            view.Buffer.NumElements = bytes / input.binding.stride;
        }
        if (structured) {
            info.MiscFlags = D3D11_RESOURCE_MISC_BUFFER_STRUCTURED;
            info.StructureByteStride = input.binding.stride;
            view.BufferEx.NumElements = bytes / input.binding.stride;
        }
        check(device_->CreateBuffer(&info, &data, &buffer), "buffer");
        if (info.BindFlags == D3D11_BIND_CONSTANT_BUFFER) {
            ID3D11Buffer* constants = buffer.Get();
            context_->CSSetConstantBuffers(slot, 1, &constants);
            context_->PSSetConstantBuffers(slot, 1, &constants);
        } else if (info.BindFlags == D3D11_BIND_UNORDERED_ACCESS) {
            ComPtr<ID3D11UnorderedAccessView> writable;
            check(device_->CreateUnorderedAccessView(buffer.Get(), nullptr, &writable), "writable view");
            ID3D11UnorderedAccessView* target = writable.Get();
            context_->CSSetUnorderedAccessViews(slot, 1, &target, nullptr);
        } else {
            set_view(buffer.Get(), &view, slot);
        }
    }

    void bind_texture(const Input& input, UINT slot) {
        D3D11_TEXTURE2D_DESC info{};
        info.Width = input.width;
        info.Height = input.height;
        info.MipLevels = info.ArraySize = info.SampleDesc.Count = 1;
        info.Format = static_cast<DXGI_FORMAT>(lightbin::dxgi_format(input.binding.format));
        info.BindFlags = D3D11_BIND_SHADER_RESOURCE;
        const D3D11_SUBRESOURCE_DATA data{input.bytes.data(), input.width * input.binding.stride, 0};
        ComPtr<ID3D11Texture2D> texture;
        check(device_->CreateTexture2D(&info, &data, &texture), "texture");
        set_view(texture.Get(), nullptr, slot);
    }

    void set_view(ID3D11Resource* resource, const D3D11_SHADER_RESOURCE_VIEW_DESC* info, UINT slot) {
        ComPtr<ID3D11ShaderResourceView> view;
        check(device_->CreateShaderResourceView(resource, info, &view), "view");
        ID3D11ShaderResourceView* bound = view.Get();
        context_->CSSetShaderResources(slot, 1, &bound);
        context_->PSSetShaderResources(slot, 1, &bound);
    }

    std::vector<std::uint32_t> read(ID3D11Buffer* buffer, std::size_t bytes) {
        D3D11_BUFFER_DESC info{};
        buffer->GetDesc(&info);
        info.BindFlags = info.MiscFlags = info.StructureByteStride = 0;
        info.Usage = D3D11_USAGE_STAGING;
        info.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
        ComPtr<ID3D11Buffer> copy;
        check(device_->CreateBuffer(&info, nullptr, &copy), "staging buffer");
        context_->CopyResource(copy.Get(), buffer);
        D3D11_MAPPED_SUBRESOURCE mapped;
        check(context_->Map(copy.Get(), 0, D3D11_MAP_READ, 0, &mapped), "map");
        std::vector<std::uint32_t> words(bytes / 4);
        std::memcpy(words.data(), mapped.pData, bytes);
        context_->Unmap(copy.Get(), 0);
        return words;
    }

    // A triangle over the viewport, which lies at job.corner in a picture that is as much larger; with several views,
    // one in each layer of the picture.
    std::vector<std::uint32_t> draw(const Job& job, const std::vector<char>& code) {
        D3D11_TEXTURE2D_DESC info{};
        info.Width = job.width + job.corner[0];
        info.Height = job.height + job.corner[1];
        info.MipLevels = info.SampleDesc.Count = 1;
        info.ArraySize = job.views;
        info.Format = job.within.empty() ? DXGI_FORMAT_R32G32B32A32_UINT : DXGI_FORMAT_R32G32_FLOAT;
        const std::size_t pixel_bytes = job.within.empty() ? 16 : 8, row_bytes = pixel_bytes * job.width;
        info.BindFlags = D3D11_BIND_RENDER_TARGET;
        ComPtr<ID3D11Texture2D> picture, copy;
        check(device_->CreateTexture2D(&info, nullptr, &picture), "picture");
        ComPtr<ID3D11RenderTargetView> view;
        check(device_->CreateRenderTargetView(picture.Get(), nullptr, &view), "render target");
        ID3D11RenderTargetView* target = view.Get();
        context_->OMSetRenderTargets(1, &target, nullptr);
        ComPtr<ID3D11VertexShader> vertex;
        check(device_->CreateVertexShader(vertex_.data(), vertex_.size(), nullptr, &vertex), "vertex shader");
        ComPtr<ID3D11PixelShader> pixel;
        check(device_->CreatePixelShader(code.data(), code.size(), nullptr, &pixel), "pixel shader");
        context_->VSSetShader(vertex.Get(), nullptr, 0);
        context_->PSSetShader(pixel.Get(), nullptr, 0);
        context_->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
        const D3D11_VIEWPORT viewport{static_cast<float>(job.corner[0]),
                                      static_cast<float>(job.corner[1]),
                                      static_cast<float>(job.width),
                                      static_cast<float>(job.height),
                                      0,
                                      1};
        context_->RSSetViewports(1, &viewport);
        context_->DrawInstanced(3, job.views, 0, 0);

        info.BindFlags = 0;
        info.Usage = D3D11_USAGE_STAGING;
        info.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
        check(device_->CreateTexture2D(&info, nullptr, &copy), "staging picture");
        context_->CopyResource(copy.Get(), picture.Get());
        std::vector<std::uint32_t> words(row_bytes / 4 * job.height * job.views);
        for (UINT layer = 0; layer < job.views; ++layer) {
            D3D11_MAPPED_SUBRESOURCE mapped;
            check(context_->Map(copy.Get(), layer, D3D11_MAP_READ, 0, &mapped), "map");
            for (std::size_t y = 0; y < job.height; ++y)
                std::memcpy(words.data() + row_bytes / 4 * (layer * job.height + y),
                            static_cast<const char*>(mapped.pData) + (y + job.corner[1]) * mapped.RowPitch +
                                pixel_bytes * job.corner[0],
                            row_bytes);
            context_->Unmap(copy.Get(), layer);
        }
        return words;
    }

    Fxc fxc_;
    std::map<std::string, std::vector<char>> compute_codes_, pixel_codes_;
    std::vector<char> vertex_;
    ComPtr<ID3D11Device> device_;
    ComPtr<ID3D11DeviceContext> context_;
};
