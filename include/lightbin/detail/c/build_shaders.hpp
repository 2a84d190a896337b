// SPDX-License-Identifier: MIT
// The C side's shaders that reduce depth buffers and build grids on the GPU, and the data that they read.
#pragma once

#include <lightbin/detail/c/shaders.hpp>

#include <lightbin/shader_build.hpp>

extern "C" {

lightbin_result lightbin_reduce_shader(const lightbin_reduce_options* options,
                                       const lightbin_allocator* allocator, lightbin_shader** shader) {
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
    return make_shader(allocator, shader, [&] { return lightbin::reduce_shader(known); });
}

lightbin_result lightbin_shader_reduce(const lightbin_view* view, std::int32_t corner_x,
                                       std::int32_t corner_y, lightbin_reduce_constants* constants) {
    return lightbin::c::write_constants<lightbin::shader_reduce>(view, constants, corner_x, corner_y);
}

lightbin_result lightbin_build_shader(const lightbin_build_options* options,
                                      const lightbin_allocator* allocator, lightbin_shader** shader) {
    using namespace lightbin::c;
    if (shader == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "shader");
    lightbin_build_options given;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(check_value(given.language, LIGHTBIN_WGSL, "options.language"),
                             check_value(given.pass, LIGHTBIN_FILL, "options.pass"),
                             check_value(given.depth_test, LIGHTBIN_SPLIT_BOX, "options.depth_test"),
                             check_value(given.slicing, LIGHTBIN_Z_BINS, "options.slicing"));
    if (result.error != LIGHTBIN_OK) return result;
    lightbin::BuildShaderOptions known;
    known.language = static_cast<lightbin::ShaderLanguage>(given.language);
    known.pass = static_cast<lightbin::BuildPass>(given.pass);
    known.depth_test = static_cast<lightbin::DepthTest>(given.depth_test);
    known.slicing = static_cast<lightbin::Slicing>(given.slicing);
    known.max_only = given.max_only != 0;
    known.orthographic = given.orthographic != 0;
    known.push_constants = given.push_constants != 0;
    known.prefix = prefix_of(given.prefix);
    if (given.slots_given != 0) {
        known.footprints = slot_of(given.footprints);
        known.z_bounds = slot_of(given.z_bounds);
        known.tiles = slot_of(given.tiles);
        known.lists = slot_of(given.lists);
        known.total = slot_of(given.total);
        known.grid = slot_of(given.grid);
    }
    return make_shader(allocator, shader, [&] { return lightbin::build_shader(known); });
}

lightbin_result lightbin_shader_build(const lightbin_view* view, std::uint32_t footprints,
                                      std::uint32_t capacity, std::int32_t slices,
                                      lightbin_build_constants* constants) {
    return lightbin::c::write_constants<lightbin::shader_build>(view, constants, footprints, capacity,
                                                                slices);
}

lightbin_result lightbin_shader_footprints(const lightbin_view* view, const lightbin_lights* lights,
                                           lightbin_shader_footprint* footprints, std::size_t capacity,
                                           std::size_t* count) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    CallLights known;
    lightbin_result result = read_lights(lights, known);
    if (result.error != LIGHTBIN_OK) return result;
    if (known.overlaps({footprints, lightbin::detail::product_of_sizes(capacity, sizeof *footprints)}))
        return refused(LIGHTBIN_OVERLAP, "footprints");
    return guarded(view->memory, [&] {
        std::vector<lightbin::ShaderFootprint> all;
        std::uint32_t first_id = 0;
        lightbin::detail::for_each_array(known.all(), [&](const auto& array) {
            if (result.error != LIGHTBIN_OK) return;
            const auto made = lightbin::shader_footprints(view->value, array);
            if (!made) {
                result = refused(made.error());
                return;
            }
            for (lightbin::ShaderFootprint footprint : *made) {
                footprint.id += first_id;
                all.push_back(footprint);
            }
            first_id += static_cast<std::uint32_t>(array.array.size());
        });
        if (result.error != LIGHTBIN_OK) return result;
        return write_items(all.data(), all.size(), footprints, capacity, count, "footprints");
    });
}

lightbin_result lightbin_shader_edges(const lightbin_view* view, lightbin_edges* edges, std::size_t capacity,
                                      std::size_t* count) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    return guarded(view->memory, [&] {
        const auto made = lightbin::shader_edges(view->value);
        return write_items(made.data(), made.size(), edges, capacity, count, "edges");
    });
}

lightbin_result lightbin_shader_slabs(const lightbin_slices* slices, lightbin_edges* slabs,
                                      std::size_t capacity, std::size_t* count) {
    using namespace lightbin::c;
    if (slices == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "slices");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    return guarded(slices->memory, [&] {
        const auto made = lightbin::shader_slabs(slices->value);
        return write_items(made.data(), made.size(), slabs, capacity, count, "slabs");
    });
}

}  // extern "C"
