// SPDX-License-Identifier: MIT
// Exact screen bounds: where in the image the part of a ball beyond the near plane ends.
//
// Numbers have 1,100 bits and exponents without end. Inputs are floats, and a sum of two products of floats spans at most
// 555 bits, so each sum that the formulas below take of inputs is exact; roots and quotients are rounded, and what they
// lose is multiplied by no more than 2^600. So an edge is known to far more bits than a double has. agrees() holds it
// against the rational decider of oracle.hpp, which knows no root and no formula of a tangent.
#pragma once

#include "oracle.hpp"

#include <boost/multiprecision/gmp.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace oracle {

using Wide =
    boost::multiprecision::number<boost::multiprecision::gmp_float<331>, boost::multiprecision::et_off>;

/// The pixels and tiles that a light covers along one image axis.
struct AxisExtent {
    double low, high;  ///< in pixels, within the viewport
    int first, last;   ///< tiles; none if first > last, and then low and high mean nothing
};

class ScreenBounds {
public:
    /// Perspective cameras only.
    explicit ScreenBounds(const Oracle& oracle) : oracle_(oracle), near_(wide(*oracle.range().min)) {
        for (const int i : {0, 1}) {
            Axis& axis = axes_[static_cast<std::size_t>(i)];
            const Camera& camera = oracle.camera();
            axis.side = i == 0 ? camera.width : camera.height;
            axis.tiles = i == 0 ? oracle.tiles_x() : oracle.tiles_y();
            const Slab whole = slab(i, {0, axis.side});
            axis.scale = axis.side / (wide(whole.high.slope) - wide(whole.low.slope));
            axis.offset = -wide(whole.low.slope) * axis.scale;
        }
    }

    const Wide& near_depth() const { return near_; }
    double scale(int axis) const { return axes_[static_cast<std::size_t>(axis)].scale.convert_to<double>(); }
    double offset(int axis) const {
        return axes_[static_cast<std::size_t>(axis)].offset.convert_to<double>();
    }

    /// Returns the extent of the part of a ball between the near and the far plane.
    AxisExtent extent(int axis, const CameraBall& ball) const {
        const Depths& range = oracle_.range();
        if (ball.depth + ball.radius < *range.min || (range.max && ball.depth - ball.radius > *range.max))
            return {0, 0, 0, -1};
        const Wide c = wide(axis == 0 ? ball.x : ball.y), z = wide(ball.depth), r = wide(ball.radius);
        return within(axis, -largest_slope(-c, z, r), largest_slope(c, z, r));
    }

    /// Whether rational arithmetic agrees that the ball reaches the extent's ends in the viewport, and not 2^-20 pixels
    /// beyond them.
    bool agrees(int axis, const AxisExtent& extent, const CameraBall& ball) const {
        const auto meets_edges = [&](const Rational& low, const Rational& high) {
            Slabs slabs;
            (axis == 0 ? slabs.x : slabs.y) = slab(axis, {low, high});
            Depths depths = oracle_.range();
            if (extent.first <= extent.last) depths.max.reset();  // the far plane cuts no bounds
            return meets(slabs, depths, ball);
        };
        const double side = axes_[static_cast<std::size_t>(axis)].side, slack = 0x1p-20;
        if (extent.first > extent.last) return !meets_edges(0, exact(side));
        if (extent.low > 0 && (meets_edges(-far_off(), exact(extent.low - slack)) ||
                               !meets_edges(-far_off(), exact(extent.low + slack))))
            return false;
        return extent.high >= side || (!meets_edges(exact(extent.high + slack), far_off()) &&
                                       meets_edges(exact(extent.high - slack), far_off()));
    }

private:
    struct Axis {
        Wide scale, offset;  ///< pixel = scale * slope + offset
        int side, tiles;
    };

    static Wide wide(const Rational& value) { return Wide(numerator(value)) / Wide(denominator(value)); }
    static Rational far_off() { return Rational(1 << 24); }

    Slab slab(int axis, const Edges& edges) const {
        return axis == 0 ? oracle_.column_slab(edges) : oracle_.row_slab(edges);
    }

    /// Returns the largest slope c / z in the part of a disc (c, z, r) beyond the near plane: at the tangent through
    /// the eye if it touches there, else where circle and plane meet.
    Wide largest_slope(const Wide& c, const Wide& z, const Wide& r) const {
        const Wide d2 = c * c + z * z, t2 = d2 - r * r;
        if (t2 > 0) {
            // The direction of the disc's centre, turned by the angle of the tangent.
            const Wide t = sqrt(t2), forward = z * t - c * r;
            if (forward > 0 && (z - r > near_ || t * forward >= near_ * d2)) return (c * t + z * r) / forward;
        }
        const Wide w = near_ - z, h2 = (r - w) * (r + w);
        return (c + sqrt(h2 > 0 ? h2 : Wide(0))) / near_;
    }

    AxisExtent within(int i, const Wide& low_slope, const Wide& high_slope) const {
        const Axis& axis = axes_[static_cast<std::size_t>(i)];
        const Wide low = axis.scale * low_slope + axis.offset, high = axis.scale * high_slope + axis.offset;
        if (high < 0 || low > axis.side) return {0, 0, 0, -1};
        const auto clamped = [&](const Wide& at) { return std::clamp<Wide>(at, Wide(0), Wide(axis.side)); };
        const auto tile = [&](const Wide& at) {
            return std::min(Wide(floor(clamped(at) / oracle_.camera().tile)).convert_to<int>(),
                            axis.tiles - 1);
        };
        return {clamped(low).convert_to<double>(), clamped(high).convert_to<double>(), tile(low), tile(high)};
    }

    const Oracle& oracle_;
    Wide near_;
    std::array<Axis, 2> axes_;
};

}  // namespace oracle
