// SPDX-License-Identifier: MIT
// Which kernel runs: the choice of a tier by the instruction set, and of a binning method by the number of tiles.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/engine/costs.hpp>
#include <lightbin/detail/engine/scatter.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/detail/project/spheres_in_double.hpp>
#include <lightbin/detail/tiers/avx2.hpp>
#include <lightbin/detail/tiers/avx512.hpp>
#include <lightbin/detail/tiers/scalar.hpp>
#include <lightbin/detail/tiers/simd128.hpp>
#include <lightbin/isa.hpp>

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

/// Returns the kernel that reduces rows of `columns` samples: the widest, up to `isa`, whose vectors a row can fill.
inline DepthKernel depth_kernel(Isa isa, std::size_t columns) {
    if (isa == Isa::scalar) return scalar::Tier::depth_kernel();
    if (with_tier(isa, [=](auto tier) { return columns >= tier.vector; }))
        return with_tier(isa, [](auto tier) { return tier.depth_kernel(); });
    return depth_kernel(static_cast<Isa>(static_cast<int>(isa) - 1), columns);
}

/// Returns the fastest binning kernel for lights whose rectangles have `area` tiles in all. Kernels without a depth test
/// read footprints only, so all kinds of lights share those of spheres.
template <class Id, Tested tested, LightKind kind>
BinKernel<Id> bin_kernel(Isa isa, const View& view, std::uint64_t area) {
    if constexpr (tested == Tested::nothing)
        if (scatter_is_faster(isa, view.tile_count(), area)) return scatter_lights<Id>;
    return with_tier(isa, [](auto tier) { return tier.template bin_kernel<Id, tested, kind>(); });
}

/// The binning kernels for a set of options and a kind of lights.
template <class Id> struct ListKernels {
    /// Returns the kernel for one slice: the fastest for lights whose rectangles have `area` tiles in all.
    BinKernel<Id> (*choose)(Isa isa, const View& view, std::uint64_t area);
    /// Returns how many entries the lists of one slice have. Null without a depth test.
    std::uint64_t (*count)(const BinJob& slice, Scratch& scratch);
};

/// Returns the kernels for lights of the kind `kind`. With clusters and a depth test, spheres and spots are tested
/// against boxes of equal depths, see SlabCells: a build takes 1.2 to 2 times as long with boxes that differ in depth.
template <class Id, bool depth_test, bool clusters, LightKind kind> constexpr ListKernels<Id> list_kernels() {
    constexpr Tested tested = clusters && kind != LightKind::box ? Tested::slab : Tested::cells;
    if constexpr (depth_test)
        return {bin_kernel<Id, tested, kind>, least::count_entries<tested, kind>};
    else
        return {bin_kernel<Id, Tested::nothing, LightKind::sphere>, nullptr};
}

}}}  // namespace lightbin::detail
