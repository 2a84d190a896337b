// SPDX-License-Identifier: MIT
// The C side's shader texts that read lists or reduce depth buffers, and the data that the shaders read.
#pragma once

#include <lightbin/detail/c/grids.hpp>

#include <lightbin/shader.hpp>
#include <lightbin/shader_reduce.hpp>

struct lightbin_shader {
    lightbin::ShaderText value;
};

namespace lightbin {
namespace c {

/// Makes a handle of the text that make() returns.
template <class Make>
lightbin_result make_shader(lightbin_shader** shader, const lightbin_result& checked, const Make& make) {
    return call_if(first_error(check_pointers({{shader, "shader"}}), checked), [&] {
        Result<ShaderText> made = make();
        return made ? make_handle(shader, std::move(*made)) : refused(made.error());
    });
}

inline lightbin_result read_member(const char* given, std::string_view& known, const char*) {
    if (given != nullptr) known = given;
    return succeeded();
}
inline lightbin_result read_member(const lightbin_slot& given, ShaderSlot& known, const char*) {
    known = {given.binding, given.set};
    return succeeded();
}

/// Writes the constants that make() returns of a view to the caller's struct, which has the layout of the library's.
template <auto make, class To, class... Arguments>
lightbin_result write_constants(const lightbin_view* view, To* to, const Arguments&... arguments) {
    static_assert(sizeof(To) == sizeof(make(view->value, arguments...)));
    return call_if(check_pointers({{view, "view"}, {to, "constants"}}),
                   [&] { return write_numbers(make(view->value, arguments...), to); });
}

/// Writes the array that make() returns of a view or slices to the caller's memory.
template <auto make, class From, class To>
lightbin_result write_array(const From* from, const char* from_name, To* to, std::size_t capacity,
                            const char* to_name) {
    return call_if(check_pointers({{from, from_name}}), [&] {
        const auto made = make(from->value);
        return write_items(made.data(), made.size(), to, capacity, to_name);
    });
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_shader_snippet(const lightbin_snippet_options* options,
                                        lightbin_shader** shader) {
    using namespace lightbin::c;
    lightbin_snippet_options given;
    lightbin::SnippetOptions known;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(
            LIGHTBIN_MEMBER(language), LIGHTBIN_MEMBER(storage), LIGHTBIN_MEMBER(slicing), LIGHTBIN_MEMBER(format),
            LIGHTBIN_MEMBER(prefix), LIGHTBIN_MEMBER(tile_size), LIGHTBIN_MEMBER(tiles_in_uniform_block),
            LIGHTBIN_MEMBER(packed_ids), LIGHTBIN_MEMBER(flip_y), LIGHTBIN_MEMBER(viewport_corner),
            LIGHTBIN_MEMBER(heat_map), LIGHTBIN_MEMBER(wave_loop), LIGHTBIN_MEMBER(view_check),
            LIGHTBIN_MEMBER(list_check), LIGHTBIN_MEMBER(window), LIGHTBIN_MEMBER(push_constants),
            LIGHTBIN_MEMBER(texture_width), LIGHTBIN_MEMBER(max_tiles), LIGHTBIN_MEMBER(max_entries),
            LIGHTBIN_MEMBER(max_slices), LIGHTBIN_MEMBER(uniform_block_bytes), LIGHTBIN_MEMBER(views),
            LIGHTBIN_MEMBER(masks), LIGHTBIN_MEMBER(columns_and_rows), LIGHTBIN_MEMBER(turned));
    if (result.error == LIGHTBIN_OK && given.slots_given != 0)
        first_error(LIGHTBIN_MEMBER(tiles), LIGHTBIN_MEMBER(lists), LIGHTBIN_MEMBER(grid), LIGHTBIN_MEMBER(slices),
                    LIGHTBIN_MEMBER(bins), LIGHTBIN_MEMBER(view));
    return make_shader(shader, result, [&] { return lightbin::shader_snippet(known); });
}

void lightbin_shader_destroy(lightbin_shader* shader) {
    delete shader;
}

const char* lightbin_shader_text(const lightbin_shader* shader) {
    return shader != nullptr ? shader->value.text.c_str() : nullptr;
}

std::size_t lightbin_shader_binding_count(const lightbin_shader* shader) {
    return shader != nullptr ? shader->value.bindings.size() : 0;
}

lightbin_result lightbin_shader_binding(const lightbin_shader* shader, std::size_t index,
                                        lightbin_binding* binding) {
    using namespace lightbin::c;
    return call_if(first_error(check_pointers({{shader, "shader"}}), check_size(binding, "binding")), [&] {
        const std::vector<lightbin::ShaderBinding>& bindings = shader->value.bindings;
        if (index >= bindings.size()) return refused(LIGHTBIN_NOT_A_VALUE, "index", index, bindings.size());
        const lightbin::ShaderBinding& from = bindings[index];
        const lightbin::GlFormat gl = gl_format(from.format);
        return write({0, static_cast<std::int32_t>(from.resource), from.name.c_str(),
                      {from.slot.binding, from.slot.set}, from.stride, from.bytes, from.width, gl.internal, gl.layout,
                      gl.type, vk_format(from.format), dxgi_format(from.format), webgpu_format(from.format)},
                     binding);
    });
}

lightbin_result lightbin_get_grid_constants(const lightbin_view* view, std::int32_t corner_x, std::int32_t corner_y,
                                            lightbin_grid_constants* constants) {
    return lightbin::c::write_constants<lightbin::grid_constants>(view, constants, corner_x, corner_y);
}

lightbin_result lightbin_get_view_constants(const lightbin_view* view, float tolerance,
                                            lightbin_view_constants* constants) {
    return lightbin::c::write_constants<lightbin::view_constants>(view, constants, tolerance);
}

lightbin_result lightbin_shader_slices(const lightbin_slices* slices, std::uint32_t* words, std::size_t capacity) {
    return lightbin::c::write_array<lightbin::shader_slices>(slices, "slices", words, capacity, "words");
}

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
