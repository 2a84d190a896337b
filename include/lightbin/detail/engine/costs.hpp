// SPDX-License-Identifier: MIT
// The thresholds of binning to lists. They choose between methods that give the same lists, and were measured with
// bench/binning on a Zen 4 and a Zen 5.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/isa.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Up to this instruction set, lights without a depth test are always binned by scattering (scatter.hpp). On x86, where
/// nearly all processors have AVX2, the kernels of 128 bits are not worth their compile time: a program with one Binner
/// compiles in 0.9 of the time without them. Scattering takes 1.2 to 1.3 times as long as they do with 10,000 lights of
/// 20 tiles, and up to 3.6 times with thousands of lights of 200 tiles.
#if defined(LIGHTBIN_X86)
inline constexpr Isa widest_that_scatters = Isa::simd128;
#else
inline constexpr Isa widest_that_scatters = Isa::scalar;
#endif

/// Returns whether binning by scattering (scatter.hpp) is faster than by lists for blocks of 8x8 tiles (lists.inl), for
/// lights whose rectangles have `area` tiles in all, each a list entry, in a grid of `tiles` tiles. Visiting all blocks
/// takes as long as scattering three entries per tile of the grid, and with vectors of 128 bits 24.
inline bool scatter_is_faster(Isa isa, std::uint64_t tiles, std::uint64_t area) {
    return isa <= widest_that_scatters || area < (isa == Isa::simd128 ? 24 : 3) * tiles;
}

/// Binning by scattering (scatter.hpp) counts the lights of this many rows of tiles at a time, to bound its memory.
inline constexpr unsigned rows_counted_at_once = 512;

/// The most entries in all lists of bands (8 tile rows) that one pass over the lights makes; bounds their memory.
inline constexpr std::uint64_t max_band_entries = std::uint64_t{1} << 24;

}}}  // namespace lightbin::detail
