// SPDX-License-Identifier: MIT
// The words that no name of a shader may be: keywords and reserved words of GLSL 4.60, GLSL ES 3.20, Vulkan's GLSL, HLSL
// and WGSL. Those that end with a digit (vec2, float4x4, image2D and their like) are left out, as no name of the library's
// texts ends with one.
#pragma once

#include <string_view>

/// A space before and after each.
inline constexpr std::string_view reserved_words =
    " abstract active alias alignas alignof AppendStructuredBuffer as asm asm_fragment async "
    "atomic_uint attribute auto await become binding_array BlendState bool break Buffer buffer "
    "ByteAddressBuffer case cast catch cbuffer centroid char class co_await co_return co_yield "
    "coherent column_major common compile compile_fragment CompileShader ComputeShader concept const "
    "const_assert const_cast consteval constexpr constinit ConsumeStructuredBuffer continue continuing "
    "crate debugger decl decltype default delete demote demote_to_helper DepthStencilState "
    "DepthStencilView diagnostic discard do DomainShader double dword dynamic_cast else enable enum "
    "explicit export extends extern external fallthrough false filter final finally fixed flat float "
    "fn for friend from fxgroup GeometryShader get goto groupshared half handle highp Hullshader if "
    "iimage1D iimage1DArray iimage2D iimage2DArray iimage2DMS iimage2DMSArray iimage2DRect iimage3D "
    "iimageBuffer iimageCube iimageCubeArray image1D image1DArray image2D image2DArray image2DMS "
    "image2DMSArray image2DRect image3D imageBuffer imageCube imageCubeArray impl implements import in "
    "inline inout input InputPatch instanceof int interface invariant isampler1D isampler1DArray "
    "isampler2D isampler2DArray isampler2DMS isampler2DMSArray isampler2DRect isampler3D "
    "isamplerBuffer isamplerCube isamplerCubeArray isubpassInput isubpassInputMS itexture1D "
    "itexture1DArray itexture2D itexture2DArray itexture2DMS itexture2DMSArray itexture2DRect "
    "itexture3D itextureBuffer itextureCube itextureCubeArray layout let line lineadj linear "
    "LineStream long loop lowp macro macro_rules match matrix mediump meta min10float min12int "
    "min16float min16int min16uint mod module move mut mutable namespace new nil noexcept noinline "
    "nointerpolation non_coherent noncoherent noperspective NULL null nullptr of operator out output "
    "OutputPatch override package packoffset partial partition pass patch pixelfragment PixelShader "
    "point PointStream precise precision premerge priv private protected pub public RasterizerState "
    "readonly ref regardless register reinterpret_cast RenderTargetView require requires resource "
    "restrict return row_major RWBuffer RWByteAddressBuffer RWStructuredBuffer RWTexture1D "
    "RWTexture1DArray RWTexture2D RWTexture2DArray RWTexture3D sample sampler sampler1D sampler1DArray "
    "sampler1DArrayShadow sampler1DShadow sampler2D sampler2DArray sampler2DArrayShadow sampler2DMS "
    "sampler2DMSArray sampler2DRect sampler2DRectShadow sampler2DShadow sampler3D sampler3DRect "
    "sampler_state samplerBuffer SamplerComparisonState samplerCUBE samplerCube samplerCubeArray "
    "samplerCubeArrayShadow samplerCubeShadow samplerExternalOES samplerShadow SamplerState Self self "
    "set shared short signed sizeof smooth snorm stateblock stateblock_state static static_assert "
    "static_cast std string struct StructuredBuffer subpassInput subpassInputMS subroutine super "
    "superp switch target tbuffer technique template texture Texture1D texture1D Texture1DArray "
    "texture1DArray Texture2D texture2D Texture2DArray texture2DArray Texture2DMS texture2DMS "
    "Texture2DMSArray texture2DMSArray texture2DRect Texture3D texture3D textureBuffer TextureCube "
    "textureCUBE textureCube TextureCubeArray textureCubeArray this thread_local throw trait triangle "
    "triangleadj TriangleStream true try type typedef typeid typename typeof uimage1D uimage1DArray "
    "uimage2D uimage2DArray uimage2DMS uimage2DMSArray uimage2DRect uimage3D uimageBuffer uimageCube "
    "uimageCubeArray uint uniform union unless unorm unsafe unsigned unsized usampler1D "
    "usampler1DArray usampler2D usampler2DArray usampler2DMS usampler2DMSArray usampler2DRect "
    "usampler3D usamplerBuffer usamplerCube usamplerCubeArray use using usubpassInput usubpassInputMS "
    "utexture1D utexture1DArray utexture2D utexture2DArray utexture2DMS utexture2DMSArray "
    "utexture2DRect utexture3D utextureBuffer utextureCube utextureCubeArray var varying vector "
    "vertexfragment VertexShader virtual void volatile wgsl where while with writeonly yield ";
