// SPDX-License-Identifier: MIT
// The kinds of lights, each of which has kernels of its own.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// What kind of object the caller's lights are: Sphere, Spot or Box, or `mixed` where lights() joined arrays of
/// several kinds.
enum class LightKind : std::uint8_t { sphere, spot, box, mixed };

}}}  // namespace lightbin::detail
