// SPDX-License-Identifier: MIT
// The kernels of spots and boxes of one tier (instruction set). kernels.inl has all other kernels.

#define LIGHTBIN_KERNELS

// clang-format off: in this order
#include <lightbin/detail/project/spot_vectors.inl>
#include <lightbin/detail/project/spots.inl>
#include <lightbin/detail/project/box_vectors.inl>
#include <lightbin/detail/project/boxes.inl>
// clang-format on

#undef LIGHTBIN_KERNELS
#undef LIGHTBIN_TIER
