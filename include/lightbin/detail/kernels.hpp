// SPDX-License-Identifier: MIT
// The tiers' kernels side by side, and the choice between them.
#pragma once

#include <lightbin/detail/avx2.hpp>
#include <lightbin/detail/avx512.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/neon.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scalar.hpp>
#include <lightbin/detail/scatter.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/detail/sse2.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

using ProjectKernel = decltype(&scalar::project);
using RowSpanKernel = decltype(&scalar::row_spans);
struct DepthKernels {
    decltype(&scalar::column_extremes) extremes;
    decltype(&scalar::column_gaps) gaps;
};
template <class Id>
using BinKernel = std::uint64_t (*)(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands);

inline ProjectKernel project_kernel(Isa isa) {
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512) return avx512::project;
    if (isa == Isa::avx2) return avx2::project;
    if (isa == Isa::sse2) return sse2::project;
#elif defined(LIGHTBIN_NEON)
    if (isa == Isa::neon) return neon::project;
#endif
    static_cast<void>(isa);
    return scalar::project;
}

inline RowSpanKernel row_span_kernel(Isa isa) {
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512) return avx512::row_spans;
    if (isa == Isa::avx2) return avx2::row_spans;
    if (isa == Isa::sse2) return sse2::row_spans;
#elif defined(LIGHTBIN_NEON)
    if (isa == Isa::neon) return neon::row_spans;
#endif
    static_cast<void>(isa);
    return scalar::row_spans;
}

/// For blocks of `columns` columns or more.
inline DepthKernels depth_kernels(Isa isa, std::size_t columns) {
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512 && columns >= avx512::lanes) return {avx512::column_extremes, avx512::column_gaps};
    if (isa >= Isa::avx2 && columns >= avx2::lanes) return {avx2::column_extremes, avx2::column_gaps};
    if (isa >= Isa::sse2 && columns >= sse2::lanes) return {sse2::column_extremes, sse2::column_gaps};
#elif defined(LIGHTBIN_NEON)
    if (isa == Isa::neon && columns >= neon::lanes) return {neon::column_extremes, neon::column_gaps};
#endif
    static_cast<void>(isa);
    static_cast<void>(columns);
    return {scalar::column_extremes, scalar::column_gaps};
}

/// The scalar tier has the vectors of the platform too: the text is there, and the bytes are the same.
template <class Id> BinKernel<Id> scatter_kernel(Isa isa) {
    static_cast<void>(isa);
#if defined(LIGHTBIN_X86)
    if (isa >= Isa::avx2) return avx2::bin_rectangles<Id>;
    return sse2::bin_rectangles<Id>;
#elif defined(LIGHTBIN_NEON)
    return neon::bin_rectangles<Id>;
#else
    return bin_scatter<Id, scalar::lay_out_rows<Id>>;
#endif
}

/// The fastest kernel for `lights` lights in view whose rectangles have `area` tiles in all.
template <Footprint footprint, DepthTest depth_test, class Id>
BinKernel<Id> bin_kernel(Isa isa, const View& view, std::uint32_t lights, std::uint64_t area) {
    if constexpr (!masked<footprint, depth_test>) {
        // A walk over all supertiles costs as much as scattering some entries a tile; putting a light in their lists,
        // where neither compress nor scanning does it, as scattering it to 48 tiles.
        const std::uint64_t tiles = view.tile_count();
        const bool scatter = isa == Isa::avx512 ? area <= tiles && lights < tiles / 16
                             : isa == Isa::avx2 ? area < 3 * tiles
                                                : area < 6 * tiles + std::uint64_t{48} * lights;
        if (isa == Isa::scalar || scatter) return scatter_kernel<Id>(isa);
    }
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512) return avx512::bin_compress<footprint, depth_test, Id>;
    if (isa == Isa::avx2) return avx2::bin_supertiles<footprint, depth_test, Id>;
    if (isa == Isa::sse2) return sse2::bin_supertiles<footprint, depth_test, Id>;
#elif defined(LIGHTBIN_NEON)
    if (isa == Isa::neon) return neon::bin_supertiles<footprint, depth_test, Id>;
#endif
    return scalar::bin_supertiles<footprint, depth_test, Id>;
}

}  // namespace lightbin::detail
