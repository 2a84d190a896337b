// SPDX-License-Identifier: MIT
// The C side's shaders that make light grids on the GPU of lights there, and their plans.
#pragma once

#include <lightbin/detail/c/shaders.hpp>

#include <lightbin/shader_cull.hpp>

namespace lightbin {
namespace c {

/// Reads the pass, the options, and the spots and boxes of the room that the caller's struct describes, or returns why
/// they are refused.
inline lightbin_result read_cull_options(const lightbin_cull_options* options, CullPass& pass, CullOptions& known,
                                         CullCapacity& room) {
    lightbin_cull_options given;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(read_member(given.pass, pass, "options.pass"), LIGHTBIN_MEMBER(language),
                             LIGHTBIN_MEMBER(prefix), LIGHTBIN_MEMBER(kind), LIGHTBIN_MEMBER(world_space),
                             LIGHTBIN_MEMBER(count_in_buffer), LIGHTBIN_MEMBER(count_at), LIGHTBIN_MEMBER(ids),
                             LIGHTBIN_MEMBER(depth_test), LIGHTBIN_MEMBER(slicing), LIGHTBIN_MEMBER(max_only),
                             LIGHTBIN_MEMBER(orthographic), LIGHTBIN_MEMBER(bounded));
    if (result.error != LIGHTBIN_OK) return result;
    if (given.stride != 0)
        known.lights_at = {given.stride,     given.centre,    given.radius, given.axis,        given.cosine,
                           given.box_centre, given.half_axes, given.taper,  given.spot_stride, given.box_stride};
    else if (known.kind == CullKind::spot)
        known.lights_at.stride = sizeof(Spot) / 4;
    else if (known.kind == CullKind::box)
        known.lights_at.stride = sizeof(Box) / 4;
    room.spots = given.spots;
    room.boxes = given.boxes;
    if (given.slots_given != 0)
        first_error(LIGHTBIN_MEMBER(lights), LIGHTBIN_MEMBER(z_bounds), LIGHTBIN_MEMBER(scratch),
                    LIGHTBIN_MEMBER(slices), LIGHTBIN_MEMBER(tiles), LIGHTBIN_MEMBER(light_count),
                    LIGHTBIN_MEMBER(lists), LIGHTBIN_MEMBER(grid));
    return result;
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_cull_shader(const lightbin_cull_options* options, lightbin_shader** shader) {
    using namespace lightbin::c;
    lightbin::CullPass pass = {};
    lightbin::CullOptions known;
    lightbin::CullCapacity room;
    return make_shader(shader, read_cull_options(options, pass, known, room),
                       [&] { return lightbin::cull_shader(pass, known); });
}

lightbin_result lightbin_plan_cull(const lightbin_view* view, const lightbin_cull_options* options,
                                   std::uint32_t lights, std::uint32_t entries, const lightbin_slices* slices,
                                   const lightbin_matrix* to_view, lightbin_cull_plan* plan) {
    using namespace lightbin::c;
    lightbin::CullPass pass = {};
    lightbin::CullOptions known;
    lightbin::CullCapacity room;
    lightbin::Matrix matrix;
    lightbin_result result = first_error(check_pointers({{view, "view"}}),
                                         read_cull_options(options, pass, known, room), check_size(plan, "plan"));
    room.lights = lights;
    room.entries = entries;
    if (result.error == LIGHTBIN_OK)
        result =
            first_error(check_input(known.slicing != lightbin::Slicing::none, slices, LIGHTBIN_NULL_ARGUMENT, "slices"),
                        check_input(known.world_space, to_view, LIGHTBIN_NULL_ARGUMENT, "to_view"));
    if (result.error == LIGHTBIN_OK && to_view != nullptr) result = read_member(*to_view, matrix, "to_view");
    return call_if(result, [&] {
        const auto made =
            lightbin::plan_cull(view->value, known, room, slices != nullptr ? &slices->value : nullptr,
                                to_view != nullptr ? &matrix : nullptr);
        if (!made) return refused(made.error());
        lightbin_cull_plan filled = {};
        filled.masks_suit = made->masks_suit;
        filled.scratch_bytes = made->bytes.scratch;
        filled.tile_bytes = made->bytes.tiles;
        filled.list_bytes = made->bytes.lists;
        filled.mask_bytes = made->bytes.masks;
        static_assert(sizeof filled.groups == sizeof made->groups);
        std::memcpy(filled.groups, made->groups, sizeof made->groups);
        static_assert(sizeof filled.constants >= sizeof made->constants);
        std::memcpy(filled.constants, &made->constants, sizeof made->constants);
        return write(filled, plan);
    });
}

lightbin_result lightbin_shader_edges(const lightbin_view* view, lightbin_edges* edges, std::size_t capacity) {
    return lightbin::c::write_array<lightbin::shader_edges>(view, "view", edges, capacity, "edges");
}

lightbin_result lightbin_shader_slabs(const lightbin_slices* slices, lightbin_edges* slabs, std::size_t capacity) {
    return lightbin::c::write_array<lightbin::shader_slabs>(slices, "slices", slabs, capacity, "slabs");
}

}  // extern "C"
