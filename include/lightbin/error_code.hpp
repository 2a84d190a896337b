// SPDX-License-Identifier: MIT
// The errors that a running program can meet, one value per cause.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Why a call of this library refused its input. to_string() has a sentence that names the likely cause of each.
enum class ErrorCode : std::uint8_t {
    // View::from_projection
    matrix_not_finite,
    not_a_projection,
    projection_transposed,
    eye_not_at_origin,
    image_axes_rotated,
    oblique_depth,
    no_near_plane,
    near_plane_too_close,
    depth_range_not_finite,
    degenerate_scale,
    image_offset_out_of_range,
    viewport_out_of_range,
    tile_size_out_of_range,
    // lights
    view_matrix_not_affine,
    view_matrix_transposed,
    too_many_lights,
    // light grid
    too_many_entries,
    too_many_list_places,
    range_buffer_too_small,
    id_buffer_too_small,
    // Z bounds
    z_bounds_too_small,
    depth_buffer_too_small,
    samples_out_of_range,
    row_pitch_too_small,
    no_transparent_max,
    // slices
    no_slices,
    slice_range_empty,
    slices_do_not_ascend,
    too_many_cells,
    // encodings and shader text
    ids_too_narrow,
    list_buffer_too_small,
    bit_buffer_too_small,
    capacity_unknown,
    max_lights_unknown,
    block_size_unknown,
    uniform_block_too_small,
    no_storage_buffers,
    no_texel_buffers,
    no_byte_address_buffers,
    slot_out_of_range,
    no_sets,
    no_push_constants,
    no_multisample_textures,
    no_split_box_shader,
    no_such_slicing_shader,
    no_wave_operations,
    texture_width_out_of_range,
    bindings_overlap,
    not_a_prefix,
};

/// Returns one English sentence that names the cause and a remedy. Placeholders {needed}, {available} and {given}
/// stand for the numbers of an Error, which Error::message() fills in; {given} is Error::needed as a signed number.
constexpr const char* to_string(ErrorCode code);

}}  // namespace lightbin
