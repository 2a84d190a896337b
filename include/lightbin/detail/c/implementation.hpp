// SPDX-License-Identifier: MIT
// The functions of lightbin.h, for the file that defines LIGHTBIN_IMPLEMENTATION. LIGHTBIN_NO_ defines leave out what
// the program never asks for: docs/c.md names them all, and says what each saves. Functions that are left out are not
// there; options and kinds of lights that are left out are refused by the define's name.
#pragma once

#include <lightbin/detail/c/grids.hpp>
#if !defined(LIGHTBIN_NO_DUMP)
#include <lightbin/detail/c/dumps.hpp>
#endif
#if !defined(LIGHTBIN_NO_SHADERS)
#include <lightbin/detail/c/shaders.hpp>
#if !defined(LIGHTBIN_NO_CULL_SHADERS)
#include <lightbin/detail/c/cull_shaders.hpp>
#endif
#endif

extern "C" {

float lightbin_light_range(float intensity, float cutoff) {
    return lightbin::light_range(intensity, cutoff);
}

}  // extern "C"
