// SPDX-License-Identifier: MIT
// Stability: settled.
// The errors that a running program can meet, one value per cause, and a sentence for each.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Why a call of this library refused its input. to_string() has a sentence that names the likely cause of each. The
/// numbers are those of lightbin_error in lightbin.h.
enum class ErrorCode : std::uint8_t {
    // View::from_projection
    matrix_not_finite = 100,
    not_a_projection,
    projection_transposed,
    eye_not_at_origin,
    image_axes_rotated,
    looks_along_x,
    looks_along_y,
    no_near_plane,
    near_plane_too_close,
    depth_range_not_finite,
    degenerate_scale,
    image_offset_out_of_range,
    viewport_out_of_range,
    tile_size_out_of_range,
    tile_count_out_of_range,
    // lights
    view_matrix_not_affine,
    view_matrix_transposed,
    too_many_lights,
    // light grid
    too_many_entries,
    too_many_pairs,
    range_buffer_too_small,
    id_buffer_too_small,
    grids_differ,
    // Z bounds
    z_bounds_too_small,
    depth_buffer_too_small,
    samples_out_of_range,
    row_pitch_too_small,
    // slices
    no_slices,
    slice_range_empty,
    slices_do_not_ascend,
    too_many_cells,
    // arrays with one element per light
    too_few_weights,
    light_buffer_too_small,
    // encodings and shader text
    ids_too_narrow,
    list_buffer_too_small,
    capacity_unknown,
    block_size_unknown,
    uniform_block_too_small,
    no_storage_buffers,
    no_texel_buffers,
    slot_out_of_range,
    views_out_of_range,
    no_sets,
    no_push_constants,
    no_multisample_textures,
    no_such_slicing_shader,
    no_wave_operations,
    texture_width_out_of_range,
    bindings_overlap,
    not_a_prefix,
    // light grids made on the GPU
    too_many_slices,
    view_matrix_distorts,
    scratch_too_large,
    // lights relative to an eye
    eye_not_finite,
};

namespace detail {

/// A sentence for each ErrorCode, in the order of their values. Users of C and of JavaScript read them, too: an option
/// is called by its bare name, and no function is named.
inline constexpr const char* error_sentences[] = {
    "the projection matrix has a NaN or infinite entry",
    ("the matrix is neither a perspective nor an orthographic projection: its w row must read z alone, or be a "
     "positive constant alone. Pass the projection alone, not projection times view (the view matrix goes with lights "
     "that are in world space)"),
    ("the matrix is a projection when it is transposed: give the layout that its numbers have in memory, row major or "
     "column major"),
    ("the perspective matrix does not have its eye at the origin of view space: pass the projection alone, not "
     "projection times view (the view matrix goes with lights that are in world space)"),
    ("the projection rotates or shears the image (its x row reads y, its y row reads x, or an orthographic row "
     "reads z). Pass the projection alone, not projection times view, and not the view matrix; where the projection "
     "itself turns the image by other angles than 90, 180 and 270 degrees, apply that to the pixels"),
    ("the projection looks along x of view space, and must look along z: give its columns, and the rows of the "
     "world-to-view matrix, in the order y, z, x, w, and lights in view space the coordinates y, z, x. But if this is "
     "the view matrix, pass the projection in its place"),
    ("the projection looks along y of view space, as with z up in Panda3D, and must look along z: give its columns, "
     "and the rows of the world-to-view matrix, in the order x, z, y, w, and lights in view space the coordinates x, z, "
     "y. But if this is the view matrix, pass the projection in its place"),
    ("the perspective projection has no near plane in front of the eye: was it made with a near distance of 0 or "
     "less? Check the matrix's z row and the option clip_depth"),
    "the near plane is closer to the eye than 2^-126, the least normal float: move it away, or use smaller units",
    ("the orthographic projection's near and far plane must be at depths that floats hold: check the matrix's z "
     "row, which must read z"),
    "the projection scales x or y by zero, or by more than 2^80 or less than 2^-80 tiles a unit",
    ("the projection moves the image by more than 2^80 tiles in x or y: check the x and y of the matrix's third "
     "column, or of an orthographic one's fourth"),
    "the viewport's sides must be 0 to {available} pixels, and one is {given}",
    "the tile size must be at least 1 pixel, and is {given}; it is 0 of a view that numbers of tiles were given for",
    ("the options columns and rows must both be 1 to {available}, or both 0, and max_tiles 0 or more, and one is "
     "{given}"),
    ("the world-to-view matrix is not affine: its entries must be finite and its last row 0 0 0 1. Pass the view "
     "matrix alone, not projection times view"),
    ("the world-to-view matrix is transposed, its last column is 0 0 0 1: give the layout that its numbers have in "
     "memory, row major or column major"),
    ("{needed} lights are too many, {available} is the limit for ids of this width: choose a wider type by the option "
     "ids, or use fewer lights"),
    ("the light index list, or masks, may need {needed} entries, and 32-bit offsets reach {available}: use larger "
     "tiles, fewer slices or fewer lights"),
    "the lights meet slices {needed} times, and binning counts to {available}: use fewer slices or fewer lights",
    "the buffer for list ranges holds {available} ranges, and {needed} are needed",
    "the buffer for light ids holds {available} ids and {needed} are needed",
    ("grids that share buffers must have the same numbers of columns and rows of tiles and of slices: give their "
     "views the same viewport and tile size, and bin with the same slices"),
    "a Z bounds buffer holds {available} tiles, and the view has {needed}",
    "the depth buffer holds {available} samples and {needed} are needed",
    "a depth buffer has 1 to 8 samples a pixel, not {given}",
    "the depth buffer's row pitch is {available} samples and a row of pixels has {needed}",
    "there must be at least 1 slice, not {given}",
    ("two or more slices need a range of finite depths: 0 < first < last if they are exponential, begin < end if they "
     "are linear"),
    ("the boundaries of slices must be finite and ascend, and boundary {needed}, counted from 0, does not (if they "
     "are exponential or linear: too few floats lie in their range for so many slices)"),
    ("tiles times slices (of all views) are {needed} cells, and 32-bit numbers reach {available}: use larger tiles or "
     "fewer slices"),
    "a budget needs a weight for each of the {needed} lights that were binned, and was given {available}",
    "the buffer with one element per light has {available}, and {needed} lights were binned",
    "the lists' format numbers {available} lights and {needed} are needed: use wider ids",
    "the buffer for the encoded lists holds {available} bytes and {needed} are needed",
    "sentinel lists need the option capacity, the lights a tile can hold",
    ("uniform blocks have a fixed size: give the option max_tiles, for lists with offsets and counts max_entries, and "
     "for slicing max_slices"),
    ("a uniform block would need {needed} bytes and holds {available}: use larger tiles, narrower ids or another "
     "storage, or raise the option uniform_block_bytes to what the device has"),
    ("GLSL 3.30 and GLSL ES 3.00 have no storage buffers and no compute shaders: read the lists from a buffer "
     "texture (not ES), a 2D texture or a uniform block, reduce depth in a fragment shader, and bin lights on the CPU"),
    "GLSL ES and WGSL have no buffer textures: use a 2D texture, a uniform block or (not ES 3.00) a storage buffer",
    "a binding and a set must be 0 or more, and one is {given}",
    "the option views must be 1 to {available}, and is {given}",
    "this language has no descriptor sets, register spaces or groups: each set must be 0, and one is {given}",
    "push constants are Vulkan GLSL's: leave the option push_constants off",
    "GLSL ES 3.00 has no multisample textures: resolve the depth buffer first",
    ("lists that are built on the GPU are of tiles or of clusters, not of z-bins; masks are of tiles or of z-bins, not "
     "of clusters, and have no depth test"),
    "wave loops go over masks, and need GLSL 4.30, ES 3.10, Vulkan, HLSL 6 (the language hlsl_5_1) or WGSL",
    "the option texture_width must be 1 to {available} texels, and is {needed}",
    "two resources of the shader are bound to binding {needed} of set {available}",
    ("the option prefix must begin a name in every language: a letter, then letters, digits and single "
     "underscores, 1000 at most, not gl_ or GL_, and not vola, which would make volatile"),
    "a grid that is built on the GPU has at most {available} slices, not {given}",
    ("the world-to-view matrix distorts lengths by more than 32, or scales them by more than 2^20 or less than 2^-20: "
     "transform the lights to view space before they are culled"),
    ("the passes would need {needed} bytes of scratch memory, and their 32-bit indices reach {available}: use larger "
     "tiles, fewer slices or fewer lights"),
    "the eye, in world space, must be three finite numbers, and one is NaN or infinite",
};
static_assert(sizeof error_sentences / sizeof *error_sentences == static_cast<int>(ErrorCode::eye_not_finite) - 99);

}  // namespace detail

/// Returns one English sentence that names the cause and a remedy. Placeholders {needed}, {available} and {given}
/// stand for the numbers of an Error, which Error::message() fills in; {given} is Error::needed as a signed number.
constexpr const char* to_string(ErrorCode code) {
    return code >= ErrorCode::matrix_not_finite && code <= ErrorCode::eye_not_finite
               ? detail::error_sentences[static_cast<int>(code) - 100]
               : "unknown error";
}

}}  // namespace lightbin
