// SPDX-License-Identifier: MIT
// Functions of lightbin.h that a define leaves out: they refuse every call, by the name of the define.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

extern "C" {

#if defined(LIGHTBIN_NO_BUDGETS)
lightbin_result lightbin_budget_create(const lightbin_allocator*, lightbin_budget**) {
    return lightbin::c::refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BUDGETS");
}
void lightbin_budget_destroy(lightbin_budget*) {}
lightbin_result lightbin_limit_grid(lightbin_budget*, const lightbin_grid*, const float*, std::size_t,
                                    std::uint32_t, std::uint32_t, lightbin_grid*, lightbin_cut*) {
    return lightbin::c::refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BUDGETS");
}
#endif

#if defined(LIGHTBIN_NO_SHADERS)
#define LIGHTBIN_WITHOUT return lightbin::c::refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_SHADERS")
lightbin_result lightbin_shader_snippet(const lightbin_snippet_options*, const lightbin_allocator*,
                                        lightbin_shader**) {
    LIGHTBIN_WITHOUT;
}
void lightbin_shader_destroy(lightbin_shader*) {}
const char* lightbin_shader_text(const lightbin_shader*) {
    return nullptr;
}
std::size_t lightbin_shader_binding_count(const lightbin_shader*) {
    return 0;
}
lightbin_result lightbin_shader_binding(const lightbin_shader*, std::size_t, lightbin_binding*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_grid(const lightbin_view*, std::int32_t, std::int32_t,
                                     lightbin_grid_constants*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_view(const lightbin_view*, float, lightbin_view_constants*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_slices(const lightbin_slices*, std::uint32_t*, std::size_t) {
    LIGHTBIN_WITHOUT;
}
#undef LIGHTBIN_WITHOUT
#endif

#if defined(LIGHTBIN_NO_BUILD_SHADERS)
#define LIGHTBIN_WITHOUT return lightbin::c::refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BUILD_SHADERS")
lightbin_result lightbin_reduce_shader(const lightbin_reduce_options*, const lightbin_allocator*,
                                       lightbin_shader**) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_reduce(const lightbin_view*, std::int32_t, std::int32_t,
                                       lightbin_reduce_constants*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_build_shader(const lightbin_build_options*, const lightbin_allocator*,
                                      lightbin_shader**) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_build(const lightbin_view*, std::uint32_t, std::uint32_t, std::int32_t,
                                      lightbin_build_constants*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_footprints(const lightbin_view*, const lightbin_lights*,
                                           lightbin_shader_footprint*, std::size_t, std::size_t*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_edges(const lightbin_view*, lightbin_edges*, std::size_t, std::size_t*) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_shader_slabs(const lightbin_slices*, lightbin_edges*, std::size_t, std::size_t*) {
    LIGHTBIN_WITHOUT;
}
#undef LIGHTBIN_WITHOUT
#endif

#if defined(LIGHTBIN_NO_ADVICE)
#define LIGHTBIN_WITHOUT return lightbin::c::refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_ADVICE")
lightbin_result lightbin_advise(const lightbin_view*, const lightbin_lights*, const lightbin_costs*,
                                const lightbin_z_bounds*, const lightbin_allocator*, lightbin_advice**) {
    LIGHTBIN_WITHOUT;
}
lightbin_result lightbin_advise_slices(const lightbin_view*, const lightbin_lights*, const lightbin_slices*,
                                       const lightbin_slices*, const float*, std::int32_t, std::int32_t,
                                       const lightbin_costs*, const lightbin_allocator*, lightbin_advice**) {
    LIGHTBIN_WITHOUT;
}
void lightbin_advice_destroy(lightbin_advice*) {}
std::size_t lightbin_advice_count(const lightbin_advice*) {
    return 0;
}
lightbin_result lightbin_advice_plan(const lightbin_advice*, std::size_t, lightbin_plan*) {
    LIGHTBIN_WITHOUT;
}
const char* lightbin_advice_text(const lightbin_advice*) {
    return nullptr;
}
const char* lightbin_advice_table(const lightbin_advice*) {
    return nullptr;
}
#undef LIGHTBIN_WITHOUT
#endif

}  // extern "C"
