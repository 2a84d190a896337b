// SPDX-License-Identifier: MIT
// Whether a ball meets a cell, proven in double precision: the quick answer to most questions. Where it has none,
// oracle.hpp decides. It is the one decider in double precision: the exact tests and the bench both ask it.
//
// They do not meet. A direction n separates a ball from a cell if  n.p > n.c + r |n|  for every point p of the cell.
// Which n to try is found with ordinary rounding and needs no proof: a bad one only proves nothing. What is proven is
// the inequality, for the n that came out, as the doubles they are:
// - On a cell low(d) <= x <= high(d), the same in y, d0 <= d <= d1, lines  offset + slope d,  a positive n_x meets
//   its least product on the low line, a negative one on the high line. So
//       n.p >= A + B d,  A = n_x offset_x + n_y offset_y,  B = n_x slope_x + n_y slope_y + n_z,
//   least at d0 if B >= 0 and at d1 if B <= 0; a B whose sign rounding hides proves nothing.
// - Lines and ends of depth are rationals cut to double, each within 2^-52 of itself; n, c, r are exact. A term of
//   A, B d or n.c is a product of at most three of them and goes through fewer than 12 roundings of 2^-53, so it
//   is within 2^-48 of itself in the computed sum (of B alone as well): the error of a sum is at most 2^-48 of the
//   sum of its terms' sizes. 2^-47 is taken, for the roundings of that bound and of the comparison.
// - Overflow leaves infinity or NaN, for which no comparison below holds. Underflow of a product is less than
//   2^-1074, times at most 2^230 later on: nothing beside the 2^-800 that is asked of the difference.
//
// They meet. The cell has a point at every depth between its ends: the one nearest to the centre, whose distance along
// each image axis is a difference of the centre's coordinate and a line at that depth. That is four roundings of its
// terms, and the depth itself may be an end that was cut to double, 2^-52 of it: 2^-48 of the sizes is taken for both.
#pragma once

#include "oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace oracle {

/// View depths in double, each end within 2^-52 of the true one; max may be +inf.
struct FlatDepths {
    double min = 0, max = 0;

    explicit FlatDepths(const Depths& depths)
        : min(nearly(*depths.min)),
          max(depths.max ? nearly(*depths.max) : std::numeric_limits<double>::infinity()) {}
    FlatDepths(double low, double high) : min(low), max(high) {}
    FlatDepths() = default;

    /// Returns true only if it is certain that no depth lies between min and max.
    bool surely_empty() const { return min - max > 0x1p-50 * (std::abs(min) + std::abs(max)); }
    /// Beyond doubt some do.
    bool surely_some() const {
        return min < max && (std::isinf(max) || max - min > 0x1p-50 * (std::abs(min) + std::abs(max)));
    }
};

/// A ball in the camera's axes, exact.
struct FlatBall {
    double x, y, depth, radius;
};

class Filter {
public:
    explicit Filter(const Oracle& exact)
        : oracle_(exact), columns_(static_cast<std::size_t>(exact.tiles_x()) + 1),
          rows_(static_cast<std::size_t>(exact.tiles_y()) + 1) {}

    /// Returns true if it is proven that the ball does not meet these tiles between these depths.
    bool apart(int x0, int x1, int y0, int y1, const FlatDepths& depths, const FlatBall& ball) {
        if (separates({0, 0, ball.depth < depths.min ? 1.0 : -1.0}, {}, depths, ball)) return true;
        const Cell cell = {{{column(x0), column(x1)}, {row(y0), row(y1)}}};
        for (const int axis : {0, 1})
            for (const int side : {0, 1})
                if (separates(of_planes(axis, side == 0 ? 1.0 : -1.0, cell), cell, depths, ball)) return true;
        return apart_at_edge(cell, cell, depths, ball);
    }

    /// Returns whether the ball meets these tiles between these depths; nothing if doubles cannot tell.
    std::optional<bool> meets(int x0, int x1, int y0, int y1, const FlatDepths& depths,
                              const FlatBall& ball) {
        if (apart(x0, x1, y0, y1, depths, ball)) return false;
        if (reaches({{{column(x0), column(x1)}, {row(y0), row(y1)}}}, depths, ball)) return true;
        return std::nullopt;
    }
    /// Whether a sphere meets the wedge that whole columns or rows of tiles show; nothing if doubles cannot tell.
    std::optional<bool> meets_columns(int x0, int x1, const FlatDepths& depths, const FlatBall& ball) {
        return meets_wedge(0, {column(x0), column(x1)}, depths, ball);
    }
    std::optional<bool> meets_rows(int y0, int y1, const FlatDepths& depths, const FlatBall& ball) {
        return meets_wedge(1, {row(y0), row(y1)}, depths, ball);
    }

    /// The squared distance of the ball's centre from the wedge of space that a column or row of tiles shows, within
    /// 2^-48 of the sizes involved.
    double column_distance2(int x, const FlatDepths& depths, const FlatBall& ball) {
        double at = 0;
        return nearest(wedge(0, {column(x), column(x + 1)}), depths, ball, at);
    }
    double row_distance2(int y, const FlatDepths& depths, const FlatBall& ball) {
        double at = 0;
        return nearest(wedge(1, {row(y), row(y + 1)}), depths, ball, at);
    }

    /// The squared distance of the ball's centre from the box around a tile's cell, give or take 2^-48 of the
    /// box's sides and of itself.
    double box_distance2(int x, int y, const FlatDepths& depths, const FlatBall& ball) {
        const auto outside = [](double low, double high, double c) {
            return std::max(std::max(low - c, c - high), 0.0);
        };
        const auto across = [&](const FlatLine& low, const FlatLine& high, double c) {
            return outside(std::min(low.at(depths.min), low.at(depths.max)),
                           std::max(high.at(depths.min), high.at(depths.max)), c);
        };
        const double u = across(column(x), column(x + 1), ball.x), v = across(row(y), row(y + 1), ball.y),
                     w = outside(depths.min, depths.max, ball.depth);
        return u * u + v * v + w * w;
    }

    struct Direction {
        double x, y, z;
    };

    /// Returns true if every point p of the cell behind the tiles [x0, x1) x [y0, y1) between these depths is proven to
    /// have n.p > reach; false means unknown.
    bool beyond(const Direction& n, int x0, int x1, int y0, int y1, const FlatDepths& depths, double reach) {
        const Cell cell = {{{column(x0), column(x1)}, {row(y0), row(y1)}}};
        double sizes = 0;
        const auto along = least_along(n, cell, depths, sizes);
        return along && *along - 0x1p-47 * sizes > reach;
    }
    /// Tilts a direction that is at right angles to an edge of the cell, so that the sign of B is certain.
    Direction tilted(const Direction& n, int x0, int x1, int y0, int y1) {
        const Cell cell = {{{column(x0), column(x1)}, {row(y0), row(y1)}}};
        const Direction up = lifted(n.x, n.y, cell);
        return std::abs(n.z - up.z) <= 0x1p-40 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) ? up : n;
    }
    /// Returns directions that may separate a shape from the cell: at right angles to its sides, along depth, and along
    /// its edges.
    std::array<Direction, 6> sides(int x0, int x1, int y0, int y1) {
        const Cell cell = {{{column(x0), column(x1)}, {row(y0), row(y1)}}};
        return {{of_planes(0, 1, cell),
                 of_planes(0, -1, cell),
                 of_planes(1, 1, cell),
                 of_planes(1, -1, cell),
                 {0, 0, 1},
                 {0, 0, -1}}};
    }
    std::array<Direction, 6> edges(int x0, int x1, int y0, int y1) {
        const double u[] = {column(x0).slope, column(x1).slope}, v[] = {row(y0).slope, row(y1).slope};
        return {{{1, 0, 0}, {0, 1, 0}, {u[0], v[0], 1}, {u[1], v[0], 1}, {u[0], v[1], 1}, {u[1], v[1], 1}}};
    }

private:
    struct FlatLine {
        double offset = 0, slope = 0;
        bool known = false;
        double at(double d) const { return offset + slope * d; }
    };
    struct Cell {
        FlatLine side[2][2];  ///< axis, low or high
    };
    /// Returns a line that bounds nothing, for an axis without bounds.
    static FlatLine nowhere(int direction) {
        return {direction * std::numeric_limits<double>::infinity(), 0, true};
    }

    const FlatLine& column(int x) { return line(columns_, x, true); }
    const FlatLine& row(int y) { return line(rows_, y, false); }
    const FlatLine& line(std::vector<FlatLine>& lines, int edge, bool across) {
        FlatLine& flat = lines[static_cast<std::size_t>(edge)];
        if (!flat.known) {
            const Line exact = across ? oracle_.column_slab(oracle_.columns(edge, edge)).low
                                      : oracle_.row_slab(oracle_.rows(edge, edge)).low;
            flat = {nearly(exact.offset), nearly(exact.slope), true};
        }
        return flat;
    }

    /// Returns the direction with these x and y that is at right angles to the cell's lines, with a tilt that makes the
    /// sign of B (see the top) certain.
    static Direction lifted(double x, double y, const Cell& cell) {
        const double u = x * cell.side[0][x > 0 ? 0 : 1].slope, v = y * cell.side[1][y > 0 ? 0 : 1].slope;
        return {x, y, 0x1p-44 * (std::abs(u) + std::abs(v)) - (u + v)};
    }
    static Direction of_planes(int axis, double towards, const Cell& cell) {
        return axis == 0 ? lifted(towards, 0, cell) : lifted(0, towards, cell);
    }

    /// Returns the least n.p of a cell's points p, with an error of at most 2^-47 of `sizes`; or nothing.
    static std::optional<double> least_along(const Direction& n, const Cell& cell, const FlatDepths& depths,
                                             double& sizes) {
        const FlatLine& x = cell.side[0][n.x > 0 ? 0 : 1];
        const FlatLine& y = cell.side[1][n.y > 0 ? 0 : 1];
        const double b = n.x * x.slope + n.y * y.slope + n.z;
        const double b_error = 0x1p-47 * (std::abs(n.x * x.slope) + std::abs(n.y * y.slope) + std::abs(n.z));
        if (!(std::abs(b) >= b_error)) return std::nullopt;
        const double d = b >= 0 ? depths.min : depths.max;
        sizes = std::abs(n.x * x.offset) + std::abs(n.y * y.offset) +
                (std::abs(n.x * x.slope) + std::abs(n.y * y.slope) + std::abs(n.z)) * std::abs(d);
        return n.x * x.offset + n.y * y.offset + b * d;
    }

    static bool separates(const Direction& n, const Cell& cell, const FlatDepths& depths, const FlatBall& c) {
        double sizes = 0;
        const auto along = least_along(n, cell, depths, sizes);
        if (!along) return false;
        const double centre = n.x * c.x + n.y * c.y + n.z * c.depth;
        sizes += std::abs(n.x * c.x) + std::abs(n.y * c.y) + std::abs(n.z * c.depth);
        const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        const double gap = *along - centre;
        return gap > 0x1p-800 && gap - 0x1p-47 * sizes > c.radius * length * (1 + 0x1p-47);
    }

    /// Returns the part of space between two lines of one image axis, unbounded along the other axis.
    static Cell wedge(std::size_t axis, const FlatLine (&lines)[2]) {
        Cell cell = {{{nowhere(-1), nowhere(1)}, {nowhere(-1), nowhere(1)}}};
        cell.side[axis][0] = lines[0], cell.side[axis][1] = lines[1];
        return cell;
    }

    std::optional<bool> meets_wedge(std::size_t axis, const FlatLine (&lines)[2], const FlatDepths& depths,
                                    const FlatBall& ball) {
        if (apart_from_wedge(axis, lines, depths, ball)) return false;
        if (reaches(wedge(axis, lines), depths, ball)) return true;
        return std::nullopt;
    }

    /// Returns whether a direction with no part along the other image axis separates the ball from a wedge.
    static bool apart_from_wedge(std::size_t axis, const FlatLine (&lines)[2], const FlatDepths& depths,
                                 const FlatBall& ball) {
        if (separates({0, 0, ball.depth < depths.min ? 1.0 : -1.0}, {}, depths, ball)) return true;
        Cell cell = {};
        cell.side[axis][0] = lines[0], cell.side[axis][1] = lines[1];
        for (const double towards : {1.0, -1.0})
            if (separates(of_planes(static_cast<int>(axis), towards, cell), cell, depths, ball)) return true;
        return apart_at_edge(wedge(axis, lines), cell, depths, ball);
    }

    /// Returns true only if some of these depths are certainly in view. A camera may have no depth between its planes.
    bool some(const FlatDepths& depths) const { return !oracle_.range().empty && depths.surely_some(); }

    static double clamped(double v, double low, double high) { return v < low ? low : v > high ? high : v; }

    /// Returns the cell's squared distance from the ball's centre, and the depth of the nearest point.
    static double nearest(const Cell& cell, const FlatDepths& depths, const FlatBall& c, double& best_d) {
        const double centre[2] = {c.x, c.y};
        double best = std::numeric_limits<double>::infinity();
        const auto distance = [&](double d) {
            double sum = (d - c.depth) * (d - c.depth);
            for (const int axis : {0, 1}) {
                const FlatLine(&lines)[2] = cell.side[axis];
                const double off = centre[axis] - clamped(centre[axis], lines[0].at(d), lines[1].at(d));
                sum += off * off;
            }
            return sum;
        };
        const auto consider = [&](double d) {
            d = clamped(d, depths.min, depths.max);
            const double f = distance(d);
            if (f < best) best = f, best_d = d;
        };
        for (int i = -1; i < 2; ++i)
            for (int j = -1; j < 2; ++j) {
                double top = c.depth, bottom = 1;
                if (i >= 0) {
                    const FlatLine& line = cell.side[0][i];
                    top += line.slope * (c.x - line.offset), bottom += line.slope * line.slope;
                }
                if (j >= 0) {
                    const FlatLine& line = cell.side[1][j];
                    top += line.slope * (c.y - line.offset), bottom += line.slope * line.slope;
                }
                consider(top / bottom);
            }
        consider(depths.min);
        if (std::isfinite(depths.max)) consider(depths.max);
        return best;
    }

    /// Returns true only if the cell's point at the depth of its nearest point is certainly in the ball.
    bool reaches(const Cell& cell, const FlatDepths& depths, const FlatBall& c) const {
        if (!some(depths)) return false;
        const double centre[2] = {c.x, c.y};
        double d = 0;
        nearest(cell, depths, c, d);
        const auto squared = [](double v) { return v * v; };
        double distance2 = squared(std::abs(d - c.depth) + 0x1p-48 * (std::abs(d) + std::abs(c.depth)));
        for (const int axis : {0, 1}) {
            const FlatLine(&lines)[2] = cell.side[axis];
            if (std::isinf(lines[0].offset)) continue;  // not bounded
            const double off = centre[axis] - clamped(centre[axis], lines[0].at(d), lines[1].at(d));
            const auto size = [&](const FlatLine& line) {
                return std::abs(line.offset) + std::abs(line.slope * d);
            };
            distance2 += squared(std::abs(off) + 0x1p-48 * (std::abs(centre[axis]) +
                                                            std::max(size(lines[0]), size(lines[1]))));
        }
        const double reach = c.radius * c.radius;
        return reach > 0x1p-800 && distance2 * (1 + 0x1p-48) <= reach;
    }

    /// Tries the direction to the point of `found` nearest to the ball; `found` may lack the bounds of one axis.
    static bool apart_at_edge(const Cell& found, const Cell& cell, const FlatDepths& depths,
                              const FlatBall& c) {
        const double centre[2] = {c.x, c.y};
        double best_d = 0;
        nearest(found, depths, c, best_d);
        double n[2];
        for (const int axis : {0, 1}) {
            const FlatLine(&lines)[2] = found.side[axis];
            n[axis] = clamped(centre[axis], lines[0].at(best_d), lines[1].at(best_d)) - centre[axis];
        }
        return separates(lifted(n[0], n[1], cell), cell, depths, c) ||
               separates({n[0], n[1], best_d - c.depth}, cell, depths, c);
    }

    const Oracle& oracle_;
    std::vector<FlatLine> columns_, rows_;  ///< at tile edges
};

}  // namespace oracle
