// SPDX-License-Identifier: MIT
// What the lists ought to hold: for every tile and light of a scene, by exact arithmetic, whether the sphere
// meets the tile's cell, and whether each rung of the ladder would keep it if its numbers were never rounded.
//
// Decided in double precision where a bound on its rounding proves the answer, else by the rational oracle of
// the tests. A slope or a plane's depth is rounded once, and at most six roundings follow, so each sum below
// is within 2^-50 of its terms' sizes; 2^-48 is allowed for.
#pragma once

#include "raster.hpp"

#include "../tests/oracle/oracle.hpp"

#include <lightbin/z_bounds.hpp>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

/// What may be true of a tile and a light.
enum Fact : std::uint32_t {
    in_pyramid = 1,     ///< the sphere meets the tile's cell without Z bounds
    in_cell = 2,        ///< ... between the tile's minimum and maximum depth
    in_split = 4,       ///< ... and outside its gap: the exact set
    by_interval = 8,    ///< the sphere's depths meet the tile's
    by_box = 16,        ///< it meets the view-space box around the cell
    by_split_box = 32,  ///< it meets one of the boxes before and behind the gap
};

/// A light in whose rectangle, by exact arithmetic, a tile lies.
struct Pair {
    std::uint32_t id;
    std::uint32_t facts;
};

struct ExactPairs {
    std::vector<std::vector<Pair>> tiles;  ///< ids ascend
    std::uint64_t verdicts = 0;            ///< pairs of a tile and a light decided: all there are
    std::uint64_t by_rationals = 0;        ///< questions that double precision left open
};

class ExactDecider {
public:
    /// A symmetric perspective matrix; tiles from the lower left corner.
    ExactDecider(const glm::mat4& projection, lightbin::Extent screen, int tile_size)
        : oracle_(camera(projection, screen, tile_size)), view_{oracle_.range().min->convert_to<double>(),
                                                                oracle_.range().max->convert_to<double>()} {
        for (int x = 0; x <= oracle_.tiles_x(); ++x)
            columns_.emplace_back(oracle_.column_slab(oracle_.columns(x, x)).low);
        for (int y = 0; y <= oracle_.tiles_y(); ++y)
            rows_.emplace_back(oracle_.row_slab(oracle_.rows(y, y)).low);
    }

    /// Decides every pair of a tile and a light. Gap spans may be empty.
    ExactPairs pairs(const Lights& lights, const lightbin::ZBounds& bounds) {
        const std::size_t nx = columns_.size() - 1, ny = rows_.size() - 1;
        ExactPairs result{std::vector<std::vector<Pair>>(nx * ny), nx * ny * lights.size(), 0};
        by_rationals_ = 0;
        for (std::size_t id = 0; id < lights.size(); ++id) {
            const Ball ball(lights[id]);
            const Span across = met(columns_, ball, true), up = met(rows_, ball, false);
            for (std::size_t y = up.first; y < up.end; ++y)
                for (std::size_t x = across.first; x < across.end; ++x)
                    result.tiles[y * nx + x].push_back(
                        {static_cast<std::uint32_t>(id), facts(ball, x, y, y * nx + x, bounds)});
        }
        result.by_rationals = by_rationals_;
        return result;
    }

private:
    using Rational = oracle::Rational;
    static constexpr double share = 0x1p-48;

    /// A plane  coordinate = slope * depth  through the eye.
    struct Edge {
        explicit Edge(const oracle::Line& line) : exact(line), slope(line.slope.convert_to<double>()) {
            assert(line.offset.is_zero());
        }
        oracle::Line exact;
        double slope;
    };
    struct Ball {
        explicit Ball(const glm::vec4& v)
            : x(static_cast<double>(v.x)), y(static_cast<double>(v.y)), depth(-static_cast<double>(v.z)),
              radius(static_cast<double>(v.w)) {}
        double x, y, depth, radius;
    };
    /// View depths. The ends are floats, so exact, or those of view_.
    struct Range {
        double min, max;
        bool empty() const { return !(min <= max); }
    };
    struct Span {
        std::size_t first, end;
    };

    static oracle::Camera camera(const glm::mat4& projection, lightbin::Extent screen, int tile_size) {
        oracle::Camera camera;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                camera.m[column][row] = static_cast<double>(projection[column][row]);
        camera.width = screen.width, camera.height = screen.height, camera.tile = tile_size;
        return camera;
    }

    Range within_view(float min, float max) const {
        return {std::max(static_cast<double>(min), view_.min), std::min(static_cast<double>(max), view_.max)};
    }

    /// The columns (rows) of tiles whose wedges the ball meets. They are neighbours, as the ball is convex.
    Span met(const std::vector<Edge>& edges, const Ball& ball, bool across) {
        const auto meets_wedge = [&](std::size_t i) {
            return across ? meets(&edges[i], nullptr, view_, ball) : meets(nullptr, &edges[i], view_, ball);
        };
        std::size_t first = 0, end = edges.size() - 1;
        while (first < end && !meets_wedge(first))
            ++first;
        while (first < end && !meets_wedge(end - 1))
            --end;
        return {first, end};
    }

    std::uint32_t facts(const Ball& ball, std::size_t x, std::size_t y, std::size_t tile,
                        const lightbin::ZBounds& bounds) {
        const float min = bounds.min[tile], max = bounds.max[tile];
        const bool pyramid = meets(&columns_[x], &rows_[y], view_, ball);
        std::uint32_t facts = pyramid ? +in_pyramid : 0;
        // Exact in double: two floats of 24 bits that are not 2^29 times apart.
        if (!(min <= max) || ball.depth + ball.radius < static_cast<double>(min) ||
            ball.depth - ball.radius > static_cast<double>(max))
            return facts;
        facts |= by_interval;
        const Range whole = within_view(min, max);
        if (whole.empty() || !meets_box(x, y, whole, ball)) return facts;
        facts |= by_box;
        const bool cell = pyramid && meets(&columns_[x], &rows_[y], whole, ball);
        if (cell) facts |= in_cell;
        const bool gap = !bounds.gap_min.empty() && bounds.gap_min[tile] < bounds.gap_max[tile];
        if (!gap) return facts | by_split_box | (cell ? +in_split : 0);
        for (const Range& part :
             {within_view(min, bounds.gap_min[tile]), within_view(bounds.gap_max[tile], max)}) {
            if (part.empty() || !meets_box(x, y, part, ball)) continue;
            facts |= by_split_box;
            if (cell && meets(&columns_[x], &rows_[y], part, ball)) facts |= in_split;
        }
        return facts;
    }

    /// Whether the ball meets the cell between x[0] and x[1], y[0] and y[1] (null: that axis has no bounds).
    bool meets(const Edge* x, const Edge* y, const Range& range, const Ball& ball) {
        return settle(proven_to_meet(x, y, range, ball), [&] {
            oracle::Slabs slabs;
            if (x != nullptr) slabs.x = {x[0].exact, x[1].exact};
            if (y != nullptr) slabs.y = {y[0].exact, y[1].exact};
            return oracle::meets(slabs, exact(range), exact(ball));
        });
    }

    /// The answer in double precision, or where there is none, and now and then as a check, the exact one.
    template <class Exact> bool settle(std::optional<bool> proven, Exact by_rationals) {
        const bool checked = ++questions_ % 1009 == 0;
        by_rationals_ += !proven;
        if (proven && !checked) return *proven;
        const bool truth = by_rationals();
        if (proven && *proven != truth) throw std::logic_error("the exact set's two deciders disagree");
        return truth;
    }

    std::optional<bool> proven_to_meet(const Edge* x, const Edge* y, const Range& range,
                                       const Ball& ball) const {
        // The cell's nearest point lies at a depth where one of the pieces of the distance, a convex function
        // of depth, is least, or at an end (oracle.hpp). How well it is found decides nothing.
        double best = std::numeric_limits<double>::infinity(), depth = 0;
        const auto consider = [&](double d) {
            d = std::clamp(d, range.min, range.max);
            const double dx = outside(x, ball.x, d), dy = outside(y, ball.y, d), dz = d - ball.depth;
            const double distance = dx * dx + dy * dy + dz * dz;
            if (distance < best) best = distance, depth = d;
        };
        for (int i = 0; i < (x == nullptr ? 1 : 3); ++i)
            for (int j = 0; j < (y == nullptr ? 1 : 3); ++j) {
                const double u = i == 0 ? 0 : x[i - 1].slope, v = j == 0 ? 0 : y[j - 1].slope;
                consider((ball.depth + u * ball.x + v * ball.y) / (1 + u * u + v * v));
            }
        consider(range.min);
        consider(range.max);

        // The point is in the cell, but for rounding, and in the ball whatever that was?
        const double nx = outside(x, ball.x, depth), ny = outside(y, ball.y, depth), nz = depth - ball.depth;
        const auto grown = [&](const Edge* edges, double gap, double c) {
            if (edges == nullptr) return 0.0;
            return std::fabs(gap) + share * (std::fabs(c) + depth * largest(edges));
        };
        const double gx = grown(x, nx, ball.x), gy = grown(y, ny, ball.y), gz = std::fabs(nz) + share * depth;
        const double reach = ball.radius * ball.radius;
        if ((gx * gx + gy * gy + gz * gz) * (1 + share) <= reach) return true;

        // Else does the plane through it, square to the way from the centre, part the two? On the cell
        // n.p = d (n_x s_x + n_y s_y + n_z), least at one end of the depths, with s the low edge for a
        // positive component of n and the high edge for a negative one.
        const double sx = x == nullptr ? 0 : nx * x[nx > 0 ? 0 : 1].slope;
        const double sy = y == nullptr ? 0 : ny * y[ny > 0 ? 0 : 1].slope;
        const double along =
            sx + sy + nz - share * (std::fabs(sx) + std::fabs(sy) + std::fabs(nz));  // at least
        const double cell = std::min(along * range.min, along * range.max);
        const double centre = nx * ball.x + ny * ball.y + nz * ball.depth;
        const double sizes = std::fabs(nx * ball.x) + std::fabs(ny * ball.y) + std::fabs(nz * ball.depth);
        const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
        if (cell - centre - share * (sizes + std::fabs(cell)) > ball.radius * length * (1 + share))
            return false;
        return std::nullopt;
    }

    /// From the coordinate to the nearest one of the slab at a depth, with its sign.
    static double outside(const Edge* edges, double c, double depth) {
        if (edges == nullptr) return 0;
        const double low = edges[0].slope * depth - c, high = edges[1].slope * depth - c;
        return low > 0 ? low : high < 0 ? high : 0;
    }
    static double largest(const Edge* edges) {
        return std::max(std::fabs(edges[0].slope), std::fabs(edges[1].slope));
    }

    /// Whether the ball meets the view-space box around the part of tile (x, y) in this range.
    bool meets_box(std::size_t x, std::size_t y, const Range& range, const Ball& ball) {
        return settle(proven_to_meet_box(x, y, range, ball),
                      [&] { return exactly_meets_box(x, y, range, ball); });
    }

    std::optional<bool> proven_to_meet_box(std::size_t x, std::size_t y, const Range& range,
                                           const Ball& ball) const {
        double least = 0, most = 0;  // squared distance, rounded either way
        const auto add = [&](double low, double high, double c) {
            const double gap = std::max({low - c, c - high, 0.0}),
                         error = share * (std::fabs(low) + std::fabs(high) + std::fabs(c));
            least += std::max(gap - error, 0.0) * std::max(gap - error, 0.0);
            most += (gap + error) * (gap + error);
        };
        const auto add_slab = [&](const Edge* edges, double c) {
            const double low = edges[0].slope, high = edges[1].slope;
            add(std::min(low * range.min, low * range.max), std::max(high * range.min, high * range.max), c);
        };
        add_slab(&columns_[x], ball.x);
        add_slab(&rows_[y], ball.y);
        add(range.min, range.max, ball.depth);
        const double reach = ball.radius * ball.radius;
        if (most * (1 + share) <= reach) return true;
        if (least > reach * (1 + share)) return false;
        return std::nullopt;
    }

    bool exactly_meets_box(std::size_t x, std::size_t y, const Range& range, const Ball& ball) const {
        const oracle::Depths depths = exact(range);
        const oracle::CameraBall centre = exact(ball);
        Rational distance = 0;
        const auto add_exact = [&](const Rational& low, const Rational& high, const Rational& c) {
            if (c < low) distance += oracle::square(low - c);
            if (c > high) distance += oracle::square(c - high);
        };
        const auto add_exact_slab = [&](const Edge* edges, const Rational& c) {
            const Rational &low = edges[0].exact.slope, &high = edges[1].exact.slope;
            add_exact(low * (low < 0 ? *depths.max : *depths.min),
                      high * (high < 0 ? *depths.min : *depths.max), c);
        };
        add_exact_slab(&columns_[x], centre.x);
        add_exact_slab(&rows_[y], centre.y);
        add_exact(*depths.min, *depths.max, centre.depth);
        return distance <= oracle::square(centre.radius);
    }

    oracle::Depths exact(const Range& range) const {
        const oracle::Depths& all = oracle_.range();
        return {range.min == view_.min ? *all.min : Rational(range.min),
                range.max == view_.max ? *all.max : Rational(range.max)};
    }
    static oracle::CameraBall exact(const Ball& ball) {
        return {Rational(ball.x), Rational(ball.y), Rational(ball.depth), Rational(ball.radius)};
    }

    oracle::Oracle oracle_;
    Range view_;
    std::vector<Edge> columns_, rows_;
    std::uint64_t questions_ = 0, by_rationals_ = 0;
};
