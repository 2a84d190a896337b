// SPDX-License-Identifier: MIT
// Turns the elements of the caller's array into Spheres, Spots or Boxes.
#pragma once

#include <lightbin/detail/project/light_kind.hpp>
#include <lightbin/detail/project/sphere_around.hpp>

#include <concepts>
#include <span>
#include <utility>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// A struct with members x, y, z and w of the given number type.
template <class Light, class Number>
concept Vec4Of = requires(const Light& light) {
    requires std::same_as<std::remove_cvref_t<decltype(light.x)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.y)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.z)>, Number>;
    requires std::same_as<std::remove_cvref_t<decltype(light.w)>, Number>;
};

}  // namespace detail

/// The default way to make a light of an element: what converts to Box, Spot or Sphere is converted, and a vec4 of floats,
/// or of doubles rounded outward, becomes the Sphere with centre (x, y, z) and radius w.
struct AsLight {
    template <class Light>
    requires(std::convertible_to<const Light&, Sphere> || std::convertible_to<const Light&, Spot> ||
             std::convertible_to<const Light&, Box> || detail::Vec4Of<Light, float> ||
             detail::Vec4Of<Light, double>)
    constexpr auto operator()(const Light& light) const {
        if constexpr (std::convertible_to<const Light&, Box>)
            return static_cast<Box>(light);
        else if constexpr (std::convertible_to<const Light&, Spot>)
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

struct NotCalled {};

/// Calls a function, a function object or a pointer to a member with a light. Returns NotCalled if it cannot be called.
template <class Callable, class Light> constexpr decltype(auto) call(const Callable& callable, Light& light) {
    if constexpr (requires { callable(light); })
        return callable(light);
    else if constexpr (requires { (light.*callable)(); })
        return (light.*callable)();
    else if constexpr (std::is_member_object_pointer_v<Callable> && requires { light.*callable; })
        return (light.*callable);
    else
        return NotCalled();
}

/// Returns the object that a pointer, smart pointer or std::reference_wrapper refers to, or else the argument itself.
template <class Light> constexpr auto& referred(Light& light) {
    if constexpr (requires { requires std::is_lvalue_reference_v<decltype(*light)>; })
        return *light;
    else if constexpr (requires { requires std::is_same_v<decltype(light.get()), typename Light::type&>; })
        return light.get();
    else
        return light;
}

/// Whether `to_light` can only be called with the object that an array element of type Light points or refers to.
template <class ToLight, class Light>
inline constexpr bool by_reference =
    std::same_as<decltype(call(std::declval<const ToLight&>(), std::declval<const Light&>())), NotCalled>;

/// Calls `to_light` with an array element, or with the object that the element refers to. Returns NotCalled if
/// `to_light` accepts neither.
template <class ToLight, class Light>
constexpr decltype(auto) make_light(const ToLight& to_light, const Light& light) {
    if constexpr (by_reference<ToLight, Light>)
        return call(to_light, referred(light));
    else
        return call(to_light, light);
}

/// The kind of light that objects of type Made are converted to.
template <class Made>
inline constexpr LightKind kind_of = std::convertible_to<Made, Box>    ? LightKind::box
                                     : std::convertible_to<Made, Spot> ? LightKind::spot
                                                                       : LightKind::sphere;

/// Returns `to_light`. If it cannot make lights of type Light, that is a compile error, and a stand-in is returned so
/// that no further errors follow.
template <class Light, class ToLight> constexpr auto checked_to_light(const ToLight& to_light) {
    using Made = decltype(make_light(to_light, std::declval<const Light&>()));
    constexpr bool can_be_called = !std::same_as<Made, NotCalled>;
    if constexpr (std::same_as<ToLight, AsLight>)
        static_assert(
            can_be_called,
            "lightbin: this light is no Sphere, Spot or Box and has no float or double x, y, z and w (the "
            "radius): pass view_space(lights, to_light) or world_space(lights, view_matrix, to_light), "
            "where to_light makes a lightbin::Sphere, a lightbin::Spot or a lightbin::Box of a light");
    else
        static_assert(
            can_be_called,
            "lightbin: to_light is called, as const, with a const reference to one of the lights, or with "
            "what that points to, and can't be called with either");
    if constexpr (std::convertible_to<Made, Sphere> || std::convertible_to<Made, Spot> ||
                  std::convertible_to<Made, Box>) {
        static_assert(kernels_included<kind_of<Made>>,
                      "lightbin: to bin Spots include <lightbin/spot.hpp>, and to bin Boxes <lightbin/box.hpp>");
        return to_light;
    } else {
        static_assert(!can_be_called,
                      "lightbin: to_light must return a lightbin::Sphere, a lightbin::Spot or a lightbin::Box");
        return [](const Light&) { return Sphere(); };
    }
}

/// Returns a span of the caller's array; after the compile error for a range that is not contiguous, an empty one.
template <class Range> auto checked_array(const Range& lights) {
    constexpr bool contiguous = requires { std::span(std::data(lights), std::size(lights)); };
    static_assert(
        contiguous,
        "lightbin: lights are an array, a std::vector, a std::span or another range whose elements lie one "
        "after another, with data() and size()");
    if constexpr (contiguous)
        return std::span<const std::remove_cvref_t<decltype(*std::data(lights))>>(std::data(lights),
                                                                                  std::size(lights));
    else if constexpr (requires { *std::begin(lights); })
        return std::span<const std::remove_cvref_t<decltype(*std::begin(lights))>>();
    else
        return std::span<const Sphere>();
}

}  // namespace detail
}}  // namespace lightbin
