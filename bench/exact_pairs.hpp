// SPDX-License-Identifier: MIT
// What the lists ought to hold: for every tile and light of a scene, by exact arithmetic, whether the sphere, spot or
// box meets the tile's cell.
//
// Decided in double precision where that proves the answer, else in rationals; of a spot, by a certificate.
#pragma once

#include "exact/box.hpp"
#include "exact/spot.hpp"
#include "exact/truth.hpp"
#include "raster.hpp"
#include "spot_filter.hpp"

#include <lightbin/box.hpp>
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

/// Facts about a tile and a light, as bits.
enum Fact : std::uint32_t {
    in_pyramid = 1,  ///< the light meets the tile's cell without Z bounds
    in_cell = 2,     ///< the light meets the tile's cell between its minimum and maximum depth
};

/// A light that meets a tile.
struct Pair {
    std::uint32_t id;
    std::uint32_t facts;
};

struct ExactPairs {
    std::vector<std::vector<Pair>> tiles;  ///< ids ascend
    std::uint64_t verdicts = 0;            ///< pairs of a tile and a light that were decided: all pairs
    std::uint64_t by_rationals = 0;        ///< questions that double precision could not decide
    std::uint64_t open = 0;  ///< of these, about spots, those without a proof: counted as "do not meet"
};

/// Calls visit(pair, whether the tile's list contains the light) for each pair of a tile. The list's ids must ascend.
template <class Visit>
void for_each_listed(std::span<const Pair> pairs, std::span<const std::uint32_t> list, Visit visit) {
    auto id = list.begin();
    for (const Pair& pair : pairs) {
        while (id != list.end() && *id < pair.id)
            ++id;
        visit(pair, id != list.end() && *id == pair.id);
    }
}

/// Returns a camera for the exact arithmetic, with a projection given in floats.
inline oracle::Camera camera_with(const glm::mat4& projection, lightbin::ImageSize screen, int tile_size) {
    oracle::Camera camera;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            camera.m[column][row] = static_cast<double>(projection[column][row]);
    camera.width = screen.width, camera.height = screen.height, camera.tile = tile_size;
    return camera;
}

class ExactDecider {
public:
    /// The projection must be a symmetric perspective; tiles are counted from the lower left corner.
    ExactDecider(const glm::mat4& projection, lightbin::ImageSize screen, int tile_size)
        : truth_(camera_with(projection, screen, tile_size)) {
        using oracle::nearly;
        for (int x = 0; x < truth_.oracle.tiles_x(); ++x)
            column_slopes_.push_back(
                {nearly(truth_.columns(x, x + 1).low.slope), nearly(truth_.columns(x, x + 1).high.slope)});
        for (int y = 0; y < truth_.oracle.tiles_y(); ++y)
            row_slopes_.push_back(
                {nearly(truth_.rows(y, y + 1).low.slope), nearly(truth_.rows(y, y + 1).high.slope)});
    }

    /// Decides for every tile and every light whether they meet. No light may be bad input.
    template <class AnyLights> ExactPairs pairs(const AnyLights& lights, const lightbin::ZBounds& bounds) {
        const std::size_t tiles = tile_at(0, truth_.oracle.tiles_y());
        ExactPairs result = {std::vector<std::vector<Pair>>(tiles), tiles * lights.size()};
        const std::uint64_t before = truth_.by_rationals() + spots_by_rationals_, open_before = open_;
        for (std::size_t id = 0; id < lights.size(); ++id)
            add(static_cast<std::uint32_t>(id), subject(lights[id]), bounds, result);
        result.by_rationals = truth_.by_rationals() + spots_by_rationals_ - before;
        result.open = open_ - open_before;
        return result;
    }

private:
    using Ball = oracle::FlatBall;
    using Range = oracle::FlatDepths;  ///< ends are floats, and so exact, or the planes of the view
    using Rational = oracle::Rational;
    struct Span {
        int first, end;
    };
    /// A ball in rational numbers, computed when it is first needed.
    struct Exactly {
        const Ball& ball;
        oracle::CameraBall operator()() const {
            return {Rational(ball.x), Rational(ball.y), Rational(ball.depth), Rational(ball.radius)};
        }
    };

    /// The sphere that a light lies within: where it does not reach, the spot or box does not, either.
    struct Subject {
        Ball ball;
        template <class Light>
        explicit Subject(const Light& light)
            : ball{static_cast<double>(light.x), static_cast<double>(light.y), -static_cast<double>(light.z),
                   static_cast<double>(light.radius)} {}
    };
    struct SpotSubject : Subject {
        explicit SpotSubject(const lightbin::Spot& s)
            : Subject(s), exact(oracle::exact_spot(s.x, s.y, s.z, s.radius, s.axis_x, s.axis_y, s.axis_z,
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
        oracle::ExactSpot exact;
        oracle::FlatSpot flat;
        std::vector<SpotSubject>
            halves;  ///< half balls that together almost fill a spot wider than 90 degrees
    };
    struct BoxSubject : Subject {
        BoxSubject(const oracle::Oracle& oracle, const oracle::BoxLight& box)
            : Subject(box), light(box), flat(oracle::flat_box(box, [&](const oracle::Vector& corner) {
                  return oracle.in_camera({corner, 0});
              })) {}
        oracle::BoxLight light;
        oracle::FlatBox flat;
        mutable std::optional<oracle::ExactBox> exact;  ///< computed when first needed
    };
    Subject subject(const lightbin::Sphere& ball) const { return Subject(ball); }
    Subject subject(const glm::vec4& ball) const {
        return Subject(lightbin::Sphere{ball.x, ball.y, ball.z, ball.w});
    }
    SpotSubject subject(const lightbin::Spot& spot) const { return SpotSubject(spot); }
    BoxSubject subject(const lightbin::Box& box) const {
        oracle::BoxLight light = {box.x, box.y,    box.z, box.radius, {box.box_x, box.box_y, box.box_z},
                                  {},    box.taper};
        std::copy(&box.half_axes[0][0], &box.half_axes[0][0] + 9, &light.half_axes[0][0]);
        return {truth_.oracle, light};
    }

    /// Returns the columns (or rows) of tiles whose wedges of space the ball meets: without holes, as it is convex.
    template <class Meets> static Span met(int count, Meets meets) {
        Span span = {0, count};
        while (span.first < span.end && !meets(span.first))
            ++span.first;
        while (span.first < span.end && !meets(span.end - 1))
            --span.end;
        return span;
    }

    std::size_t tile_at(int x, int y) const {
        return static_cast<std::size_t>(y * truth_.oracle.tiles_x() + x);
    }

    /// Visits the tiles of a row that the light meets. They are neighbours, because the light is convex.
    template <class AnySubject>
    void add(std::uint32_t id, const AnySubject& light, const lightbin::ZBounds& bounds, ExactPairs& result) {
        const Exactly exactly{light.ball};
        const auto in_column = [&](int x) { return truth_.meets_columns(x, x + 1, light.ball, exactly); };
        const auto in_row = [&](int y) { return truth_.meets_rows(y, y + 1, light.ball, exactly); };
        const Span across = met(truth_.oracle.tiles_x(), in_column),
                   up = met(truth_.oracle.tiles_y(), in_row);
        for (int y = up.first; y < up.end; ++y) {
            const Span row = met(across.end - across.first,
                                 [&](int x) { return meets(across.first + x, y, truth_.range, light); });
            for (int x = across.first + row.first; x < across.first + row.end; ++x) {
                const std::size_t tile = tile_at(x, y);
                const float min = bounds.min[tile], max = bounds.max[tile];
                const Range whole = {std::max(static_cast<double>(min), truth_.range.min),
                                     std::min(static_cast<double>(max), truth_.range.max)};
                const bool cell = min <= max && whole.min <= whole.max && meets(x, y, whole, light);
                result.tiles[tile].push_back({id, in_pyramid | (cell ? +in_cell : 0)});
            }
        }
    }

    /// Whether the ball meets the cell of tile (x, y) in this range.
    bool meets(int x, int y, const Range& range, const Subject& light) {
        return truth_.meets(
            {x, x + 1, y, y + 1}, range, light.ball, [&] { return exact(range); }, Exactly{light.ball});
    }
    /// Returns whether the spot meets the cell of tile (x, y): by double precision or, where that cannot tell and now
    /// and then as a check, by an exact proof.
    bool meets(int x, int y, const Range& range, const SpotSubject& spot) {
        if (spot.exact.ball.all) return meets(x, y, range, static_cast<const Subject&>(spot));
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
        const std::optional<bool> verdict = oracle::meets(planes(x, y, range), spot.exact);
        if (proven && verdict && *proven != *verdict)
            throw std::logic_error("double precision and a certificate disagree");
        if (proven) return *proven;
        open_ += !verdict;
        return verdict.value_or(false);
    }

    bool meets(int x, int y, const Range& range, const BoxSubject& box) {
        if (truth_.filter.apart(x, x + 1, y, y + 1, range, box.ball) ||
            oracle::apart(truth_.filter, x, x + 1, y, y + 1, range, box.flat))
            return false;
        if (!box.exact) box.exact.emplace(box.light);
        return oracle::meets(planes(x, y, range), *box.exact);
    }

    std::vector<oracle::HalfSpace> planes(int x, int y, const Range& range) const {
        const oracle::Oracle& oracle = truth_.oracle;
        return oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), exact(range));
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

/// Decides every pair of a light and a cell of this depth slice; its boundaries serve as the Z bounds of every tile.
template <class AnyLights>
ExactPairs pairs_in(ExactDecider& decider, const lightbin::View& view, const lightbin::Slices& slices,
                    int slice, const AnyLights& lights) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const auto boundary = [&](int i) { return slices.boundaries()[static_cast<std::size_t>(i)]; };
    const std::vector<float> min(view.tile_count(), slice == 0 ? -endless : boundary(slice - 1)),
        max(view.tile_count(), slice + 1 == slices.count() ? endless : boundary(slice));
    return decider.pairs(lights, {.min = min, .max = max});
}
