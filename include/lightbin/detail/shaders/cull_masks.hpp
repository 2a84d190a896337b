// SPDX-License-Identifier: MIT
// The text of the compute pass `masks`, which makes the contents of LightMasks::words() out of the lights' rectangles.
// A light's number in the masks is its position in the light buffer, so the CPU knows their size beforehand.
#pragma once

#include <lightbin/detail/shaders/cull_lists.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Writes the text of the pass `masks`. Each invocation writes one word: that of 32 lights in the mask of a column, in
/// the empty mask or in the mask of a row, or the id of a light. The invocations of the same 32 lights are side by
/// side, in groups of 128, so that they read the same 32 records.
inline void add_masks(ShaderWriter& writer, const CullOptions& options) {
    declare_scratch(writer, options);
    writer.declare_storage("lists", "uint", "writeonly", options.lists, 4);
    add_total_lights(writer);
    writer.add(R"(
// The word of a column or row: the lights from `first` on whose rectangles reach it.
uint $mask_of(uint mask, uint first) {
    uint shift = 0u;
    uint tile = mask;
    if (mask >= $grid.x) {
        shift = 16u;
        tile = mask - $grid.x - 1u;  // of the empty mask 2^32 - 1, which no rectangle reaches
    }
    uint count = min($segments.x - first, 32u);
    uint bits = 0u;
    for (uint i = 0u; i < count; i += 1u) {
        uint at = @totals + (first + i) * @record_words;
        uint begin = ($scratch[at] >> shift) & 0xffffu;
        uint end = ($scratch[at + 1u] >> shift) & 0xffffu;
        if (begin <= tile && tile <= end) { bits |= 1u << i; }
    }
    return bits;
}

void $run(uvec2 group, uint thread) {
    uint number = group.y * 32768u + group.x;
    uint words = ($segments.x + 31u) >> 5u;
    uint masks = $grid.x + 1u + $grid.y;
    uint groups = (masks + 159u) >> 7u;
    uint word = number / groups;
    uint mask = (number % groups) * 128u + thread;
    if (word < words && mask < masks) { $lists[1u + mask * words + word] = $mask_of(mask, word * 32u); }
    if (word < words && mask >= masks && mask < masks + 32u) {
        uint light = word * 32u + mask - masks;
        $lists[1u + masks * words + light] = light;
    }
    if (number == 0u) {
        if (thread == 0u) { $lists[0] = words; }
        $total_lights(thread);
    }
}
)");
}

}}}  // namespace lightbin::detail
