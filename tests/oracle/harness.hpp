// SPDX-License-Identifier: MIT
// Compares the library's lists with exact arithmetic: counts entries that exact arithmetic would not list.
#pragma once

#include "library_view.hpp"
#include "spheres.hpp"

#include "../../bench/exact/truth.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace oracle {

inline lightbin::View view_of(const Camera& camera) {
    const auto view = library_view(camera);
    REQUIRE_MESSAGE(view.has_value(), camera.name);
    return *view;
}

inline Ball exact_ball(const Light& light) {
    return exact_ball(light.x, light.y, light.z, light.w);
}

/// The rectangle of tiles whose lists have a light, first and last included, and the number of these entries.
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

/// Turns a list for each tile into a set of tiles for each light. Checks that tiles are in order without gaps, and ids
/// ascend.
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

/// Reads the lights of each tile from masks; with z-bins in[bin and tile][light], tile by tile in each bin.
inline std::vector<std::vector<bool>> membership(const lightbin::LightMasks& masks, std::size_t lights) {
    std::vector<std::vector<bool>> in;
    const lightbin::BinRange every_light[] = {{0, 0xffffffff}};
    for (const lightbin::BinRange& bin : masks.bins().empty() ? std::span(every_light) : masks.bins())
        for (int y = 0; y < masks.tiles_y(); ++y)
            for (int x = 0; x < masks.tiles_x(); ++x) {
                in.emplace_back(lights);
                const auto column = masks.column(x), row = masks.row(y);
                for (std::uint32_t place = 0; place < masks.ids().size(); ++place)
                    if (place >= bin.least && place <= bin.greatest &&
                        (column[place / 32] & row[place / 32]) >> place % 32 & 1)
                        in.back()[masks.ids()[place]] = true;
            }
    return in;
}

/// Answers all questions about the lights and tiles of one camera.
class Examiner {
public:
    explicit Examiner(const Camera& camera) : truth(camera), oracle(truth.oracle), sides_{side(0), side(1)} {
        // The library cuts a sphere at the near plane, rounded to float, if it is a perspective; never at the far
        // plane.
        if (!oracle.orthographic()) beyond_near_.at_least(*oracle.range().min * (1 - Rational(1) / (1 << 22)));
    }

    /// A ball in the camera's axes.
    struct Subject {
        CameraBall seen;
        FlatBall flat;
    };
    Subject subject(const Ball& ball) const {
        const CameraBall seen = oracle.in_camera(ball);
        return {seen, {nearly(seen.x), nearly(seen.y), nearly(seen.depth), ball.all ? INFINITY : nearly(ball.radius)}};
    }

    /// The depths of a tile's cell between two bounds (infinite if there is none) and between the near and far plane.
    /// Rational numbers are used if double precision leaves a question open.
    class Cell {
    public:
        Cell(const Examiner& examiner, float low = -INFINITY, float high = INFINITY)
            : flat{std::max(static_cast<double>(low), examiner.truth.range.min),
                   std::min(static_cast<double>(high), examiner.truth.range.max)},
              min(low), max(high), empty(min == INFINITY || max == -INFINITY), oracle_(&examiner.oracle) {}
        FlatDepths flat;
        float min, max;
        bool empty;

        const Depths& depths() const {
            if (!depths_) depths_ = oracle_->depths(min, max);
            return *depths_;
        }

    private:
        const Oracle* oracle_;
        mutable std::optional<Depths> depths_;
    };

    /// Returns true only if the light's sphere certainly does not meet a block of tiles between the cell's depths.
    bool apart(const Block& b, const Cell& cell, const FlatBall& ball) {
        return truth.filter.apart(b.x0, b.x1, b.y0, b.y1, cell.flat, ball);
    }

    /// Returns whether a light's rectangle lacks a column or row whose wedge of space the sphere meets, if it meets
    /// some row or column at all.
    bool lacks_some(const Subject& s, const Emitted& e) {
        const int nx = oracle.tiles_x(), ny = oracle.tiles_y();
        const auto ball = [&]() -> const CameraBall& { return s.seen; };
        const auto columns = [&](int x0, int x1) { return truth.meets_columns(x0, x1, s.flat, ball); };
        const auto rows = [&](int y0, int y1) { return truth.meets_rows(y0, y1, s.flat, ball); };
        if (!e.any()) return columns(0, nx) && rows(0, ny);
        const bool wider = columns(0, e.x0) || columns(e.x1 + 1, nx), taller = rows(0, e.y0) || rows(e.y1 + 1, ny);
        return (wider && rows(0, ny)) || (taller && columns(0, nx));
    }

    /// Returns whether the sphere meets the outermost columns and rows of its rectangle, allowing for rounding.
    bool explained(const Subject& s, const Emitted& e) {
        if (s.seen.all) return true;
        if (!depths_within(s, oracle.range().min, oracle.range().max)) return false;
        // Where the sphere's circle in the near plane is tiny, its size is mostly rounding error of the radius.
        CameraBall ball = s.seen;
        ball.radius *= 1 + Rational(1) / (std::int64_t{1} << 40);
        // Errors of double precision are far smaller than the library's margins. The depths include all of the sphere
        // that its rectangle is made from: the part beyond the near plane, or for orthographic cameras everything.
        const double reach = s.flat.radius * s.flat.radius, end = 2 * (std::abs(s.flat.depth) + s.flat.radius);
        const FlatDepths flat = {oracle.orthographic() ? -end : truth.range.min, end};
        const auto column = [&](int x) {
            return truth.filter.column_distance2(x, flat, s.flat) <= reach ||
                   meets({sides_[0].grown[static_cast<std::size_t>(x)], {}}, beyond_near_, ball);
        };
        const auto row = [&](int y) {
            return truth.filter.row_distance2(y, flat, s.flat) <= reach ||
                   meets({{}, sides_[1].grown[static_cast<std::size_t>(y)]}, beyond_near_, ball);
        };
        return (eye_on_surface(ball.x, ball) || (column(e.x0) && column(e.x1))) &&
               (eye_on_surface(ball.y, ball) || (row(e.y0) && row(e.y1)));
    }

    /// Returns whether the sphere's depths, z - r to z + r rounded to float, overlap the tile's bounds.
    bool depths_within(const Subject& s, const std::optional<Rational>& min,
                       const std::optional<Rational>& max) const {
        // Errors of double precision are far smaller than the tolerance below.
        if ((!min || s.flat.depth + s.flat.radius >= nearly(*min)) &&
            (!max || s.flat.depth - s.flat.radius <= nearly(*max)))
            return true;
        if (s.seen.all) return true;
        const Rational rounding = (abs(s.seen.depth) + s.seen.radius) / (1 << 23);
        return (!min || s.seen.depth + s.seen.radius + rounding >= *min - abs(*min) / (1 << 22)) &&
               (!max || s.seen.depth - s.seen.radius - rounding <= *max + abs(*max) / (1 << 22));
    }

    /// Returns whether the sphere meets the box around the tile's cell between these depths, within twice the margins
    /// that the library states: 2^-21 of an edge and of a depth, 2^-20 of the squared radius. Double precision is tried
    /// first: its errors are far smaller.
    bool box_meets(const Subject& s, int x, int y, const Cell& cell) {
        if (s.flat.radius > 0x1p63) return true;  // its square is infinite in float
        if (cell.empty) return false;
        if (truth.filter.box_distance2(x, y, cell.flat, s.flat) <= s.flat.radius * s.flat.radius) return true;
        const auto grown = [](const Rational& end, int direction) {
            return end + direction * (abs(end) / (1 << 20) + exact(0x1p-100));
        };
        const auto outside = [](const Rational& low, const Rational& high, const Rational& c) {
            return std::max({Rational(low - c), Rational(c - high), Rational(0)});
        };
        // A cell without a maximum depth gets one far beyond the sphere: behind it no line from the eye enters a sphere.
        const Depths& depths = cell.depths();
        const Rational near = grown(*depths.min, -1);
        const Rational far = grown(depths.max ? *depths.max : Rational(*depths.min + exact(FLT_MAX)), 1);
        Rational distance = square(outside(near, far, s.seen.depth));
        const auto add = [&](const Side& side, int at, const Rational& c) {
            const Slab& slab = side.slabs[static_cast<std::size_t>(at)];
            const Rational low = std::min(slab.low.at(near), slab.low.at(far)),
                           high = std::max(slab.high.at(near), slab.high.at(far));
            // The image's offset has an error of 2^-48 of its parts. Twice that is allowed, of the parts that an edge's
            // position in tiles is computed from, in slopes or coordinates; a partial column is less than a tile.
            const Rational size = abs(slab.high.slope - slab.low.slope) + abs(slab.high.offset - slab.low.offset),
                           off = size * side.offset_in_tiles / (std::int64_t{1} << 47) *
                                 (oracle.orthographic() ? Rational(1) : std::max(abs(near), abs(far)));
            distance += square(outside(grown(low, -1) - off, grown(high, 1) + off, c));
        };
        add(sides_[0], x, s.seen.x);
        add(sides_[1], y, s.seen.y);
        return distance <= square(s.seen.radius) * (1 + Rational(1) / (1 << 18)) + exact(0x1p-124);
    }

    Truth truth;
    const Oracle& oracle;

private:
    /// Columns (axis 0) or rows of tiles, and the margin that rounding explains, in pixels. The library states an error
    /// of 16 u (|O| + tiles) tiles (u = 2^-24, O: the image's offset), and adds as much: twice that.
    struct Side {
        std::vector<Slab> slabs, grown;
        Rational offset_in_tiles;  ///< rounding errors are in proportion to it: |offset| + number of tiles + 1
    };
    Side side(int axis) const {
        const int tiles = axis == 0 ? oracle.tiles_x() : oracle.tiles_y();
        const Rational offset = abs(axis == 0 ? oracle.offset_x() : oracle.offset_y()) + tiles,
                       grow = Rational(2 * oracle.camera().tile) * offset / (1 << 20);
        const auto slab = [&](const Edges& edges) {
            return axis == 0 ? oracle.column_slab(edges) : oracle.row_slab(edges);
        };
        Side made = {{}, {}, offset + 1};
        for (int i = 0; i < tiles; ++i) {
            const Edges edges = axis == 0 ? oracle.columns(i, i + 1) : oracle.rows(i, i + 1);
            made.slabs.push_back(slab(edges));
            made.grown.push_back(slab({edges.low - grow, edges.high + grow}));
        }
        return made;
    }

    /// Returns whether double precision cannot tell if the eye is inside a sphere's disc, whose image may then have any
    /// slope.
    bool eye_on_surface(const Rational& c, const CameraBall& ball) const {
        const Rational squares = square(c) + square(ball.depth), radius = square(ball.radius);
        return !oracle.orthographic() && abs(squares - radius) * (1 << 29) < squares + radius;
    }

    Side sides_[2];
    Depths beyond_near_;
};

}  // namespace oracle
