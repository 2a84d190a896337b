// SPDX-License-Identifier: MIT
// Stability: may change.
// The options of cull_shader(), and what plan_cull() and shader_edges() return: all three are in shader_cull.hpp, which
// includes this header.
#pragma once

#include <lightbin/options.hpp>
#include <lightbin/shader_text.hpp>

#include <string_view>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The passes, in the order of their dispatches. Each reads what the passes before it wrote, so there is a barrier
/// between any two: one that makes the writes of storage buffers visible to the reads of compute shaders.
enum class CullPass : std::uint8_t {
    project,  ///< finds each light's rectangle of tiles, and the blocks of tiles that it meets
    count,    ///< counts the lights of each cell
    sums,     ///< adds the counts up, over 128 cells at a time
    offsets,  ///< adds the sums up, and finds the total
    fill,     ///< writes the lists
    masks,    ///< writes masks of the columns and rows of tiles, in place of the passes `count` to `fill`
};
/// The passes that make lists.
inline constexpr CullPass cull_passes[] = {CullPass::project, CullPass::count, CullPass::sums, CullPass::offsets,
                                           CullPass::fill};
/// The passes that make masks.
inline constexpr CullPass cull_mask_passes[] = {CullPass::project, CullPass::masks};

constexpr const char* to_string(CullPass value) {
    return detail::name_at(value, {"project", "count", "sums", "offsets", "fill", "masks"});
}

/// What the lights in the buffer are.
enum class CullKind : std::uint8_t {
    sphere,
    spot,  ///< those with a half angle beyond 138 degrees, such as Spot::whole() makes, count as whole spheres
    box,
    /// Spheres, behind them spots, and behind them boxes, as many of each as CullCapacity has room for. Ids number them
    /// in this order, as they do with lights() on the CPU.
    mixed,
};

constexpr const char* to_string(CullKind value) {
    return detail::name_at(value, {"sphere", "spot", "box", "mixed"});
}

/// Where the numbers of a light lie in the caller's buffer: how many words of 32 bits after the light's first word. The
/// defaults are for an array of Sphere, or of vec4s, and with CullKind::mixed for arrays of Sphere, Spot and Box. For
/// an array of Spot alone set the stride to 8, for one of Box to 17.
struct CullLayout {
    std::uint32_t stride = 4;  ///< from one light to the next
    std::uint32_t centre = 0;  ///< x, y and z, side by side
    std::uint32_t radius = 3;
    std::uint32_t axis = 4;         ///< of a spot: the first of the three words x, y and z of its axis
    std::uint32_t cosine = 7;       ///< of a spot: the cosine of its half angle
    std::uint32_t box_centre = 4;   ///< of a box: the first of the three words of its centre
    std::uint32_t half_axes = 7;    ///< of a box: the first of the nine words of its half axes
    std::uint32_t taper = 16;       ///< of a box: Box::taper
    std::uint32_t spot_stride = 8;  ///< with CullKind::mixed, words from one spot to the next; `stride` is for spheres
    std::uint32_t box_stride = 17;  ///< with CullKind::mixed, words from one box to the next
};

/// What cull_shader() generates. All passes of a build need the same options, those of CullPass apart. Every device
/// with OpenGL ES 3.1, Vulkan or WebGPU can run them: each pass uses at most four storage buffers, by default at
/// bindings below 4, 128 invocations in a group and 9 KB of shared memory; none uses subgroups, and no group waits
/// for another.
struct CullOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    CullKind kind = CullKind::sphere;
    CullLayout lights_at = {};
    bool world_space = false;      ///< the lights are in world space, and are transformed to view space
    bool count_in_buffer = false;  ///< reads the number of lights from the buffer `light_count`
    /// With count_in_buffer: the index of the word that holds the number, with CullKind::mixed that of spheres, behind
    /// which are those of spots and boxes.
    std::uint32_t count_at = 0;

    IdWidth ids = IdWidth::u32;              ///< u32, or u16: then each word of `lists` holds two ids
    bool depth_test = false;
    Slicing slicing = Slicing::none;  ///< z_bins is an error
    bool max_only = false;      ///< tests with the maximum Z bound alone, for transparent surfaces; not with clusters
    /// With clusters: the cells whose slice does not meet their tile's Z bounds list no light. These are in `z_bounds`.
    bool bounded = false;
    bool orthographic = false;  ///< whether the view is orthographic: View::orthographic()

    /// The buffers; CullBytes has their sizes. Passes use slots in turn: no pass uses two buffers that have the
    /// same default.
    ShaderSlot lights = {0}, z_bounds = {0}, scratch = {1}, slices = {2}, tiles = {2}, light_count = {3}, lists = {3};
    ShaderSlot grid = {4};                  ///< the uniform block with the constants, laid out as CullConstants
    std::string_view prefix = "lightbin_";  ///< every name in the generated shader text begins with it
};

/// The numbers of lights and of list entries that the caller's buffers have room for.
struct CullCapacity {
    /// The number of lights, or with count_in_buffer the greatest number that there may be. With CullKind::mixed this
    /// counts the spheres alone.
    std::uint32_t lights = 0;
    std::uint32_t entries = 0;  ///< ids that fit in `lists`
    std::uint32_t spots = 0, boxes = 0;  ///< with CullKind::mixed, the same for spots and for boxes
};

/// The values of the constants. The uniform block `grid` has this layout, a vec4 or uvec4 a line.
struct CullConstants {
    std::uint32_t tiles_x, tiles_y, slices, entries;  // slices: of clusters, else 1; CullCapacity::entries
    /// Columns and rows of mask blocks; log2 of the tiles along a block's side, and of the slices in a block.
    std::uint32_t blocks_x, blocks_y, block_shift, slice_shift;
    // How many lights there is room for, how many segments they are divided into, and how many steps of 1024 lights a
    // segment has. The others are indices of words in `scratch` at which its arrays begin: a count for each 64 lights,
    // the masks of blocks, a count for each cell and segment, the range of each cell's list, and a sum for each 128
    // ranges. The array of lights begins behind CullTotals.
    std::uint32_t lights, segments, steps, groups;
    std::uint32_t masks, counts, ranges, sums;
    // The image axes, in tiles, as in ImageAxis. The margins are those of the GPU's arithmetic.
    float scale_x, offset_x, margin_x, limit_x;
    float scale_y, offset_y, margin_y, limit_y;
    float sign_x, sign_y, sign_z, depth_margin;
    float near_depth, front, back, near_fast;  // the near plane; both planes, moved outward; Camera::min_float_depth
    // The transform to view space, as in FloatTransform.
    float origin[3], stretch;
    float column_x[3], error_rate;
    float column_y[3], error_at_origin;
    float column_z[3], cone_error;
    float origin_image[3], max_distance;
    // With CullKind::mixed: the ids of the first spot and the first box, and the indices of the words in the buffer
    // `lights` at which they begin.
    std::uint32_t first_spot, first_box, spots_at, boxes_at;
};
static_assert(sizeof(CullConstants) == 14 * 16);  // it has no padding

/// The work groups of a dispatch, in x and y; z is 1. Neither exceeds 65,535.
struct CullGroups {
    std::uint32_t x = 1, y = 1;
};

/// The sizes of the buffers of a build, in bytes, each a multiple of 4 and at least 16. They need no initial content.
struct CullBytes {
    std::uint64_t scratch = 0;  ///< written and read by the passes; its first words are CullTotals afterwards
    std::uint64_t tiles = 0;    ///< a ListRange for each cell
    std::uint64_t lists = 0;    ///< the ids
    std::uint64_t masks = 0;    ///< what the pass `masks` writes to the buffer `lists`
};

/// What the passes leave in the first words of `scratch`.
struct CullTotals {
    std::uint32_t entries;   ///< of the complete lists, at most 2^32 - 1; undefined if there are masks
    std::uint32_t rejected;  ///< lights left out as bad input: see Sphere, Spot and Box
    std::uint32_t visible;   ///< lights in view
    /// How many were given, with CullKind::mixed of all kinds: with count_in_buffer, it may exceed CullCapacity.
    std::uint32_t lights;
};
static_assert(sizeof(CullTotals) == 16);

/// All that a program needs to run the passes for a view.
struct CullPlan {
    CullConstants constants = {};
    CullBytes bytes = {};
    CullGroups groups[std::size(cull_passes) + 1] = {};  ///< by CullPass
    /// Whether masks, in two dispatches, are meant for the lights that there is room for, rather than lists: up to
    /// 1,024 lights, without clusters and depth test.
    bool masks_suit = false;

    CullGroups groups_of(CullPass pass) const { return groups[static_cast<std::size_t>(pass)]; }
};

/// Two ends of an interval: the sides of a tile column or row as slopes (perspective) or view-space coordinates
/// (orthographic), or the view depths of a slice.
struct ShaderEdges {
    float low, high;
};

}}  // namespace lightbin
