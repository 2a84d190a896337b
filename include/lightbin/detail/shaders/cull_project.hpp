// SPDX-License-Identifier: MIT
// The pass project: finds each light's rectangle of tiles, its slices, and the mask blocks that it meets.
//
// The lists must have every light that reaches a cell, on every device that keeps the arithmetic that GLSL (section
// 4.7.1), SPIR-V for Vulkan and WGSL (section 15.7) state: so each bound here is made to hold the Binner's. Sums and
// products are correctly rounded, but in which direction is open, so with an error of up to 2u of the result, where u =
// 2^-24; quotients within 2.5 units in the last place, 5u; roots computed as 1 / inversesqrt(x), 9u. Denormal numbers
// may be flushed to zero, and NaN and infinity may not be supported: so they are recognised in the input by their bits,
// and are never computed.
#pragma once

#include <lightbin/detail/shaders/cull_boxes.hpp>
#include <lightbin/detail/shaders/cull_common.hpp>
#include <lightbin/detail/shaders/cull_spots.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Sets the expressions for the numbers of the light that begins at word `at` of the buffer `lights`.
inline void name_numbers(ShaderWriter& writer, const CullLayout& layout) {
    const auto word = [&](const std::string& name, std::uint32_t offset) {
        const std::string text = "$lights[at + " + std::to_string(offset) + "u]";
        writer.set(name, text);
        return "uintBitsToFloat(" + text + ")";
    };
    const auto vector = [&](const std::string& name, std::uint32_t offset) {
        const std::string x = word(name + "_x", offset), y = word(name + "_y", offset + 1);
        writer.set(name, "vec3(" + x + ", " + y + ", " + word(name + "_z", offset + 2) + ")");
    };
    vector("centre", layout.centre);
    vector("axis", layout.axis);
    writer.set("radius", word("radius_word", layout.radius));
    writer.set("cosine", word("cosine_word", layout.cosine));
    writer.set("wide", "(@cosine_word & 0x7fffffffu) > 0x3f800000u");
    writer.set("turned", "$column_x.xyz * apart.x + $column_y.xyz * apart.y + $column_z.xyz * apart.z");
    writer.set("stretched", "@radius * $origin.w");
    vector("box_middle", layout.box_centre);
    vector("half_x", layout.half_axes);
    vector("half_y", layout.half_axes + 3);
    vector("half_z", layout.half_axes + 6);
    writer.set("taper", word("taper_word", layout.taper));
    for (const auto& [name, number] :
         {std::pair("stride", layout.stride), std::pair("spot_stride", layout.spot_stride),
          std::pair("box_stride", layout.box_stride), std::pair("box_centre", layout.box_centre),
          std::pair("half_axes", layout.half_axes)})
        writer.set(name, std::to_string(number) + "u");
}

/// Adds the function `state_of`, which returns 0 for a light that is bad input, 1 for one that counts as everywhere, as
/// one of its numbers exceeds 2^40, 3 for one that is switched off, else 2. The bits of floats without a sign ascend
/// with the floats: those of 2^40 are 0x53800000, of infinity 0x7f800000. Those of -1 are 0xbf800000.
inline void add_state(ShaderWriter& writer) {
    writer.set("bad_taper", "(@taper_word > 0x3f800000u && @taper_word != 0x80000000u)");
    writer.add(R"(
uint $largest(uint at, uint count) {                                                @if boxes
    uint most = 0u;                                                                 @if boxes
    for (uint i = 0u; i < count; i += 1u) { most = max(most, $lights[at + i] & 0x7fffffffu); }      @if boxes
    return most;                                                                    @if boxes
}                                                                                   @if boxes
uint $state_of(uint at) {
    uint x = @centre_x & 0x7fffffffu;
    uint y = @centre_y & 0x7fffffffu;
    uint z = @centre_z & 0x7fffffffu;
    uint radius = @radius_word;
    uint size = radius & 0x7fffffffu;
    uint state = 2u;
    if (max(max(x, y), max(z, size)) > 0x53800000u) { state = 1u; }
    if (max(max(x, y), z) >= 0x7f800000u || size > 0x7f800000u || radius > 0x80000000u) { state = 0u; }
    if (at >= $kinds.z && at < $kinds.w) {                                                              @if mixed
    uint axis = max(max((@axis_x & 0x7fffffffu), (@axis_y & 0x7fffffffu)), (@axis_z & 0x7fffffffu));   @if spots
    if (@cosine_word != 0xbf800000u && (axis == 0u || axis >= 0x7f800000u || @wide)) { state = 0u; }    @if spots
    }                                                                                                   @if mixed
    if (at >= $kinds.w) {                                                                               @if mixed
    uint most = max($largest(at + @half_axes, 9u), $largest(at + @box_centre, 3u));                     @if boxes
    if (most >= 0x7f800000u || $largest(at + @half_axes, 9u) == 0u || @bad_taper) { state = 0u; }       @if boxes
    }                                                                                                   @if mixed
    if (radius == 0xbf800000u) { state = 3u; }
    return state;
}
)");
}

/// Adds the function `sphere_at`, which returns a light's sphere in view space, signed so that tile indices grow with x
/// and y, and z is the view depth. It contains the Binner's sphere. The radius is made at least 2^-40, so that squares
/// don't underflow.
inline void add_sphere(ShaderWriter& writer) {
    writer.add(R"(
vec4 $sphere_at(uint at) {
    vec3 centre = @centre;
    float radius = max(@radius, 9.094947e-13);
    vec3 apart = centre - $origin.xyz;                                              @if world_space
    float distance = abs(apart.x) + abs(apart.y) + abs(apart.z);                    @if world_space
    centre = @turned + $origin_image.xyz;                                           @if world_space
    radius = radius * $origin.w + (distance * $column_x.w + $column_y.w);           @if world_space
    if (distance > $origin_image.w) { radius = 2.0e12; }                            @if world_space
    return vec4(centre * $signs.xyz, radius);
}
)");
}

/// Adds `quotient` and `root`, the operations that devices round worst.
inline void add_worst_operations(ShaderWriter& writer) {
    writer.add(R"(
float $quotient(float a, float b) {
    return a / b;
}

float $root(float x) {
    return sqrt(x);
}
)");
}

/// Adds the shader function `tangents`, which does what tangent_slopes() of project/spheres.inl does, whose variables
/// have the same names. Errors, relative to each result, with u = 2^-24: e 6u, c^2 + e 8u, its root 13u, q 17u, the
/// outer and the inner slope 28u.
inline void add_tangents(ShaderWriter& writer) {
    writer.add(R"(
vec2 $tangents(float c, float z, float r) {
    float a = abs(c);
    float e = (z - r) * (z + r);
    float q = a * z + r * $root(a * a + e);
    float outer = $quotient(q, e);
    float inner = $quotient((a - r) * (a + r), q);
    vec2 bounds = vec2(inner, outer);
    if (c < 0.0) { bounds = vec2(-outer, -inner); }
    return bounds;
}
)");
}

/// Adds `clipped`, the bounds over that part of a disc whose depth is at least n: clipped_slopes() of
/// project/spheres_in_double.hpp, in float. The errors, with K = (c^2 + z^2 + r^2) / t2:
///
/// h2      10u r^2, as the disc meets the near plane and so |n - z| <= r but for rounding; 2^-19 = 32u is added, and
///         2^-19 of the root is more than its own 9u
/// doubt   each product of tangent_side and square is off by less than 8u of itself; 2^-18 = 64u
/// corner  sum 4u, quotient 5u; 2^-18 = 64u
/// slope   t2 is off by 6u K of itself, its root by half of that and 9u, the sum, e and the quotient by 15u, together
///         by 3u K + 26u; 2^-20 K + 2^-18 = 16u K + 64u. Beyond 2^-6 a slope counts as unknown.
inline void add_clipped(ShaderWriter& writer) {
    writer.add(R"(
vec2 $clipped(float c, float z, float r, float n) {
    float a = abs(c);
    float h2 = (r - (n - z)) * (r + (n - z));
    float h2_error = r * r * 1.9073486e-6;
    float h = $root(max(h2, 0.0) + h2_error) * 1.000002;
    float h_low = $root(max(h2 - h2_error, 0.0) + 1e-37) * 0.999998 - 1e-18;
    float doubt = (h * h + a * h + n * (abs(z) + n)) * 3.8146973e-6;
    float side = n * (z - n) + doubt;
    float square = h_low * abs(h_low);
    bool outer_cut = side < square + a * h_low;
    bool inner_cut = side < square - a * h;
    float corner_error = (a + h) * 3.8146973e-6;
    float squares = a * a + z * z;
    float t2 = squares - r * r;
    float error = 1.0;
    if (t2 > 0.0) { error = min($quotient((squares + r * r) * 9.5367432e-7, t2) + 3.8146973e-6, 1.0); }
    bool sure = error <= 0.015625;
    float az = a * z;
    float rt = r * $root(max(t2, 0.0) + 1e-37);
    float e = (z - r) * (z + r);
    float outer = 1e30;
    float inner = 1e30;
    if (outer_cut) { outer = $quotient(h + a + corner_error, n); }
    else if (sure && z > r) {
        outer = $quotient(az + rt, e);
        outer += abs(outer) * error;
    }
    if (inner_cut) { inner = $quotient(h - a + corner_error, n); }
    else if (sure) {
        if (z < 0.0) { inner = $quotient(rt - az, e); }
        else { inner = $quotient((r - a) * (r + a), rt + az); }
        inner += abs(inner) * error;
    }
    vec2 bounds = vec2(-inner, outer);
    if (c < 0.0) { bounds = vec2(-outer, inner); }
    return bounds;
}
)");
}

/// Adds `bounds_of` a sphere along an image axis, `within_ball`, which narrows bounds along x and then along y to those
/// of a sphere, and `span`, the first and last tile of bounds, where -1e30 and 1e30 are infinite; first > last if there
/// is none.
///
/// An edge at x = p + offset tiles in the viewport, where p = scale slope, has a |p| of at most F, the greater one of
/// |offset| and |tiles - offset|. The GPU's slope is off by 28u of itself, the rounded scale by u and the product by
/// 2u, together 31u F; the rounded offset by u |offset|, and the two sums by 2u tiles each. The Binner's slope is off
/// by 10u, scale and product by u each, together 12u F; its offset by u |offset|, its two sums by u tiles each. So
/// beyond the Binner's own margin, by which it moves its edges outward, the GPU's must be 43u F + 2u |offset| + 6u
/// tiles. It is 46u F + 8u (|offset| + tiles), see plan_axis(); the rest is for products of errors.
inline void add_span(ShaderWriter& writer, const CullOptions& options) {
    if (!options.orthographic) {
        add_tangents(writer);
        add_clipped(writer);
    }
    writer.add(R"(
vec2 $bounds_of(float c, float z, float r) {
    return vec2(c - r, c + r);                                          @if orthographic
    vec2 bounds = vec2(0.0, 0.0);                                       @if !orthographic
    if (z - r > $planes.w) { bounds = $tangents(c, z, r); }             @if !orthographic
    else { bounds = $clipped(c, z, r, $planes.x); }                     @if !orthographic
    return bounds;                                                      @if !orthographic
}

vec4 $within_ball(vec4 bounds, vec4 ball) {
    vec2 x = $bounds_of(ball.x, ball.z, ball.w);
    vec2 y = $bounds_of(ball.y, ball.z, ball.w);
    return vec4(max(bounds.x, x.x), min(bounds.y, x.y), max(bounds.z, y.x), min(bounds.w, y.y));
}

uvec2 $span(vec4 axis, uint tiles, vec2 bounds) {
    float low = bounds.x * axis.x + axis.y - axis.z;
    float high = bounds.y * axis.x + axis.y + axis.z;
    float most = float(tiles) - 0.5;
    if (bounds.x <= -1e30) { low = 0.0; }
    if (bounds.y >= 1e30) { high = most; }
    uvec2 span = uvec2(1u, 0u);
    if (high >= 0.0 && low <= axis.w) { span = uvec2(uint(clamp(low, 0.0, most)), uint(clamp(high, 0.0, most))); }
    return span;
}
)");
}

/// Adds `slices_of`, which returns the first and the last slice that an interval of view depths meets. Boundaries are
/// integers that ascend with the depths, see shader_slices().
inline void add_slices(ShaderWriter& writer) {
    writer.add(R"(
uint $key_of(float depth) {
    uint bits = floatBitsToUint(depth);
    uint key = bits | 0x80000000u;
    if (bits > 0x80000000u) { key = ~bits; }
    return key;
}

uint $slices_before(uint key) {
    uint low = 0u;
    uint high = $slices[3];
    while (low < high) {
        uint middle = (low + high) >> 1u;
        if ($slices[middle + 4u] < key) { low = middle + 1u; }
        else { high = middle; }
    }
    return low;
}

uvec2 $slices_of(vec2 z) {
    return uvec2($slices_before($key_of(z.x)), $slices_before($key_of(z.y) + 1u));
}
)");
}

/// Adds `store_four`, which writes four words of `scratch`: a sphere, or the vec4 (n, most) of a half space, the points
/// p with  n.p <= most.  The passes count and fill compare these with cells.
inline void add_store_four(ShaderWriter& writer) {
    writer.add(R"(
void $store_four(uint at, vec4 v) {
    $store_word(at, floatBitsToUint(v.x));
    $store_word(at + 1u, floatBitsToUint(v.y));
    $store_word(at + 2u, floatBitsToUint(v.z));
    $store_word(at + 3u, floatBitsToUint(v.w));
}
)");
}

/// Adds the pass project.
inline void add_project(ShaderWriter& writer, const CullOptions& options) {
    const bool sliced = options.slicing == Slicing::clusters, mixed = options.kind == CullKind::mixed,
               spots = options.kind == CullKind::spot || mixed, boxes = options.kind == CullKind::box || mixed;
    name_numbers(writer, options.lights_at);
    const auto count_at = [&](std::uint32_t kind) {
        return "$light_count[" + std::to_string(options.count_at + kind) + "]";
    };
    writer.set("given", options.count_in_buffer ? count_at(0) : "$segments.x");
    writer.set("given_spots", count_at(1));
    writer.set("given_boxes", count_at(2));
    writer.set("everywhere", "vec4(-1e30, 1e30, -1e30, 1e30)");
    writer.set({{"counts", mixed && options.count_in_buffer}, {"depths", cull_sphere_at(options) > 2}});
    writer.declare_storage("lights", "uint", "readonly", options.lights, 4);
    declare_scratch(writer, options, true);
    if (sliced) writer.declare_storage("slices", "uint", "readonly", options.slices, 4);
    if (options.count_in_buffer) writer.declare_storage("light_count", "uint", "readonly", options.light_count, 4);
    writer.add("\n");
    writer.declare_shared("tally", 1, true);
    add_masks_of_group(writer);
    add_state(writer);
    add_sphere(writer);
    if (!options.orthographic || spots || (boxes && options.depth_test)) add_worst_operations(writer);
    add_span(writer, options);
    if (options.depth_test) add_store_four(writer);
    if (spots) add_spots(writer, options);
    if (boxes) add_boxes(writer, options);
    if (sliced) add_slices(writer);

    // With a depth test a light's record in `scratch` has its sphere, and behind it the half spaces around a spot or
    // box. A radius of -1 stands for a light that no cell's box excludes: one that counts as everywhere, or a spot for
    // which `spot_at` found that the Binner may list more.
    //
    // A light's depths are compared with slices or, of spots and boxes, with tiles' Z bounds. They are widened, as they
    // must hold the Binner's: the sums that they end with are off by 2u of themselves, and the Binner's by u. Errors
    // before are in a spot's tolerance and a box's error. 2^-20 = 16u is more, see plan_cull().
    writer.add(R"(
// Projects a light, writes its record, and returns what it adds to the tally.
uint $project(uint id, uint thread) {
    uint at = id * @stride;
    if (id >= $kinds.x) { at = $kinds.z + (id - $kinds.x) * @spot_stride; } @if mixed
    if (id >= $kinds.y) { at = $kinds.w + (id - $kinds.y) * @box_stride; }  @if mixed
    uint record = @totals + id * @record_words;
    uint state = $state_of(at);
    vec4 s = vec4(0.0, 0.0, 0.0, 1.0);
    if (state == 2u) {
        s = $sphere_at(at);
        if (max(max(abs(s.x), abs(s.y)), max(abs(s.z), s.w)) > 1.0995116e12) { state = 1u; }
    }
    bool bounded = state == 2u;                                             @if depth_test
    bool seen = state == 1u;
    vec4 bounds = @everywhere;
    vec2 z = bounds.xy;
    if (at >= $kinds.w && (state == 1u || state == 2u)) {                   @if mixed
    if (state == 1u || state == 2u) {                                       @if !balls
        $box box = $box_at(at, s, state == 2u);                             @if boxes
        s = box.ball;                                                       @if boxes
        if (box.known) { state = 2u; }                                      @if boxes
        bounded = state == 2u;                                              @if boxes depth_test
        z = box.depths;                                                     @if boxes
        seen = z.x <= z.y && z.y >= $planes.y && z.x <= $planes.z;          @if boxes
        if (seen) { $store_faces(record + @sphere + 4u, box); }             @if boxes depth_test
        if (seen) { bounds = $bounds_of_box(box); }                         @if boxes
    } else if (state == 2u) {                                               @if mixed
    if (state == 2u) {                                                      @if balls !mixed
        z = vec2(s.z - s.w, s.z + s.w);                                     @if balls !spots
        $spot spot = $spot_at(at, s);                                       @if spots
        z = spot.depths;                                                    @if spots
        bounded = spot.sound;                                               @if spots depth_test !mixed
        bounded = spot.sound || at < $kinds.z;                              @if mixed depth_test
        seen = z.y >= $planes.y && z.x <= $planes.z;                        @if balls
        if (seen) { $store_half_spaces(record + @sphere + 4u, spot); }      @if spots depth_test
        if (seen) { bounds = $bounds_of_spot(spot); }                       @if spots
        if (seen) { bounds = $within_ball(bounds, s); }                     @if balls !spots
    }
    uvec2 columns = $span($axis_x, $grid.x, bounds.xy);
    uvec2 rows = $span($axis_y, $grid.y, bounds.zw);
    seen = seen && columns.x <= columns.y && rows.x <= rows.y;
    if (!seen) {
        columns = uvec2(1u, 0u);
        rows = columns;
    }
    $store_word(record, columns.x | (rows.x << 16u));
    $store_word(record + 1u, columns.y | (rows.y << 16u));
    z = vec2(z.x - abs(z.x) * $signs.w - 1e-37, z.y + abs(z.y) * $signs.w + 1e-37);                     @if depths
    $store_word(record + 2u, floatBitsToUint(z.x));                         @if depths !clusters
    $store_word(record + 3u, floatBitsToUint(z.y));                         @if depths !clusters
    uvec2 layers = uvec2(0u, 0u);                                           @if !clusters
    uvec2 layers = $slices_of(z);                                           @if clusters
    if (state == 1u) { layers = uvec2(0u, $slices[3]); }                    @if clusters
    $store_word(record + 2u, layers.x | (layers.y << 16u));                 @if clusters
    if (!bounded) { s.w = -1.0; }                                           @if depth_test
    $store_four(record + @sphere, s);                                       @if depth_test
    if (seen) { $mark(thread, columns, rows, layers); }
    uint result = 0u;
    if (seen) { result = 0x10000u; }
    if (state == 0u) { result = 1u; }
    return result;
}

void $run(uvec2 group, uint thread) {
    uint number = group.y * 32768u + group.x;
    uint id = number * 64u + thread;
    if (thread == 0u) { atomicStore(&$tally[0], 0u); }
    $clear_masks(thread);
    sync_group();
    uint given = @given;
    if (id >= $kinds.x) { given = $kinds.x + min(@given_spots, $segments.x); }                      @if counts
    if (id >= $kinds.y) { given = $kinds.y + min(@given_boxes, $segments.x); }                      @if counts
    if (id < min(given, $segments.x)) { atomicAdd(&$tally[0], $project(id, thread)); }
    else if (id < $segments.x) {
        $store_word(@totals + id * @record_words, 0x10001u);
        $store_word(@totals + id * @record_words + 1u, 0u);
    }
    if (id == 0u) { $store_word(3u, given); }                                                       @if !counts
    if (id == 0u) { $store_word(3u, @given + @given_spots + @given_boxes); }                        @if counts
    sync_group();
    uint groups = max(($segments.x + 63u) >> 6u, 1u);
    if (number < groups) {
        if (thread == 0u) { $store_word($segments.w + number, atomicLoad(&$tally[0])); }
        $write_masks(number, thread);
    }
}
)");
}

}}}  // namespace lightbin::detail
