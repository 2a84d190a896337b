// SPDX-License-Identifier: MIT
// The lights as the caller has them: vec4 arrays or the caller's own structs, in view space or world space.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/maybe.hpp>
#include <lightbin/detail/plain.hpp>
#include <lightbin/detail/world_to_view.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/sphere.hpp>
#include <lightbin/spot.hpp>

#include <concepts>
#include <span>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

namespace detail {

template <class Light, class Number>
concept Vec4Of = requires(const Light& light) {
    requires std::same_as<std::remove_cvref_t<decltype(light.x)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.y)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.z)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.w)>, Number>;
};

}  // namespace detail

/// How a light becomes a Sphere or a Spot by default: what is one, derives from one or converts to one, as it is; else a
/// Sphere of the x, y, z and w of a vec4 of floats, or of doubles, which are rounded outward.
struct AsLight {
    template <class Light>
    requires(std::convertible_to<const Light&, Sphere> || detail::Vec4Of<Light, float> ||
             detail::Vec4Of<Light, double>) constexpr auto
    operator()(const Light& light) const {
        if constexpr (std::convertible_to<const Light&, Spot>)
            return static_cast<Spot>(light);
        else if constexpr (std::convertible_to<const Light&, Sphere>)
            return static_cast<Sphere>(light);
        else if constexpr (detail::Vec4Of<Light, float>)
            return Sphere{light.x, light.y, light.z, light.w};
        else
            return detail::sphere_around(light.x, light.y, light.z, light.w);
    }
};

namespace detail {

template <class Range>
concept Array = requires(const Range& range) {
    std::span(std::data(range), std::size(range));
};
template <class ToLight, class Light>
concept MakesLights = std::convertible_to<std::invoke_result_t<const ToLight&, const Light&>, Sphere>;

/// Returns `to_light`, or where it can't be one, the compiler's sentence and one that can, so that no other error follows.
template <class Light, class ToLight> constexpr auto checked_to_light(const ToLight& to_light) {
    constexpr bool can_be_called = std::invocable<const ToLight&, const Light&>;
    if constexpr (std::same_as<ToLight, AsLight>)
        static_assert(
            can_be_called,
            "lightbin: this light is no Sphere or Spot and has no float or double x, y, z and w (the "
            "radius): pass view_space(lights, to_light) or world_space(lights, view_matrix, to_light), "
            "where to_light makes a lightbin::Sphere or a lightbin::Spot of a light");
    else
        static_assert(
            can_be_called,
            "lightbin: to_light is called, as const, with a const reference to one of the lights, and "
            "can't be called with it");
    if constexpr (MakesLights<ToLight, Light>) {
        return to_light;
    } else {
        static_assert(!can_be_called,
                      "lightbin: to_light must return a lightbin::Sphere or a lightbin::Spot");
        return [](const Light&) { return Sphere(); };
    }
}

/// Returns the caller's array, or where it is none, the compiler's sentence and an empty one.
template <class Range> auto checked_array(const Range& lights) {
    static_assert(
        Array<Range>,
        "lightbin: lights are an array, a std::vector, a std::span or another range whose elements lie one "
        "after another, with data() and size()");
    if constexpr (Array<Range>)
        return std::span<const std::remove_cvref_t<decltype(*std::data(lights))>>(std::data(lights),
                                                                                  std::size(lights));
    else if constexpr (requires { *std::begin(lights); })
        return std::span<const std::remove_cvref_t<decltype(*std::begin(lights))>>();
    else
        return std::span<const Sphere>();
}

}  // namespace detail

/// Lights made by view_space() or world_space(): a view of the caller's array, how an element becomes a Sphere or a Spot,
/// and how that is moved to view space.
template <class Light, class ToLight> struct Lights {
    std::span<const Light> array;
    ToLight to_light;
    detail::Maybe<detail::WorldToView> to_view;

    /// Whether the lights are Spots, of which some may be whole spheres.
    static constexpr bool spots =
        std::convertible_to<std::invoke_result_t<const ToLight&, const Light&>, Spot>;

    /// Returns a light of the array as a sphere in view space.
    Sphere view_sphere(const Light& light) const {
        const Sphere sphere = detail::call(to_light, light);
        return to_view ? (*to_view)(sphere) : sphere;
    }

    /// Returns a light of the array in view space, a Spot with its axis rounded to nearest.
    auto view_light(const Light& light) const {
        if constexpr (spots) {
            const Spot spot = detail::call(to_light, light);
            if (!to_view) return spot;
            const Sphere ball = (*to_view)(Sphere{spot.x, spot.y, spot.z, spot.radius});
            const Sphere axis = to_view->direction(spot.axis_x, spot.axis_y, spot.axis_z);
            return Spot{ball.x, ball.y, ball.z, ball.radius, axis.x, axis.y, axis.z, spot.cos_half_angle};
        } else {
            return view_sphere(light);
        }
    }
};

/// Returns lights in view space (the space that the projection matrix takes). The array is read in place: it
/// must live until the Binner's call returns.
///
/// to_light  a callable that makes a Sphere, or a Spot, of an element; it is copied, and called as const
template <class Range, class ToLight = AsLight>
auto view_space(const Range& lights, const ToLight& to_light = {}) {
    const auto array = detail::checked_array(lights);
    const auto checked = detail::checked_to_light<typename decltype(array)::value_type>(to_light);
    return Lights<typename decltype(array)::value_type, std::remove_const_t<decltype(checked)>>{
        array, checked, {}};
}

/// Returns lights in world space, moved by `view_matrix` (any type that matrix.hpp lists; affine: rotation,
/// translation, scale) as they are read. The rounding of the move is in the spheres and cones: no light is missed by
/// it. A matrix that is far from a rotation and a scale bends cones out of shape: spots are moved as least spheres then.
template <class Range, class ViewMatrix, class ToLight = AsLight>
auto world_space(const Range& lights, const ViewMatrix& view_matrix, const ToLight& to_light = {}) {
    auto result = view_space(lights, to_light);
    result.to_view = detail::WorldToView(detail::to_matrix(view_matrix));
    return result;
}

namespace detail {

/// Lights passed as a plain range are view-space vec4s, Spheres or Spots.
template <class Range> auto as_lights(const Range& lights) {
    return view_space(lights);
}
template <class Light, class ToLight>
const Lights<Light, ToLight>& as_lights(const Lights<Light, ToLight>& lights) {
    return lights;
}

/// The caller's array as spheres, if its elements are Spheres, or vec4s laid out like them; else null. Read it with
/// load_sphere.
template <class Light, class ToLight> const Sphere* as_they_are(const Lights<Light, ToLight>& lights) {
    if constexpr (std::is_same_v<ToLight, AsLight> && !Lights<Light, ToLight>::spots &&
                  sizeof(Light) == sizeof(Sphere) && std::is_trivially_copyable_v<Light>) {
        if (lights.array.empty()) return nullptr;
        if constexpr (std::is_base_of_v<Sphere, Light>) {
            return lights.array.data();
        } else if constexpr (!std::convertible_to<const Light&, Sphere> && Vec4Of<Light, float>) {
            const void* const array = lights.array.data();
            const float* const numbers = static_cast<const float*>(array);
            const Light& first = lights.array.front();
            if (&first.x == numbers && &first.y == numbers + 1 && &first.z == numbers + 2 &&
                &first.w == numbers + 3)
                return static_cast<const Sphere*>(array);
        }
    }
    return nullptr;
}

}  // namespace detail
}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
