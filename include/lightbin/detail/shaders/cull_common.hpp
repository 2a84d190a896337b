// SPDX-License-Identifier: MIT
// What the passes that make a light grid on the GPU have in common: the refusal of options, the constants, the buffer
// `scratch`, and how blocks of tiles are marked.
#pragma once

#include <lightbin/cull_options.hpp>
#include <lightbin/detail/shaders/writer.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

// Numbers that the texts and the plan share.
/// The most blocks of tiles with a mask of their lights: the bits of 64 lights then take 8 KB of shared memory.
inline constexpr std::uint32_t cull_max_blocks = 1024;
inline constexpr std::uint32_t cull_max_slices = 0xffff;  ///< a word has a light's first and last slice, 16 bits each

/// Returns the first error among the options, or nothing.
inline std::optional<Error> refuse_cull(const CullOptions& options) {
    return refuse_common(
        options,
        {options.lights, options.z_bounds, options.scratch, options.slices, options.tiles, options.light_count,
         options.lists, options.grid},
        {{!Dialect{options.language}.storage_buffers, {ErrorCode::no_storage_buffers}},
         {options.ids != IdWidth::u16 && options.ids != IdWidth::u32, {ErrorCode::ids_too_narrow, 0, 256}},
         {options.slicing == Slicing::z_bins, {ErrorCode::no_such_slicing_shader}}});
}

/// How many invocations a group of a pass has.
constexpr unsigned cull_threads(CullPass pass) {
    return pass == CullPass::sums || pass == CullPass::offsets || pass == CullPass::masks ? 128 : 64;
}

/// Returns the index of the first word of a light's sphere in its record in `scratch`. Before the sphere are the
/// light's rectangle of tiles (two words) and, with clusters, its slices (one word) or, with a depth test of tiles, the
/// least and the greatest view depth of a spot or box.
inline std::uint32_t cull_sphere_at(const CullOptions& options) {
    if (options.slicing == Slicing::clusters) return 3;
    return options.depth_test && options.kind != CullKind::sphere ? 4 : 2;
}

/// Returns where behind the begin of a light's sphere its half spaces end, of four words each: four around a spot, and
/// six around a box.
inline std::uint32_t cull_half_spaces_end(CullKind kind) {
    return kind == CullKind::sphere ? 4 : kind == CullKind::spot ? 20 : 28;
}

/// How many words of `scratch` a light takes. The sphere and the half spaces are for the depth test.
inline std::uint32_t cull_record_words(const CullOptions& options) {
    return cull_sphere_at(options) + (options.depth_test ? cull_half_spaces_end(options.kind) : 0);
}

/// Declares the members of CullConstants, without those that lights in view space don't need, and sets the conditions
/// and names that the texts of all passes use. In the buffer `scratch`, the words about the light with the number id
/// begin at the word totals + id * record_words, both names of the texts.
inline void declare_cull_constants(ShaderWriter& writer, const CullOptions& options) {
    const bool clusters = options.slicing == Slicing::clusters, mixed = options.kind == CullKind::mixed;
    writer.set({{"clusters", clusters}, {"depth_test", options.depth_test}, {"world_space", options.world_space},
                {"spots", options.kind == CullKind::spot || mixed}, {"balls", options.kind != CullKind::box},
                {"boxes", options.kind == CullKind::box || mixed}, {"mixed", mixed},
                {"shapes", options.kind != CullKind::sphere}, {"orthographic", options.orthographic},
                {"max_only", options.max_only && !clusters}, {"narrow", options.ids == IdWidth::u16},
                {"count_in_buffer", options.count_in_buffer}, {"bounded", clusters && options.bounded}});
    writer.set("totals", std::to_string(sizeof(CullTotals) / 4) + "u");
    writer.set("record_words", std::to_string(cull_record_words(options)) + "u");
    writer.set("sphere", std::to_string(cull_sphere_at(options)) + "u");
    // The numbers of layers of cells and, with 2^$blocks.w slices each, of mask blocks.
    writer.set("cell_layers", clusters ? "$grid.z" : "1u");
    writer.set("mask_layers", clusters ? "((($grid.z - 1u) >> $blocks.w) + 1u)" : "1u");
    writer.set("mask_blocks", "($blocks.x * $blocks.y * @mask_layers)");
    // Behind the masks: the first of the words that say which words of the masks have bits, see add_masks_of_group().
    writer.set("summaries", "($places.x + (($segments.x + 63u) >> 6u) * 2u * @mask_blocks)");
    writer.set("cells", clusters ? "$grid.x * $grid.y * $grid.z" : "$grid.x * $grid.y");
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"},   {"uvec4", "blocks"}, {"uvec4", "segments"},
                                             {"uvec4", "places"}, {"vec4", "axis_x"},  {"vec4", "axis_y"},
                                             {"vec4", "signs"},   {"vec4", "planes"}};
    if (options.world_space || mixed)
        for (const char* name : {"origin", "column_x", "column_y", "column_z", "origin_image"})
            constants.push_back({"vec4", name});
    if (mixed) constants.push_back({"uvec4", "kinds"});
    writer.declare_constants(constants, options.grid, false, 1, true);
}

inline void declare_scratch(ShaderWriter& writer, const CullOptions& options, bool atomic = false) {
    const char* const type = atomic && writer.dialect.webgpu ? "atomic<uint>" : "uint";
    writer.declare_storage("scratch", type, "", options.scratch, 4);
}

/// Adds `sum`, which adds two numbers and returns 2^32 - 1 if the sum overflows.
inline void add_saturated_sum(ShaderWriter& writer) {
    writer.add("\nuint $sum(uint a, uint b) {\n    return a + min(b, ~a);\n}\n");
}

/// Adds the functions by which a group of 64 threads finds the mask blocks that 64 lights meet: `clear_masks` before,
/// `mark` for each light in view, and `write_masks` after. A mask block is a block of tiles, see plan_blocks(), that
/// has a bitmask of the lights in it, 32 to a word. Of these words only those with bits are written: a word of summary
/// for each block and 32 words has a bit for each of them. Each group changes the bits of its own two words and no
/// others, so neither the order of groups nor what was there before makes a difference.
inline void add_masks_of_group(ShaderWriter& writer) {
    writer.declare_shared("block_bits", 2 * cull_max_blocks, true);
    writer.add(R"(
void $store_word(uint at, uint word) {
    atomicStore(&$scratch[at], word);
}

void $clear_masks(uint thread) {
    uint words = 2u * @mask_blocks;
    for (uint i = thread; i < words; i += 64u) { atomicStore(&$block_bits[i], 0u); }
}

void $mark(uint thread, uvec2 columns, uvec2 rows, uvec2 layers) {
    uint row_begin = (thread >> 5u) * @mask_blocks;
    uint bit = 1u << (thread & 31u);
    for (uint z = layers.x >> $blocks.w; z <= layers.y >> $blocks.w; z += 1u) {     @if clusters
    {                                                                               @if !clusters
        uint z = 0u;                                                                @if !clusters
        for (uint y = rows.x >> $blocks.z; y <= rows.y >> $blocks.z; y += 1u) {
            uint row = row_begin + (z * $blocks.y + y) * $blocks.x;
            for (uint x = columns.x >> $blocks.z; x <= columns.y >> $blocks.z; x += 1u) {
                atomicOr(&$block_bits[row + x], bit);
            }
        }
    }
}

void $write_masks(uint number, uint thread) {
    uint blocks = @mask_blocks;
    uint begin = $places.x + number * 2u * blocks;
    uint shift = (number & 15u) * 2u;
    uint own = 3u << shift;
    if (number + 1u >= ($segments.x + 63u) >> 6u) { own = 0xffffffffu << shift; }  // no lights follow
    for (uint i = thread; i < blocks; i += 64u) {
        uint low = atomicLoad(&$block_bits[i]);
        uint high = atomicLoad(&$block_bits[blocks + i]);
        if (low != 0u) { $store_word(begin + i, low); }
        if (high != 0u) { $store_word(begin + blocks + i, high); }
        uint at = @summaries + (number >> 4u) * blocks + i;
        atomicAnd(&$scratch[at], ~own);
        uint bits = (min(low, 1u) | (min(high, 1u) << 1u)) << shift;
        if (bits != 0u) { atomicOr(&$scratch[at], bits); }
    }
}
)");
}

}}}  // namespace lightbin::detail
