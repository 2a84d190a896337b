// SPDX-License-Identifier: MIT
// Turns the elements of the caller's array into Spheres, Spots or Boxes.
#pragma once

#include <lightbin/detail/project/light_kind.hpp>
#include <lightbin/sphere.hpp>

#include <concepts>
#include <span>
#include <utility>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// A struct with members x, y, z and w that are floats.
template <class Light>
concept Vec4 = requires(const Light& light) {
    requires std::same_as<std::remove_cvref_t<decltype(light.x)>, float>;
    requires std::same_as<std::remove_cvref_t<decltype(light.y)>, float>;
    requires std::same_as<std::remove_cvref_t<decltype(light.z)>, float>;
    requires std::same_as<std::remove_cvref_t<decltype(light.w)>, float>;
};

/// The default way to make a light of an element: what converts to Box, Spot or Sphere is converted, and a vec4 becomes
/// the Sphere with centre (x, y, z) and radius w.
struct AsLight {
    template <class Light>
    requires(std::convertible_to<const Light&, Sphere> || std::convertible_to<const Light&, Spot> ||
             std::convertible_to<const Light&, Box> || Vec4<Light>)
    constexpr auto operator()(const Light& light) const {
        if constexpr (std::convertible_to<const Light&, Box>)
            return static_cast<Box>(light);
        else if constexpr (std::convertible_to<const Light&, Spot>)
            return static_cast<Spot>(light);
        else if constexpr (std::convertible_to<const Light&, Sphere>)
            return static_cast<Sphere>(light);
        else
            return Sphere{light.x, light.y, light.z, light.w};
    }
};

/// Adds  origin - eye  to a float coordinate. The result is less than 2^-24 (1 + 2^-20) of itself off the exact sum, as
/// the difference is kept with its rounding error, `rest` (Knuth, The Art of Computer Programming 2, 4.2.2). It is
/// +inf, which is bad input, for a NaN, and where the sum is beyond the range of floats.
inline void move_from_eye(double origin, double eye, float& coordinate) {
    const double difference = origin - eye, moved = difference - origin;
    const double rest = (origin - (difference - moved)) - (eye + moved);
    const double sum = difference + static_cast<double>(coordinate) + rest;
    coordinate = abs_of(sum) < 0x1.ffffffp127 ? static_cast<float>(sum) : infinity;  // below, FLT_MAX is the nearest
}
inline void move_from_eye(const WorldPoint& origin, const WorldPoint& eye, float& x, float& y, float& z) {
    move_from_eye(origin.x, eye.x, x);
    move_from_eye(origin.y, eye.y, y);
    move_from_eye(origin.z, eye.z, z);
}

/// Makes lights whose centres are relative to the eye, from the Placed ones that `to_light` makes.
template <class ToLight> struct FromEye {
    WorldPoint eye;
    ToLight to_light;

    template <class Element> auto operator()(const Element& element) const -> decltype(to_light(element).light) {
        auto [origin, light] = to_light(element);
        move_from_eye(origin, eye, light.x, light.y, light.z);
        if constexpr (std::convertible_to<decltype(light), Box>)
            move_from_eye(origin, eye, light.box_x, light.box_y, light.box_z);
        return light;
    }
};

/// What `to_light`, as const, returns for an array element.
template <class ToLight, class Light>
using MadeBy = decltype(std::declval<const ToLight&>()(std::declval<const Light&>()));

/// The kind of light that objects of type Made are converted to.
template <class Made>
inline constexpr LightKind kind_of = std::convertible_to<Made, Box>    ? LightKind::box
                                     : std::convertible_to<Made, Spot> ? LightKind::spot
                                                                       : LightKind::sphere;

/// Returns `to_light`. If it cannot make lights of type Light, that is a compile error, and a stand-in is returned so
/// that no further errors follow.
template <class Light, class ToLight> constexpr auto checked_to_light(const ToLight& to_light) {
    constexpr bool can_be_called = requires { typename MadeBy<ToLight, Light>; };
    if constexpr (std::same_as<ToLight, AsLight>)
        static_assert(
            can_be_called,
            "lightbin: this light is no Sphere, Spot or Box and has no float x, y, z and w (the radius): pass "
            "view_space(lights, to_light) or world_space(lights, view_matrix, to_light), where to_light makes a "
            "lightbin::Sphere, a lightbin::Spot or a lightbin::Box of a light");
    else
        static_assert(can_be_called, "lightbin: to_light is called, as const, with a const reference to one of the "
                                     "lights, and can't be called so (with an eye, it must return a Placed light)");
    constexpr auto stand_in = [](const Light&) { return Sphere(); };
    if constexpr (can_be_called) {
        using Made = MadeBy<ToLight, Light>;
        constexpr bool is_light =
            std::convertible_to<Made, Sphere> || std::convertible_to<Made, Spot> || std::convertible_to<Made, Box>;
        static_assert(is_light,
                      "lightbin: to_light must return a lightbin::Sphere, a lightbin::Spot or a lightbin::Box");
        if constexpr (is_light) {
            static_assert(kernels_included<kind_of<Made>>,
                          "lightbin: to bin Spots include <lightbin/spot.hpp>, and to bin Boxes <lightbin/box.hpp>");
            return to_light;
        } else {
            return stand_in;
        }
    } else {
        return stand_in;
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

}}}  // namespace lightbin::detail
