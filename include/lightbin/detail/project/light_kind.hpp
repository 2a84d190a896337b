// SPDX-License-Identifier: MIT
// The kinds of lights, each of which has kernels of its own.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// What kind of object the caller's lights are: Sphere, Spot or Box, or `mixed` where lights() joined arrays of
/// several kinds.
enum class LightKind : std::uint8_t { sphere, spot, box, mixed };

/// Whether the kernels of a kind of lights are included. spot.hpp and box.hpp specialise it for Spots and for Boxes.
template <LightKind kind> inline constexpr bool kernels_included = kind == LightKind::sphere;

/// Whether mixed kinds can have spots, and boxes. The file that implements lightbin.h may leave out the code for
/// either.
#if defined(LIGHTBIN_IMPLEMENTATION) && defined(LIGHTBIN_NO_SPOTS)
inline constexpr bool kinds_have_spots = false;
#else
inline constexpr bool kinds_have_spots = true;
#endif
#if defined(LIGHTBIN_IMPLEMENTATION) && defined(LIGHTBIN_NO_BOXES)
inline constexpr bool kinds_have_boxes = false;
#else
inline constexpr bool kinds_have_boxes = true;
#endif

}}}  // namespace lightbin::detail
