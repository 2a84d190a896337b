// SPDX-License-Identifier: MIT
// The kernels of spots and boxes, for each tier (instruction set). Only spot.hpp and box.hpp include them, since a
// program without spots and boxes compiles in less time if it does not read them.
#pragma once

#include <lightbin/detail/dispatch/kernels.hpp>
#include <lightbin/detail/project/spheres_around_shapes.hpp>

#include <lightbin/detail/base/warnings_off.inl>

#define LIGHTBIN_KERNELS

#define LIGHTBIN_TIER scalar
#include <lightbin/detail/kinds/shape_kernels.inl>

#include <lightbin/detail/kinds/boxes_in_double.inl>

#if defined(LIGHTBIN_HAS_SIMD128)
LIGHTBIN_SIMD128_BEGIN
#define LIGHTBIN_TIER simd128
#include <lightbin/detail/kinds/shape_kernels.inl>
LIGHTBIN_SIMD128_END
#endif

#if defined(LIGHTBIN_X86)
LIGHTBIN_AVX2_BEGIN
#define LIGHTBIN_TIER avx2
#include <lightbin/detail/kinds/shape_kernels.inl>
LIGHTBIN_AVX2_END

LIGHTBIN_AVX512_BEGIN
#define LIGHTBIN_TIER avx512
#include <lightbin/detail/kinds/shape_kernels.inl>
LIGHTBIN_AVX512_END
#endif

#undef LIGHTBIN_KERNELS

#include <lightbin/detail/base/warnings_on.inl>
