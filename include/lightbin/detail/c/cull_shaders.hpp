// SPDX-License-Identifier: MIT
// The C side's shaders that make light grids on the GPU of lights there, and their plans.
#pragma once

#include <lightbin/detail/c/shaders.hpp>

#include <lightbin/shader_cull.hpp>

namespace lightbin {
namespace c {

/// Reads the pass and the options that the caller's struct describes, or returns why they are refused.
inline lightbin_result read_cull_options(const lightbin_cull_options* options, CullPass& pass,
                                         CullShaderOptions& known) {
    lightbin_cull_options given;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(check_value(given.language, LIGHTBIN_WGSL, "options.language"),
                             check_value(given.pass, LIGHTBIN_CULL_FILL, "options.pass"),
                             check_value(given.kind, LIGHTBIN_CULL_BOX, "options.kind"),
                             check_value(given.ids, LIGHTBIN_U16, "options.ids"),
                             check_value(given.slicing, LIGHTBIN_Z_BINS, "options.slicing"));
    if (result.error != LIGHTBIN_OK) return result;
    pass = static_cast<CullPass>(given.pass);
    known.language = static_cast<ShaderLanguage>(given.language);
    known.prefix = prefix_of(given.prefix);
    known.kind = static_cast<CullKind>(given.kind);
    if (given.stride != 0)
        known.lights_at = {given.stride, given.centre, given.radius, given.axis, given.cosine};
    else if (known.kind == CullKind::spot)
        known.lights_at.stride = sizeof(Spot) / 4;
    known.world_space = given.world_space != 0;
    known.count_in_buffer = given.count_in_buffer != 0;
    known.count_at = given.count_at;
    known.ids = given.ids == LIGHTBIN_U32 ? IdWidth::u32 : static_cast<IdWidth>(given.ids);
    known.depth_test = given.depth_test != 0;
    known.slicing = static_cast<Slicing>(given.slicing);
    known.max_only = given.max_only != 0;
    known.orthographic = given.orthographic != 0;
    if (given.slots_given != 0) {
        known.lights = slot_of(given.lights);
        known.z_bounds = slot_of(given.z_bounds);
        known.scratch = slot_of(given.scratch);
        known.slices = slot_of(given.slices);
        known.tiles = slot_of(given.tiles);
        known.light_count = slot_of(given.light_count);
        known.lists = slot_of(given.lists);
        known.grid = slot_of(given.grid);
    }
    return result;
}

/// Writes a plan to the C side's struct.
inline void write_plan(const CullPlan& made, lightbin_cull_plan* plan) {
    lightbin_cull_plan known = {};
    known.scratch_bytes = made.bytes.scratch;
    known.tile_bytes = made.bytes.tiles;
    known.list_bytes = made.bytes.lists;
    static_assert(sizeof known.groups == sizeof made.groups);
    std::memcpy(known.groups, made.groups, sizeof made.groups);
    static_assert(sizeof known.constants >= sizeof made.constants);
    std::memcpy(known.constants, &made.constants, sizeof made.constants);
    write(known, plan);
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_cull_shader(const lightbin_cull_options* options,
                                     lightbin_shader** shader) {
    using namespace lightbin::c;
    if (shader == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "shader");
    lightbin::CullPass pass = {};
    lightbin::CullShaderOptions known;
    const lightbin_result result = read_cull_options(options, pass, known);
    if (result.error != LIGHTBIN_OK) return result;
    return make_shader(shader, [&] { return lightbin::cull_shader(pass, known); });
}

lightbin_result lightbin_plan_cull(const lightbin_view* view, const lightbin_cull_options* options,
                                   std::uint32_t lights, std::uint32_t entries, const lightbin_slices* slices,
                                   const lightbin_matrix* to_view, lightbin_cull_plan* plan) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    lightbin::CullPass pass = {};
    lightbin::CullShaderOptions known;
    lightbin::Matrix matrix;
    lightbin_result result = first_error(read_cull_options(options, pass, known), check_size(plan, "plan"));
    if (result.error != LIGHTBIN_OK) return result;
    const bool sliced = known.slicing != lightbin::Slicing::none;
    if (sliced != (slices != nullptr))
        return refused(sliced ? LIGHTBIN_NULL_ARGUMENT : LIGHTBIN_NOT_READ, "slices");
    if (known.world_space != (to_view != nullptr))
        return refused(known.world_space ? LIGHTBIN_NULL_ARGUMENT : LIGHTBIN_NOT_READ, "to_view");
    if (to_view != nullptr) result = read_matrix(*to_view, matrix, "to_view");
    if (result.error != LIGHTBIN_OK) return result;
    return guarded([&] {
        const auto made =
            lightbin::plan_cull(view->value, known, {lights, entries}, sliced ? &slices->value : nullptr,
                                to_view != nullptr ? &matrix : nullptr);
        if (!made) return refused(made.error());
        write_plan(*made, plan);
        return succeeded();
    });
}

lightbin_result lightbin_shader_edges(const lightbin_view* view, lightbin_edges* edges, std::size_t capacity,
                                      std::size_t* count) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    return guarded([&] {
        const auto made = lightbin::shader_edges(view->value);
        return write_items(made.data(), made.size(), edges, capacity, count, "edges");
    });
}

lightbin_result lightbin_shader_slabs(const lightbin_slices* slices, lightbin_edges* slabs,
                                      std::size_t capacity, std::size_t* count) {
    using namespace lightbin::c;
    if (slices == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "slices");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    return guarded([&] {
        const auto made = lightbin::shader_slabs(slices->value);
        return write_items(made.data(), made.size(), slabs, capacity, count, "slabs");
    });
}

}  // extern "C"
