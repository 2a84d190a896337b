// SPDX-License-Identifier: MIT
// The passes count, sums, offsets and fill: they make the lists of all cells from the lights' rectangles and masks.
//
// A group of 64 invocations has the cells of 8x8 tiles, one each. It stages the lights of the mask block around these
// tiles in shared memory, by ascending id, 32 words of the mask at a time: each invocation reads half a word, and notes
// for each of its lights which columns and rows of the 8x8 tiles the light's rectangle covers. Then each column and
// each row of tiles gets a word for each 32 staged lights, with a bit for each that covers it: a tile's lights are its
// column's word AND its row's. An invocation visits these bits in ascending order, so lists ascend, whatever the order
// in which invocations run. The lights are divided into segments, so that there are enough groups where there are few
// cells. Prefix sums of the counts of a cell's segments say where each segment's part of the list begins.
#pragma once

#include <lightbin/detail/shaders/cull_common.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Adds the function `depths_of`, which returns the view depths of the cells that the depth test compares lights
/// with: a tile's Z bounds, or a slice's depths. A Z bound that is NaN excludes nothing; it is recognised by its
/// bits, as compilers may assume that no float is NaN, and infinity is made a finite depth beyond all lights that
/// are tested.
inline void add_cell_depths(ShaderWriter& writer) {
    writer.add(R"(
float $finite(float depth, float other) {
    uint bits = floatBitsToUint(depth);
    float result = clamp(depth, -1e30, 1e30);
    if ((bits & 0x7fffffffu) == 0x7f800000u) {
        result = 1e30;
        if (bits != 0x7f800000u) { result = -1e30; }
    }
    if ((bits & 0x7fffffffu) > 0x7f800000u) { result = other; }
    return result;
}

vec2 $depths_of(uint cell) {
    vec2 z = $z_bounds[cell];
    return vec2($finite(z.x, -1e30), $finite(z.y, 1e30));      @if !max_only
    return vec2(-1e30, $finite(z.y, 1e30));                    @if max_only
}
)");
}

/// Adds `meets_half_spaces`, which tells whether a tile's cell has depths of a light, and whether a cell has points of
/// each half space  n.p <= most  around it, by the formula of view/cell_planes.hpp. Where a radius is -1, see
/// add_project(), there are none. The Binner's n differs from this one by less than 2^-14 in each coordinate, see
/// add_half_spaces() and add_faces(): so 2^-14 of the cell's coordinates is subtracted, and the Binner lists no light
/// that this test excludes.
inline void add_half_space_test(ShaderWriter& writer) {
    writer.add(R"(
bool $meets_half_spaces(uint at, uint end, vec2 columns, vec2 rows, vec2 z) {
    bool met = true;                                                                                    @if clusters
    bool met = uintBitsToFloat($scratch[at - 2u]) <= z.y && z.x <= uintBitsToFloat($scratch[at - 1u]);  @if !clusters
    vec2 across = clamp(columns, vec2(-1e18, -1e18), vec2(1e18, 1e18));
    vec2 down = clamp(rows, vec2(-1e18, -1e18), vec2(1e18, 1e18));
    uint last = end;
    if (uintBitsToFloat($scratch[at + 3u]) == -1.0) { last = 0u; }
    for (uint i = 4u; i < last; i += 4u) {
        vec3 n = vec3(uintBitsToFloat($scratch[at + i]), uintBitsToFloat($scratch[at + i + 1u]),
                      uintBitsToFloat($scratch[at + i + 2u]));
        float most = uintBitsToFloat($scratch[at + i + 3u]);
        vec3 p = vec3(across.x, down.x, z.x);
        if (n.x < 0.0) { p.x = across.y; }
        if (n.y < 0.0) { p.y = down.y; }
        if (n.z < 0.0) { p.z = z.y; }                                                       @if orthographic
        if (most < 0.0) { p.z = z.y; }                                                      @if !orthographic
        float slope = n.x * p.x + n.y * p.y + n.z - (abs(p.x) + abs(p.y) + 1.0) * 6.1035156e-5;   @if !orthographic
        met = met && slope * p.z <= most;                                                   @if !orthographic
        float size = abs(p.x) + abs(p.y) + abs(p.z);                                        @if orthographic
        met = met && n.x * p.x + n.y * p.y + n.z * p.z - size * 6.1035156e-5 <= most;       @if orthographic
    }
    return met;
}
)");
}

/// Adds the functions with which the depth test finds a cell's view-space box, as view/cell_boxes.hpp does, and the
/// function `meets_box`. In perspective the sides of a cell are slopes, which a depth multiplies.
///
/// Rounding, u = 2^-24. A box must hold the Binner's: an edge that the Binner computes is within u of the product
/// of side and depth, and one that a GPU computes within 2u, so 2^-20 = 16u outward is more than enough. The
/// distances, each a difference, have a relative error of 2u, the sum of their squares of 10u, the Binner's of 5u;
/// 2^-18 of the squared radius = 64u is more. 2^-80 is for squares that are flushed to zero.
inline void add_cell_box(ShaderWriter& writer) {
    writer.add(R"(
vec2 $across(vec2 sides, vec2 z) {
    return sides;                                                                                   @if orthographic
    float low = min(sides.x * z.x, sides.x * z.y);                                                  @if !orthographic
    float high = max(sides.y * z.x, sides.y * z.y);                                                 @if !orthographic
    return vec2(low - abs(low) * 9.5367432e-7 - 1e-37, high + abs(high) * 9.5367432e-7 + 1e-37);    @if !orthographic
}

float $apart(float at, vec2 ends) {
    return max(max(ends.x - at, at - ends.y), 0.0);
}

bool $meets_box(uint at, vec2 columns, vec2 rows, vec2 z) {
    float radius = uintBitsToFloat($scratch[at + 3u]);
    float x = $apart(uintBitsToFloat($scratch[at]), columns);
    float y = $apart(uintBitsToFloat($scratch[at + 1u]), rows);
    float d = $apart(uintBitsToFloat($scratch[at + 2u]), z);
    bool met = radius < 0.0 || x * x + y * y + d * d <= radius * radius * 1.0000038 + 8.2718061e-25;
    return met;
}
)");
}

/// Adds `tiles_met`, which returns what the rectangle of the light whose record begins at `at` covers of the 8x8 tiles
/// from `corner` on: a bit for each column and, from bit 8 on, for each row; 0 if the light does not meet the slice.
inline void add_tiles_met(ShaderWriter& writer) {
    writer.add(R"(
// Returns 8 bits for the tiles from `begin` on: set for those from `first` to `last`.
uint $bits_of(uint first, uint last, uint begin) {
    uint low = max(first, begin) - begin;
    uint end = min(last + 1u, begin + 8u) - min(last + 1u, begin);
    uint result = 0u;
    if (low < end) { result = (1u << end) - (1u << low); }
    return result;
}

uint $tiles_met(uint at, uvec2 corner, uint slice) {
    uint first = $scratch[at];
    uint last = $scratch[at + 1u];
    uint bits = $bits_of(first & 0xffffu, last & 0xffffu, corner.x) |
                ($bits_of(first >> 16u, last >> 16u, corner.y) << 8u);
    uint slices = $scratch[at + 2u];                                            @if clusters
    if (slice < (slices & 0xffffu) || slice > slices >> 16u) { bits = 0u; }     @if clusters
    return bits;
}
)");
}

inline void declare_stage(ShaderWriter& writer) {
    writer.declare_shared("words", 32, false);         // the 32 words of the mask whose lights are staged
    writer.declare_shared("lights_in", 8, false);      // how many lights each of these words has, a byte each
    writer.declare_shared("staged", 1024, false);      // ids less the first one, and tiles_met() in the upper 16 bits
    writer.declare_shared("column_bits", 256, false);  // bits of the lights in a column: 8 words for each 32 lights
    writer.declare_shared("row_bits", 256, false);     // the same for rows
}

/// Adds `stage`, with which a group stages the lights of 32 words of a mask block, from word `first` on, and finds
/// those in each column and row of the 8x8 tiles from `corner` on. It returns how many words of 32 lights they fill;
/// bits beyond the last light are 0.
inline void add_stage(ShaderWriter& writer) {
    writer.add(R"(
// Returns which of 32 words of a mask block, from word 32 `step` on, have bits.
uint $summary(uint step, uint mask_block) {
    uint steps = ($segments.x + 1023u) >> 10u;
    uint bits = 0u;
    if (step < steps) { bits = $scratch[@summaries + step * @mask_blocks + mask_block]; }
    return bits;
}

uint $stage(uint first, uint mask_block, uvec2 corner, uint slice, uint thread) {
    if (thread < 8u) {
        uint summary = $summary(first >> 5u, mask_block) >> (thread * 4u);
        uint counts = 0u;
        for (uint i = 0u; i < 4u; i += 1u) {
            uint own = 0u;
            uint at = $places.x + (first + thread * 4u + i) * @mask_blocks + mask_block;
            if (((summary >> i) & 1u) != 0u) { own = $scratch[at]; }
            $words[thread * 4u + i] = own;
            counts |= uint(bitCount(own)) << (i * 8u);
        }
        $lights_in[thread] = counts;
    }
    sync_group();
    uint word = thread >> 1u;
    uint bits = $words[word];
    uint at = 0u;
    if ((thread & 1u) == 0u) { bits &= 0xffffu; }
    else {
        at = uint(bitCount(bits & 0xffffu));
        bits &= 0xffff0000u;
    }
    // The product with 0x1010101 has the sum of the four bytes in its upper byte.
    uint lights = 0u;
    for (uint quad = 0u; quad < 8u; quad += 1u) {
        uint counts = $lights_in[quad];
        uint before = 0u;
        if (quad < (word >> 2u)) { before = counts; }
        if (quad == word >> 2u) { before = counts & ((1u << ((word & 3u) * 8u)) - 1u); }
        lights += (counts * 0x1010101u) >> 24u;
        at += (before * 0x1010101u) >> 24u;
    }
    while (bits != 0u) {
        uint light = word * 32u + uint(findLSB(bits));
        bits &= bits - 1u;
        uint record = @totals + (first * 32u + light) * @record_words;
        $staged[at] = light | ($tiles_met(record, corner, slice) << 16u);
        at += 1u;
    }
    sync_group();
    uint filled = (lights + 31u) >> 5u;
    for (uint slot = thread; slot < filled * 8u; slot += 64u) {
        uint begin = (slot >> 3u) * 32u;
        uint end = min(begin + 32u, lights);
        uint in_column = 0u;
        uint in_row = 0u;
        for (uint next = begin; next < end; next += 1u) {
            uint tiles = $staged[next] >> (16u + (slot & 7u));
            in_column |= (tiles & 1u) << (next & 31u);
            in_row |= ((tiles >> 8u) & 1u) << (next & 31u);
        }
        $column_bits[slot] = in_column;
        $row_bits[slot] = in_row;
    }
    sync_group();
    return filled;
}
)");
}

/// Adds `store_id`, which writes an id to the lists. Ids of 16 bits share words, also with the lists before and
/// after: `half` changes its own half of a word and no other, so it makes no difference which half is written
/// first.
inline void add_store_id(ShaderWriter& writer) {
    writer.add(R"(
void $store_id(uint at, uint id) {
    if (at < $grid.w) { $lists[at] = id; }                  @if !narrow
    if (at < $grid.w) {                                     @if narrow
        uint word = at >> 1u;                               @if narrow
        uint shift = (at & 1u) * 16u;                       @if narrow
        atomicAnd(&$lists[word], ~(0xffffu << shift));      @if narrow
        atomicOr(&$lists[word], id << shift);               @if narrow
    }                                                       @if narrow
}
)");
}

/// Adds the pass count or fill.
inline void add_lists(ShaderWriter& writer, const CullOptions& options, bool fill) {
    const bool narrow = options.ids == IdWidth::u16, bounded = options.bounded && options.slicing == Slicing::clusters;
    if (options.depth_test || bounded) writer.declare_storage("z_bounds", "vec2", "readonly", options.z_bounds, 8);
    declare_scratch(writer, options);
    if (fill) {
        writer.declare_storage("tiles", "uvec2", "writeonly", options.tiles, 8);
        writer.declare_storage("lists", narrow && writer.dialect.webgpu ? "atomic<uint>" : "uint",
                               narrow ? "" : "writeonly", options.lists, 4);
    }
    writer.add("\n");
    declare_stage(writer);
    writer.declare_shared("found", 1, true);
    writer.declare_shared("needed", 1, false);
    if (options.depth_test || bounded) add_cell_depths(writer);
    if (options.depth_test) add_cell_box(writer);
    if (options.depth_test && options.kind != CullKind::sphere) add_half_space_test(writer);
    add_tiles_met(writer);
    add_stage(writer);
    if (fill) {
        add_saturated_sum(writer);
        add_store_id(writer);
    }
    writer.set("half_spaces_end", std::to_string(cull_half_spaces_end(options.kind)) + "u");
    writer.set("tested_sphere", "@totals + id * @record_words + @sphere");
    writer.set({{"fill", fill}, {"each_light", fill || options.depth_test}});
    // The tiles' Z bounds lie behind the slices' depths and the edges of tiles. They are widened as add_project() does
    // lights' depths, so that no cell of the Binner's is left out. A group of which no cell is drawn, or whose mask
    // block has none of the segment's lights, skips all lights.
    writer.set("tile_bounds", "$depths_of($grid.z + $grid.x + $grid.y + tile.y * $grid.x + tile.x)");
    // Lights that are tested end before the depth 2^42.
    writer.set("least_depth", options.orthographic ? "-4.3980465e12" : "$planes.x");
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint number = group.y * 32768u + group.x;
    uint block_columns = ($grid.x + 7u) >> 3u;
    uint block_plane = block_columns * (($grid.y + 7u) >> 3u);
    uint block = number % max(block_plane * @cell_layers, 1u);
    uint segment = number / max(block_plane * @cell_layers, 1u);
    uint slice = block / max(block_plane, 1u);
    block %= max(block_plane, 1u);
    uvec2 corner = uvec2(block % max(block_columns, 1u), block / max(block_columns, 1u)) * 8u;
    uvec2 tile = corner + uvec2(thread & 7u, thread >> 3u);
    bool inside = segment < $segments.y && tile.x < $grid.x && tile.y < $grid.y;
    uint cells = $grid.x * $grid.y * @cell_layers;
    uint cell = (slice * $grid.y + tile.y) * $grid.x + tile.x;
    uint mask_block = ((slice >> $blocks.w) * $blocks.y + (corner.y >> $blocks.z)) * $blocks.x;
    mask_block += corner.x >> $blocks.z;
    bool drawn = inside;                                                    @if !depth_test
    vec2 z = vec2(0.0, 0.0);                                                @if depth_test
    if (inside) { z = $depths_of(cell); }                                   @if depth_test !clusters
    if (inside) { z = $depths_of(slice); }                                  @if depth_test clusters
    bool drawn = inside && z.x <= z.y;                                      @if depth_test
    z = vec2(min(max(z.x, $planes.x), 4.3980465e12), min(max(z.y, @least_depth), $planes.z));   @if depth_test
    vec2 x_sides = vec2(0.0, 0.0);                                          @if depth_test
    vec2 y_sides = x_sides;                                                 @if depth_test
    if (drawn) {                                                            @if depth_test
        uint sides = $grid.x * $grid.y;                                     @if depth_test !clusters
        uint sides = $grid.z;                                               @if depth_test clusters
        x_sides = $z_bounds[sides + tile.x];                                @if depth_test
        y_sides = $z_bounds[sides + $grid.x + tile.y];                      @if depth_test
    }                                                                       @if depth_test
    vec2 columns = $across(x_sides, z);                                     @if depth_test
    vec2 rows = $across(y_sides, z);                                        @if depth_test
    if (inside) {                                                           @if bounded
        vec2 slab = $depths_of(slice);                                      @if bounded
        vec2 seen = @tile_bounds;                                           @if bounded
        drawn = drawn && seen.x <= seen.y;                                  @if bounded
        drawn = drawn && seen.x - abs(seen.x) * $signs.w <= slab.y;         @if bounded
        drawn = drawn && slab.x <= seen.y + abs(seen.y) * $signs.w;         @if bounded
    }                                                                       @if bounded
    if (thread == 0u) { atomicStore(&$found[0], 0u); }
    sync_group();
    if (drawn) { atomicOr(&$found[0], 1u); }
    for (uint i = thread; i < $segments.z; i += 64u) {
        if ($summary(segment * $segments.z + i, mask_block) != 0u) { atomicOr(&$found[0], 2u); }
    }
    sync_group();
    if (thread == 0u) { $needed[0] = atomicLoad(&$found[0]) / 3u; }
    sync_group();
    uint steps = $segments.z * uniform_load(&$needed[0]);
    uint count = 0u;                                                        @if !fill
    uint at = 0u;                                                           @if fill
    if (inside) {                                                           @if fill
        uint range = $places.z + 2u * cell;                                 @if fill
        uint count = $scratch[range + 1u];                                  @if fill
        uint base = $sum($scratch[range], $scratch[$places.w + (cell >> 7u)]);                          @if fill
        uint begin = min(base, $grid.w);                                    @if fill
        if (segment == 0u) { $tiles[cell] = uvec2(begin, min(count, $grid.w - begin)); }                @if fill
        at = $sum(base, $scratch[$places.y + segment * cells + cell]);      @if fill
    }                                                                       @if fill
    for (uint step = 0u; step < steps; step += 1u) {
        uint first = (segment * $segments.z + step) * 32u;
        uint staged_words = $stage(first, mask_block, corner, slice, thread);
        for (uint i = 0u; i < staged_words; i += 1u) {
            uint met = $column_bits[i * 8u + (thread & 7u)] & $row_bits[i * 8u + (thread >> 3u)];
            if (!drawn) { met = 0u; }
            count += uint(bitCount(met));                                   @if !each_light
            while (met != 0u) {                                             @if each_light
                uint id = first * 32u + ($staged[i * 32u + uint(findLSB(met))] & 0xffffu);              @if each_light
                met &= met - 1u;                                            @if each_light
                if (!$meets_box(@tested_sphere, columns, rows, z)) { continue; }        @if depth_test
                uint end = @half_spaces_end;                                            @if depth_test shapes !mixed
                uint end = 4u;                                                          @if depth_test mixed
                if (id >= $kinds.x) { end = 20u; }                                      @if depth_test mixed
                if (id >= $kinds.y) { end = @half_spaces_end; }                         @if depth_test mixed
                if (!$meets_half_spaces(@tested_sphere, end, x_sides, y_sides, z)) { continue; }   @if depth_test shapes
                count += 1u;                                                @if each_light !fill
                $store_id(at, id);                                          @if fill
                at = $sum(at, 1u);                                          @if fill
            }                                                               @if each_light
        }
    }
    if (inside) { $scratch[$places.y + segment * cells + cell] = count; }   @if !fill
}
)");
}

/// Adds `scan`, a prefix sum over the 128 numbers of a group, in `partial` (Hillis, Steele, "Data Parallel Algorithms",
/// 1986).
inline void add_scan(ShaderWriter& writer) {
    writer.declare_shared("partial", 128, false);
    add_saturated_sum(writer);
    writer.add(R"(
// Adds to each invocation's number those of the invocations before it.
void $scan(uint thread, uint own) {
    $partial[thread] = own;
    sync_group();
    for (uint distance = 1u; distance < 128u; distance *= 2u) {
        uint before = 0u;
        if (thread >= distance) { before = $partial[thread - distance]; }
        sync_group();
        $partial[thread] = $sum($partial[thread], before);
        sync_group();
    }
}
)");
}

/// Adds the pass sums: an invocation adds up the counts of a cell's segments, and a group those of 128 cells.
inline void add_sums(ShaderWriter& writer, const CullOptions& options) {
    declare_scratch(writer, options);
    add_scan(writer);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint number = group.y * 32768u + group.x;
    uint cells = @cells;
    uint cell = number * 128u + thread;
    uint count = 0u;
    if (cell < cells) {
        for (uint i = 0u; i < $segments.y; i += 1u) {
            uint at = $places.y + i * cells + cell;
            uint own = $scratch[at];
            $scratch[at] = count;
            count += own;
        }
    }
    $scan(thread, count);
    if (cell < cells) {
        uint before = 0u;
        if (thread > 0u) { before = $partial[thread - 1u]; }
        $scratch[$places.z + 2u * cell] = before;
        $scratch[$places.z + 2u * cell + 1u] = count;
    }
    if (thread == 127u && number * 128u < cells) { $scratch[$places.w + number] = $partial[127]; }
}
)");
}

/// Writes the shader function `total_lights`, with which a single work group stores CullTotals::rejected and ::visible.
/// For each 64 lights, the pass `project` left a word with the number of rejected lights in its low 16 bits, and the
/// number of lights in view in its high 16 bits.
inline void add_total_lights(ShaderWriter& writer) {
    add_scan(writer);
    writer.add(R"(
void $total_lights(uint thread) {
    uint groups = ($segments.x + 63u) >> 6u;
    for (uint shift = 0u; shift < 32u; shift += 16u) {
        uint own = 0u;
        for (uint i = thread; i < groups; i += 128u) { own += ($scratch[$segments.w + i] >> shift) & 0xffffu; }
        $scan(thread, own);
        if (thread == 127u) { $scratch[1u + (shift >> 4u)] = $partial[thread]; }
    }
}
)");
}

/// Writes the text of the pass `offsets`, in which a single work group adds up the sums that the work groups of the
/// pass `sums` left in `scratch`, and stores CullTotals.
inline void add_offsets(ShaderWriter& writer, const CullOptions& options) {
    declare_scratch(writer, options);
    add_total_lights(writer);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint cells = @cells;
    uint sums = (cells + 127u) >> 7u;
    uint before = 0u;
    for (uint first = 0u; first < sums; first += 128u) {
        uint at = $places.w + first + thread;
        uint own = 0u;
        if (first + thread < sums) { own = $scratch[at]; }
        $scan(thread, own);
        uint base = before;
        if (thread > 0u) { base = $sum(base, $partial[thread - 1u]); }
        if (first + thread < sums) { $scratch[at] = base; }
        before = $sum(before, $partial[127]);
        sync_group();
    }
    $total_lights(thread);
    if (thread == 0u) { $scratch[0] = before; }
}
)");
}

}}}  // namespace lightbin::detail
