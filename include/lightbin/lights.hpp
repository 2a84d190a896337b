// SPDX-License-Identifier: MIT
// The lights as the caller has them: vec4 arrays or the caller's own structs, in view space or world space.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/matrix.hpp>
#include <lightbin/detail/rounding.hpp>
#include <lightbin/result.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstring>
#include <functional>
#include <ranges>
#include <span>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// A light's sphere of influence: centre and radius (the papers' range), in the units of the space that the lights are
/// given in. That is the space that the projection matrix takes, unless they go through world_space().
///
/// Radius 0 is a point; radius +inf covers everything. A light with a NaN or infinite centre, or a NaN or
/// negative radius, is bad input: it is skipped and counted, and the others are right.
struct Sphere {
    float x, y, z, radius;
};

/// Returns the distance at which a point light of `intensity` candela (lumen per steradian) has fallen to
/// `cutoff` lux (lumen per square metre, on a surface that faces it), rounded up: sqrt(intensity / cutoff),
/// in metres. What a light gives beyond its range is lost, so the cutoff is the largest error that one
/// light's missing tail can make.
///
/// intensity  0 or less gives range 0, infinite an infinite one, NaN gives NaN
/// cutoff     0 or less gives an infinite range
inline float light_range(float intensity, float cutoff) {
    if (intensity <= 0) return 0;
    if (cutoff <= 0 || (intensity > FLT_MAX && !std::isnan(cutoff))) return detail::infinity;
    return detail::float_above(std::sqrt(static_cast<double>(intensity) / static_cast<double>(cutoff)) *
                               (1 + 0x1p-50));
}

namespace detail {

/// Returns the smallest sphere found around one of doubles: exact where floats hold it. A centre out of their range gives
/// one that covers everything; bad input stays bad.
inline Sphere sphere_around(double x, double y, double z, double radius) {
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z) || !(radius >= 0)) return {0, 0, 0, -1};
    constexpr double most = static_cast<double>(FLT_MAX);
    if (std::fabs(x) > most || std::fabs(y) > most || std::fabs(z) > most) return {0, 0, 0, infinity};
    const Sphere nearest = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0};
    const double error = std::fabs(x - static_cast<double>(nearest.x)) +
                         std::fabs(y - static_cast<double>(nearest.y)) +
                         std::fabs(z - static_cast<double>(nearest.z));
    const double reach = error > 0 ? (radius + error) * (1 + 0x1p-50) : radius;
    return {nearest.x, nearest.y, nearest.z, float_above(reach)};
}

template <class Light, class Number>
concept Vec4Of = requires(const Light& light) {
    requires std::same_as<std::remove_cvref_t<decltype(light.x)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.y)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.z)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.w)>, Number>;
};

}  // namespace detail

/// How a light becomes a Sphere by default: what is one, derives from one or converts to one, as it is; else the x, y, z
/// and w of a vec4 of floats, or of doubles, which are rounded outward.
struct AsSphere {
    template <class Light> constexpr Sphere operator()(const Light& light) const {
        if constexpr (std::convertible_to<const Light&, Sphere>) {
            return light;
        } else if constexpr (detail::Vec4Of<Light, float>) {
            return {light.x, light.y, light.z, light.w};
        } else {
            static_assert(detail::Vec4Of<Light, double>,
                          "lightbin: this light is no Sphere and has no float or double x, y, z and w (the "
                          "radius): pass "
                          "view_space(lights, to_sphere) or world_space(lights, view_matrix, to_sphere), "
                          "where to_sphere "
                          "makes a lightbin::Sphere of a light");
            return detail::sphere_around(light.x, light.y, light.z, light.w);
        }
    }
};

namespace detail {

/// World to view space. The moved sphere holds the exact image of the given one: its radius takes in the
/// matrix's largest stretch and the rounding of the moved centre.
class WorldToView {
public:
    template <class Matrix> explicit WorldToView(const Matrix& matrix) {
        copy_matrix(matrix, m_);
        affine_ = finite(m_) && m_[0][3] == 0 && m_[1][3] == 0 && m_[2][3] == 0 && m_[3][3] == 1;
        // The largest singular value is at most the root of the largest row sum of M^T M. Where a product overflows, sums
        // are infinite or NaN, which no comparison takes for the largest: then there is no bound.
        double square = 0, all = 0;
        for (int i = 0; i < 3; ++i) {
            double row_sum = 0;
            for (int j = 0; j < 3; ++j)
                row_sum += std::fabs(m_[i][0] * m_[j][0] + m_[i][1] * m_[j][1] + m_[i][2] * m_[j][2]);
            square = (std::max)(square, row_sum);
            all += row_sum;
        }
        stretch_ = std::isfinite(all) ? std::sqrt(square) * (1 + 0x1p-48) : HUGE_VAL;
    }

    bool affine() const { return affine_; }

    Sphere operator()(const Sphere& light) const {
        if (!std::isfinite(light.x) || !std::isfinite(light.y) || !std::isfinite(light.z) ||
            !(light.radius >= 0))
            return light;  // bad input stays bad
        const double x = static_cast<double>(light.x), y = static_cast<double>(light.y),
                     z = static_cast<double>(light.z);
        double centre[3], error = 0;
        for (int row = 0; row < 3; ++row) {
            const double a = m_[0][row] * x, b = m_[1][row] * y, c = m_[2][row] * z, d = m_[3][row];
            centre[row] = a + b + c + d;
            if (!(std::fabs(centre[row]) <= static_cast<double>(FLT_MAX))) return {0, 0, 0, infinity};
            // 2^-24 to round the centre to float, 2^-50 for the sum in double
            error += 0x1p-24 * std::fabs(centre[row]) +
                     0x1p-50 * (std::fabs(a) + std::fabs(b) + std::fabs(c) + std::fabs(d));
        }
        const double radius = (static_cast<double>(light.radius) * stretch_ + error) * (1 + 0x1p-23) +
                              static_cast<double>(FLT_MIN);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2]),
                radius <= static_cast<double>(FLT_MAX) ? static_cast<float>(radius) : infinity};
    }

private:
    double m_[4][4];
    double stretch_;  ///< the most that it makes a length longer
    bool affine_;
};

}  // namespace detail

/// Lights made by view_space() or world_space(): a view of the caller's array, and how an element becomes a
/// view-space sphere.
template <class Light, class ToViewSphere> struct Lights {
    std::span<const Light> array;
    ToViewSphere to_view_sphere;
    bool valid = true;  ///< false: the view matrix is not affine
};

/// Returns lights in view space (the space that the projection matrix takes). The array is read in place: it
/// must live until the Binner's call returns.
///
/// to_sphere  a callable that makes a Sphere of an element; it is copied, and called as const
template <std::ranges::contiguous_range Range, class ToSphere = AsSphere>
auto view_space(const Range& lights, ToSphere to_sphere = {}) {
    using Light = std::ranges::range_value_t<const Range>;
    return Lights<Light, ToSphere>{
        std::span<const Light>(std::ranges::data(lights), std::ranges::size(lights)), to_sphere};
}

/// Returns lights in world space, moved by `view_matrix` (view_matrix[column][row], affine: rotation,
/// translation, scale) as they are read. The rounding of the move is in the spheres: no light is missed by
/// it.
template <std::ranges::contiguous_range Range, class Matrix, class ToSphere = AsSphere>
auto world_space(const Range& lights, const Matrix& view_matrix, ToSphere to_sphere = {}) {
    const detail::WorldToView to_view(view_matrix);
    auto to_view_sphere = [to_view, to_sphere](const auto& light) {
        return to_view(std::invoke(to_sphere, light));
    };
    auto result = view_space(lights, to_view_sphere);
    result.valid = to_view.affine();
    return result;
}

namespace detail {

/// Lights passed as a plain range are view-space vec4s or Spheres.
template <class Range> auto as_lights(const Range& lights) {
    return view_space(lights);
}
template <class Light, class ToViewSphere>
const Lights<Light, ToViewSphere>& as_lights(const Lights<Light, ToViewSphere>& lights) {
    return lights;
}

/// The caller's array as spheres, if its elements are Spheres, or vec4s laid out like them, and are not to be
/// moved; else null. Read it with load_sphere.
template <class Light, class ToViewSphere>
const Sphere* as_they_are(const Lights<Light, ToViewSphere>& lights) {
    if constexpr (std::is_same_v<ToViewSphere, AsSphere> && sizeof(Light) == sizeof(Sphere) &&
                  std::is_trivially_copyable_v<Light>) {
        if (lights.array.empty()) return nullptr;
        if constexpr (std::is_base_of_v<Sphere, Light>) {
            return lights.array.data();
        } else if constexpr (!std::convertible_to<const Light&, Sphere> && Vec4Of<Light, float>) {
            const void* const array = lights.array.data();
            const Light& first = lights.array.front();
            const auto at = [&](const auto& member) {
                return static_cast<const char*>(static_cast<const void*>(&member)) -
                       static_cast<const char*>(array);
            };
            if (at(first.x) == 0 && at(first.y) == 4 && at(first.z) == 8 && at(first.w) == 12)
                return static_cast<const Sphere*>(array);
        }
    }
    return nullptr;
}

/// Reads bytes, which may be of any type.
inline Sphere load_sphere(const Sphere* from) {
    Sphere sphere;
    std::memcpy(&sphere, from, sizeof sphere);
    return sphere;
}

}  // namespace detail
}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
