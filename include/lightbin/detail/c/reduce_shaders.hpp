// SPDX-License-Identifier: MIT
// The C side's shaders that reduce depth buffers on the GPU, and the data that they read.
#pragma once

#include <lightbin/detail/c/shaders.hpp>

#include <lightbin/shader_reduce.hpp>

extern "C" {

lightbin_result lightbin_reduce_shader(const lightbin_reduce_options* options,
                                       lightbin_shader** shader) {
    using namespace lightbin::c;
    if (shader == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "shader");
    lightbin_reduce_options given;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(check_value(given.language, LIGHTBIN_WGSL, "options.language"),
                             check_value(given.format, LIGHTBIN_UNORM16, "options.format"));
    if (result.error != LIGHTBIN_OK) return result;
    lightbin::ReduceShaderOptions known;
    known.language = static_cast<lightbin::ShaderLanguage>(given.language);
    known.stage = given.fragment != 0 ? lightbin::ShaderStage::fragment : lightbin::ShaderStage::compute;
    known.samples = given.samples != 0 ? given.samples : 1;
    known.reversed_z = given.reversed_z != 0;
    known.orthographic = given.orthographic != 0;
    known.format = static_cast<lightbin::DepthFormat>(given.format);
    known.skip_background = given.skip_background != 0;
    known.flip_y = given.flip_y != 0;
    known.viewport_corner = given.viewport_corner != 0;
    known.push_constants = given.push_constants != 0;
    known.prefix = prefix_of(given.prefix);
    if (given.slots_given != 0) {
        known.depth = slot_of(given.depth);
        known.z_bounds = slot_of(given.z_bounds);
        known.grid = slot_of(given.grid);
    }
    return make_shader(shader, [&] { return lightbin::reduce_shader(known); });
}

lightbin_result lightbin_shader_reduce(const lightbin_view* view, std::int32_t corner_x,
                                       std::int32_t corner_y, lightbin_reduce_constants* constants) {
    return lightbin::c::write_constants<lightbin::shader_reduce>(view, constants, corner_x, corner_y);
}

}  // extern "C"
