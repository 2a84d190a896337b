// SPDX-License-Identifier: MIT
// Compiles the kernels once for each tier, that is, for each instruction set, in the tier's namespace.
#pragma once

#include <lightbin/detail/base/warnings_off.inl>

#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/detail/engine/scatter.hpp>
#include <lightbin/detail/vectors/avx2.hpp>
#include <lightbin/detail/vectors/avx512.hpp>
#include <lightbin/detail/vectors/scalar.hpp>
#include <lightbin/detail/vectors/simd128.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

// The types of the kernels, which are alike in all tiers.
using ProjectKernel = void (*)(const Camera& camera, const LightSource& source, std::uint32_t first,
                               std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts);
using DepthBucketsKernel = void (*)(const DepthBuckets& to, float z_sign, const FootprintArrays& lights,
                                   const std::uint32_t* ids, std::uint32_t count, LightDepths& out);
using DepthKernel = void (*)(const DepthRows& depth, float skipped, float* lower, float* upper);
template <class Id>
using BinKernel = std::uint64_t (*)(const BinJob& job, Scratch& scratch, const BinShare<Id>& share);

}}}  // namespace lightbin::detail

#define LIGHTBIN_KERNELS

#define LIGHTBIN_TIER scalar
#include <lightbin/detail/dispatch/kernels.inl>

#include <lightbin/detail/project/spheres_in_double.inl>

#if defined(LIGHTBIN_HAS_SIMD128)
LIGHTBIN_SIMD128_BEGIN
#define LIGHTBIN_TIER simd128
#include <lightbin/detail/dispatch/kernels.inl>
LIGHTBIN_SIMD128_END
#endif

#if defined(LIGHTBIN_X86)
LIGHTBIN_AVX2_BEGIN
#define LIGHTBIN_TIER avx2
#include <lightbin/detail/dispatch/kernels.inl>
LIGHTBIN_AVX2_END

LIGHTBIN_AVX512_BEGIN
#define LIGHTBIN_TIER avx512
#include <lightbin/detail/dispatch/kernels.inl>
LIGHTBIN_AVX512_END
#endif

#undef LIGHTBIN_KERNELS

#include <lightbin/detail/base/warnings_on.inl>
