// SPDX-License-Identifier: MIT
// Functions that all tiers have in common. A tier that has a better way overloads them for its own types, as templates
// are chosen last. Included once per tier (instruction set), before all kernels.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A mask's bits, see movemask(), with every lane set.
inline constexpr std::uint64_t every_lane = (std::uint64_t{1} << lanes) - 1;

// Loads and stores take the compiler's own type of register: GCC 12 copies a class that contains one in two halves, and
// the next load would have to wait for both.
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

// Logic of masks, for tiers whose masks have the operators & | ^.
template <class Mask> inline Mask both(Mask a, Mask b) {
    return static_cast<Mask>(a & b);
}
template <class Mask> inline Mask either(Mask a, Mask b) {
    return static_cast<Mask>(a | b);
}
template <class Mask> inline Mask and_not(Mask a, Mask b) {
    return static_cast<Mask>(a & (a ^ b));
}

/// Returns a (mask set) or b, for masks that no branch predictor could guess: in the scalar tier branchless for floats.
template <class Mask, class Reals>
inline Reals select_unpredicted(Mask mask, Reals a, Reals b) {
    return select(mask, a, b);
}

/// Returns a vector of floats or doubles, all of which are the number `each`, which float represents exactly.
template <class Reals> Reals all(double each) {
    if constexpr (std::is_same_v<Reals, Floats>)
        return broadcast(static_cast<float>(each));
    else
        return broadcast(each);
}
template <class Reals> Reals dot(const Reals (&a)[3], const Reals (&b)[3]) {
    return mul(a[0], b[0]) + mul(a[1], b[1]) + mul(a[2], b[2]);
}
template <class Reals> void cross(const Reals (&a)[3], const Reals (&b)[3], Reals (&to)[3]) {
    for (unsigned i = 0; i < 3; ++i)
        to[i] = mul(a[(i + 1) % 3], b[(i + 2) % 3]) - mul(a[(i + 2) % 3], b[(i + 1) % 3]);
}

/// Loads the spheres with `count` indices, but no more than a vector holds, as four vectors. If they are fewer, the
/// last sphere fills the other lanes.
template <class Index>
void load_listed_spheres(const Sphere* spheres, const Index* indices, std::uint32_t count, Floats& x, Floats& y, Floats& z,
                         Floats& radius) {
    Sphere some[lanes];
    for (std::uint32_t i = 0; i < lanes; ++i)
        some[i] = load_sphere(spheres + indices[min_of(i, count - 1)]);
    load_spheres(some, x, y, z, radius);
}

}}}}  // namespace lightbin::detail
