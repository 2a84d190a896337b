// SPDX-License-Identifier: MIT
// From the library's lists to questions for the oracle, and the count of the answers.
#pragma once

#include "library_view.hpp"
#include "spheres.hpp"

#include "../../bench/exact/truth.hpp"

#include <lightbin/binner.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace oracle {

inline lightbin::View view_of(const Camera& camera) {
    const auto view = library_view(camera);
    REQUIRE_MESSAGE(view.has_value(), camera.name);
    return *view;
}

inline std::string text(const Light& light) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, "{%a, %a, %a, %a}", static_cast<double>(light.x),
                  static_cast<double>(light.y), static_cast<double>(light.z), static_cast<double>(light.w));
    return buffer;
}

/// The tiles whose lists hold a light: both ends included; `entries` of them.
struct Emitted {
    int x0 = 1 << 20, y0 = 1 << 20, x1 = -1, y1 = -1;
    std::int64_t entries = 0;
    bool any() const { return entries > 0; }
    bool rectangle() const { return !any() || entries == std::int64_t{x1 - x0 + 1} * (y1 - y0 + 1); }
};

/// The blocks of tiles outside a light's rectangle: left and right of it, below and above it, or the whole image if the
/// light has no rectangle.
inline std::vector<Block> blocks_around(const Emitted& e, int nx, int ny) {
    std::vector<Block> blocks = {{0, nx, 0, ny}};
    if (e.any())
        blocks = {{0, e.x0, 0, ny}, {e.x1 + 1, nx, 0, ny}, {e.x0, e.x1 + 1, 0, e.y0}, {e.x0, e.x1 + 1, e.y1 + 1, ny}};
    std::erase_if(blocks, [](const Block& b) { return b.empty(); });
    return blocks;
}

/// Turns lists a tile into tiles a light, checking what every grid must be: tiles in order without gaps, ids
/// ascending.
template <class Id>
std::vector<Emitted> emitted_tiles(const lightbin::LightGrid<Id>& grid, std::size_t lights) {
    std::vector<Emitted> emitted(lights);
    bool in_order = true;
    std::uint32_t end = 0;
    for (int y = 0; y < grid.tiles_y(); ++y)
        for (int x = 0; x < grid.tiles_x(); ++x) {
            const lightbin::ListRange range = grid.ranges()[static_cast<std::size_t>(y * grid.tiles_x() + x)];
            in_order = in_order && range.offset == end;
            end = range.offset + range.count;
            std::int64_t last = -1;
            for (const Id id : grid.lights_in(x, y)) {
                in_order = in_order && std::int64_t{id} > last && id < lights;
                last = id;
                Emitted& e = emitted[id];
                e.x0 = std::min(e.x0, x), e.x1 = std::max(e.x1, x);
                e.y0 = std::min(e.y0, y), e.y1 = std::max(e.y1, y);
                ++e.entries;
            }
        }
    CHECK(in_order);
    CHECK(end == grid.ids().size());
    return emitted;
}

/// in[tile][light]
template <class Id>
std::vector<std::vector<bool>> membership(const lightbin::LightGrid<Id>& grid, std::size_t lights) {
    std::vector<std::vector<bool>> in(grid.ranges().size(), std::vector<bool>(lights));
    for (std::size_t tile = 0; tile < in.size(); ++tile)
        for (const Id id : grid.ids().subspan(grid.ranges()[tile].offset, grid.ranges()[tile].count))
            in[tile][id] = true;
    return in;
}

/// What was asked of the oracle and what went wrong.
struct Tally {
    std::uint64_t verdicts = 0;  ///< "this ball does not meet this cell", each proven exactly
    std::uint64_t twice = 0;     ///< of these, put to the second decider as well
    std::uint64_t misses = 0;
    std::uint64_t below = 0;        ///< pairs that the method's geometry demands and the lists lack
    std::uint64_t unexplained = 0;  ///< pairs that the method's geometry, with its margin, does not explain
    std::uint64_t explained = 0;

    void report(std::uint64_t& count, const std::string& what, const Camera& camera, const std::string& set,
                std::size_t id, const Light& light, const std::string& where) {
        if (++count <= 5)
            MESSAGE(what << ": " << camera.name << ", " << set << " " << id << " " << text(light) << " "
                         << where);
    }
};

/// All questions about one camera.
class Examiner {
public:
    Examiner(const Camera& camera, Tally& counts) : truth(camera), oracle(truth.oracle), tally(counts) {
        for (int x = 0; x < oracle.tiles_x(); ++x)
            columns_.push_back(oracle.column_slab(oracle.columns(x, x + 1)));
        for (int y = 0; y < oracle.tiles_y(); ++y)
            rows_.push_back(oracle.row_slab(oracle.rows(y, y + 1)));
        // The image-plane margin that rounding explains, in pixels. The library states 16 u (|O| + tiles)
        // tiles, u = 2^-24, for its error and adds as much: twice that.
        const auto margin = [&](const Rational& offset, int tiles) {
            return Rational(2 * camera.tile) * (abs(offset) + tiles) / (1 << 20);
        };
        grow_x_ = margin(oracle.offset_x(), oracle.tiles_x());
        grow_y_ = margin(oracle.offset_y(), oracle.tiles_y());
        const auto grown = [](const Edges& edges, const Rational& grow) {
            return Edges{edges.low - grow, edges.high + grow};
        };
        for (int x = 0; x < oracle.tiles_x(); ++x)
            grown_columns_.push_back(oracle.column_slab(grown(oracle.columns(x, x + 1), grow_x_)));
        for (int y = 0; y < oracle.tiles_y(); ++y)
            grown_rows_.push_back(oracle.row_slab(grown(oracle.rows(y, y + 1), grow_y_)));
        // A perspective sphere is cut at the near plane, held as a float, and not at the far plane; an orthographic one
        // is not cut.
        if (!oracle.orthographic()) beyond_near_.at_least(*oracle.range().min * (1 - Rational(1) / (1 << 22)));
        const auto add_slack = [](std::vector<Rational>& slacks, const std::vector<Slab>& slabs,
                                  const Rational& offset) {
            for (const Slab& slab : slabs)
                slacks.push_back(slack(slab, offset, static_cast<int>(slabs.size())));
        };
        add_slack(column_slacks_, columns_, oracle.offset_x());
        add_slack(row_slacks_, rows_, oracle.offset_y());
    }

    /// The ball of a light in both of the oracle's forms.
    struct Subject {
        Ball ball;
        CameraBall seen;
        FlatBall flat;
    };
    Subject subject(const Light& light) const {
        return subject(exact_ball(light.x, light.y, light.z, light.w));
    }
    Subject subject(const Ball& ball) const {
        const CameraBall seen = oracle.in_camera(ball);
        return {ball,
                seen,
                {nearly(seen.x), nearly(seen.y), nearly(seen.depth), ball.all ? INFINITY : nearly(ball.radius)}};
    }

    /// The depths of a tile between two bounds, infinite where there is none, and within near and far. In rationals once
    /// double precision leaves a question open.
    class Cell {
    public:
        Cell(const Examiner& examiner, float min = -INFINITY, float max = INFINITY)
            : flat{std::max(static_cast<double>(min), examiner.truth.range.min),
                   std::min(static_cast<double>(max), examiner.truth.range.max)},
              empty(min == INFINITY || max == -INFINITY), oracle_(&examiner.oracle), min_(min), max_(max) {}
        FlatDepths flat;
        bool empty;

        const Depths& depths() const {
            if (!depths_) depths_ = oracle_->depths(min_, max_);
            return *depths_;
        }

    private:
        const Oracle* oracle_;
        float min_, max_;
        mutable std::optional<Depths> depths_;
    };

    /// A subject's ball for Truth.
    static auto exactly(const Subject& s) {
        return [&s]() -> const CameraBall& { return s.seen; };
    }

    /// In three dimensions: does the light meet the block of tiles? In every 97th case decided exactly, by both
    /// deciders.
    bool meets_block(const Subject& s, const Block& block) {
        const Depths& depths = oracle.range();
        const auto exact_depths = [&] { return depths; };
        if (++asked_ % 97 != 0)
            return truth.meets(block, truth.range, s.flat, exact_depths, exactly(s));
        const Edges columns = oracle.columns(block.x0, block.x1), rows = oracle.rows(block.y0, block.y1);
        const bool verdict = meets({{oracle.column_slab(columns)}, {oracle.row_slab(rows)}}, depths, s.seen);
        ++tally.twice;
        REQUIRE(verdict == meets(oracle.half_spaces(columns, rows, depths), s.ball));
        return verdict;
    }
    bool meets_tile(const Subject& s, int x, int y, const Cell& cell) {
        const auto exact_depths = [&] { return cell.depths(); };
        return !cell.empty &&
               truth.meets({x, x + 1, y, y + 1}, cell.flat, s.flat, exact_depths, exactly(s));
    }
    /// What a rectangle tests, one image axis at a time: the wedge of whole columns (rows) of tiles.
    bool meets_columns(const Subject& s, int x0, int x1) {
        return truth.meets_columns(x0, x1, s.flat, exactly(s));
    }
    bool meets_rows(const Subject& s, int y0, int y1) {
        return truth.meets_rows(y0, y1, s.flat, exactly(s));
    }

    /// A light without Z bounds: no tile outside `emitted` may be met, and the rectangle must be the method's
    /// own.
    void examine_rectangle(const Light& light, std::size_t id, const std::string& set, const Emitted& e) {
        const auto at = [&] {
            return "tiles " + std::to_string(e.x0) + ".." + std::to_string(e.x1) + " x " +
                   std::to_string(e.y0) + ".." + std::to_string(e.y1);
        };
        if (is_bad(light)) {
            CHECK(!e.any());
            return;
        }
        const Subject s = subject(light);
        const int nx = oracle.tiles_x(), ny = oracle.tiles_y();
        CHECK(e.rectangle());

        for (const Block& block : blocks_around(e, nx, ny)) {
            ++tally.verdicts;
            if (meets_block(s, block)) tally.report(tally.misses, "MISS", oracle.camera(), set, id, light, at());
        }
        if (!e.any()) {
            if (meets_columns(s, 0, nx) && meets_rows(s, 0, ny))
                tally.report(tally.below, "not emitted", oracle.camera(), set, id, light, at());
            return;
        }

        // From below: a column (row) whose wedge is met belongs to the rectangle, if any row (column) is met
        // at all.
        const bool wider = meets_columns(s, 0, e.x0) || meets_columns(s, e.x1 + 1, nx);
        const bool taller = meets_rows(s, 0, e.y0) || meets_rows(s, e.y1 + 1, ny);
        if ((wider && meets_rows(s, 0, ny)) || (taller && meets_columns(s, 0, nx)))
            tally.report(tally.below, "rectangle too small", oracle.camera(), set, id, light, at());

        // From above: the outermost columns and rows are met, give or take rounding.
        ++tally.explained;
        if (!explained(s, e))
            tally.report(tally.unexplained, "unexplained", oracle.camera(), set, id, light, at());
    }

    /// Depths that hold all of a ball that a rectangle is made of: beyond the near plane of a perspective,
    /// and not cut elsewhere.
    FlatDepths seen_depths(const FlatBall& ball) const {
        const double end = 2 * (std::abs(ball.depth) + ball.radius);
        return {oracle.orthographic() ? -end : truth.range.min, end};
    }

    bool explained(const Subject& s, const Emitted& e) {
        if (s.seen.all) return true;
        if (!depths_within(s, oracle.range().min, oracle.range().max)) return false;
        // Where the circle in the near plane is tiny its size is all rounding, of the radius in double precision.
        CameraBall ball = s.seen;
        ball.radius *= 1 + Rational(1) / (std::int64_t{1} << 40);
        // What double precision gets wrong is nothing beside the margins.
        const double reach = s.flat.radius * s.flat.radius;
        const FlatDepths flat = seen_depths(s.flat);
        const auto column = [&](int x) {
            return truth.filter.column_distance2(x, flat, s.flat) <= reach ||
                   meets({grown_columns_[static_cast<std::size_t>(x)], {}}, beyond_near_, ball);
        };
        const auto row = [&](int y) {
            return truth.filter.row_distance2(y, flat, s.flat) <= reach ||
                   meets({{}, grown_rows_[static_cast<std::size_t>(y)]}, beyond_near_, ball);
        };
        return (eye_on_surface(ball.x, ball) || (column(e.x0) && column(e.x1))) &&
               (eye_on_surface(ball.y, ball) || (row(e.y0) && row(e.y1)));
    }

    /// z - r to z + r meets the bounds, the sums in float arithmetic.
    bool depths_within(const Subject& s, const std::optional<Rational>& min,
                       const std::optional<Rational>& max) const {
        const auto flat = [](const std::optional<Rational>& bound, double none) {
            return bound ? nearly(*bound) : none;
        };
        return depths_within(s, {flat(min, -INFINITY), flat(max, INFINITY)}, min, max);
    }
    bool depths_within(const Subject& s, const FlatDepths& flat, const std::optional<Rational>& min,
                       const std::optional<Rational>& max) const {
        // What double precision gets wrong is nothing beside the allowance below.
        if (s.flat.depth + s.flat.radius >= flat.min && s.flat.depth - s.flat.radius <= flat.max) return true;
        if (s.seen.all) return true;
        const Rational rounding = (abs(s.seen.depth) + s.seen.radius) / (1 << 23);
        return (!min || s.seen.depth + s.seen.radius + rounding >= *min - abs(*min) / (1 << 22)) &&
               (!max || s.seen.depth - s.seen.radius - rounding <= *max + abs(*max) / (1 << 22));
    }

    /// The sphere meets the box around the tile's cell between these depths, give or take the margins that the
    /// library states: 2^-21 of an edge and of a depth, 2^-20 of the squared radius. Twice those are allowed.
    /// What double precision gets wrong is nothing beside the margins, so it is asked first.
    bool box_meets(const Subject& s, int x, int y, const Cell& cell) {
        if (s.flat.radius > 0x1p63) return true;  // its square is infinite in float
        return !cell.empty &&
               (truth.filter.box_distance2(x, y, cell.flat, s.flat) <= s.flat.radius * s.flat.radius ||
                box_meets(s, x, y, cell.depths()));
    }

    bool box_meets(const Subject& s, int x, int y, const Depths& depths) const {
        const auto grown = [](const Rational& end, int direction) {
            return end + direction * (abs(end) / (1 << 20) + exact(0x1p-100));
        };
        const auto outside = [](const Rational& low, const Rational& high, const Rational& c) {
            return std::max({Rational(low - c), Rational(c - high), Rational(0)});
        };
        // No maximum: far beyond the sphere a line can only have left it, or be there still.
        const Rational near = grown(*depths.min, -1);
        const Rational far = grown(depths.max ? *depths.max : Rational(*depths.min + exact(FLT_MAX)), 1);
        Rational distance = square(outside(near, far, s.seen.depth));
        const auto add = [&](const Slab& slab, const Rational& c, const Rational& slack) {
            const Rational low = std::min(slab.low.at(near), slab.low.at(far)),
                           high = std::max(slab.high.at(near), slab.high.at(far));
            // The offset of the image is off by 2^-48 of its parts, wherever the edge is.
            const Rational off =
                slack * (oracle.orthographic() ? Rational(1) : std::max(abs(near), abs(far)));
            distance += square(outside(grown(low, -1) - off, grown(high, 1) + off, c));
        };
        const std::size_t column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
        add(columns_[column], s.seen.x, column_slacks_[column]);
        add(rows_[row], s.seen.y, row_slacks_[row]);
        return distance <= square(s.seen.radius) * (1 + Rational(1) / (1 << 18)) + exact(0x1p-124);
    }

    /// Beyond doubt the ball does not meet the block of tiles within the cell's depths.
    bool apart(int x0, int x1, int y0, int y1, const Cell& cell, const FlatBall& ball) {
        return truth.filter.apart(x0, x1, y0, y1, cell.flat, ball);
    }

    Truth truth;
    const Oracle& oracle;
    Tally& tally;

private:
    /// Double precision cannot tell on which side of the circle (c, depth) the eye is, so any slope may be
    /// reached.
    bool eye_on_surface(const Rational& c, const CameraBall& ball) const {
        const Rational squares = square(c) + square(ball.depth), radius = square(ball.radius);
        return !oracle.orthographic() && abs(squares - radius) * (1 << 29) < squares + radius;
    }

    /// 2^-47 of the parts that the position of an edge in tiles is made from, in slopes or coordinates. The
    /// column may be a partial one, then it is less than a tile.
    static Rational slack(const Slab& slab, const Rational& offset, int tiles) {
        const Rational size = abs(slab.high.slope - slab.low.slope) + abs(slab.high.offset - slab.low.offset);
        return size * (abs(offset) + tiles + 1) / (std::int64_t{1} << 47);
    }

    std::vector<Slab> columns_, rows_, grown_columns_, grown_rows_;
    std::vector<Rational> column_slacks_, row_slacks_;
    Depths beyond_near_;
    Rational grow_x_, grow_y_;
    std::uint64_t asked_ = 0;
};

}  // namespace oracle
