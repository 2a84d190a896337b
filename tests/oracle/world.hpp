// SPDX-License-Identifier: MIT
// World space: view matrices, lights before them, and cells before them.
//
// A matrix of floats is never exactly a rotation, and some are not meant to be one, so the image of a ball is
// an ellipsoid. It meets a cell iff the ball meets the cell's preimage, and the preimage of a polyhedron
// under an affine map is one too, with rational planes: the second decider answers for ellipsoids exactly.
#pragma once

#include "spheres.hpp"

#include "../../bench/exact/truth.hpp"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace oracle {

using Affine = Matrix4<float>;
constexpr Affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

struct ViewMatrix {
    std::string name;
    Affine m;
    double stretch;  ///< for a rotation times a scale: that scale; 0 for other maps
    /// A large world: the eye, and the origin that lights are relative to. The translation of `m` is not read then.
    struct Large {
        glm::dvec3 eye, origin;
    };
    std::optional<Large> large = {};
};

/// Returns a random rotation, with scaled columns, one of which may be leaned towards another, and a translation.
inline ViewMatrix random_view(const std::string& name, Random& random, double distance, glm::dvec3 scale,
                              double lean) {
    const auto normals = [&] { return glm::dvec3(random.normal(), random.normal(), random.normal()); };
    glm::dmat4 m(glm::mat3_cast(glm::normalize(glm::dquat(random.normal(), normals()))));
    for (int i = 0; i < 3; ++i)
        m[i] *= scale[i];
    m[0] += lean * m[1];
    m[3] = glm::dvec4(distance * normals(), 1);
    ViewMatrix view{name, {}, lean == 0 && scale == glm::dvec3(scale[0]) ? scale[0] : 0};
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            view.m[c][r] = static_cast<float>(m[c][r]);
    return view;
}

/// A view matrix with an eye that is about `distance` from the world's origin, and lights relative to an origin about
/// `sector` from the eye. The doubles are rounded, and all their bits count.
inline ViewMatrix large_world(const std::string& name, Random& random, double distance, double sector,
                              glm::dvec3 scale, double lean) {
    ViewMatrix view = random_view(name, random, 1e3, scale, lean);
    const auto normals = [&] { return glm::dvec3(random.normal(), random.normal(), random.normal()); };
    const glm::dvec3 eye = distance * normals();
    view.large = {eye, eye + sector * normals()};
    return view;
}

inline std::vector<ViewMatrix> view_matrices(Random& random) {
    return {{"identity", identity, 1},
            random_view("rotation", random, 0, {1, 1, 1}, 0),
            random_view("camera in a room", random, 10, {1, 1, 1}, 0),
            random_view("camera in a country", random, 1e6, {1, 1, 1}, 0),
            random_view("centimetres", random, 100, {0.01, 0.01, 0.01}, 0),
            random_view("enlarged", random, 10, {3000, 3000, 3000}, 0),
            random_view("stretched", random, 10, {1, 0.3, 4}, 0),
            random_view("a little uneven", random, 10, {1, 0.98, 1.02}, 0.01),
            random_view("mirrored, far away", random, 1e4, {-2, 2, 2}, 0),
            random_view("sheared", random, 10, {1, 1, 1}, 1.7),
            random_view("nearly flat", random, 10, {1, 1e-3, 1}, 0),
            large_world("eye at 1e5", random, 1e5, 0, {1, 1, 1}, 0),
            large_world("eye at 1e9", random, 1e9, 30, {1, 1, 1}, 0),
            large_world("eye at 1e9, sectors of 1e6", random, 1e9, 1e6, {1, 1, 1}, 0),
            large_world("eye at 2^60", random, 0x1p60, 3000, {1, 1, 1}, 0),
            large_world("eye at 2^127", random, 0x1p127, 0, {0.01, 0.01, 0.01}, 0),
            large_world("eye at 1e7, sheared", random, 1e7, 10, {1, 1, 1}, 1.7),
            large_world("eye at 1e7, a little uneven", random, 1e7, 10, {1, 0.98, 1.02}, 0.01)};
}

/// Returns world-space lights that a view matrix moves about where they are wanted in view space. Solved in double;
/// tests use the rounded result.
inline std::vector<Light> into_world(const std::vector<Light>& lights, const ViewMatrix& view) {
    glm::dmat4 m;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            m[c][r] = static_cast<double>(view.m[c][r]);
    if (view.large) m[3] = glm::dvec4(glm::dmat3(m) * (view.large->origin - view.large->eye), 1);
    const glm::dmat4 inverse = glm::inverse(m);
    const double size = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
    std::vector<Light> world;
    for (const Light& light : lights) {
        const glm::vec3 at(inverse * glm::dvec4(light.x, light.y, light.z, 1));
        world.push_back({at.x, at.y, at.z, static_cast<float>(static_cast<double>(light.w) / size)});
    }
    return world;
}

struct ExactView {
    Vector column[4];
    explicit ExactView(const ViewMatrix& view) {
        for (int c = 0; c < 4; ++c)
            column[c] = {exact(static_cast<double>(view.m[c][0])), exact(static_cast<double>(view.m[c][1])),
                         exact(static_cast<double>(view.m[c][2]))};
        if (!view.large) return;
        const auto [eye, origin] = *view.large;
        column[3] = (exact(origin.x) - exact(eye.x)) * column[0] + (exact(origin.y) - exact(eye.y)) * column[1] +
                    (exact(origin.z) - exact(eye.z)) * column[2];
    }
    Vector operator()(const Vector& q) const {
        return q.x * column[0] + q.y * column[1] + q.z * column[2] + column[3];
    }
    HalfSpace preimage(const HalfSpace& h) const {
        return {{dot(h.a, column[0]), dot(h.a, column[1]), dot(h.a, column[2])}, dot(h.a, column[3]) + h.b};
    }
};

/// The half-spaces of a cell in view space or, if a view matrix is given, in world space.
class CellPlanes {
public:
    CellPlanes(const Oracle& oracle, const ViewMatrix* matrix) : oracle_(oracle) {
        if (matrix) world_.emplace(*matrix);
    }
    std::vector<HalfSpace> operator()(const Block& tiles, const Depths& depths) const {
        std::vector<HalfSpace> planes =
            oracle_.half_spaces(oracle_.columns(tiles.x0, tiles.x1), oracle_.rows(tiles.y0, tiles.y1), depths);
        if (world_)
            for (HalfSpace& plane : planes)
                plane = world_->preimage(plane);
        return planes;
    }

private:
    const Oracle& oracle_;
    std::optional<ExactView> world_;
};

/// A sphere around the ellipsoid that a light becomes in view space, for tests in double: mostly it does not meet the
/// cell, either.
class AroundImage {
public:
    AroundImage(const Oracle& oracle, const ViewMatrix& matrix) : oracle_(oracle), view_(matrix) {
        // The square of the greatest stretch is an eigenvalue of the transpose times the matrix: at most the greatest
        // sum of a row's sizes (Gershgorin).
        Rational most = 0;
        for (int a = 0; a < 3; ++a) {
            Rational sum = 0;
            for (int b = 0; b < 3; ++b)
                sum += abs(dot(view_.column[a], view_.column[b]));
            most = std::max(most, sum);
        }
        stretch_ = std::sqrt(nearly(most)) * (1 + 0x1p-30);
    }

    /// Rounding to double moves the centre by less than 2^-51 of its coordinates.
    FlatBall operator()(const Light& light) const {
        const CameraBall seen = oracle_.in_camera({view_(exact_ball(light.x, light.y, light.z, 0).centre), 0});
        const double x = nearly(seen.x), y = nearly(seen.y), depth = nearly(seen.depth);
        return {x, y, depth,
                static_cast<double>(light.w) * stretch_ + 0x1p-50 * (std::abs(x) + std::abs(y) + std::abs(depth))};
    }

private:
    const Oracle& oracle_;
    ExactView view_;
    double stretch_;
};

}  // namespace oracle
