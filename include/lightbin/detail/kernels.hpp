// SPDX-License-Identifier: MIT
// The tiers' kernels side by side, and the choice between them.
#pragma once

#include <lightbin/detail/avx2.hpp>
#include <lightbin/detail/avx512.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scalar.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/detail/sse2.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin::detail {

using ProjectKernel = decltype(&scalar::project);
template <class Id, bool with_depth> using BinKernel = decltype(&bin_scalar<with_depth, Id>);

inline namespace LIGHTBIN_FLAVOUR {

inline ProjectKernel project_kernel(Isa isa) {
#if defined(LIGHTBIN_X86)
    if (isa == Isa::avx512) return avx512::project;
    if (isa == Isa::avx2) return avx2::project;
    if (isa == Isa::sse2) return sse2::project;
#endif
    static_cast<void>(isa);
    return scalar::project;
}

/// The fastest kernel for lights that cover `area` tiles in all. Kernels with full-vector stores need the
/// room for `area` entries that the scalar one does without.
template <class Id, bool with_depth>
BinKernel<Id, with_depth> bin_kernel(Isa isa, const BinJob<Id>& job, std::uint64_t area) {
    // Nearly empty grids, and those without tiles or lights: the walk over all supertiles costs more than
    // counting and scattering the few entries.
    const std::uint64_t tiles =
        static_cast<std::uint64_t>(job.tiles_x) * static_cast<std::uint64_t>(job.tiles_y);
    if (with_depth ? area <= tiles : area <= tiles / 4) return bin_scalar<with_depth, Id>;
#if defined(LIGHTBIN_X86)
    const bool small_grid = job.tiles_x <= 248 && job.tiles_y <= 248;
    const bool short_ids = job.lights.ids[0] >> 16 == job.lights.ids[job.count - 1] >> 16;
    if (isa == Isa::avx512 && small_grid && short_ids) return avx512::bin_compress<with_depth, Id>;
    // Without compress, putting a small light in its lists costs as much as scattering it.
    const bool small_lights = !with_depth && area < std::uint64_t{16} * job.count;
    if (isa >= Isa::avx2 && !small_lights) return avx2::bin_supertiles<with_depth, Id>;
#endif
    static_cast<void>(isa);
    return bin_scalar<with_depth, Id>;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
