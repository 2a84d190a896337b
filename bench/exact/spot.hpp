// SPDX-License-Identifier: MIT
// Whether a spot meets a cell: a verdict by certificate. Floating point finds one, rational arithmetic checks it, and
// what has none is left open.
//
// A spot is a ball and a cone from its centre, the apex. Cell, ball and cone are convex for half angles to 90 degrees:
// - They meet: a rational point lies in all three.
// - They don't: weights w >= 0 of the cell's half-spaces  a.p + b >= 0  and a vector u. With n the weighted sum of the
//   a, every point p = apex + v of the cell has  n.v >= g,  g the negative of the weighted sum of  a.apex + b.  Where
//   n - u makes an angle of at least 90 degrees with every direction of the cone, every v of the cone and the ball has
//   n.v <= u.v <= r |u|,  and they are apart if that is below g. All of it is decided without roots:  t = (n - u).axis
//   must be at most 0, and  t^2 >= sine^2 |n - u|^2 |axis|^2.
// A certificate needs no trust in how it was found, and a bad one proves nothing. Where none is found, the point of the
// cell that is nearest to the apex is asked for without rounding; if it is out of the ball, they are apart, too.
//
// From 90 degrees on a spot counts as its convex hull: the ball cut off by the plane of the rim, the circle where cone
// and ball meet. Then "they meet" is that of the hull, which the spot need not. Of infinite range it counts as its
// whole ball.
#pragma once

#include "oracle.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace oracle {

struct ExactSpot {
    Ball ball;
    Vector axis;      ///< of any length but 0
    Rational cosine;  ///< of the half angle
    /// Returns whether the spot is decided without certificates: as a ball, perhaps cut by the plane of its rim.
    bool whole() const { return ball.all || cosine <= 0; }
    /// Returns the half-space in front of the rim. Its plane is moved outward by this part of its distance from the
    /// apex, because the axis' length is rounded.
    HalfSpace before_rim(double outward) const {
        const Rational length = exact(std::sqrt(nearly(dot(axis, axis))) * (1 + outward));
        return {axis, -ball.radius * cosine * length - dot(axis, ball.centre)};
    }
};

inline ExactSpot exact_spot(float x, float y, float z, float radius, float axis_x, float axis_y, float axis_z,
                            float cosine) {
    return {exact_ball(x, y, z, radius), {exact(axis_x), exact(axis_y), exact(axis_z)}, exact(cosine)};
}

/// A proof that a spot and a cell are apart: the weights w and the vector u of the text at the top of this file.
struct Separation {
    std::vector<Rational> weights;  ///< of the half-spaces of the cell, one each
    Vector ball_part;               ///< the vector u of the text at the top
};

/// Returns whether a point lies in the cell, in the spot's sphere and in its cone, so that it proves that they meet.
inline bool proves_meeting(const std::vector<HalfSpace>& cell, const ExactSpot& spot, const Vector& point) {
    for (const HalfSpace& h : cell)
        if (h.at(point) < 0) return false;
    const Vector v = point - spot.ball.centre;
    const Rational along = dot(v, spot.axis), length2 = dot(v, v);
    return length2 <= square(spot.ball.radius) && along >= 0 &&
           square(along) >= square(spot.cosine) * length2 * dot(spot.axis, spot.axis);
}

inline bool proves_apart(const std::vector<HalfSpace>& cell, const ExactSpot& spot, const Separation& by) {
    if (by.weights.size() != cell.size()) return false;
    Vector n{};
    Rational g = 0;
    for (std::size_t i = 0; i < cell.size(); ++i) {
        if (by.weights[i] < 0) return false;
        if (by.weights[i].is_zero()) continue;
        n = n + by.weights[i] * cell[i].a;
        g -= by.weights[i] * cell[i].at(spot.ball.centre);
    }
    const Vector rest = n - by.ball_part;
    const Rational along = dot(rest, spot.axis), sine2 = 1 - square(spot.cosine);
    if (along > 0 || square(along) < sine2 * dot(rest, rest) * dot(spot.axis, spot.axis)) return false;
    return g > 0 && square(spot.ball.radius) * dot(by.ball_part, by.ball_part) < square(g);
}

//------------------------------------------------------------------------------------------------------------
// The search, in double precision but for rays. Vectors start at the apex.

/// Looks for a certificate that a spot and a cell meet or are apart. The spot must not be whole().
class SpotSearch {
public:
    SpotSearch(const std::vector<HalfSpace>& cell, const ExactSpot& spot) : cell_(cell), spot_(spot) {
        const Flat axis = flat(spot.axis);
        axis_length_ = length(axis);
        axis_ = scaled(axis, 1 / axis_length_);
        cosine_ = nearly(spot.cosine);
        sine_ = std::sqrt((1 - cosine_) * (1 + cosine_));
        radius_ = nearly(spot.ball.radius);
        for (std::size_t i = 0; i < cell.size(); ++i) {
            const Rational at_apex = cell[i].at(spot.ball.centre);
            holds_apex_ = holds_apex_ && at_apex >= 0;
            const Flat normal = flat(cell[i].a);
            const double size = length(normal);
            // A normal of length 0 makes a half-space everything or nothing; if nothing, its weight alone is a proof.
            if (size == 0)
                faces_.push_back({{}, at_apex < 0 ? -HUGE_VAL : HUGE_VAL, 1});
            else
                faces_.push_back({scaled(normal, 1 / size), nearly(at_apex) / size, size});
        }
    }

    std::optional<bool> verdict() {
        if (holds_apex_ && proves_meeting(cell_, spot_, spot_.ball.centre)) return true;
        for (std::size_t i = 0; i < faces_.size(); ++i)
            if (faces_[i].offset < 0 &&
                (radius_ == 0 || std::isinf(faces_[i].offset) || gap({{i, 1.0}}) > 0) && apart_by({{i, 1.0}}))
                return false;
        // Two planes that face away from each other leave nothing, however large the spot.
        for (std::size_t i = 0; i < faces_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const double a = faces_[i].offset, b = faces_[j].offset;
                if (product(faces_[i].normal, faces_[j].normal) < -0.999 && a + b <= 0x1p-40 * std::abs(a) &&
                    apart_by({{i, 1.0}, {j, 1.0}}))
                    return false;
            }
        if (const auto verdict = by_axis()) return verdict;
        find_opposites();
        for (const double scale : scales())
            if (const auto verdict = by_barrier(scale)) return verdict;
        if (apart_from_half_space()) return false;
        if (const auto verdict = by_nearest_points()) return verdict;
        return by_corners();
    }

private:
    struct Flat {
        double x = 0, y = 0, z = 0;
    };
    struct Face {
        Flat normal;    ///< points into the cell, has length 1
        double offset;  ///< distance of the apex from this side, positive inside
        double size;    ///< length of the normal as it was given
    };
    /// Two parallel sides of a cell that face each other.
    struct Opposites {
        std::size_t one, other;
        bool flat;  ///< both sides lie in one plane
    };
    struct Weight {
        std::size_t face;
        double weight;
    };
    using Weights = std::vector<Weight>;
    /// How far the spot reaches in a direction n. The part of n along which the cone does not reach is  -back axis +
    /// lateral,  where lateral is at right angles to the axis.
    struct Support {
        double value, back;
        Flat lateral;
    };

    static Flat flat(const Vector& v) { return {nearly(v.x), nearly(v.y), nearly(v.z)}; }
    static Vector exactly(const Flat& v) { return {exact(v.x), exact(v.y), exact(v.z)}; }
    static double product(const Flat& a, const Flat& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    static double length(const Flat& v) { return std::sqrt(product(v, v)); }
    static Flat scaled(const Flat& v, double k) { return {v.x * k, v.y * k, v.z * k}; }
    static Flat sum(const Flat& a, const Flat& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    static Flat cross(const Flat& a, const Flat& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }

    /// The radii to search with: the range and, where that is far larger than the cell, one that just reaches beyond
    /// the cell.
    std::vector<double> scales() const {
        std::vector<double> away;
        for (const Face& face : faces_)
            if (std::isfinite(face.offset))
                away.push_back(std::abs(face.offset)), away.push_back(16 * away.back());
        std::sort(away.rbegin(), away.rend());
        std::vector<double> scales = {radius_};
        for (const double scale : away)
            if (scale > 0 && scale < scales.back() / 4) scales.push_back(scale);
        return scales;
    }

    void find_opposites() {
        for (std::size_t i = 0; i < cell_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (product(faces_[i].normal, faces_[j].normal) > -0.999) continue;
                const HalfSpace &a = cell_[i], &b = cell_[j];
                const Rational ab = dot(a.a, b.a), aa = dot(a.a, a.a);
                if (square(ab) == aa * dot(b.a, b.a)) opposites_.push_back({i, j, b.b == ab / aa * a.b});
            }
    }
    /// A cell between two equal depths is flat: no point of doubles lies in it but by chance.
    Vector into_plane(Vector point) const {
        for (const Opposites& pair : opposites_)
            if (pair.flat) {
                const HalfSpace& face = cell_[pair.one];
                point = point - face.at(point) / dot(face.a, face.a) * face.a;
            }
        return point;
    }
    bool is_flat() const {
        return std::any_of(opposites_.begin(), opposites_.end(),
                           [](const Opposites& pair) { return pair.flat; });
    }
    /// Subtracts the common part of the weights of two opposite sides: it adds nothing to the proof and loses digits.
    void cancel_opposites(Weights& weights) const {
        std::vector<double*> of(faces_.size());
        for (Weight& w : weights)
            of[w.face] = &w.weight;
        for (const Opposites& pair : opposites_) {
            double *const one = of[pair.one], *const other = of[pair.other];
            if (one == nullptr || other == nullptr) continue;
            const double common = std::min(*one, *other);
            *one -= common, *other -= common;
        }
    }

    Support support(const Flat& n) const {
        const double along = product(n, axis_);
        const Flat aside = sum(n, scaled(axis_, -along));
        const double across = length(aside), side = cosine_ * along + sine_ * across,
                     off = cosine_ * across - sine_ * along;
        if (off <= 0) return {length(n), 0, {}};  // the cap
        if (side <= 0) {                          // the apex
            const double most = sine_ > 0 ? std::min(across, -along * cosine_ / sine_) : across;
            return {0, -along, scaled(aside, most / std::max(across, DBL_MIN))};
        }
        return {side, off * sine_, scaled(aside, off * cosine_ / across)};  // the rim
    }

    Flat direction(const Weights& weights) const {
        Flat n;
        for (const Weight& w : weights)
            n = sum(n, scaled(faces_[w.face].normal, w.weight));
        return n;
    }
    /// Returns the distance by which the weighted sum of a cell's sides separates the cell from the spot.
    double gap(const Weights& weights) const {
        double reach = 0;
        for (const Weight& w : weights)
            reach -= w.weight * faces_[w.face].offset;
        return reach - support(direction(weights)).value * radius_;
    }

    bool meets_at(const Flat& v) const {
        return proves_meeting(cell_, spot_, into_plane(spot_.ball.centre + exactly(v)));
    }

    bool apart_by(const Weights& weights) const {
        std::vector<Rational> exact_weights(cell_.size());
        for (const Weight& w : weights) {
            if (!(w.weight >= 0) || !std::isfinite(w.weight / faces_[w.face].size)) return false;
            exact_weights[w.face] = exact(w.weight / faces_[w.face].size);
        }
        return apart_with(std::move(exact_weights));
    }
    bool apart_with(std::vector<Rational> weights) const {
        Separation by = {std::move(weights), {}};
        Vector n{};
        for (std::size_t i = 0; i < cell_.size(); ++i)
            if (!by.weights[i].is_zero()) n = n + by.weights[i] * cell_[i].a;
        const Support reach = support(flat(n));
        // If all of n lies in the cone's part or none does, no rounding matters. Else the part that is taken from n
        // must surely stay within the cone's bounds, so its part along the axis is made a little larger.
        if (radius_ == 0 || (reach.back == 0 && length(reach.lateral) == 0)) {
            by.ball_part = n;
        } else {
            if (reach.value <= 0 && proves_apart(cell_, spot_, by)) return true;
            const double back = (reach.back + length(reach.lateral) * 0x1p-50) * (1 + 0x1p-50) / axis_length_;
            by.ball_part = n + exact(back) * spot_.axis - exactly(reach.lateral);
        }
        return proves_apart(cell_, spot_, by);
    }

    /// Decides by the part of the axis inside the cell, without rounding. A cone of half angle 0 is nothing but its
    /// axis, which often lies in a side of the cell; this leaves no such question open.
    std::optional<bool> by_axis() const {
        constexpr std::size_t none = static_cast<std::size_t>(-1);
        std::size_t first = none, last = none;
        Rational from = 0, to = 0;  // in lengths of the axis
        std::vector<Rational> climb(cell_.size());
        for (std::size_t i = 0; i < cell_.size(); ++i) {
            climb[i] = dot(cell_[i].a, spot_.axis);
            if (climb[i].is_zero()) continue;
            const Rational at = -cell_[i].at(spot_.ball.centre) / climb[i];
            if (climb[i] > 0 && at > from) from = at, first = i;
            if (climb[i] < 0 && (last == none || at < to)) to = at, last = i;
        }
        const Rational axis2 = dot(spot_.axis, spot_.axis);
        if (last == none || from <= to) {
            // The point to test: the middle of the part inside the ball, or without rounding where that part begins.
            const double end = std::min(last == none ? HUGE_VAL : nearly(to), radius_ / axis_length_);
            for (const Rational& at : {exact((nearly(from) + end) / 2), from})
                if (proves_meeting(cell_, spot_, spot_.ball.centre + at * spot_.axis)) return true;
        }
        if (spot_.cosine != 1) return std::nullopt;
        Separation by;
        by.weights.resize(cell_.size());
        if (last != none && from > to) {
            by.weights[last] = first == none ? Rational(1) : climb[first];
            if (first != none) by.weights[first] = -climb[last];
        } else if (first != none) {
            by.weights[first] = 1;
            by.ball_part = climb[first] / axis2 * spot_.axis;
        }
        return proves_apart(cell_, spot_, by) ? std::optional(false) : std::nullopt;
    }

    // --------------------------------------------------------------------------------------------------------
    // Cases that the search below never reaches, decided without rounding: cells that are tiny beside their distance,
    // half angles just below 90 degrees, and balls that touch a cell.

    /// Calls visit(i, j, k) for three faces that meet in a point, until it returns true.
    template <class Visit> bool any_corner(Visit visit) const {
        for (std::size_t i = 2; i < faces_.size(); ++i)
            for (std::size_t j = 1; j < i; ++j)
                for (std::size_t k = 0; k < j; ++k)
                    if (product(faces_[i].normal, cross(faces_[j].normal, faces_[k].normal)) != 0 &&
                        visit(i, j, k))
                        return true;
        return false;
    }
    static Vector cross(const Vector& a, const Vector& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    /// By Cramer's rule.
    std::optional<Vector> corner(std::size_t i, std::size_t j, std::size_t k) const {
        const HalfSpace &a = cell_[i], &b = cell_[j], &c = cell_[k];
        const Rational volume = dot(a.a, cross(b.a, c.a));
        if (volume.is_zero()) return std::nullopt;
        return Rational(-1) / volume *
               (a.b * cross(b.a, c.a) + b.b * cross(c.a, a.a) + c.b * cross(a.a, b.a));
    }
    /// Returns the weights that make `sum` from the normals of three sides of the cell, if none is negative.
    std::optional<std::vector<Rational>> weights_of(const Vector& sum, std::size_t i, std::size_t j,
                                                    std::size_t k) const {
        const Flat n = flat(sum);
        const double volume = product(faces_[i].normal, cross(faces_[j].normal, faces_[k].normal));
        for (const auto& [a, b] : {std::pair(j, k), std::pair(k, i), std::pair(i, j)})
            if (product(n, cross(faces_[a].normal, faces_[b].normal)) / volume < -0x1p-40 * length(n))
                return std::nullopt;
        const Vector &a = cell_[i].a, &b = cell_[j].a, &c = cell_[k].a;
        const Rational exact_volume = dot(a, cross(b, c));
        if (exact_volume.is_zero()) return std::nullopt;
        std::vector<Rational> weights(cell_.size());
        weights[i] = dot(sum, cross(b, c)) / exact_volume;
        weights[j] = dot(sum, cross(c, a)) / exact_volume;
        weights[k] = dot(sum, cross(a, b)) / exact_volume;
        if (weights[i] < 0 || weights[j] < 0 || weights[k] < 0) return std::nullopt;
        return weights;
    }

    /// Looks for sides of the cell whose weighted normals add up to the negative axis. If the apex lies on these sides,
    /// a small weight of a side that it is beyond completes the proof.
    bool apart_from_half_space() const {
        if (cosine_ > 0x1p-10) return false;
        return any_corner([&](std::size_t i, std::size_t j, std::size_t k) {
            const auto weights = weights_of(Rational(-1) * spot_.axis, i, j, k);
            if (!weights) return false;
            if (proves_apart(cell_, spot_, {*weights, {}})) return true;
            for (std::size_t beyond = 0; beyond < faces_.size(); ++beyond) {
                if (!(faces_[beyond].offset < 0)) continue;
                Separation more = {*weights, {}};
                more.weights[beyond] += spot_.cosine * exact(axis_length_ / (2 * faces_[beyond].size));
                if (proves_apart(cell_, spot_, more)) return true;
            }
            return false;
        });
    }

    /// Tries to prove that a spot meets the cell by the points of the cell nearest to the apex, the middle and the end
    /// of its axis.
    std::optional<bool> by_nearest_points() const {
        const auto nearest = nearest_point(cell_, spot_.ball.centre);
        if (!nearest) return false;
        const Vector away = *nearest - spot_.ball.centre;
        if (dot(away, away) > square(spot_.ball.radius)) return false;
        if (proves_meeting(cell_, spot_, *nearest)) return true;
        for (const double part : {0.5, 1.0}) {
            const Vector on_axis = spot_.ball.centre + exact(part * radius_ / axis_length_) * spot_.axis;
            const auto point = nearest_point(cell_, on_axis);
            if (point && proves_meeting(cell_, spot_, *point)) return true;
        }
        return std::nullopt;
    }

    /// Tries a corner of the cell, or the plane that touches the cone on the side of the corners.
    std::optional<bool> by_corners() const {
        std::optional<Flat> some;
        if (any_corner([&](std::size_t i, std::size_t j, std::size_t k) {
                const auto point = corner(i, j, k);
                if (!point || !std::all_of(cell_.begin(), cell_.end(),
                                           [&](const HalfSpace& h) { return h.at(*point) >= 0; }))
                    return false;
                some = flat(*point - spot_.ball.centre);
                return proves_meeting(cell_, spot_, *point);
            }))
            return true;
        if (!some) return std::nullopt;
        const Flat off = sum(*some, scaled(axis_, -product(*some, axis_)));
        if (!(length(off) > 0)) return std::nullopt;
        const Vector outward = exactly(sum(scaled(off, cosine_ / length(off)), scaled(axis_, -sine_)));
        const bool apart = any_corner([&](std::size_t i, std::size_t j, std::size_t k) {
            const auto weights = weights_of(outward, i, j, k);
            return weights && apart_with(*weights);
        });
        return apart ? std::optional(false) : std::nullopt;
    }

    //--------------------------------------------------------------------------------------------------------
    // The point that is deepest in all three, or least far out of them, by an interior-point method: a greatest t such
    // that v is t inside of each face, of a ball and of the cone's side, with the ball's radius as unit. The barrier is
    // the sum of -log of
    //     n.v + offset - t,   (1 - t)^2 - |v|^2   and   (sine v.axis - t)^2 - cosine^2 |v - (v.axis) axis|^2,
    // which is self-concordant; the weights of the faces in its derivative go to those of the best separation.

    using Four = std::array<double, 4>;  // x, y, z, t
    struct Slope {
        Four gradient{};
        std::array<Four, 4> hessian{};
        /// Adds the barrier -log(value) of a value with these first and second derivatives; the second one is constant.
        void add(double value, const Four& first, const std::array<Four, 4>& second) {
            for (std::size_t i = 0; i < 4; ++i) {
                gradient[i] -= first[i] / value;
                for (std::size_t j = 0; j < 4; ++j)
                    hessian[i][j] += first[i] / value * (first[j] / value) - second[i][j] / value;
            }
        }
    };
    /// (rise - t)^2 - |rest|^2 as a product, or 0 where t is not below rise.
    static double cone_value(double rise, double rest) {
        return rise <= rest ? 0 : (rise - rest) * (rise + rest);
    }

    double slack(const Face& face, const Four& at) const {
        return product(face.normal, {at[0], at[1], at[2]}) + face.offset / scale_ - at[3];
    }
    double ball_value(const Four& at) const { return cone_value(1 - at[3], length({at[0], at[1], at[2]})); }
    Flat aside(const Four& at) const {
        const Flat v = {at[0], at[1], at[2]};
        return sum(v, scaled(axis_, -product(v, axis_)));
    }
    double side_value(const Four& at) const {
        return cone_value(sine_ * product({at[0], at[1], at[2]}, axis_) - at[3], cosine_ * length(aside(at)));
    }
    bool inside(const Four& at) const {
        if (!(ball_value(at) > 0) || !(side_value(at) > 0)) return false;
        return std::all_of(faces_.begin(), faces_.end(), [&](const Face& f) { return slack(f, at) > 0; });
    }

    /// Returns whether a point lies inside the light and the cell, where sides that contain the point are not counted.
    bool inside_but_for_planes(Four at) const {
        at[3] = 0;
        if (!(ball_value(at) > 0) || !(side_value(at) > 0)) return false;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            const bool flat = std::any_of(opposites_.begin(), opposites_.end(), [&](const Opposites& pair) {
                return pair.flat && (pair.one == i || pair.other == i);
            });
            if (!flat && !(slack(faces_[i], at) >= 0)) return false;
        }
        return true;
    }

    Slope slope(const Four& at, double push) const {
        Slope s;
        s.gradient[3] = -push;
        const auto axis = std::array<double, 3>{axis_.x, axis_.y, axis_.z};
        for (const Face& f : faces_)
            if (std::isfinite(f.offset)) s.add(slack(f, at), {f.normal.x, f.normal.y, f.normal.z, -1}, {});
        std::array<Four, 4> second{};
        for (std::size_t i = 0; i < 3; ++i)
            second[i][i] = -2;
        second[3][3] = 2;
        s.add(ball_value(at), {-2 * at[0], -2 * at[1], -2 * at[2], -2 * (1 - at[3])}, second);

        const Flat a = aside(at);
        const double rise = sine_ * product({at[0], at[1], at[2]}, axis_) - at[3], c2 = cosine_ * cosine_;
        const std::array<double, 3> off = {a.x, a.y, a.z};
        Four first{};
        for (std::size_t i = 0; i < 3; ++i) {
            first[i] = 2 * rise * sine_ * axis[i] - 2 * c2 * off[i];
            for (std::size_t j = 0; j < 3; ++j)
                second[i][j] = 2 * axis[i] * axis[j] * (sine_ * sine_ + c2) - (i == j ? 2 * c2 : 0);
            second[i][3] = second[3][i] = -2 * sine_ * axis[i];
        }
        first[3] = -2 * rise;
        s.add(side_value(at), first, second);
        return s;
    }

    /// Solves  hessian step = -gradient  by Cholesky's method; returns false if the matrix is not positive definite.
    static bool solve(const Slope& s, Four& step) {
        std::array<Four, 4> l{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = s.hessian[i][j];
                for (std::size_t k = 0; k < j; ++k)
                    sum -= l[i][k] * l[j][k];
                if (i == j && !(sum > 0)) return false;
                l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
            }
        for (std::size_t i = 0; i < 4; ++i) {
            double sum = -s.gradient[i];
            for (std::size_t k = 0; k < i; ++k)
                sum -= l[i][k] * step[k];
            step[i] = sum / l[i][i];
        }
        for (std::size_t i = 4; i-- > 0;) {
            for (std::size_t k = i + 1; k < 4; ++k)
                step[i] -= l[k][i] * step[k];
            step[i] /= l[i][i];
        }
        return true;
    }

    std::optional<bool> by_barrier(double scale) {
        scale_ = scale;
        Four at = {axis_.x / 2, axis_.y / 2, axis_.z / 2, 0};
        double least = std::min(0.0, sine_ / 2);
        for (const Face& f : faces_)
            least = std::min(least, slack(f, at));
        at[3] = least - 1;
        int tries = 0;
        for (double push = 1; push < 0x1p54; push *= 8) {
            for (int steps = 0; steps < 60; ++steps) {
                const Slope s = slope(at, push);
                Four step{};
                if (!solve(s, step)) break;
                double decrement2 = 0;
                for (std::size_t i = 0; i < 4; ++i)
                    decrement2 -= s.gradient[i] * step[i];
                const double decrement = std::sqrt(std::max(decrement2, 0.0));
                double stride = decrement < 0.25 ? 1 : 1 / (1 + decrement);
                Four next{};
                for (int halvings = 0; halvings < 30; ++halvings, stride /= 2) {
                    for (std::size_t i = 0; i < 4; ++i)
                        next[i] = at[i] + stride * step[i];
                    if (inside(next)) break;
                }
                if (!inside(next)) break;
                at = next;
                if (decrement < 0.5) break;
            }
            if ((at[3] > 0 ? tries++ < 6 : is_flat() && inside_but_for_planes(at)) &&
                meets_at(scaled({at[0], at[1], at[2]}, scale_)))
                return true;
            Weights weights;
            for (std::size_t i = 0; i < faces_.size(); ++i)
                if (std::isfinite(faces_[i].offset))
                    weights.push_back({i, 1 / (push * slack(faces_[i], at))});
            cancel_opposites(weights);
            if (gap(weights) > 0 && tries++ < 6 && apart_by(weights)) return false;
        }
        return std::nullopt;
    }

    const std::vector<HalfSpace>& cell_;
    const ExactSpot& spot_;
    std::vector<Face> faces_;
    std::vector<Opposites> opposites_;
    Flat axis_;
    double axis_length_, cosine_, sine_, radius_, scale_ = 1;
    bool holds_apex_ = true;
};

/// Whether a spot meets a cell; nothing: no certificate was found.
inline std::optional<bool> meets(const std::vector<HalfSpace>& cell, const ExactSpot& spot) {
    if (spot.ball.all || spot.cosine == -1) return meets(cell, spot.ball);
    if (spot.whole()) {
        std::vector<HalfSpace> all = cell;
        all.push_back(spot.before_rim(0x1p-50));
        if (!meets(all, spot.ball)) return false;
        all.back() = spot.before_rim(-0x1p-50);
        return meets(all, spot.ball) ? std::optional(true) : std::nullopt;
    }
    return SpotSearch(cell, spot).verdict();
}

}  // namespace oracle
