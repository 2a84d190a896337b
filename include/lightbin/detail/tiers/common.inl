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

/// Loads the spheres at the first `count` of `indices`, or as many as a vector has; if those are fewer, the last lanes repeat the
/// last sphere.
template <class Index>
void load_listed_spheres(const Sphere* spheres, const Index* indices, std::uint32_t count, Floats& x, Floats& y, Floats& z,
                         Floats& radius) {
    Sphere some[lanes];
    for (std::uint32_t i = 0; i < lanes; ++i)
        some[i] = load_sphere(spheres + indices[min_of(i, count - 1)]);
    load_spheres(some, x, y, z, radius);
}

}}}}  // namespace lightbin::detail
