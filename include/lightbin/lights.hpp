// SPDX-License-Identifier: MIT
// Lights as the caller has them: arrays of vec4, Sphere, Spot or the caller's own structs, in view or world space.
#pragma once

#include <lightbin/detail/project/to_light.hpp>
#include <lightbin/detail/project/world_to_view.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What view_space() and world_space() return: a span of the caller's array, the callable that makes a Sphere or a Spot
/// of an element, and for world_space() the transform to view space.
template <class Light, class ToLight> struct Lights {
    std::span<const Light> array;
    ToLight to_light;
    std::optional<detail::WorldToView> to_view;

    /// True if `to_light` makes Spots, false if it makes Spheres. The Spots may include spheres, by Spot::whole().
    static constexpr bool spots = std::convertible_to<
        decltype(detail::make_light(std::declval<const ToLight&>(), std::declval<const Light&>())), Spot>;

    /// Returns the Spot or Sphere that to_light makes of an array element, in the space of the array. A null pointer
    /// gives bad input, unless to_light itself takes pointers.
    auto made(const Light& light) const {
        using Made = std::conditional_t<spots, Spot, Sphere>;
        if constexpr (detail::by_reference<ToLight, Light> && requires { !light, *light; })
            if (!light) return static_cast<Made>(Spot::whole(detail::bad_sphere));
        return static_cast<Made>(detail::make_light(to_light, light));
    }

    /// Returns the sphere, in view space, of an array element.
    Sphere view_sphere(const Light& light) const {
        const Sphere sphere = made(light);
        return to_view ? (*to_view)(sphere) : sphere;
    }

    /// Returns an array element's Sphere or Spot in view space. A Spot's axis is rounded to nearest, not outward.
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

/// What view_space() and world_space() return for a temporary array, such as a std::vector that a function returned.
/// The array was moved into `array`. (Of a temporary std::span only the span is copied.)
template <class Range, class ToLight> struct OwnedLights {
    Range array;
    ToLight to_light;
    std::optional<detail::WorldToView> to_view;
};

/// Describes lights that are in view space, the space that the projection matrix is applied to. The array is read where
/// it is, so it must live until the Binner's call returns. A temporary array is moved into the returned object.
///
/// lights    a contiguous range of any type: structs, pointers or smart pointers to them, std::reference_wrapper
/// to_light  a callable or a pointer to a member that makes a Sphere or a Spot of an element. If it does not take an
///           element itself, it is called with the object that the element points to, and a null pointer is bad input.
///           A to_light that takes pointers is called with null pointers, too. It is copied, and called as const.
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

/// Describes lights that are in world space. They are transformed by `view_matrix` as they are read, and enlarged by a
/// bound on the rounding error of the transform.
///
/// lights, to_light  as for view_space()
/// view_matrix       world space to view space, any type that matrix.hpp lists. Must be affine. If it is so far from a
///                   rotation and uniform scale that it would distort cones, spots become their least_sphere().
template <class Range, class ViewMatrix, class ToLight = AsLight>
auto world_space(Range&& lights, const ViewMatrix& view_matrix, const ToLight& to_light = {}) {
    auto result = view_space(static_cast<Range&&>(lights), to_light);
    result.to_view = detail::WorldToView(detail::to_matrix(view_matrix));
    return result;
}

namespace detail {

/// Returns the Lights that a call was given. A plain range is taken for vec4s, Spheres or Spots in view space.
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

/// Returns a pointer to the caller's array if its elements are Spheres or float vec4s of the same layout, so that
/// kernels can read the array directly, by load_sphere(); else null.
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
