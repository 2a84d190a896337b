// SPDX-License-Identifier: MIT
// Functions that all tiers have in common. A tier that has a better way overloads them for its own types, as templates
// are chosen last. Included once per tier (instruction set), before all kernels.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor, it is read as the scalar tier's text
#pragma once
#include <lightbin/detail/vectors/scalar.hpp>
#define LIGHTBIN_TIER scalar
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

/// Returns a vector of floats, or a double, all of whose lanes are the number `each`, which float represents exactly.
template <class Reals> Reals all(double each) {
    if constexpr (std::is_same_v<Reals, Floats>)
        return broadcast(static_cast<float>(each));
    else
        return each;
}
template <class Reals> Reals dot(const Reals (&a)[3], const Reals (&b)[3]) {
    return mul(a[0], b[0]) + mul(a[1], b[1]) + mul(a[2], b[2]);
}
template <class Reals> void cross(const Reals (&a)[3], const Reals (&b)[3], Reals (&to)[3]) {
    for (unsigned i = 0; i < 3; ++i)
        to[i] = mul(a[(i + 1) % 3], b[(i + 2) % 3]) - mul(a[(i + 2) % 3], b[(i + 1) % 3]);
}

/// Loads `lanes` vec4s, of which the first begins at `from` and each next one `stride` bytes later: all their first
/// numbers into x, all their second ones into y, and so on. Unrolled, the loop compiles to loads alone, without a copy.
template <class Reals>
void load_vec4s(const void* from, std::size_t stride, Reals& x, Reals& y, Reals& z, Reals& w) {
    Sphere vec4s[lanes];
    LIGHTBIN_UNROLL for (std::uint32_t lane = 0; lane < lanes; ++lane)
        std::memcpy(vec4s + lane, static_cast<const char*>(from) + lane * stride, sizeof *vec4s);
    load_spheres(vec4s, x, y, z, w);
}
/// Stores four vectors as vec4s, one for each lane, that begin `stride` bytes apart, the first one at `to`.
template <class Reals> void store_vec4s(void* to, std::size_t stride, Reals x, Reals y, Reals z, Reals w) {
    Sphere vec4s[lanes];
    store_spheres(vec4s, x, y, z, w);
    LIGHTBIN_UNROLL for (std::uint32_t lane = 0; lane < lanes; ++lane)
        std::memcpy(static_cast<char*>(to) + lane * stride, vec4s + lane, sizeof *vec4s);
}

/// Transposes 64 bytes to 8 words: bit i of word j is bit j of byte i.
template <class Word> void split_bits(const std::uint8_t* bytes, Word* words) {
    LIGHTBIN_UNROLL for (unsigned bit = 0; bit < 8; ++bit) {
        words[bit] = 0;
        LIGHTBIN_UNROLL for (unsigned i = 0; i < 64; i += byte_lanes)
            words[bit] |= Word{not_zero(load_bytes(bytes + i) & broadcast_byte(1u << bit))} << i;
    }
}

/// Stores the chosen ids, of `byte_lanes`, side by side, then meaningless elements.
inline void compress_store(ByteMask chosen, const std::uint32_t* from, std::uint32_t* to) {
    LIGHTBIN_UNROLL for (unsigned i = 0; i < byte_lanes; i += 16)
        to = append_16(to, from + i, static_cast<unsigned>(chosen >> i & 0xffff));
}

/// Returns where a whole vector of lights can be read: `from` or, if only `used` lights lie there, `padded`, to which
/// they are copied, and the first of them for the other lanes. The lights at `from` may be objects of another type with
/// the same layout, which load_vec4s() and load_sphere() can read.
template <class Light>
LIGHTBIN_INLINE const Light* whole_vector(const Light* from, std::uint32_t used, Light (&padded)[lanes]) {
    if (used == lanes) return from;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        std::memcpy(static_cast<void*>(padded + lane), from + (lane < used ? lane : 0), sizeof *padded);
    return padded;
}

}}}}  // namespace lightbin::detail
