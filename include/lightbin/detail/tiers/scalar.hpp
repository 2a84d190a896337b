// SPDX-License-Identifier: MIT
// The scalar tier: what every other tier must equal, byte for byte.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/tiers/tier.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace scalar {

using Floats = float;
using Doubles = double;
using FloatRegister = float;
using DoubleRegister = double;
using ListId = std::uint32_t;
inline constexpr std::uint32_t lanes = 1, double_lanes = 1;

#include <lightbin/detail/tiers/numbers.inl>

template <class Real> Real broadcast(Real each) {
    return each;
}
template <class Real> Real sqrt(Real a) {
    return root_of(a);
}
inline unsigned movemask(bool mask) {
    return mask;
}
// By bits, as of an array of both clang 14 reads another call's where it makes vectors for WebAssembly.
inline float select_unpredicted(bool mask, float a, float b) {
    const std::uint32_t if_set = 0u - std::uint32_t{mask};
    return bit_cast<float>((bit_cast<std::uint32_t>(a) & if_set) | (bit_cast<std::uint32_t>(b) & ~if_set));
}
inline double widened(float a, unsigned) {
    return static_cast<double>(a);
}
inline void load_spheres(const Sphere* spheres, float& x, float& y, float& z, float& radius) {
    const Sphere sphere = load_sphere(spheres);
    x = sphere.x;
    y = sphere.y;
    z = sphere.z;
    radius = sphere.radius;
}
inline void store_spheres(Sphere* spheres, float x, float y, float z, float radius) {
    const Sphere sphere = {x, y, z, radius};
    std::memcpy(spheres, &sphere, sizeof sphere);
}
inline float ascending_bits(float value) {
    const std::int32_t bits = bit_cast<std::int32_t>(value);
    return static_cast<float>(bits ^ (bits >> 31 & 0x7fffffff));
}
template <class Real> void store_tiles(std::uint16_t* tiles, Real value) {
    *tiles = static_cast<std::uint16_t>(value);
}
inline void store_spans(RowSpan* spans, double first, double last) {
    *spans = {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(last)};
}

using portable::append;
using portable::Packed;
using portable::packs_ids;
using portable::split_bits;
using portable::transpose_words;

}}}}  // namespace lightbin::detail

#define LIGHTBIN_TIER scalar
#if !defined(LIGHTBIN_IN_EDITOR)
#include <lightbin/detail/tiers/kernels.inl>
#endif

