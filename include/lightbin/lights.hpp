// SPDX-License-Identifier: MIT
// The lights as the caller has them: vec4 arrays or the caller's own structs, in view space or world space.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/project/sphere_around.hpp>
#include <lightbin/detail/project/world_to_view.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/sphere.hpp>
#include <lightbin/spot.hpp>

#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

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
    requires(std::convertible_to<const Light&, Sphere> || std::convertible_to<const Light&, Spot> ||
             detail::Vec4Of<Light, float> || detail::Vec4Of<Light, double>) constexpr auto
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

/// Whether `to_light` does not accept an element itself. Then it is called with what the element points or refers to.
template <class ToLight, class Light>
inline constexpr bool by_reference =
    std::same_as<decltype(call(std::declval<const ToLight&>(), std::declval<const Light&>())), NotCalled>;

/// Calls `to_light` with an element, or with what that refers to. Returns NotCalled where it takes neither.
template <class ToLight, class Light>
constexpr decltype(auto) make_light(const ToLight& to_light, const Light& light) {
    if constexpr (by_reference<ToLight, Light>)
        return call(to_light, referred(light));
    else
        return call(to_light, light);
}

/// Returns `to_light`, or where it can't be one, the compiler's sentence and one that can, so that no other error follows.
template <class Light, class ToLight> constexpr auto checked_to_light(const ToLight& to_light) {
    using Made = decltype(make_light(to_light, std::declval<const Light&>()));
    constexpr bool can_be_called = !std::same_as<Made, NotCalled>;
    if constexpr (std::same_as<ToLight, AsLight>)
        static_assert(
            can_be_called,
            "lightbin: this light is no Sphere or Spot and has no float or double x, y, z and w (the "
            "radius): pass view_space(lights, to_light) or world_space(lights, view_matrix, to_light), "
            "where to_light makes a lightbin::Sphere or a lightbin::Spot of a light");
    else
        static_assert(
            can_be_called,
            "lightbin: to_light is called, as const, with a const reference to one of the lights, or with "
            "what that points to, and can't be called with either");
    if constexpr (std::convertible_to<Made, Sphere> || std::convertible_to<Made, Spot>) {
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
    static constexpr bool spots = std::convertible_to<
        decltype(detail::make_light(std::declval<const ToLight&>(), std::declval<const Light&>())), Spot>;

    /// Returns the Spot or Sphere that to_light makes of an element; of a null pointer that it would be called through, one
    /// that is bad input.
    auto made(const Light& light) const {
        using Made = std::conditional_t<spots, Spot, Sphere>;
        if constexpr (detail::by_reference<ToLight, Light> && requires { !light, *light; })
            if (!light) return static_cast<Made>(Spot::whole(detail::bad_sphere));
        return static_cast<Made>(detail::make_light(to_light, light));
    }

    /// Returns a light of the array as a sphere in view space.
    Sphere view_sphere(const Light& light) const {
        const Sphere sphere = made(light);
        return to_view ? (*to_view)(sphere) : sphere;
    }

    /// Returns a light of the array in view space, a Spot with its axis rounded to nearest.
    auto view_light(const Light& light) const {
        if constexpr (spots) {
            const Spot spot = made(light);
            if (!to_view) return spot;
            const Sphere ball = (*to_view)(Sphere{spot.x, spot.y, spot.z, spot.radius});
            const Sphere axis = to_view->direction(spot.axis_x, spot.axis_y, spot.axis_z);
            return Spot{ball.x, ball.y, ball.z, ball.radius, axis.x, axis.y, axis.z, spot.cos_half_angle};
        } else {
            return view_sphere(light);
        }
    }
};

/// Lights that view_space() or world_space() made of a temporary array, such as a std::vector that a function returned,
/// which they moved in here: it lives as long as they do. (A temporary std::span is copied; the array it views is not.)
template <class Range, class ToLight> struct OwnedLights {
    Range array;
    ToLight to_light;
    detail::Maybe<detail::WorldToView> to_view;
};

/// Returns lights in view space (the space that the projection matrix takes). The array is read in place: it
/// must live until the Binner's call returns. A temporary one is moved into what is returned.
///
/// lights    a contiguous range of anything: of structs, of pointers or smart pointers to them, of std::reference_wrapper
/// to_light  a callable or a pointer to a member that makes a Sphere, or a Spot, of an element or, where it does not take
///           one, of what the element points to; it is copied, and called as const. A null pointer is bad input, as
///           described at Sphere: that light is skipped and counted. A to_light that takes pointers is given null ones, too
template <class Range, class ToLight = AsLight>
auto view_space(Range&& lights, const ToLight& to_light = {}) {
    constexpr bool temporary = !std::is_lvalue_reference_v<Range>,
                   movable = std::is_move_constructible_v<Range>;
    static_assert(!temporary || movable,
                  "lightbin: these lights are gone after the expression and can't be moved: give the array a "
                  "name that lives on");
    const auto array = detail::checked_array(lights);
    const auto checked = detail::checked_to_light<typename decltype(array)::value_type>(to_light);
    using Checked = std::remove_const_t<decltype(checked)>;
    if constexpr (temporary && movable)
        return OwnedLights<std::remove_cv_t<Range>, Checked>{static_cast<Range&&>(lights), checked, {}};
    else
        return Lights<typename decltype(array)::value_type, Checked>{array, checked, {}};
}

/// Returns lights in world space, moved by `view_matrix` (any type that matrix.hpp lists; affine: rotation,
/// translation, scale) as they are read. The rounding of the move is in the spheres and cones: no light is missed by
/// it. A matrix that is far from a rotation and a scale bends cones out of shape: spots are moved as least spheres then.
///
/// lights, to_light  as for view_space()
template <class Range, class ViewMatrix, class ToLight = AsLight>
auto world_space(Range&& lights, const ViewMatrix& view_matrix, const ToLight& to_light = {}) {
    auto result = view_space(static_cast<Range&&>(lights), to_light);
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
template <class Range, class ToLight> auto as_lights(const OwnedLights<Range, ToLight>& lights) {
    auto result = view_space(lights.array, lights.to_light);
    result.to_view = lights.to_view;
    return result;
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
}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
