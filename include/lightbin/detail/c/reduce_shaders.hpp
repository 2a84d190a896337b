// SPDX-License-Identifier: MIT
// The C side's shaders that reduce depth buffers on the GPU, and the data that they read.
#pragma once

#include <lightbin/detail/c/shaders.hpp>

#include <lightbin/shader_reduce.hpp>

extern "C" {

lightbin_result lightbin_reduce_shader(const lightbin_reduce_options* options, lightbin_shader** shader) {
    using namespace lightbin::c;
    lightbin_reduce_options given;
    lightbin::ReduceOptions known;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(LIGHTBIN_MEMBER(language), LIGHTBIN_MEMBER(prefix), LIGHTBIN_MEMBER(fragment),
                             LIGHTBIN_MEMBER(samples), LIGHTBIN_MEMBER(format), LIGHTBIN_MEMBER(reversed_z),
                             LIGHTBIN_MEMBER(orthographic), LIGHTBIN_MEMBER(oblique), LIGHTBIN_MEMBER(skip_background),
                             LIGHTBIN_MEMBER(flip_y), LIGHTBIN_MEMBER(viewport_corner),
                             LIGHTBIN_MEMBER(push_constants));
    if (result.error == LIGHTBIN_OK && given.slots_given != 0)
        first_error(LIGHTBIN_MEMBER(depth), LIGHTBIN_MEMBER(z_bounds), LIGHTBIN_MEMBER(grid));
    return make_shader(shader, result, [&] { return lightbin::reduce_shader(known); });
}

lightbin_result lightbin_get_reduce_constants(const lightbin_view* view, std::int32_t corner_x, std::int32_t corner_y,
                                              lightbin_reduce_constants* constants) {
    return lightbin::c::write_constants<lightbin::reduce_constants>(view, constants, corner_x, corner_y);
}

}  // extern "C"
