// SPDX-License-Identifier: MIT
// Which kernel runs: the choice of a tier by the instruction set.
#pragma once

#include <lightbin/detail/dispatch/tiers.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The tier that every machine has that runs the program.
#if defined(LIGHTBIN_VECTORS_ONLY)
namespace least = simd128;
#else
namespace least = scalar;
#endif

/// Returns pick(Tier()), where Tier has the kernels of an instruction set, which the machine must support.
template <class Pick> auto with_tier(Isa isa, Pick pick) {
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512) return pick(avx512::Tier{});
    if (isa == Isa::avx2) return pick(avx2::Tier{});
#endif
#if defined(LIGHTBIN_HAS_SIMD128)
    if (isa == Isa::simd128) return pick(simd128::Tier{});
#endif
    static_cast<void>(isa);
    return pick(least::Tier{});
}

template <LightKind kind> ProjectKernel project_kernel(Isa isa) {
    return with_tier(isa, [](auto tier) { return tier.template project_kernel<kind>(); });
}

template <LightKind kind> DepthBucketsKernel depth_buckets_kernel(Isa isa) {
    return with_tier(isa, [](auto tier) { return tier.template depth_buckets_kernel<kind>(); });
}

/// Returns the kernel that reduces rows of `columns` samples: the scalar one, if these do not fill a vector.
inline DepthKernel depth_kernel(Isa isa, std::size_t columns) {
    return with_tier(isa, [=](auto tier) {
        const DepthKernel by_vectors = tier.depth_kernel();
        return columns < tier.vector ? scalar::Tier::depth_kernel() : by_vectors;
    });
}

}}}  // namespace lightbin::detail
