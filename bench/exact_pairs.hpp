// SPDX-License-Identifier: MIT
// What the lists ought to hold: for every tile and light of a scene, by exact arithmetic, whether the sphere or the spot
// meets the tile's cell.
//
// Decided in double precision where that proves the answer, else in rationals; of a spot, by a certificate.
#pragma once

#include "exact/spot.hpp"
#include "exact/truth.hpp"
#include "raster.hpp"
#include "spot_filter.hpp"

#include <lightbin/slices.hpp>
#include <lightbin/z_bounds.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

/// What may be true of a tile and a light.
enum Fact : std::uint32_t {
    in_pyramid = 1,  ///< the light meets the tile's cell without Z bounds
    in_cell = 2,     ///< ... between the tile's minimum and maximum depth: the exact set
};

/// A light in whose rectangle, by exact arithmetic, a tile lies; a spot that meets the tile.
struct Pair {
    std::uint32_t id;
    std::uint32_t facts;
};

struct ExactPairs {
    std::vector<std::vector<Pair>> tiles;  ///< ids ascend
    std::uint64_t verdicts = 0;            ///< pairs of a tile and a light decided: all there are
    std::uint64_t by_rationals = 0;        ///< questions that double precision left open
    std::uint64_t open = 0;  ///< of these, about spots, such as no certificate was found for: taken for "no"
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

/// A camera of the exact decider with a projection in floats.
inline oracle::Camera camera_with(const glm::mat4& projection, lightbin::Extent screen, int tile_size) {
    oracle::Camera camera;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            camera.m[column][row] = static_cast<double>(projection[column][row]);
    camera.width = screen.width, camera.height = screen.height, camera.tile = tile_size;
    return camera;
}

class ExactDecider {
public:
    /// A symmetric perspective matrix; tiles from the lower left corner.
    ExactDecider(const glm::mat4& projection, lightbin::Extent screen, int tile_size)
        : truth_(camera_with(projection, screen, tile_size)) {
        using oracle::nearly;
        for (int x = 0; x < truth_.oracle.tiles_x(); ++x)
            column_slopes_.push_back(
                {nearly(truth_.columns(x, x + 1).low.slope), nearly(truth_.columns(x, x + 1).high.slope)});
        for (int y = 0; y < truth_.oracle.tiles_y(); ++y)
            row_slopes_.push_back(
                {nearly(truth_.rows(y, y + 1).low.slope), nearly(truth_.rows(y, y + 1).high.slope)});
    }

    /// Decides every pair of a tile and a light. Gap spans may be empty.
    ExactPairs pairs(const Lights& lights, const lightbin::ZBounds& bounds) {
        ExactPairs result = no_pairs(lights.size());
        const std::uint64_t before = truth_.by_rationals();
        for (std::size_t id = 0; id < lights.size(); ++id)
            add_ball(static_cast<std::uint32_t>(id),
                     {static_cast<double>(lights[id].x), static_cast<double>(lights[id].y),
                      -static_cast<double>(lights[id].z), static_cast<double>(lights[id].w)},
                     bounds, result);
        result.by_rationals = truth_.by_rationals() - before;
        return result;
    }

    /// The same of spots. No light may be bad.
    ExactPairs pairs(const Spots& lights, const lightbin::ZBounds& bounds) {
        ExactPairs result = no_pairs(lights.size());
        const std::uint64_t before = truth_.by_rationals() + spots_by_rationals_, open_before = open_;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const auto id = static_cast<std::uint32_t>(i);
            const SpotSubject spot(lights[i]);
            if (spot.exact.ball.all)
                add_ball(id, spot.ball, bounds, result);
            else
                add_spot(id, spot, bounds, result);
        }
        result.by_rationals = truth_.by_rationals() + spots_by_rationals_ - before;
        result.open = open_ - open_before;
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

    struct SpotSubject {
        explicit SpotSubject(const lightbin::Spot& s)
            : ball{static_cast<double>(s.x), static_cast<double>(s.y), -static_cast<double>(s.z),
                   static_cast<double>(s.radius)},
              exact(oracle::exact_spot(s.x, s.y, s.z, s.radius, s.axis_x, s.axis_y, s.axis_z,
                                       s.cos_half_angle)),
              flat(s) {
            if (s.cos_half_angle >= 0) return;
            const glm::dvec3 axis = glm::normalize(glm::dvec3(s.axis_x, s.axis_y, s.axis_z)),
                             across = glm::normalize(glm::cross(
                                 axis, std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
            const double cosine = static_cast<double>(s.cos_half_angle) + 0x1p-20,
                         sine = std::sqrt(1 - cosine * cosine);
            constexpr int count = 64;
            for (int i = 0; i < count; ++i) {
                const double turn = i * 2 * 3.14159265358979324 / count;
                const glm::vec3 half = sine * axis - cosine * (std::cos(turn) * across +
                                                               std::sin(turn) * glm::cross(axis, across));
                halves.emplace_back(lightbin::Spot{s.x, s.y, s.z, s.radius, half.x, half.y, half.z, 0});
            }
        }
        Ball ball;
        oracle::ExactSpot exact;
        oracle::FlatSpot flat;
        std::vector<SpotSubject>
            halves;  ///< of a half angle above 90 degrees: half balls that fill it but for slivers
    };

    Range within_view(float min, float max) const {
        return {std::max(static_cast<double>(min), truth_.range.min),
                std::min(static_cast<double>(max), truth_.range.max)};
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

    struct Block {
        Span across, up;
    };
    Block rectangle(const Ball& ball) {
        return {met(truth_.oracle.tiles_x(),
                    [&](int x) { return truth_.meets_columns(x, x + 1, ball, Exactly{ball}); }),
                met(truth_.oracle.tiles_y(),
                    [&](int y) { return truth_.meets_rows(y, y + 1, ball, Exactly{ball}); })};
    }
    ExactPairs no_pairs(std::size_t lights) const {
        const std::size_t tiles = tile_at(0, truth_.oracle.tiles_y());
        return {std::vector<std::vector<Pair>>(tiles), tiles * lights};
    }
    std::size_t tile_at(int x, int y) const {
        return static_cast<std::size_t>(y * truth_.oracle.tiles_x() + x);
    }

    void add_ball(std::uint32_t id, const Ball& ball, const lightbin::ZBounds& bounds, ExactPairs& result) {
        const Block block = rectangle(ball);
        for (int y = block.up.first; y < block.up.end; ++y)
            for (int x = block.across.first; x < block.across.end; ++x)
                result.tiles[tile_at(x, y)].push_back({id, facts(ball, x, y, tile_at(x, y), bounds)});
    }

    /// In a row of tiles those that it meets are neighbours, as it is convex.
    void add_spot(std::uint32_t id, const SpotSubject& spot, const lightbin::ZBounds& bounds,
                  ExactPairs& result) {
        const Block block = rectangle(spot.ball);
        for (int y = block.up.first; y < block.up.end; ++y) {
            const auto meets_tile = [&](int x) {
                return meets(block.across.first + x, y, truth_.range, spot);
            };
            const Span row = met(block.across.end - block.across.first, meets_tile);
            for (int x = block.across.first + row.first; x < block.across.first + row.end; ++x)
                result.tiles[tile_at(x, y)].push_back({id, facts(spot, x, y, tile_at(x, y), bounds)});
        }
    }

    /// Of a tile that it meets.
    std::uint32_t facts(const SpotSubject& spot, int x, int y, std::size_t tile,
                        const lightbin::ZBounds& bounds) {
        const float min = bounds.min[tile], max = bounds.max[tile];
        const Range whole = within_view(min, max);
        const bool cell = min <= max && !empty(whole) && meets(x, y, whole, spot);
        return in_pyramid | (cell ? +in_cell : 0);
    }

    std::uint32_t facts(const Ball& ball, int x, int y, std::size_t tile, const lightbin::ZBounds& bounds) {
        const float min = bounds.min[tile], max = bounds.max[tile];
        const bool pyramid = meets(x, y, truth_.range, ball);
        std::uint32_t facts = pyramid ? +in_pyramid : 0;
        const Range whole = within_view(min, max);
        const bool cell = pyramid && min <= max && !empty(whole) && meets(x, y, whole, ball);
        return facts | (cell ? +in_cell : 0);
    }

    /// Whether the ball meets the cell of tile (x, y) in this range.
    bool meets(int x, int y, const Range& range, const Ball& ball) {
        return truth_.meets(
            {x, x + 1, y, y + 1}, range, ball, [&] { return exact(range); }, Exactly{ball});
    }
    /// Whether the spot does, by double precision, or where that has no answer, and now and then as a check, by a
    /// certificate.
    bool meets(int x, int y, const Range& range, const SpotSubject& spot) {
        if (!spot.halves.empty())
            return std::ranges::any_of(spot.halves,
                                       [&](const SpotSubject& half) { return meets(x, y, range, half); });
        const Slopes &column = column_slopes_[static_cast<std::size_t>(x)],
                     &row = row_slopes_[static_cast<std::size_t>(y)];
        const bool from_near = range.min == truth_.range.min, to_far = range.max == truth_.range.max;
        const oracle::FlatCell cell = {column.low,
                                       column.high,
                                       row.low,
                                       row.high,
                                       range,
                                       range.min * (from_near ? 1 + 0x1p-50 : 1),
                                       range.max * (to_far ? 1 - 0x1p-50 : 1)};
        const std::optional<bool> proven = oracle::surely_meets(cell, spot.flat);
        if (proven && ++spot_questions_ % 1009 != 0) return *proven;
        spots_by_rationals_ += !proven;
        const auto planes = truth_.oracle.half_spaces(truth_.oracle.columns(x, x + 1),
                                                      truth_.oracle.rows(y, y + 1), exact(range));
        const std::optional<bool> verdict = oracle::meets(planes, spot.exact);
        if (proven && verdict && *proven != *verdict)
            throw std::logic_error("double precision and a certificate disagree");
        if (proven) return *proven;
        open_ += !verdict;
        return verdict.value_or(false);
    }

    oracle::Depths exact(const Range& range) const {
        const oracle::Depths& all = truth_.oracle.range();
        return {range.min == truth_.range.min ? *all.min : Rational(range.min),
                range.max == truth_.range.max ? *all.max : Rational(range.max)};
    }
    struct Slopes {
        double low, high;
    };

    oracle::Truth truth_;
    std::vector<Slopes> column_slopes_, row_slopes_;
    std::uint64_t spot_questions_ = 0, spots_by_rationals_ = 0, open_ = 0;
};

/// Every pair of a cell of this slice and a light, as of tiles with the slice's boundaries for Z bounds.
template <class AnyLights>
ExactPairs pairs_in(ExactDecider& decider, const lightbin::View& view, const lightbin::Slices& slices,
                    int slice, const AnyLights& lights) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const auto boundary = [&](int i) { return slices.boundaries()[static_cast<std::size_t>(i)]; };
    const std::vector<float> min(view.tile_count(), slice == 0 ? -endless : boundary(slice - 1)),
        max(view.tile_count(), slice + 1 == slices.count() ? endless : boundary(slice));
    return decider.pairs(lights, {.min = min, .max = max});
}
