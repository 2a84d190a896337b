// SPDX-License-Identifier: MIT
// The kernels of spots and boxes of one tier, as kernels.inl has those of spheres and of all kinds together.

#include <lightbin/detail/kinds/spots.inl>

#include <lightbin/detail/kinds/box_vectors.inl>

#include <lightbin/detail/kinds/boxes.inl>

#undef LIGHTBIN_TIER
