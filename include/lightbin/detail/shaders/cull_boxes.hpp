// SPDX-License-Identifier: MIT
// The part of the pass project that finds the bounds of a box, and of the part of a sphere in a box: kinds/boxes.inl in
// one way for all boxes, where that has several.
//
// Let u = 2^-24 and S be the sum of the absolute values of all coordinates of the centre and the half axes. The Binner
// moves its bounds outward by what E = 16u S allows for, plus an error of the transform. Here `error` is four times as
// much. Of this the Binner's own bounds take up to 3.1 E: the 2 E that it moves them by and the 18u S by which it
// computes them. The GPU's bounds are off by up to 36u S = 2.25 E: corners by 8u S, and points where edges cross the
// near plane by 28u S more. These 5.4 E, divided by a depth that is up to a quarter less, are less than 8 E.
#pragma once

#include <lightbin/detail/shaders/cull_common.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Adds the struct of a box and the function `box_at`, which reads the box of a light whose ball, the sphere that cuts
/// it, is given. A box with numbers beyond 2^40 is not `known`: its error is so large that it bounds nothing. `depths`
/// are the light's view depths. The ball's radius is -2 where it cuts nothing off: where `cuts` is false, and where it
/// holds all corners up to a few times the 2^-17 of its radius by which the Binner decides the same.
inline void add_box_at(ShaderWriter& writer) {
    writer.add(R"(
struct $box {
    vec4 ball;
    vec3 centre;
    vec3 x;
    vec3 y;
    vec3 z;
    float taper;
    float size;
    float error;
    vec2 depths;
    float nearest;
    bool known;
};

float $extent(vec3 v) {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// A corner: bits 0, 1 and 2 of i are set on the side that half axis 0, 1 or 2 points to.
vec3 $corner($box b, uint i) {
    float x = 1.0;
    float y = 1.0;
    if ((i & 1u) == 0u) { x = -1.0; }
    if ((i & 2u) == 0u) { y = -1.0; }
    vec3 across = b.x * x + b.y * y;
    vec3 corner = b.centre + b.z + across;
    if ((i & 4u) == 0u) { corner = b.centre - b.z + across * b.taper; }
    return corner;
}

vec3 $to_view(vec3 apart) {
    return apart * $signs.xyz;                                              @if !world_space
    return (@turned) * $signs.xyz;                                          @if world_space
}

$box $box_at(uint at, vec4 ball, bool cuts) {
    $box b;
    b.ball = ball;
    b.centre = vec3(0.0, 0.0, 0.0);
    b.x = b.centre;
    b.y = b.centre;
    b.z = b.centre;
    b.taper = @taper;
    b.error = 1e-36;
    b.size = 2.0e12;
    if (max($largest(at + @half_axes, 9u), $largest(at + @box_centre, 3u)) <= 0x53800000u) {
        b.centre = @box_middle;
        b.x = @half_x;
        b.y = @half_y;
        b.z = @half_z;
        b.centre = b.centre - $origin.xyz;                                                      @if world_space
        float size = $extent(b.centre) + $extent(b.x) + $extent(b.y) + $extent(b.z);            @if world_space
        b.error += (size * $column_x.w + $column_y.w) * 2.0;                                    @if world_space
        b.centre = $to_view(b.centre);
        b.centre = b.centre + $origin_image.xyz * $signs.xyz;                                   @if world_space
        b.x = $to_view(b.x);
        b.y = $to_view(b.y);
        b.z = $to_view(b.z);
        b.size = $extent(b.centre) + $extent(b.x) + $extent(b.y) + $extent(b.z);
    }
    b.error += b.size * 3.8146973e-6;
    b.known = b.size + b.error <= 1.0995116e12;
    if (!b.known) { b.error = 1e30; }
    b.depths = vec2(1e30, -1e30);
    float reach2 = 0.0;
    for (uint i = 0u; i < 8u; i += 1u) {
        vec3 corner = $corner(b, i);
        b.depths = vec2(min(b.depths.x, corner.z), max(b.depths.y, corner.z));
        if (cuts && b.known) {
            vec3 apart = corner - ball.xyz;
            reach2 = max(reach2, apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
        }
    }
    b.nearest = b.depths.x - b.error;
    b.depths = vec2(b.nearest, b.depths.y + b.error);
    bool whole = !cuts;
    if (b.known && cuts) {
        float reach = ball.w * 1.0001 + b.error * 2.0;
        whole = reach2 <= reach * reach;
    }
    if (whole) { b.ball.w = -2.0; }
    else { b.depths = vec2(max(b.depths.x, ball.z - ball.w), min(b.depths.y, ball.z + ball.w)); }
    return b;
}
)");
}

/// Adds `bounds_of_box`, which returns the bounds along x and then along y: those of the box, and of the ball where it
/// cuts the box.
inline void add_bounds_of_box(ShaderWriter& writer) {
    writer.add(R"(
vec4 $held(vec4 bounds, vec2 at, float depth) {
    vec2 s = at;                                                                        @if orthographic
    vec2 s = vec2($quotient(at.x, depth), $quotient(at.y, depth));                      @if !orthographic
    return vec4(min(bounds.x, s.x), max(bounds.y, s.x), min(bounds.z, s.y), max(bounds.w, s.y));
}

// The bounds of the part of a box beyond the near plane.
vec4 $bounds_of_corners($box b, float least) {
    float cut = least - b.error;                                                @if !orthographic
    vec4 bounds = vec4(1e30, -1e30, 1e30, -1e30);
    for (uint i = 0u; i < 8u; i += 1u) {
        vec3 a = $corner(b, i);
        bounds = $held(bounds, a.xy, 1.0);                                      @if orthographic
        bool beyond = a.z >= cut;                                               @if !orthographic
        if (beyond) { bounds = $held(bounds, a.xy, a.z); }                      @if !orthographic
        for (uint bit = 1u; bit < 8u; bit *= 2u) {                              @if !orthographic
            vec3 c = $corner(b, i | bit);                                       @if !orthographic
            if (beyond != (c.z >= cut)) {                                       @if !orthographic
                float part = $quotient(cut - a.z, c.z - a.z);                   @if !orthographic
                bounds = $held(bounds, a.xy + (c.xy - a.xy) * part, cut);       @if !orthographic
            }                                                                   @if !orthographic
        }                                                                       @if !orthographic
    }
    float blur = b.error;                                                       @if orthographic
    float blur = $quotient(b.error * 2.0, least);                               @if !orthographic
    vec4 outward = vec4(-blur, blur, -blur, blur);
    return bounds + outward;                                                    @if orthographic
    return bounds + outward * (vec4(1.0, 1.0, 1.0, 1.0) + abs(bounds));         @if !orthographic
}

vec4 $bounds_of_box($box b) {
    float least = max(b.nearest, $planes.y);
    vec4 bounds = @everywhere;
    if (b.error <= least * 0.25) { bounds = $bounds_of_corners(b, least); }     @if !orthographic
    if (b.known) { bounds = $bounds_of_corners(b, least); }                     @if orthographic
    if (b.ball.w >= 0.0) { bounds = $within_ball(bounds, b.ball); }
    return bounds;
}
)");
}

/// Adds `store_faces`, which writes the half spaces of a box's six faces, as store_box_planes() of kinds/boxes.inl
/// does.
///
/// As `most` is the greatest n.p of the box, no light is missed, whatever n is. So that the Binner's lists are held,
/// too, errors of n are allowed for. The half axes are divided by their size, as there, and n by the size of the
/// products that it is made of: then the absolute values of its coordinates add up to at most 1. Each coordinate is off
/// by up to 15u, the Binner's by half of that, and by twice the error of directions that were transformed; 2^-14 =
/// 1024u is more where the transform stretches no length 20 times as much as another.
inline void add_faces(ShaderWriter& writer) {
    writer.add(R"(
void $store_face(uint at, $box b, vec3 n) {
    float across = abs(dot(n, b.x)) + abs(dot(n, b.y));
    float along = dot(n, b.z);
    float reach = max(across + along, across * b.taper - along) + (b.error + b.size * 6.1035156e-5);
    $store_four(at, vec4(n, dot(n, b.centre) + reach));
}

// Faces whose normals are too small, as those of line segments are, exclude nothing.
void $store_faces(uint at, $box b) {
    float size = $extent(b.x) + $extent(b.y) + $extent(b.z);
    float scale = 0.0;
    if (size > 1e-30) { scale = $quotient(1.0, size); }
    vec3 x = b.x * scale;
    vec3 y = b.y * scale;
    vec3 z = b.z * scale;
    if ($extent(x) == 0.0) { x = cross(y, z); }
    if ($extent(y) == 0.0) { y = cross(z, x); }
    if ($extent(z) == 0.0) { z = cross(x, y); }
    vec3 tilt = cross(x, y) * (0.5 - 0.5 * b.taper);
    float tilted = $extent(x) * $extent(y) * (0.5 - 0.5 * b.taper);
    if (dot(z, tilt) < 0.0) { tilt = tilt * -1.0; }
    for (uint i = 0u; i < 3u; i += 1u) {
        if (i == 2u) {
            tilt = vec3(0.0, 0.0, 0.0);
            tilted = 0.0;
        }
        vec3 n = cross(y, z);
        float products = $extent(y) * $extent(z) + tilted;
        vec3 up = vec3(0.0, 0.0, 0.0);
        vec3 down = up;
        if (products > 1e-15) {
            up = (n - tilt) * $quotient(1.0, products);
            down = (n * -1.0 - tilt) * $quotient(1.0, products);
        }
        $store_face(at + 8u * i, b, up);
        $store_face(at + 8u * i + 4u, b, down);
        n = x;
        x = y;
        y = z;
        z = n;
    }
}
)");
}

inline void add_boxes(ShaderWriter& writer, const CullOptions& options) {
    add_box_at(writer);
    add_bounds_of_box(writer);
    if (options.depth_test) add_faces(writer);
}

}}}  // namespace lightbin::detail
