// SPDX-License-Identifier: MIT
// World space: view matrices, lights before them, and cells before them.
//
// A matrix of floats is never exactly a rotation, and some are not meant to be one, so the image of a ball is
// an ellipsoid. It meets a cell iff the ball meets the cell's preimage, and the preimage of a polyhedron
// under an affine map is one too, with rational planes: the second decider answers for ellipsoids exactly.
#pragma once

#include "spheres.hpp"

#include "../../bench/exact/filter.hpp"
#include "../../bench/exact/oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace oracle {

using Affine = Matrix4<float>;

struct ViewMatrix {
    std::string name;
    Affine m;
    double stretch;  ///< of a rotation times a scale, that scale; 0 for other maps
};

/// Columns are the images of the axes; translation t.
inline ViewMatrix view_matrix(const std::string& name, const double (&columns)[3][3], const double (&t)[3],
                              double stretch) {
    ViewMatrix v{name, {}, stretch};
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            v.m[c][r] = static_cast<float>(columns[c][r]);
    for (int r = 0; r < 3; ++r)
        v.m[3][r] = static_cast<float>(t[r]);
    v.m[3][3] = 1;
    return v;
}

/// A rotation about a random axis, columns scaled, then one column leaned towards another.
inline ViewMatrix random_view(const std::string& name, Random& random, double distance,
                              std::array<double, 3> scale, double lean) {
    double q[4];
    double length = 0;
    for (double& v : q)
        v = random.normal(), length += v * v;
    for (double& v : q)
        v /= std::sqrt(length);
    const auto [w, x, y, z] = q;
    double c[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                      {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                      {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
    for (std::size_t i = 0; i < 3; ++i)
        for (double& v : c[i])
            v *= scale[i];
    for (std::size_t i = 0; i < 3; ++i)
        c[0][i] += lean * c[1][i];
    const double t[3] = {distance * random.normal(), distance * random.normal(), distance * random.normal()};
    const bool similar = lean == 0 && scale[0] == scale[1] && scale[1] == scale[2];
    return view_matrix(name, c, t, similar ? scale[0] : 0);
}

inline std::vector<ViewMatrix> view_matrices(Random& random) {
    return {view_matrix("identity", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, 1),
            random_view("rotation", random, 0, {1, 1, 1}, 0),
            random_view("camera in a room", random, 10, {1, 1, 1}, 0),
            random_view("camera in a country", random, 1e6, {1, 1, 1}, 0),
            random_view("centimetres", random, 100, {0.01, 0.01, 0.01}, 0),
            random_view("enlarged", random, 10, {3000, 3000, 3000}, 0),
            random_view("stretched", random, 10, {1, 0.3, 4}, 0),
            random_view("a little uneven", random, 10, {1, 0.98, 1.02}, 0.01),
            random_view("mirrored, far away", random, 1e4, {-2, 2, 2}, 0),
            random_view("sheared", random, 10, {1, 1, 1}, 1.7),
            random_view("nearly flat", random, 10, {1, 1e-3, 1}, 0)};
}

/// World-space lights that land, more or less, where a set wants them in view space. Solved in double; the
/// truth that is asked for is the image of what comes out.
inline std::vector<Light> into_world(const std::vector<Light>& lights, const ViewMatrix& view) {
    double m[4][3];
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r)
            m[c][r] = static_cast<double>(view.m[c][r]);
    double inverse[3][3], det = 0, size = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
            const int c1 = (c + 1) % 3, c2 = (c + 2) % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3;
            inverse[r][c] = m[c1][r1] * m[c2][r2] - m[c1][r2] * m[c2][r1];
        }
    for (int r = 0; r < 3; ++r)
        det += m[0][r] * inverse[r][0];
    for (int c = 0; c < 3; ++c)
        size = std::max(size, std::hypot(m[c][0], m[c][1], m[c][2]));
    std::vector<Light> world;
    for (const Light& light : lights) {
        const double p[3] = {static_cast<double>(light.x) - m[3][0], static_cast<double>(light.y) - m[3][1],
                             static_cast<double>(light.z) - m[3][2]};
        double q[3] = {};
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                q[c] += inverse[r][c] * p[r] / det;
        world.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                         static_cast<float>(static_cast<double>(light.w) / size)});
    }
    return world;
}

struct ExactView {
    Vector column[4];
    explicit ExactView(const Affine& m) {
        for (int c = 0; c < 4; ++c)
            column[c] = {exact(static_cast<double>(m[c][0])), exact(static_cast<double>(m[c][1])),
                         exact(static_cast<double>(m[c][2]))};
    }
    Vector operator()(const Vector& q) const {
        return q.x * column[0] + q.y * column[1] + q.z * column[2] + column[3];
    }
    HalfSpace preimage(const HalfSpace& h) const {
        return {{dot(h.a, column[0]), dot(h.a, column[1]), dot(h.a, column[2])}, dot(h.a, column[3]) + h.b};
    }
};

/// Does the image of the ball meet the cell?
inline bool image_meets(const ExactView& view, std::vector<HalfSpace> cell, const Ball& ball) {
    for (HalfSpace& h : cell)
        h = view.preimage(h);
    if (!ball.all)  // beyond one plane: no need to look further
        for (const HalfSpace& h : cell) {
            const Rational at = h.at(ball.centre);
            if (at < 0 && square(at) > square(ball.radius) * dot(h.a, h.a)) return false;
        }
    return meets(cell, ball);
}

/// A view matrix whose images are in the camera's axes: x and y as in the image, and depth.
using AxesMatrix = std::array<std::array<double, 3>, 4>;
inline AxesMatrix to_axes(const Oracle& oracle, const Affine& m) {
    const CameraBall signs = oracle.in_camera({{1, 1, 1}, 0});
    const double sign[] = {nearly(signs.x), nearly(signs.y), nearly(signs.depth)};
    AxesMatrix result;
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 3; ++r)
            result[c][r] = sign[r] * static_cast<double>(m[static_cast<int>(c)][static_cast<int>(r)]);
    return result;
}
constexpr Affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

/// A ball around the image of a light's under a view matrix, for the filter: in most cases that is apart from the cell, too.
class AroundImage {
public:
    AroundImage(const Oracle& oracle, const Affine& m) : m_(to_axes(oracle, m)) {
        // The square of the greatest stretch is an eigenvalue of the transpose times the matrix: at most the greatest sum
        // of a row's sizes (Gershgorin).
        double most = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            double sum = 0;
            for (std::size_t b = 0; b < 3; ++b)
                sum += std::abs(m_[a][0] * m_[b][0] + m_[a][1] * m_[b][1] + m_[a][2] * m_[b][2]);
            most = std::max(most, sum);
        }
        stretch_ = std::sqrt(most) * (1 + 0x1p-30);
    }

    /// Rounding moves the centre by less than 2^-48 of its terms.
    FlatBall operator()(const Light& light) const {
        const double from[] = {static_cast<double>(light.x), static_cast<double>(light.y),
                               static_cast<double>(light.z), 1};
        double at[3] = {}, terms = 0;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c)
                at[r] += m_[c][r] * from[c], terms += std::abs(m_[c][r] * from[c]);
        return {at[0], at[1], at[2], static_cast<double>(light.w) * stretch_ + 0x1p-48 * terms};
    }

private:
    AxesMatrix m_;
    double stretch_;
};

}  // namespace oracle
