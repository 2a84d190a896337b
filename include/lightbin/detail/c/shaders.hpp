// SPDX-License-Identifier: MIT
// The C side's shader texts that read lists, and the data that the shaders read.
#pragma once

#include <lightbin/detail/c/grids.hpp>

#include <lightbin/shader.hpp>

struct lightbin_shader {
    lightbin::ShaderText value;
};

namespace lightbin {
namespace c {

/// Makes a handle of the text that make() returns.
template <class Make> lightbin_result make_shader(lightbin_shader** shader, const Make& make) {
    return guarded([&] {
        Result<ShaderText> made = make();
        return made ? make_handle(shader, std::move(*made)) : refused(made.error());
    });
}

inline std::string_view prefix_of(const char* prefix) {
    return prefix != nullptr ? prefix : "lightbin_";
}

inline ShaderSlot slot_of(const lightbin_slot& slot) {
    return {slot.binding, slot.set};
}

/// Copies `needed` items to the caller's memory and writes their number to *count, if that is given.
template <class From, class To>
lightbin_result write_items(const From* from, std::size_t needed, To* to, std::size_t capacity,
                            std::size_t* count, const char* name) {
    static_assert(sizeof(From) == sizeof(To));
    if (count != nullptr) *count = needed;
    if (to == nullptr && needed > 0 && capacity > 0) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    if (capacity < needed) return refused(LIGHTBIN_BUFFER_TOO_SMALL, name, needed, capacity);
    if (needed > 0) std::memcpy(to, from, needed * sizeof *from);
    return succeeded();
}

/// Writes the constants that make() returns of a view to the caller's struct, which has the layout of the library's.
template <auto make, class To, class... Arguments>
lightbin_result write_constants(const lightbin_view* view, To* to, const Arguments&... arguments) {
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (to == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "constants");
    const auto made = make(view->value, arguments...);
    static_assert(sizeof made == sizeof *to);
    std::memcpy(to, &made, sizeof made);
    return succeeded();
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_shader_snippet(const lightbin_snippet_options* options,
                                        lightbin_shader** shader) {
    using namespace lightbin::c;
    if (shader == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "shader");
    lightbin_snippet_options given;
    lightbin_result result = read(options, given, "options");
    if (result.error != LIGHTBIN_OK) return result;
    lightbin::ShaderOptions known;
    result = first_error(check_value(given.language, LIGHTBIN_WGSL, "options.language"),
                         check_value(given.storage, LIGHTBIN_BYTE_ADDRESS, "options.storage"),
                         check_value(given.slicing, LIGHTBIN_Z_BINS, "options.slicing"));
    if (result.error == LIGHTBIN_OK && given.format != nullptr)
        result = read_format(given.format, known.format, "options.format");
    if (result.error != LIGHTBIN_OK) return result;
    known.language = static_cast<lightbin::ShaderLanguage>(given.language);
    known.storage = static_cast<lightbin::ListStorage>(given.storage);
    known.slicing = static_cast<lightbin::Slicing>(given.slicing);
    known.prefix = prefix_of(given.prefix);
    known.tile_size = given.tile_size;
    known.tiles_in_uniform_block = given.tiles_in_uniform_block != 0;
    known.packed_ids = given.packed_ids != 0;
    known.flip_y = given.flip_y != 0;
    known.viewport_corner = given.viewport_corner != 0;
    known.heat_map = given.heat_map != 0;
    known.wave_loop = given.wave_loop != 0;
    known.view_check = given.view_check != 0;
    known.list_check = given.list_check != 0;
    known.window = given.window != 0;
    known.push_constants = given.push_constants != 0;
    if (given.texture_width != 0) known.texture_width = given.texture_width;
    if (given.views != 0) known.views = given.views;
    known.max_tiles = given.max_tiles;
    known.max_entries = given.max_entries;
    known.max_slices = given.max_slices;
    if (given.uniform_block_bytes != 0) known.uniform_block_bytes = given.uniform_block_bytes;
    if (given.slots_given != 0) {
        known.tiles = slot_of(given.tiles);
        known.lists = slot_of(given.lists);
        known.grid = slot_of(given.grid);
        known.slices = slot_of(given.slices);
        known.bins = slot_of(given.bins);
        known.view = slot_of(given.view);
    }
    return make_shader(shader, [&] { return lightbin::shader_snippet(known); });
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
    if (shader == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "shader");
    const lightbin_result result = check_size(binding, "binding");
    if (result.error != LIGHTBIN_OK) return result;
    const std::vector<lightbin::ShaderBinding>& bindings = shader->value.bindings;
    if (index >= bindings.size()) return refused(LIGHTBIN_NOT_A_VALUE, "index", index, bindings.size());
    const lightbin::ShaderBinding& from = bindings[index];
    const lightbin::GlFormat gl = gl_format(from.format);
    write(lightbin_binding{0,
                           static_cast<std::int32_t>(from.resource),
                           from.name.c_str(),
                           {from.slot.binding, from.slot.set},
                           from.stride,
                           from.bytes,
                           from.width,
                           gl.internal,
                           gl.layout,
                           gl.type,
                           vk_format(from.format),
                           dxgi_format(from.format),
                           webgpu_format(from.format)},
          binding);
    return result;
}

lightbin_result lightbin_shader_grid(const lightbin_view* view, std::int32_t corner_x, std::int32_t corner_y,
                                     lightbin_grid_constants* constants) {
    return lightbin::c::write_constants<lightbin::shader_grid>(view, constants, corner_x, corner_y);
}

lightbin_result lightbin_shader_view(const lightbin_view* view, float tolerance,
                                     lightbin_view_constants* constants) {
    return lightbin::c::write_constants<lightbin::shader_view>(view, constants, tolerance);
}

lightbin_result lightbin_shader_slices(const lightbin_slices* slices, std::uint32_t* words,
                                       std::size_t capacity) {
    using namespace lightbin::c;
    if (slices == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "slices");
    return guarded([&] {
        const std::vector<std::uint32_t> made = lightbin::shader_slices(slices->value);
        return write_items(made.data(), made.size(), words, capacity, nullptr, "words");
    });
}

}  // extern "C"
