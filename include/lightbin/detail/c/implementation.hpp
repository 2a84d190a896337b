// SPDX-License-Identifier: MIT
// The functions of lightbin.h, for the file that defines LIGHTBIN_IMPLEMENTATION. Defines leave out what the program
// never asks for; docs/c.md says what each saves. Functions that are left out are not there; options, kinds of lights
// and threads that are left out are refused by the define's name.
//
//   LIGHTBIN_NO_SPOTS, LIGHTBIN_NO_BOXES                            kinds of lights; the functions that make boxes
//   LIGHTBIN_NO_U16                                                 16-bit ids
//   LIGHTBIN_NO_DEPTH_TEST                                          lightbin_binner_options::depth_test, reduce_depth()
//   LIGHTBIN_NO_CLUSTERS, LIGHTBIN_NO_Z_BINS                        slicings; with LIGHTBIN_NO_CULL_SHADERS all slices
//   LIGHTBIN_NO_COVERAGE                                            lightbin_coverage()
//   LIGHTBIN_NO_BUDGETS                                             lightbin_limit_grid()
//   LIGHTBIN_NO_THREADS                                             lightbin_inputs::threads
//   LIGHTBIN_NO_SHADERS                                             all shader text
//   LIGHTBIN_NO_REDUCE_SHADERS                                      lightbin_reduce_shader()
//   LIGHTBIN_NO_CULL_SHADERS                                        lightbin_cull_shader(), lightbin_plan_cull()
//   LIGHTBIN_NO_SIMD, LIGHTBIN_NO_SCALAR                            the vector kernels; the scalar ones (docs/install.md)
#pragma once

#if defined(LIGHTBIN_NO_SHADERS) && !defined(LIGHTBIN_NO_REDUCE_SHADERS)
#define LIGHTBIN_NO_REDUCE_SHADERS 1
#endif
#if defined(LIGHTBIN_NO_SHADERS) && !defined(LIGHTBIN_NO_CULL_SHADERS)
#define LIGHTBIN_NO_CULL_SHADERS 1
#endif
#if defined(LIGHTBIN_NO_CLUSTERS) && defined(LIGHTBIN_NO_Z_BINS) && defined(LIGHTBIN_NO_CULL_SHADERS)
#define LIGHTBIN_WITHOUT_SLICES 1
#endif

#include <lightbin/detail/c/grids.hpp>
#include <lightbin/detail/c/shapes.hpp>
#if !defined(LIGHTBIN_NO_SHADERS)
#include <lightbin/detail/c/shaders.hpp>
#endif
#if !defined(LIGHTBIN_NO_REDUCE_SHADERS)
#include <lightbin/detail/c/reduce_shaders.hpp>
#endif
#if !defined(LIGHTBIN_NO_CULL_SHADERS)
#include <lightbin/detail/c/cull_shaders.hpp>
#endif

extern "C" {

float lightbin_light_range(float intensity, float cutoff) {
    return lightbin::light_range(intensity, cutoff);
}

float lightbin_light_window(float distance, float range) {
    return lightbin::light_window(distance, range);
}

}  // extern "C"
