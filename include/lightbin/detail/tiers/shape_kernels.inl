// SPDX-License-Identifier: MIT
// The kernels of spots and boxes of one tier, as kernels.inl has those of spheres and of all kinds together.

#define LIGHTBIN_KERNELS

#include <lightbin/detail/project/spot_vectors.inl>

#include <lightbin/detail/project/spots.inl>

#include <lightbin/detail/project/box_vectors.inl>

#include <lightbin/detail/project/boxes.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

template <> struct KernelsOf<LightKind::spot> {
    template <LightKind kind> static ProjectKernel project_kernel() { return project_lights<kind>; }
};
template <> struct KernelsOf<LightKind::box> {
    template <LightKind kind> static ProjectKernel project_kernel() { return project_lights<kind>; }
};

}}}}  // namespace lightbin::detail

#undef LIGHTBIN_KERNELS
#undef LIGHTBIN_TIER
