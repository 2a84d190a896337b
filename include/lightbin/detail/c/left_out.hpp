// SPDX-License-Identifier: MIT
// Functions of lightbin.h that a define leaves out: they refuse every call, by the name of the define.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

/// Defines a function of lightbin.h, given by its name and types, that refuses every call.
#define LIGHTBIN_WITHOUT(define, ...)                                                                        \
    lightbin_result __VA_ARGS__ {                                                                            \
        return lightbin::c::refused(LIGHTBIN_LEFT_OUT, define);                                              \
    }

extern "C" {

#if defined(LIGHTBIN_NO_BOXES)
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_box_sphere(const lightbin_box*, lightbin_sphere*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_whole_box(const float*, const float*, lightbin_box*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_cube_box(const lightbin_matrix*, double, lightbin_box*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_half_sphere(const lightbin_sphere*, const float*, lightbin_box*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_projector_box(const float*, const float*, const float*,
                                                             const float*, double, lightbin_box*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BOXES", lightbin_tube_box(const float*, const float*, float, lightbin_box*))
#endif

#if defined(LIGHTBIN_NO_BUDGETS)
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BUDGETS", lightbin_budget_create(const lightbin_allocator*, lightbin_budget**))
void lightbin_budget_destroy(lightbin_budget*) {}
LIGHTBIN_WITHOUT("LIGHTBIN_NO_BUDGETS",
                 lightbin_limit_grid(lightbin_budget*, const lightbin_grid*, const float*, std::size_t,
                                     std::uint32_t, std::uint32_t, lightbin_grid*, lightbin_cut*))
#endif

#if defined(LIGHTBIN_NO_SHADERS)
LIGHTBIN_WITHOUT("LIGHTBIN_NO_SHADERS", lightbin_shader_snippet(const lightbin_snippet_options*,
                                                                const lightbin_allocator*, lightbin_shader**))
void lightbin_shader_destroy(lightbin_shader*) {}
const char* lightbin_shader_text(const lightbin_shader*) {
    return nullptr;
}
std::size_t lightbin_shader_binding_count(const lightbin_shader*) {
    return 0;
}
LIGHTBIN_WITHOUT("LIGHTBIN_NO_SHADERS",
                 lightbin_shader_binding(const lightbin_shader*, std::size_t, lightbin_binding*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_SHADERS", lightbin_shader_grid(const lightbin_view*, std::int32_t, std::int32_t,
                                                             lightbin_grid_constants*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_SHADERS",
                 lightbin_shader_view(const lightbin_view*, float, lightbin_view_constants*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_SHADERS",
                 lightbin_shader_slices(const lightbin_slices*, std::uint32_t*, std::size_t))
#endif

#if defined(LIGHTBIN_NO_REDUCE_SHADERS)
LIGHTBIN_WITHOUT("LIGHTBIN_NO_REDUCE_SHADERS",
                 lightbin_reduce_shader(const lightbin_reduce_options*, const lightbin_allocator*,
                                        lightbin_shader**))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_REDUCE_SHADERS",
                 lightbin_shader_reduce(const lightbin_view*, std::int32_t, std::int32_t,
                                        lightbin_reduce_constants*))
#endif

#if defined(LIGHTBIN_NO_CULL_SHADERS)
LIGHTBIN_WITHOUT("LIGHTBIN_NO_CULL_SHADERS",
                 lightbin_cull_shader(const lightbin_cull_options*, const lightbin_allocator*,
                                      lightbin_shader**))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_CULL_SHADERS",
                 lightbin_plan_cull(const lightbin_view*, const lightbin_cull_options*, std::uint32_t,
                                    std::uint32_t, const lightbin_slices*, const lightbin_matrix*,
                                    lightbin_cull_plan*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_CULL_SHADERS",
                 lightbin_shader_edges(const lightbin_view*, lightbin_edges*, std::size_t, std::size_t*))
LIGHTBIN_WITHOUT("LIGHTBIN_NO_CULL_SHADERS",
                 lightbin_shader_slabs(const lightbin_slices*, lightbin_edges*, std::size_t, std::size_t*))
#endif

}  // extern "C"

#undef LIGHTBIN_WITHOUT
