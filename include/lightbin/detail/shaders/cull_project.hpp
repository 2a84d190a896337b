// SPDX-License-Identifier: MIT
// The pass project: finds each light's rectangle of tiles, its slices, and the mask blocks that it meets.
//
// The lists must hold the Binner's on every device that keeps the arithmetic that GLSL (section 4.7.1), SPIR-V for
// Vulkan and WGSL (section 15.7) state: sums and products correctly rounded, but in which direction is open, so with
// an error of up to 2u of the result, where u = 2^-24; quotients within 2.5 units in the last place, 5u; roots
// computed as 1 / inversesqrt(x), 9u. Denormal numbers may be flushed to zero, and NaN and infinity may not be
// supported: so they are recognised in the input by their bits, and are never computed.
#pragma once

#include <lightbin/detail/shaders/cull_common.hpp>
#include <lightbin/detail/shaders/cull_spots.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Adds the function `state_of`, which returns 0 for a light that is bad input, 1 for one that counts as everywhere, as
/// one of its numbers exceeds 2^40, 3 for one that is switched off, else 2. The bits of floats without a sign ascend
/// with the floats: those of 2^40 are 0x53800000, of infinity 0x7f800000. Those of -1 are 0xbf800000.
inline void add_state(ShaderWriter& writer, const CullOptions& options) {
    const auto word = [&](std::uint32_t offset) { return "$lights[at + " + std::to_string(offset) + "u]"; };
    const CullLayout& at = options.lights_at;
    writer.add("\nuint $state_of(uint at) {\n    uint x = " + word(at.centre) + " & 0x7fffffffu;\n    uint y = " +
               word(at.centre + 1) + " & 0x7fffffffu;\n    uint z = " + word(at.centre + 2) +
               " & 0x7fffffffu;\n    uint radius = " + word(at.radius) + R"(;
    uint size = radius & 0x7fffffffu;
    uint state = 2u;
    if (max(max(x, y), max(z, size)) > 0x53800000u) { state = 1u; }
    if (max(max(x, y), z) >= 0x7f800000u || size > 0x7f800000u || radius > 0x80000000u) { state = 0u; }
)");
    if (options.kind == CullKind::spot) add_spot_state(writer, options.lights_at);
    writer.add("    if (radius == 0xbf800000u) { state = 3u; }\n    return state;\n}\n");
}

/// Adds the function `sphere_at`, which returns a light's sphere in view space, signed so that tile indices grow with x
/// and y, and z is the view depth. It contains the Binner's sphere. The radius is made at least 2^-40, so that squares
/// don't underflow.
inline void add_sphere(ShaderWriter& writer, const CullOptions& options) {
    const auto number = [&](std::uint32_t offset) {
        return "uintBitsToFloat($lights[at + " + std::to_string(offset) + "u])";
    };
    const std::uint32_t centre = options.lights_at.centre;
    writer.add("\nvec4 $sphere_at(uint at) {\n    vec3 centre = vec3(" + number(centre) + ", " +
               number(centre + 1) + ", " + number(centre + 2) + ");\n    float radius = max(" +
               number(options.lights_at.radius) +
               ", 9.094947e-13);\n");
    if (options.world_space)
        writer.add(R"(    vec3 apart = centre - $origin.xyz;
    float distance = abs(apart.x) + abs(apart.y) + abs(apart.z);
    centre = $column_x.xyz * apart.x + $column_y.xyz * apart.y + $column_z.xyz * apart.z + $origin_image.xyz;
    radius = radius * $origin.w + (distance * $column_x.w + $column_y.w);
    if (distance > $origin_image.w) { radius = 2.0e12; }
)");
    writer.add("    return vec4(centre * $signs.xyz, radius);\n}\n");
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

/// Adds `bounds_of` a sphere along an image axis, and `span`, the first and last tile of bounds, where -1e30 and 1e30
/// are infinite; first > last if there is none.
///
/// An edge at x = p + offset tiles in the viewport, where p = scale slope, has a |p| of at most F, the greater one of
/// |offset| and |tiles - offset|. The GPU's slope is off by 28u of itself, the rounded scale by u and the product by
/// 2u, together 31u F; the rounded offset by u |offset|, and the two sums by 2u tiles each. The Binner's slope is off
/// by 10u, scale and product by u each, together 12u F; its offset by u |offset|, its two sums by u tiles each. So
/// beyond the Binner's own margin, by which it moves its edges outward, the GPU's must be 43u F + 2u |offset| + 6u
/// tiles. It is 46u F + 8u (|offset| + tiles), see plan_axis(); the rest is for products of errors.
inline void add_span(ShaderWriter& writer, const CullOptions& options) {
    if (options.orthographic) {
        writer.add("\nvec2 $bounds_of(float c, float z, float r) {\n    return vec2(c - r, c + r);\n}\n");
    } else {
        add_tangents(writer);
        add_clipped(writer);
        writer.add(R"(
vec2 $bounds_of(float c, float z, float r) {
    vec2 bounds = vec2(0.0, 0.0);
    if (z - r > $planes.w) { bounds = $tangents(c, z, r); }
    else { bounds = $clipped(c, z, r, $planes.x); }
    return bounds;
}
)");
    }
    writer.add(R"(
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

/// Adds `slices_of`, which returns the first and the last slice that an interval of view depths meets. It is widened by
/// how far it may differ from the Binner's. Boundaries are integers that ascend with the depths, see shader_slices().
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
    return uvec2($slices_before($key_of(z.x - abs(z.x) * $signs.w - 1e-37)),
                 $slices_before($key_of(z.y + abs(z.y) * $signs.w + 1e-37) + 1u));
}
)");
}

/// Returns the shader's lines that store what the depth test reads, from word `word` of the record on: the light's
/// sphere, behind which `project` stores a spot's half spaces. A radius of -1 stands for a light that boxes don't
/// exclude: one that counts as everywhere, or a spot that is not sound.
inline std::string cull_depth_record(const CullOptions& options, const std::string& word) {
    const auto put = [&](const char* index, const char* value) {
        return "    $scratch[record + " + word + " + " + index + "u] = floatBitsToUint(" + value + ");\n";
    };
    if (!options.depth_test) return "";
    return "    if (!bounded) { s.w = -1.0; }\n" + put("0", "s.x") + put("1", "s.y") + put("2", "s.z") + put("3", "s.w");
}

/// Adds the pass project.
inline void add_project(ShaderWriter& writer, const CullOptions& options) {
    const bool sliced = options.slicing != Slicing::none, box = options.depth_test,
               spots = options.kind == CullKind::spot;
    const std::string depths = sliced ? "3u" : "2u";  // where in a record what the depth test reads begins
    writer.declare_storage("lights", "uint", "readonly", options.lights, 4);
    declare_scratch(writer, options);
    if (sliced) writer.declare_storage("slices", "uint", "readonly", options.slices, 4);
    if (options.count_in_buffer) writer.declare_storage("light_count", "uint", "readonly", options.light_count, 4);
    writer.add("\n");
    writer.declare_shared("tally", 1, true);
    add_masks_of_group(writer, options);
    add_state(writer, options);
    add_sphere(writer, options);
    if (!options.orthographic || spots) add_worst_operations(writer);
    add_span(writer, options);
    if (spots) add_spots(writer, options);
    if (sliced) add_slices(writer);

    writer.add(R"(
// Projects a light, writes its record, and returns what it adds to the tally.
uint $project(uint id, uint thread) {
    uint at = id * )" + std::to_string(options.lights_at.stride) + R"(u;
    uint record = )" + cull_record_of(options, "id") + R"(;
    uint state = $state_of(at);
    vec4 s = vec4(0.0, 0.0, 0.0, 1.0);
    if (state == 2u) {
        s = $sphere_at(at);
        if (max(max(abs(s.x), abs(s.y)), max(abs(s.z), s.w)) > 1.0995116e12) { state = 1u; }
    }
)" + (box ? "    bool bounded = state == 2u;\n" : "") + R"(    bool seen = state == 1u;
    vec2 x = vec2(-1e30, 1e30);
    vec2 y = x;
    vec2 z = x;
    if (state == 2u) {
        z = vec2(s.z - s.w, s.z + s.w);
)" + std::string(spots ? "        $spot spot = $spot_at(at, s);\n        z = spot.depths;\n" : "") +
               (spots && box ? "        bounded = spot.sound;\n" : "") +
               R"(        seen = z.y >= $planes.y && z.x <= $planes.z;
        if (seen) {
)" + (spots && box ? "            $store_half_spaces(record + " + depths + " + 4u, spot);\n" : "") +
               (spots ? R"(            vec4 bounds = $bounds_of_spot(spot);
            x = bounds.xy;
            y = bounds.zw;
)" : R"(            x = $bounds_of(s.x, s.z, s.w);
            y = $bounds_of(s.y, s.z, s.w);
)") + R"(        }
    }
    uvec2 columns = $span($axis_x, $grid.x, x);
    uvec2 rows = $span($axis_y, $grid.y, y);
    seen = seen && columns.x <= columns.y && rows.x <= rows.y;
    if (!seen) {
        columns = uvec2(1u, 0u);
        rows = columns;
    }
    $scratch[record] = columns.x | (rows.x << 16u);
    $scratch[record + 1u] = columns.y | (rows.y << 16u);
)" + (sliced ? "    uvec2 layers = $slices_of(z);\n    if (state == 1u) { layers = uvec2(0u, $slices[3]); }\n"
                       "    $scratch[record + 2u] = layers.x | (layers.y << 16u);\n"
             : "    uvec2 layers = uvec2(0u, 0u);\n") +
               cull_depth_record(options, depths) + R"(    if (seen) { $mark(thread, columns, rows, layers); }
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
    uint given = )" +
               (options.count_in_buffer ? "$light_count[" + std::to_string(options.count_at) + "]" : "$segments.x") +
               R"(;
    if (id < min(given, $segments.x)) { atomicAdd(&$tally[0], $project(id, thread)); }
    else if (id < $segments.x) {
        $scratch[)" + cull_record_of(options, "id") + R"(] = 0x10001u;
        $scratch[)" + cull_record_of(options, "id") + R"( + 1u] = 0u;
    }
    if (id == 0u) { $scratch[3] = given; }
    sync_group();
    uint groups = max(($segments.x + 63u) >> 6u, 1u);
    if (number < groups) {
        if (thread == 0u) { $scratch[$segments.w + number] = atomicLoad(&$tally[0]); }
        $write_masks(number, thread);
    }
}
)");
}

}}}  // namespace lightbin::detail
