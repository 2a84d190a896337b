// SPDX-License-Identifier: MIT
// The part of the pass project that narrows a spot's rectangle from that of its ball to that of the sector that its
// cone cuts out of it. It does what kinds/spots.inl does, which derives the formulas. All error bounds are at least
// four times those there: once for the Binner's own error, as its rectangle must be contained, and twice for the GPU's,
// whose operations may be off by twice as much.
#pragma once

#include <lightbin/detail/shaders/cull_common.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Adds the struct of a spot and the function `spot_at`, which reads one whose ball is given. A spot that counts as
/// its ball has the axis 0, the cosine 0, the sine 1 and the tolerance 0. `least` is the least sphere around the
/// spot, or its ball where that is hardly larger; `depths` are the spot's view depths. Where `sound` is false, the
/// Binner may have the least sphere in place of the spot.
inline void add_spot_at(ShaderWriter& writer) {
    writer.add(R"(
struct $spot {
    vec4 ball;
    vec4 least;
    vec3 axis;
    float cosine;
    float sine;
    float tolerance;
    float size;
    vec2 depths;
    bool sound;
};

// How far a spot reaches from its apex in a direction; its unit axis has the lengths along and across that direction.
float $reach($spot s, float along, float across) {
    float part = clamp(s.cosine * along + s.sine * across, 0.0, 1.0);
    if (s.cosine <= along) { part = 1.0; }
    return min(s.ball.w * part + s.tolerance, s.ball.w);
}

$spot $spot_at(uint at, vec4 ball) {
    vec3 axis = @axis;                                              @if !mixed
    float cosine = @cosine;                                         @if !mixed
    vec3 axis = vec3(0.0, 0.0, 1.0);                                @if mixed
    float cosine = -1.0;                                            @if mixed
    if (at >= $kinds.z) {                                           @if mixed
        axis = @axis;                                               @if mixed
        cosine = @cosine;                                           @if mixed
    }                                                               @if mixed
    float length1 = abs(axis.x) + abs(axis.y) + abs(axis.z);
    bool sound = cosine <= -1.0 || (length1 >= 9.5367432e-7 && length1 <= 1048576.0);
    float tolerance = ball.w * 1.5258789e-5;
    tolerance += ball.w * min($column_z.w, 2.0) + max(ball.w - @stretched, 0.0);     @if world_space
    if ($column_z.w > 1.0) { sound = false; }                                                       @if world_space
    axis = $column_x.xyz * axis.x + $column_y.xyz * axis.y + $column_z.xyz * axis.z;                @if world_space
    $spot s;
    s.ball = ball;
    s.least = ball;
    s.axis = vec3(0.0, 0.0, 0.0);
    s.cosine = 0.0;
    s.sine = 1.0;
    s.tolerance = 0.0;
    s.size = abs(ball.x) + abs(ball.y) + abs(ball.z) + ball.w;
    s.sound = sound && s.size <= 1.0995116e12 && @radius >= 9.094947e-13;
    if (sound && cosine > -0.75) {
        s.axis = axis * $signs.xyz * $quotient(1.0, $root(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z));
        s.cosine = cosine;
        s.sine = $root((1.0 - cosine) * (1.0 + cosine) + 1e-37);
        s.tolerance = tolerance;
        float along = ball.w * cosine;
        float radius = ball.w * s.sine;
        if (cosine > 0.7071) {
            along = $quotient(ball.w * 0.5, cosine);
            radius = max(along, radius);
        }
        radius += s.size * 3.8146973e-6 + tolerance;
        if (cosine > 0.0 && radius < ball.w * 0.999) { s.least = vec4(ball.xyz + s.axis * along, radius); }
    }
    float across = $root(s.axis.x * s.axis.x + s.axis.y * s.axis.y + 1e-37);
    s.depths = vec2(ball.z - $reach(s, -s.axis.z, across), ball.z + $reach(s, s.axis.z, across));
    return s;
}
)");
}

/// Adds `store_half_spaces`, which writes the four half spaces around a spot's cone, as store_planes() of
/// kinds/spots.inl does, where they are derived.
///
/// Rounding, u = 2^-24. The Binner's axis is off by at most 18u of what exact arithmetic has, and this one by 32u: the
/// root's sum 3u, the root 9u, the quotient 5u, two products 4u, and the transform, of which six operations of 2u each
/// add 11u. So both axes are at most 50u apart; e and f, whose derivatives are at most 4, are at most 200u apart and
/// their own 30u, and n at most 270u. With the box's size in meets_half_space(), 2^-14 = 1024u of the spot's size is
/// more than that and what the Binner adds. `tolerance` is four times the Binner's, which is for the apex.
///
/// Both choose e and f by the sign of the axis' z. After a transform the signs may differ where z is nearly 0: there
/// the GPU has other half spaces than the Binner, which contain the spot as well.
inline void add_half_spaces(ShaderWriter& writer) {
    writer.add(R"(
void $store_half_spaces(uint at, $spot s) {
    float side = 1.0;
    if (s.axis.z < 0.0) { side = -1.0; }
    float p = $quotient(-1.0, side + s.axis.z);
    float q = s.axis.x * s.axis.y * p;
    vec3 e = vec3(1.0 + side * s.axis.x * s.axis.x * p, side * q, -side * s.axis.x);
    vec3 f = vec3(q, side + s.axis.y * s.axis.y * p, -s.axis.y);
    float across = max(s.cosine, 0.0);
    float along = s.sine;
    if (s.cosine <= 0.0) { along = 1.0; }
    float slack = s.tolerance + s.size * 6.1035156e-5 - s.ball.w * min(s.cosine, 0.0);
    for (uint i = 0u; i < 4u; i += 1u) {
        vec3 n = e;
        if (i >= 2u) { n = f; }
        if ((i & 1u) != 0u) { n = n * -1.0; }
        n = n * across - s.axis * along;
        float most = slack + n.x * s.ball.x + n.y * s.ball.y + n.z * s.ball.z;
        $store_four(at + 4u * i, vec4(n, most));
    }
}
)");
}

/// Adds `narrowed`, the slopes of a spot along an image axis: narrow_slopes() of kinds/spots.inl.
///
/// bounds       the slopes of the sphere that the spot's cone cuts
/// c            the apex's coordinate along the image axis
/// axis, other  the coordinates of the cone's axis along this and the other image axis
inline void add_narrowed(ShaderWriter& writer) {
    writer.add(R"(
// Whether a plane through the eye touches the ball at a point inside the cone; true where rounding leaves that open.
bool $touches_cap($spot s, float slope, float across) {
    float sure = across + (1.0 + abs(slope)) * 1.5258789e-5;
    return (s.cosine * abs(s.cosine) - 3.8146973e-6) * (1.0 + slope * slope) <= sure * abs(sure);
}

vec2 $narrowed($spot s, vec2 bounds, float c, float axis, float other) {
    float along = s.ball.w * s.cosine;
    float rho = s.ball.w * s.sine;
    float rho2 = rho * rho;
    float rim_z = s.ball.z + along * s.axis.z;
    float depth = rho * $root(s.axis.x * s.axis.x + s.axis.y * s.axis.y + 1e-37);
    float x = c + along * axis;
    float b = x * rim_z + rho2 * (axis * s.axis.z);
    float squares = x * x + rim_z * rim_z;
    float q = x * axis + rim_z * s.axis.z;
    float d = (squares - rho2) * (other * other) + q * q;
    float root = rho * $root(max(d, 0.0) + (squares + rho2) * 3.8146973e-6);
    float a = (rim_z - depth) * (rim_z + depth);
    float apex = $quotient(c, s.ball.z);
    float least = min($quotient(b - root, a), apex);
    float largest = max($quotient(b + root, a), apex);
    float error = $quotient(s.size * 1.5258789e-5 + s.tolerance, s.depths.x) * (1.0 + max(abs(least), abs(largest)));
    vec2 result = bounds;
    if (!$touches_cap(s, bounds.x, bounds.x * s.axis.z - axis)) { result.x = max(least - error, bounds.x); }
    if (!$touches_cap(s, bounds.y, axis - bounds.y * s.axis.z)) { result.y = min(largest + error, bounds.y); }
    return result;
}
)");
}

/// Adds the functions of spots, up to `bounds_of_spot`, which returns the bounds along x and then along y.
///
/// In perspective they are narrowed where the ball lies beyond the near plane and the spot's size is less than 2^15
/// times its least depth, half of what the Binner allows. Where the ball certainly meets the near plane they are the
/// intersection of the ball's bounds and the least sphere's, as the Binner's are. In between it is not known which of
/// these the Binner has, and they are the ball's.
inline void add_spots(ShaderWriter& writer, const CullOptions& options) {
    add_spot_at(writer);
    if (options.depth_test) add_half_spaces(writer);
    if (options.orthographic) {
        writer.add(R"(
vec2 $bounds_across($spot s, float c, float axis, float other) {
    float across = $root(other * other + s.axis.z * s.axis.z + 1e-37);
    return vec2(c - $reach(s, -axis, across), c + $reach(s, axis, across));
}

vec4 $bounds_of_spot($spot s) {
    return vec4($bounds_across(s, s.ball.x, s.axis.x, s.axis.y), $bounds_across(s, s.ball.y, s.axis.y, s.axis.x));
}
)");
        return;
    }
    add_narrowed(writer);
    writer.add(R"(
vec4 $bounds_of_spot($spot s) {
    vec4 bounds = $within_ball(@everywhere, s.ball);
    float nearest = s.ball.z - s.ball.w;
    if (nearest * 0.9999 > $planes.w && s.size * 3.0517578e-5 < s.depths.x) {
        if (s.tolerance > 0.0) {
            bounds = vec4($narrowed(s, bounds.xy, s.ball.x, s.axis.x, s.axis.y),
                          $narrowed(s, bounds.zw, s.ball.y, s.axis.y, s.axis.x));
        }
    } else if (nearest + s.size * 2.4414063e-4 < $planes.w && s.least.w < s.ball.w &&
               s.least.z + s.least.w > $planes.x) {
        bounds = $within_ball(bounds, s.least);
    }
    return bounds;
}
)");
}

}}}  // namespace lightbin::detail
