// SPDX-License-Identifier: MIT
// The textbooks' formulas, as they are printed, in the precision of `Real`: the bounds of spheres in slopes along one
// image axis, and the slice of a depth.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace textbook {

template <class Real> struct Slopes { Real low, high; };

// c is x or y: a sphere's disc in the (c, z) plane has centre (c, z) and radius r; the near plane is z = n.

/// Mara and McGuire, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere", JCGT 2(2), 2013: the
/// centre turned by the tangent's angle, cut at the near plane.
struct MaraMcGuire {
    static constexpr const char* name = "Mara-McGuire";
    static constexpr bool knows_near_plane = true;
    template <class Real> static Slopes<Real> slopes(Real c, Real z, Real r, Real n) {
        const Real d2 = c * c + z * z, t2 = d2 - r * r;
        const bool inside = !(t2 > 0), cut = z - r <= n;
        const Real cosine = std::sqrt(t2) / std::sqrt(d2), sine = r / std::sqrt(d2);
        const Real h = std::sqrt(std::max(r * r - (n - z) * (n - z), Real(0)));
        const auto bound = [&](Real sign) {
            const Real x = cosine * (cosine * c + sign * sine * z),
                       y = cosine * (cosine * z - sign * sine * c);
            return cut && (inside || y < n) ? (c + sign * h) / n : x / y;
        };
        return {bound(-1), bound(1)};
    }
};

/// The roots of  (z^2 - r^2) s^2 - 2 c z s + c^2 - r^2 = 0,  the slopes of the tangents.
struct Quadratic {
    static constexpr const char* name = "quadratic";
    static constexpr bool knows_near_plane = false;
    template <class Real> static Slopes<Real> slopes(Real c, Real z, Real r, Real) {
        const Real root = r * std::sqrt(c * c + z * z - r * r), e = z * z - r * r;
        return {(c * z - root) / e, (c * z + root) / e};
    }
};

/// The tangent planes' normals: Lengyel, "Mathematics for 3D Game Programming", 2002; Lauritzen, "Deferred Rendering
/// for Current and Future Rendering Pipelines", SIGGRAPH 2010.
struct LengyelLauritzen {
    static constexpr const char* name = "Lengyel-Lauritzen";
    static constexpr bool knows_near_plane = false;
    template <class Real> static Slopes<Real> slopes(Real c, Real z, Real r, Real) {
        const Real d2 = c * c + z * z, root = std::sqrt(r * r * c * c - d2 * (r * r - z * z));
        const auto bound = [&](Real sign) {
            const Real nx = (r * c + sign * root) / d2, nz = (r - nx * c) / z;
            return -nz / nx;
        };
        const Real a = bound(-1), b = bound(1);
        return {std::min(a, b), std::max(a, b)};
    }
};

// Formulas for the slice of a depth: `count` slices from near to far, each deeper than the last by one factor.

/// The slice of a depth by one logarithm, one product and one sum: Sousa and Geffroy, "The devil is in the details:
/// idTech 666", SIGGRAPH 2016.
struct LogScaleBias {
    static constexpr const char* name = "log z * a + b";
    template <class Real> static Real slice(Real z, Real near_depth, Real far_depth, int count) {
        const Real scale = Real(count) / std::log2(far_depth / near_depth),
                   bias = -std::log2(near_depth) * scale;
        return std::log2(z) * scale + bias;
    }
};

/// Olsson, Billeter and Assarsson, "Clustered Deferred and Forward Shading", HPG 2012.
struct LogRatio {
    static constexpr const char* name = "log(z / near)";
    template <class Real> static Real slice(Real z, Real near_depth, Real far_depth, int count) {
        return std::log(z / near_depth) / std::log(far_depth / near_depth) * Real(count);
    }
};

}  // namespace textbook
