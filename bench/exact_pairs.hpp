// SPDX-License-Identifier: MIT
// What the lists ought to hold: for every tile and light of a scene, by exact arithmetic, whether the sphere
// meets the tile's cell, and whether each rung of the ladder would keep it if its numbers were never rounded.
//
// Decided in double precision where that proves the answer, else in rationals.
#pragma once

#include "exact/truth.hpp"
#include "raster.hpp"

#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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

/// Calls visit(pair, whether the tile's list has its light) for each of a tile's pairs. The list's ids ascend.
template <class Visit>
void for_each_listed(std::span<const Pair> pairs, std::span<const std::uint32_t> list, Visit visit) {
    auto id = list.begin();
    for (const Pair& pair : pairs) {
        while (id != list.end() && *id < pair.id)
            ++id;
        visit(pair, id != list.end() && *id == pair.id);
    }
}

class ExactDecider {
public:
    /// A symmetric perspective matrix; tiles from the lower left corner.
    ExactDecider(const glm::mat4& projection, lightbin::Extent screen, int tile_size)
        : truth_(camera(projection, screen, tile_size)) {}

    /// Decides every pair of a tile and a light. Gap spans may be empty.
    ExactPairs pairs(const Lights& lights, const lightbin::ZBounds& bounds) {
        const int nx = truth_.oracle.tiles_x(), ny = truth_.oracle.tiles_y();
        const std::size_t tiles = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
        ExactPairs result{std::vector<std::vector<Pair>>(tiles), tiles * lights.size(), 0};
        const std::uint64_t before = truth_.by_rationals();
        for (std::size_t id = 0; id < lights.size(); ++id) {
            const oracle::FlatBall ball = {
                static_cast<double>(lights[id].x), static_cast<double>(lights[id].y),
                -static_cast<double>(lights[id].z), static_cast<double>(lights[id].w)};
            const Span across = met(nx, [&](int x) { return truth_.meets_columns(x, x + 1, ball, Exactly{ball}); }),
                       up = met(ny, [&](int y) { return truth_.meets_rows(y, y + 1, ball, Exactly{ball}); });
            for (int y = up.first; y < up.end; ++y)
                for (int x = across.first; x < across.end; ++x) {
                    const std::size_t tile = static_cast<std::size_t>(y * nx + x);
                    result.tiles[tile].push_back(
                        {static_cast<std::uint32_t>(id), facts(ball, x, y, tile, bounds)});
                }
        }
        result.by_rationals = truth_.by_rationals() - before;
        return result;
    }

private:
    using Ball = oracle::FlatBall;
    using Range = oracle::FlatDepths;  ///< the ends are floats, so exact, or those of the view
    using Rational = oracle::Rational;
    struct Span {
        int first, end;
    };
    /// A ball in rationals, once they are asked for.
    struct Exactly {
        const Ball& ball;
        oracle::CameraBall operator()() const {
            return {Rational(ball.x), Rational(ball.y), Rational(ball.depth), Rational(ball.radius)};
        }
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
        return {std::max(static_cast<double>(min), truth_.range.min), std::min(static_cast<double>(max), truth_.range.max)};
    }
    static bool empty(const Range& range) { return !(range.min <= range.max); }

    /// The columns (rows) of tiles whose wedges the ball meets. They are neighbours, as the ball is convex.
    template <class Meets> static Span met(int count, Meets meets) {
        Span span = {0, count};
        while (span.first < span.end && !meets(span.first))
            ++span.first;
        while (span.first < span.end && !meets(span.end - 1))
            --span.end;
        return span;
    }

    std::uint32_t facts(const Ball& ball, int x, int y, std::size_t tile, const lightbin::ZBounds& bounds) {
        const float min = bounds.min[tile], max = bounds.max[tile];
        const bool pyramid = meets(x, y, truth_.range, ball);
        std::uint32_t facts = pyramid ? +in_pyramid : 0;
        // Exact in double: two floats of 24 bits that are not 2^29 times apart.
        if (!(min <= max) || ball.depth + ball.radius < static_cast<double>(min) ||
            ball.depth - ball.radius > static_cast<double>(max))
            return facts;
        facts |= by_interval;
        const Range whole = within_view(min, max);
        if (empty(whole) || !meets_box(x, y, whole, ball)) return facts;
        facts |= by_box;
        const bool cell = pyramid && meets(x, y, whole, ball);
        if (cell) facts |= in_cell;
        const bool gap = !bounds.gap_min.empty() && bounds.gap_min[tile] < bounds.gap_max[tile];
        if (!gap) return facts | by_split_box | (cell ? +in_split : 0);
        for (const Range& part :
             {within_view(min, bounds.gap_min[tile]), within_view(bounds.gap_max[tile], max)}) {
            if (empty(part) || !meets_box(x, y, part, ball)) continue;
            facts |= by_split_box;
            if (cell && meets(x, y, part, ball)) facts |= in_split;
        }
        return facts;
    }

    /// Whether the ball meets the cell of tile (x, y) in this range.
    bool meets(int x, int y, const Range& range, const Ball& ball) {
        return truth_.meets({x, x + 1, y, y + 1}, range, ball, [&] { return exact(range); }, Exactly{ball});
    }
    /// Whether it meets the view-space box around the cell.
    bool meets_box(int x, int y, const Range& range, const Ball& ball) {
        return truth_.settle(truth_.filter.meets_box(x, y, range, ball),
                             [&] { return exactly_meets_box(x, y, range, ball); });
    }

    bool exactly_meets_box(int x, int y, const Range& range, const Ball& ball) const {
        const oracle::Depths depths = exact(range);
        const oracle::CameraBall centre = Exactly{ball}();
        Rational distance = 0;
        const auto add = [&](const Rational& low, const Rational& high, const Rational& c) {
            if (c < low) distance += oracle::square(low - c);
            if (c > high) distance += oracle::square(c - high);
        };
        const auto add_slab = [&](const oracle::Slab& slab, const Rational& c) {
            add(slab.low.at(slab.low.slope < 0 ? *depths.max : *depths.min),
                slab.high.at(slab.high.slope < 0 ? *depths.min : *depths.max), c);
        };
        add_slab(truth_.columns(x, x + 1), centre.x);
        add_slab(truth_.rows(y, y + 1), centre.y);
        add(*depths.min, *depths.max, centre.depth);
        return distance <= oracle::square(centre.radius);
    }

    oracle::Depths exact(const Range& range) const {
        const oracle::Depths& all = truth_.oracle.range();
        return {range.min == truth_.range.min ? *all.min : Rational(range.min),
                range.max == truth_.range.max ? *all.max : Rational(range.max)};
    }
    oracle::Truth truth_;
};
