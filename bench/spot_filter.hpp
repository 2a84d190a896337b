// SPDX-License-Identifier: MIT
// Whether a spot meets a cell, proven in double precision: the quick answer to most questions, as exact/filter.hpp has it
// for balls. Where it has none, exact/spot.hpp decides.
//
// What is looked for, by the method of Gilbert, Johnson and Keerthi, needs no proof. What is found does:
// - A direction n along which the whole cell lies beyond the spot. The cell's least n.p is at a corner, the spot's
//   greatest has a formula.
// - Or a point of the cell that is in the spot.
// Corners, products and sums are within 2^-45 of the sizes of their terms: each goes through fewer than 100 roundings of
// 2^-53, and where rounding may pick a case, a corner or a formula, the others give the same but for rounding. 2^-40 is
// asked for, so that no answer rests on rounding.
#pragma once

#include "exact/filter.hpp"

#include <lightbin/spot.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace oracle {

/// A point or vector in the camera's axes: x, y, depth.
using Point = glm::dvec3;

/// Of the coordinates' sizes.
inline double size_of(const Point& a) {
    return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}

/// Part of a view frustum: the points between lines through the eye, between two depths.
struct FlatCell {
    double x_low, x_high, y_low, y_high;  ///< slopes, each within 2^-52 of itself
    FlatDepths depths;
    double first, last;  ///< depths between which none is outside, however the ends are rounded

    /// The corner with the least n.p.
    Point lowest(const Point& n) const {
        const double x = n.x < 0 ? x_high : x_low, y = n.y < 0 ? y_high : y_low,
                     d = n.x * x + n.y * y + n.z < 0 ? depths.max : depths.min;
        return {d * x, d * y, d};
    }
    /// Returns an upper limit for the sum of any corner's coordinates.
    double reach() const {
        const auto steepest = [](double low, double high) { return std::max(std::abs(low), std::abs(high)); };
        return depths.max * (1 + steepest(x_low, x_high) + steepest(y_low, y_high));
    }
    Point middle() const {
        const double d = (depths.min + depths.max) / 2;
        return {d * (x_low + x_high) / 2, d * (y_low + y_high) / 2, d};
    }
    bool surely_has(const Point& p) const {
        const auto between = [&](double low, double high, double at) {
            const double margin = 0x1p-40 * (std::abs(at) + p.z * std::max(std::abs(low), std::abs(high)));
            return at - low * p.z > margin && high * p.z - at > margin;
        };
        return first <= p.z && p.z <= last && between(x_low, x_high, p.x) && between(y_low, y_high, p.y);
    }
};

/// A spot with a half angle below 90 degrees, of a finite radius.
class FlatSpot {
public:
    /// Of view space that looks down -z.
    explicit FlatSpot(const lightbin::Spot& s)
        : apex{static_cast<double>(s.x), static_cast<double>(s.y), -static_cast<double>(s.z)},
          radius_(static_cast<double>(s.radius)), cosine_(static_cast<double>(s.cos_half_angle)),
          sine_(std::sqrt((1 - cosine_) * (1 + cosine_))) {
        const Point given = {static_cast<double>(s.axis_x), static_cast<double>(s.axis_y),
                             -static_cast<double>(s.axis_z)};
        axis_ = 1 / length(given) * given;
    }

    /// Returns the point of the spot that is farthest along n, relative to the apex.
    Point farthest(const Point& n) const {
        const double along = dot(n, axis_);
        const Point aside = n - along * axis_;
        const double across = length(aside);
        if (cosine_ * across <= sine_ * along) return radius_ / length(n) * n;
        if (cosine_ * along + sine_ * across <= 0) return Point(0);
        return radius_ * (cosine_ * axis_ + sine_ / across * aside);
    }

    bool surely_has(const Point& p) const {
        const Point v = p - apex;
        const double far_off = length(v), blur = 0x1p-40 * (size_of(p) + size_of(apex));
        return far_off + blur < radius_ && dot(v, axis_) - cosine_ * far_off > blur;
    }
    Point middle() const { return apex + radius_ / 2 * axis_; }

    /// Returns true only if the whole cell certainly lies beyond the spot along n.
    bool surely_beyond(const Point& n, const FlatCell& cell) const {
        const double blur = 0x1p-40 * size_of(n) * (cell.reach() + size_of(apex) + radius_);
        return dot(n, cell.lowest(n) - apex) - dot(n, farthest(n)) > blur;
    }

    Point apex;

private:
    double radius_, cosine_, sine_;
    Point axis_;
};

namespace detail {

/// A corner of the cell, and its vector from a point of the spot.
struct Corner {
    Point at, off;
};

/// Returns the corners' weights for the point of their affine hull nearest to the spot; nothing if too flat.
inline std::optional<std::array<double, 4>> nearest_weights(const std::vector<Corner>& corners) {
    const std::size_t n = corners.size() - 1;
    double m[3][4] = {};  // the sides' products, and on the right those with the first corner
    std::array<Point, 3> side;
    for (std::size_t i = 0; i < n; ++i)
        side[i] = corners[i + 1].off - corners[0].off;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
            m[i][j] = dot(side[i], side[j]);
        m[i][3] = -dot(side[i], corners[0].off);
    }
    for (std::size_t i = 0; i < n; ++i) {  // positive definite: no pivots are looked for
        if (!(m[i][i] > 0)) return std::nullopt;
        for (std::size_t row = 0; row < n; ++row) {
            if (row == i) continue;
            const double k = m[row][i] / m[i][i];
            for (std::size_t j = i; j < 4; ++j)
                m[row][j] -= k * m[i][j];
        }
    }
    std::array<double, 4> weights{1, 0, 0, 0};
    for (std::size_t i = 0; i < n; ++i) {
        weights[i + 1] = m[i][3] / m[i][i];
        weights[0] -= weights[i + 1];
    }
    return weights;
}

/// Some corners of the cell, and their weights for the point of their hull that is nearest to the spot.
struct Nearest {
    std::vector<Corner> corners;
    Point at = Point(0), off = Point(0);  ///< the nearest point of the cell, and the vector to it from the spot
};

inline Nearest nearest(const std::vector<Corner>& corners) {
    Nearest best;
    double least = HUGE_VAL;
    for (unsigned choice = 1; choice < 1u << corners.size(); ++choice) {
        std::vector<Corner> some;
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (choice >> i & 1) some.push_back(corners[i]);
        const auto weights = nearest_weights(some);
        if (!weights ||
            *std::min_element(weights->begin(), weights->begin() + static_cast<long>(some.size())) < 0)
            continue;
        Nearest found{some};
        for (std::size_t i = 0; i < some.size(); ++i) {
            found.at = found.at + (*weights)[i] * some[i].at;
            found.off = found.off + (*weights)[i] * some[i].off;
        }
        if (length(found.off) < least) least = length(found.off), best = std::move(found);
    }
    return best;
}

/// Returns true only if the cell and the spot certainly share this point or one a little further inside.
inline bool surely_meet_at(const FlatCell& cell, const FlatSpot& spot, const Point& at) {
    const Point in_cell = cell.middle() - at, in_spot = spot.middle() - at;
    for (const double step : {0.0, 0x1p-30, 0x1p-20, 0x1p-10, 0x1p-4})
        for (const Point& way : {in_cell, in_spot, in_cell + in_spot}) {
            const Point p = at + step * way;
            if (cell.surely_has(p) && spot.surely_has(p)) return true;
        }
    return false;
}

}  // namespace detail

/// Returns whether a spot meets a cell; nothing if doubles cannot tell.
inline std::optional<bool> surely_meets(const FlatCell& cell, const FlatSpot& spot) {
    detail::Nearest nearest;
    nearest.off = cell.middle() - spot.apex;
    for (int step = 0; step < 40; ++step) {
        const Point n = nearest.off;
        if (spot.surely_beyond(n, cell)) return false;
        const Point corner = cell.lowest(n);
        std::vector<detail::Corner> corners = nearest.corners;
        corners.push_back({corner, corner - spot.apex - spot.farthest(n)});
        nearest = detail::nearest(corners);
        if (nearest.corners.empty()) return std::nullopt;
        if (detail::surely_meet_at(cell, spot, nearest.at)) return true;
        if (nearest.corners.size() == 4) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace oracle
