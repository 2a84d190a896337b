// SPDX-License-Identifier: MIT
// The truth the light lists are held against: does a closed ball meet a closed cell? Decided in rational
// arithmetic, without rounding anywhere.
//
// What exactness rests on:
// - A float or double is a rational number, and mpq (GMP) computes with rationals exactly. The one entry is
//   exact().
// - Everything is read from the projection matrix itself, the viewport, the tile size and the API's settings.
//   Nothing is taken from the library: not its View, not a constant, not a margin.
// - A cell is what clip space says: the points with  W clip_x >= (2a - W) clip_w  right of pixel edge a, and so
//   on for each side, between the clip planes of depth and, where asked, between two view depths. Clip
//   coordinates are linear in the point, so a cell is a convex polyhedron with rational planes, and the squared
//   distance from a rational point to it is rational: no square root is ever needed.
// - Two deciders that share no formula must agree. meets() works in the camera's own axes on a convex function
//   of depth alone; nearest_point() knows only half-spaces and finds the point that satisfies the
//   Karush-Kuhn-Tucker conditions, which is a proof by itself. deciders.cpp compares them.
// - The word "pixel edge" means the real number a in window coordinates; how a GPU rounds its own vertices is
//   not ours.
#pragma once

#include "camera.hpp"

#include <boost/multiprecision/gmp.hpp>

#include <cassert>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

namespace oracle {

// Without expression templates `auto` and ?: have the number's own type.
using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

inline Rational exact(double value) {
    assert(std::isfinite(value));
    return Rational(value);
}

/// Returns the value as a double, within 2^-52 of it if it is in the range of double. A double is returned unchanged.
inline double nearly(const Rational& value) {
    return mpq_get_d(value.backend().data());  // many times as fast as Boost's, which rounds to nearest
}

inline Rational square(const Rational& v) {
    return v * v;
}

struct Vector {
    Rational x, y, z;
};

inline Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Rational& k, const Vector& v) {
    return {k * v.x, k * v.y, k * v.z};
}
inline Rational dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A closed ball. `all`: its radius is infinite.
struct Ball {
    Vector centre;
    Rational radius;
    bool all = false;
};

inline Ball exact_ball(float x, float y, float z, float radius) {
    const bool all = std::isinf(radius);
    return {{exact(x), exact(y), exact(z)}, all ? Rational(0) : exact(radius), all};
}

/// The edges of a block of tiles in window coordinates. They need not be integers: tests of excess entries enlarge
/// blocks.
struct Edges {
    Rational low, high;
};

/// A closed interval of view depths; an absent end is no bound.
struct Depths {
    std::optional<Rational> min, max;
    bool empty = false;

    void at_least(const Rational& depth) {
        if (!min || *min < depth) min = depth;
    }
    void at_most(const Rational& depth) {
        if (!max || *max > depth) max = depth;
    }
    bool contains_none() const { return empty || (min && max && *min > *max); }
};

/// a . p + b >= 0
struct HalfSpace {
    Vector a;
    Rational b;
    Rational at(const Vector& p) const { return dot(a, p) + b; }
};

//------------------------------------------------------------------------------------------------------------
// Decider 2 first, as it needs least: half-spaces and nothing else.

/// Returns the point of the intersection of `cell` that is nearest to `p`, or nothing when the intersection
/// is empty.
///
/// q is nearest iff it lies in the cell and p - q = -sum l_i a_i over planes through q with all l_i >= 0. By
/// Caratheodory linearly independent planes are enough, and in space there are at most three of those: so
/// trying every subset of up to three planes, with its Gram system solved exactly, finds q or proves there is
/// none.
inline std::optional<Vector> nearest_point(const std::vector<HalfSpace>& cell, const Vector& p) {
    std::vector<const HalfSpace*> planes;
    for (const HalfSpace& h : cell) {
        if (h.a.x.is_zero() && h.a.y.is_zero() && h.a.z.is_zero()) {
            if (h.b < 0) return std::nullopt;
        } else {
            planes.push_back(&h);
        }
    }
    const auto inside = [&](const Vector& q) {
        for (const HalfSpace* h : planes)
            if (h->at(q) < 0) return false;
        return true;
    };
    if (inside(p)) return p;

    const std::size_t n = planes.size();
    std::vector<Rational> value(n);
    std::vector<std::vector<Rational>> gram(n, std::vector<Rational>(n));
    for (std::size_t i = 0; i < n; ++i) {
        value[i] = planes[i]->at(p);
        for (std::size_t j = 0; j <= i; ++j)
            gram[i][j] = gram[j][i] = dot(planes[i]->a, planes[j]->a);
    }
    // q = p + sum l_i a_i with a_i . q + b_i = 0 for the chosen planes:  gram l = -value.  l . value = -l . gram l < 0, so
    // with l >= 0 one of the values is negative.
    for (std::size_t i = 0; i < n; ++i) {
        if (value[i] > 0) continue;  // l would be negative
        const Vector q = p + (-value[i] / gram[i][i]) * planes[i]->a;
        if (inside(q)) return q;
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const Rational det = gram[i][i] * gram[j][j] - square(gram[i][j]);
            if (det.is_zero() || (value[i] >= 0 && value[j] >= 0)) continue;
            const Rational li = gram[i][j] * value[j] - gram[j][j] * value[i];
            const Rational lj = gram[i][j] * value[i] - gram[i][i] * value[j];
            if (li < 0 || lj < 0) continue;  // det > 0 (Cauchy-Schwarz), so the signs are those of l
            const Vector q = p + (li / det) * planes[i]->a + (lj / det) * planes[j]->a;
            if (inside(q)) return q;
        }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            for (std::size_t k = j + 1; k < n; ++k) {
                const std::size_t s[3] = {i, j, k};
                if (value[i] >= 0 && value[j] >= 0 && value[k] >= 0) continue;
                const auto g = [&](int r, int c) -> const Rational& { return gram[s[r]][s[c]]; };
                const auto minor = [&](int r,
                                       int c) {  // of the symmetric 3x3 Gram matrix, signs by cyclic indices
                    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
                    return g(r1, c1) * g(r2, c2) - g(r1, c2) * g(r2, c1);
                };
                Rational cofactor[3][3];
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c)
                        cofactor[r][c] = minor(r, c);
                const Rational det =
                    g(0, 0) * cofactor[0][0] + g(0, 1) * cofactor[0][1] + g(0, 2) * cofactor[0][2];
                if (det.is_zero()) continue;
                Rational l[3];
                bool positive = true;
                for (int r = 0; r < 3 && positive; ++r) {
                    l[r] = Rational(0);
                    for (int c = 0; c < 3; ++c)
                        l[r] -= cofactor[r][c] * value[s[c]];
                    positive = l[r] >= 0;
                }
                if (!positive) continue;
                Vector q = p;
                for (int r = 0; r < 3; ++r)
                    q = q + (l[r] / det) * planes[s[r]]->a;
                if (inside(q)) return q;
            }
    return std::nullopt;
}

inline bool meets(const std::vector<HalfSpace>& cell, const Ball& ball) {
    const auto q = nearest_point(cell, ball.all ? Vector{} : ball.centre);
    if (!q) return false;
    const Vector away = *q - ball.centre;
    return ball.all || dot(away, away) <= square(ball.radius);
}

// ------------------------------------------------------------------------------------------------------------
// Decider 1: in the camera's own axes a block of tiles is  low(d) <= c <= high(d)  in each image axis: c is the
// coordinate, d the depth, and both bounds are linear in d.

/// The line offset + slope * depth: offset is 0 for a perspective, slope 0 for an orthographic camera.
struct Line {
    Rational offset, slope;
    Rational at(const Rational& d) const { return offset + slope * d; }
};

struct Slab {
    Line low, high;
};

/// Bounds of a cell in the image axes x and y, each compared with that coordinate of the ball.
struct Slabs {
    std::optional<Slab> x, y;  ///< nothing: this axis is not bounded
};

/// A ball in the camera's axes: image coordinates that grow with pixels, depth that grows away from the eye.
struct CameraBall {
    Rational x, y, depth, radius;
    bool all = false;
};

namespace detail {

inline Rational outside(const Slab& slab, const Rational& c, const Rational& d) {
    const Rational low = slab.low.at(d);
    if (c < low) return low - c;
    const Rational high = slab.high.at(d);
    return c > high ? c - high : Rational(0);
}

/// True: the ball lies strictly beyond one side of the slab, whatever the depth.
inline bool beyond_a_side(const Slab& slab, const Rational& c, const CameraBall& ball) {
    for (const bool low : {true, false}) {
        const Line& line = low ? slab.low : slab.high;
        const Rational at = line.at(ball.depth);
        const Rational gap = low ? at - c : c - at;
        if (gap > 0 && square(gap) > square(ball.radius) * (1 + square(line.slope))) return true;
    }
    return false;
}

}  // namespace detail

/// Does the ball meet the cell with these slabs and depths?
///
/// f(d) = squared distance from the centre to the cell's slice at depth d, measured in three dimensions, is
/// convex and piecewise quadratic with a continuous derivative. Its least value over the depths is therefore
/// taken at an end or where the derivative of one of the nine pieces is 0; each of those (moved into the
/// depths) is a point of the cell anyway, so the smallest f among them is the squared distance.
inline bool meets(const Slabs& slabs, const Depths& depths, const CameraBall& ball) {
    if (depths.contains_none()) return false;
    if (ball.all) return true;
    if (depths.min && ball.depth + ball.radius < *depths.min) return false;
    if (depths.max && ball.depth - ball.radius > *depths.max) return false;
    if (slabs.x && detail::beyond_a_side(*slabs.x, ball.x, ball)) return false;
    if (slabs.y && detail::beyond_a_side(*slabs.y, ball.y, ball)) return false;

    const Rational reach = square(ball.radius);
    const auto clamped = [&](const Rational& d) {
        if (depths.min && d < *depths.min) return *depths.min;
        if (depths.max && d > *depths.max) return *depths.max;
        return d;
    };
    const auto within = [&](const Rational& d) {
        Rational f = square(d - ball.depth);
        if (f > reach) return false;
        if (slabs.x) f += square(detail::outside(*slabs.x, ball.x, d));
        if (f > reach) return false;
        if (slabs.y) f += square(detail::outside(*slabs.y, ball.y, d));
        return f <= reach;
    };
    if (within(clamped(ball.depth))) return true;  // the piece inside both slabs
    if (depths.min && within(*depths.min)) return true;
    if (depths.max && within(*depths.max)) return true;

    const Line* const x_lines[] = {nullptr, slabs.x ? &slabs.x->low : nullptr,
                                   slabs.x ? &slabs.x->high : nullptr};
    const Line* const y_lines[] = {nullptr, slabs.y ? &slabs.y->low : nullptr,
                                   slabs.y ? &slabs.y->high : nullptr};
    for (const Line* u : x_lines)
        for (const Line* v : y_lines) {
            Rational top = ball.depth, bottom = 1;
            if (u) top += u->slope * (ball.x - u->offset), bottom += square(u->slope);
            if (v) top += v->slope * (ball.y - v->offset), bottom += square(v->slope);
            if (within(clamped(top / bottom))) return true;
        }
    return false;
}

//------------------------------------------------------------------------------------------------------------

/// A camera in rationals, and the cells of its tiles in both forms.
class Oracle {
public:
    explicit Oracle(const Camera& camera) : camera_(camera), width_(camera.width), height_(camera.height) {
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                m_[column][row] = exact(camera.m[column][row]);
        const auto zero = [&](int column, int row) { return m_[column][row].is_zero(); };
        // Decider 1 assumes that these entries of the matrix are 0; decider 2 does not.
        const bool axes = zero(1, 0) && zero(0, 1) && zero(0, 3) && zero(1, 3);
        const bool eye = orthographic() ? m_[3][3] > 0 && zero(2, 0) && zero(2, 1)
                                        : zero(3, 3) && zero(3, 0) && zero(3, 1);
        if (!axes || !eye) std::abort();

        // The sign of depth: for a perspective, of the entry that makes w from z; for an orthographic matrix, of the
        // slope of NDC depth, which the user says is reversed or not.
        const Rational& along = orthographic() ? m_[2][2] : m_[2][3];
        depth_sign_ = (along > 0) != (orthographic() && camera.reversed) ? 1 : -1;
        find_range();
    }

    const Camera& camera() const { return camera_; }
    bool orthographic() const { return m_[2][3].is_zero(); }
    int tiles_x() const { return (camera_.width + camera_.tile - 1) / camera_.tile; }
    int tiles_y() const { return (camera_.height + camera_.tile - 1) / camera_.tile; }
    int depth_sign() const { return depth_sign_; }

    /// The depths of the whole clip volume; no maximum if it reaches to infinity.
    const Depths& range() const { return range_; }

    /// The depths of a cell: from near to far plane, and between `min` and `max` where they are given and finite.
    Depths depths(std::optional<float> min = {}, std::optional<float> max = {}) const {
        Depths depths = range_;
        if (min && std::isinf(*min))
            depths.empty |= *min > 0;
        else if (min)
            depths.at_least(exact(*min));
        if (max && std::isinf(*max))
            depths.empty |= *max < 0;
        else if (max)
            depths.at_most(exact(*max));
        return depths;
    }

    /// The pixel edges of the tiles [first, last), cut at the viewport.
    Edges columns(int first, int last) const { return edges(first, last, camera_.width); }
    Edges rows(int first, int last) const { return edges(first, last, camera_.height); }

    /// Where the view axis is in the image, in tiles from pixel 0: O in  tile = K c / d + O.
    Rational offset_x() const { return offset(0, width_); }
    Rational offset_y() const { return offset(1, height_); }

    CameraBall in_camera(const Ball& ball) const {
        return {x_sign() * ball.centre.x, y_sign() * ball.centre.y, depth_sign_ * ball.centre.z, ball.radius,
                ball.all};
    }

    Slab column_slab(const Edges& e) const { return {line(0, width_, e.low), line(0, width_, e.high)}; }
    Slab row_slab(const Edges& e) const { return {line(1, height_, e.low), line(1, height_, e.high)}; }

    /// The cell as half-spaces of view space, straight from the clip-space inequalities (w > 0 follows from
    /// the depths).
    std::vector<HalfSpace> half_spaces(const Edges& columns, const Edges& rows, const Depths& depths) const {
        std::vector<HalfSpace> cell = depth_planes();
        const auto add = [&](int row, const Rational& clip,
                             const Rational& w) {  // clip * clip_row + w * clip_w >= 0
            const auto mix = [&](int column) { return clip * m_[column][row] + w * m_[column][3]; };
            cell.push_back({{mix(0), mix(1), mix(2)}, mix(3)});
        };
        // Window x = (ndc_x + 1) / 2 * W; window y the same, or (1 - ndc_y) / 2 * H from the upper side.
        add(0, width_, width_ - 2 * columns.low);
        add(0, -width_, 2 * columns.high - width_);
        const int up = camera_.upper_left ? -1 : 1;
        add(1, up * height_, height_ - 2 * rows.low);
        add(1, -up * height_, 2 * rows.high - height_);
        const Rational sign = depth_sign_;
        if (depths.empty) cell.push_back({{}, -1});
        if (depths.min) cell.push_back({{0, 0, sign}, -*depths.min});
        if (depths.max) cell.push_back({{0, 0, -sign}, *depths.max});
        return cell;
    }

    /// The view depth of a window depth in 0..1 at a point of the image in pixels; nothing if it is at infinity or
    /// beyond.
    std::optional<Rational> view_depth(const Rational& window_depth, const Rational& x, const Rational& y) const {
        const Rational ndc = camera_.zero_to_one ? window_depth : 2 * window_depth - 1;
        const Line distance = along(clip_plane(1, -ndc), x, y);
        if (distance.slope.is_zero()) return std::nullopt;
        const Rational depth = -distance.offset / distance.slope;
        if (!orthographic() && depth < 0) return std::nullopt;
        return depth;
    }

private:
    /// The half-space of view space where  z clip_z + w clip_w >= 0.
    HalfSpace clip_plane(const Rational& z, const Rational& w) const {
        const auto mix = [&](int column) { return z * m_[column][2] + w * m_[column][3]; };
        return {{mix(0), mix(1), mix(2)}, mix(3)};
    }
    /// The near and the far plane as half-spaces of view space: -w <= z <= w, or 0 <= z <= w.
    std::vector<HalfSpace> depth_planes() const {
        return {clip_plane(1, camera_.zero_to_one ? 0 : 1), clip_plane(-1, 1)};
    }

    /// What a half-space says at each depth of the line of sight through a point of the image, in pixels.
    Line along(const HalfSpace& plane, const Rational& x, const Rational& y) const {
        const Line across = line(0, width_, x), down = line(1, height_, y);
        const Rational a_x = x_sign() * plane.a.x, a_y = y_sign() * plane.a.y;
        return {plane.b + a_x * across.offset + a_y * down.offset,
                depth_sign_ * plane.a.z + a_x * across.slope + a_y * down.slope};
    }

    /// Finds the depths of the clip volume. Along a line of sight, clip z is a multiple of depth plus a constant; the
    /// depth of a plane is monotonic in the multiple (orthographic: the constant), which is linear across the image. So
    /// the least and the greatest depth are at the image's corners. If the near plane leaves nothing of a corner's
    /// line, it is nearly parallel to other lines and cuts them at any depth, so that there is no greatest depth.
    void find_range() {
        range_.empty = true;
        bool endless = false;
        for (const Rational& x : {Rational(0), width_})
            for (const Rational& y : {Rational(0), height_}) {
                Depths seen;
                for (const HalfSpace& plane : depth_planes()) {
                    const Line inside = along(plane, x, y);
                    const Rational end = inside.slope.is_zero() ? Rational(0) : Rational(-inside.offset / inside.slope);
                    if (inside.slope > 0)
                        seen.at_least(end);
                    else if (inside.slope < 0)
                        seen.at_most(end);
                    else if (inside.offset < 0)
                        seen.empty = true;
                }
                endless |= seen.contains_none() || !seen.max;
                if (seen.contains_none()) continue;
                range_.empty = false;
                if (!range_.min || *seen.min < *range_.min) range_.min = seen.min;
                if (!range_.max || (seen.max && *seen.max > *range_.max)) range_.max = seen.max;
            }
        if (endless) range_.max.reset();
    }

    Edges edges(int first, int last, int side) const {
        return {Rational(std::min(first * camera_.tile, side)),
                Rational(std::min(last * camera_.tile, side))};
    }

    int up(int row) const { return row == 1 && camera_.upper_left ? -1 : 1; }
    int x_sign() const { return m_[0][0] > 0 ? 1 : -1; }
    int y_sign() const { return (m_[1][1] > 0 ? 1 : -1) * up(1); }

    /// Pixel edge a as a line:  side * up * clip = (2a - side) w,  clip = m_cc * coordinate + m_2c * z + m_3c.
    Line line(int axis, const Rational& side, const Rational& a) const {
        const Rational scale = side * abs(m_[axis][axis]), ndc = 2 * a - side, flip = up(axis) * side;
        return {(ndc * m_[3][3] - flip * m_[3][axis]) / scale,
                depth_sign_ * (ndc * m_[2][3] - flip * m_[2][axis]) / scale};
    }

    Rational offset(int axis, const Rational& side) const {
        const Rational ndc =
            up(axis) * (orthographic() ? Rational(m_[3][axis] / m_[3][3]) : Rational(m_[2][axis] / m_[2][3]));
        return (ndc + 1) * side / (2 * camera_.tile);
    }

    Camera camera_;
    Rational m_[4][4];
    Rational width_, height_;
    int depth_sign_ = 1;
    Depths range_;
};

}  // namespace oracle
