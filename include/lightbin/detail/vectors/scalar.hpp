// SPDX-License-Identifier: MIT
// The tier of plain numbers, for machines without a tier of their own. Every other tier must give the same bytes.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/bits.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/sphere.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace scalar {

using Floats = float;
using FloatRegister = float;
inline constexpr std::uint32_t lanes = 1;

#include <lightbin/detail/vectors/native_vector.inl>

template <class Real> Real broadcast(Real each) {
    return each;
}
template <class Real> Real sqrt(Real a) {
    return root_of(a);
}
inline unsigned movemask(bool mask) {
    return mask;
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
template <class Real> void store_tiles(std::uint32_t* tiles, Real value) {
    *tiles = static_cast<std::uint32_t>(value);
}

inline void split_bits(const std::uint8_t* bytes, std::uint64_t* words) {
    for (unsigned i = 0; i < 64; i += 8) {
        const std::uint64_t eight = transpose_bits(load_8_bytes(bytes + i));
        for (unsigned bit = 0; bit < 8; ++bit)
            words[bit] = (i == 0 ? 0 : words[bit]) | (eight >> 8 * bit & 0xff) << i;
    }
}
/// Every id is stored, but the end moves on only if its bit is set, so that no branch can be mispredicted.
template <class Id> LIGHTBIN_INLINE Id* append_16(Id* out, const std::uint32_t* ids, unsigned mask) {
    for (unsigned i = 0; mask != 0; ++i, mask >>= 1) {
        *out = static_cast<Id>(ids[i]);
        out += mask & 1;
    }
    return out;
}
template <class Id> LIGHTBIN_INLINE Id* append_8(Id* out, const std::uint32_t* ids, unsigned mask) {
    return append_16(out, ids, mask);
}

using Bytes = std::uint8_t;
using ByteMask = std::uint8_t;
inline constexpr std::uint32_t byte_lanes = 1;

inline Bytes load_bytes(const std::uint8_t* from) {
    return *from;
}
inline void store_bytes(std::uint8_t* to, Bytes byte) {
    *to = byte;
}
inline Bytes broadcast_byte(unsigned each) {
    return static_cast<Bytes>(each);
}
inline Bytes subtract(Bytes a, Bytes b) {
    return a > b ? static_cast<Bytes>(a - b) : Bytes{0};
}
inline Bytes shuffle(const std::uint8_t (&table)[16], Bytes index) {
    return table[index];
}
inline Bytes keep_where(Bytes byte, unsigned condition) {
    return condition != 0 ? byte : Bytes{0};
}
inline ByteMask not_zero(unsigned byte) {
    return byte != 0;
}
inline Bytes coordinates(const std::uint16_t* from, unsigned more, unsigned begin) {
    const unsigned coordinate = *from + more;
    return coordinate > begin ? static_cast<Bytes>(min_of(coordinate - begin, 255u)) : Bytes{0};
}
inline void compress_store(ByteMask, unsigned from, std::uint8_t* to) {
    *to = static_cast<std::uint8_t>(from);
}

}}}}  // namespace lightbin::detail
