// SPDX-License-Identifier: MIT
// What the vectors of all tiers have in common, written once. Included once a tier, after its vectors and masks.
// Reals is either type of vector.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A bit a lane.
inline constexpr std::uint64_t every_lane = (std::uint64_t{1} << lanes) - 1;

// By way of registers: gcc 12 copies a class that holds one in halves, for which the next load has to wait.
inline Floats load_floats(const float* from) {
    FloatRegister values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
inline void store_floats(float* to, FloatRegister values) {
    std::memcpy(to, &values, sizeof values);
}
inline Doubles load_doubles(const double* from) {
    DoubleRegister values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
inline void store_doubles(double* to, DoubleRegister values) {
    std::memcpy(to, &values, sizeof values);
}

// Masks, where a tier has no other way.
template <class Mask> inline Mask both(Mask a, Mask b) {
    return static_cast<Mask>(a & b);
}
template <class Mask> inline Mask either(Mask a, Mask b) {
    return static_cast<Mask>(a | b);
}
template <class Mask> inline Mask and_not(Mask a, Mask b) {
    return static_cast<Mask>(a & (a ^ b));
}

/// As select, of what no processor predicts: the scalar tier has its own of floats, without a branch.
template <class Mask, class Reals>
inline Reals select_unpredicted(Mask mask, Reals a, Reals b) {
    return select(mask, a, b);
}

/// less() of a vector and each of 8, a byte each of bits. The AVX2 tier has its own.
template <class Vector> inline std::uint64_t movemask_of_8_less(Vector a, const float* eight) {
    std::uint64_t all_bits = 0;
    for (unsigned i = 0; i < 8; ++i)
        all_bits |= std::uint64_t{movemask(less(a, load_floats(eight + i * lanes)))} << 8 * i;
    return all_bits;
}

#if !defined(LIGHTBIN_TIER_HAS_BYTES)
/// Appends those of a vector of a chunk's lights, from `first` on, whose bit in `visible` is set. Every lane is written,
/// and the place moves on for those in view: no branch to predict.
inline void append_visible(const FootprintArrays& out, ProjectCounts& counts, std::uint32_t first_id,
                           unsigned visible, const ChunkRects& rects, std::uint32_t first) {
    for (std::uint32_t i = first; i < first + lanes; ++i, visible >>= 1) {
        const std::uint32_t at = counts.visible, in_view = visible & 1;
        out.ids[at] = first_id + i;
        out.x0[at] = rects.x0[i];
        out.y0[at] = rects.y0[i];
        out.x1[at] = rects.x1[i];
        out.y1[at] = rects.y1[i];
        counts.visible += in_view;
        counts.area +=
            in_view * ((rects.x1[i] - rects.x0[i] + 1u) * std::uint64_t{rects.y1[i] - rects.y0[i] + 1u});
    }
}
#endif

}}}}  // namespace lightbin::detail
