// SPDX-License-Identifier: MIT
// Stability: settled.
// Lights as the caller has them: arrays of vec4, Sphere, Spot, Box or the caller's own structs, in view space or world
// space.
#pragma once

#include <lightbin/detail/project/to_light.hpp>
#include <lightbin/detail/project/world_to_view.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// What view_space() and world_space() return: a span of the caller's array, the callable that makes a Sphere, a
/// Spot or a Box of an element, and for world_space() the transform to view space.
template <class Light, class ToLight> struct Lights {
    std::span<const Light> array;
    ToLight to_light;
    std::optional<WorldToView> to_view;

    /// Whether `to_light` makes Spheres, Spots or Boxes. The Spots may include spheres, by Spot::whole().
    static constexpr LightKind kind = kind_of<MadeBy<ToLight, Light>>;

    using Made = std::conditional_t<kind == LightKind::box, Box,
                                    std::conditional_t<kind == LightKind::spot, Spot, Sphere>>;

    /// Returns the Sphere, Spot or Box that to_light makes of an array element, in the space of the array.
    Made made(const Light& light) const { return static_cast<Made>(to_light(light)); }

    /// Writes what made() returns of the elements first..first + count - 1 of the array.
    void make(std::size_t first, std::size_t count, Made* to) const {
        for (std::size_t i = 0; i < count; ++i)
            to[i] = made(array[first + i]);
    }

    /// Returns the caller's array if its elements have the memory layout of a Sphere, Spot or Box, so that kernels can
    /// read it directly. Returns null if each element must be converted first.
    const void* as_they_are() const {
        if constexpr (std::is_same_v<ToLight, AsLight> && (std::is_same_v<Light, Spot> || std::is_same_v<Light, Box>)) {
            return array.data();
        } else if constexpr (std::is_same_v<ToLight, AsLight> && kind == LightKind::sphere &&
                             sizeof(Light) == sizeof(Sphere) && std::is_trivially_copyable_v<Light>) {
            if (array.empty()) return nullptr;
            if constexpr (std::is_base_of_v<Sphere, Light>) {
                return array.data();
            } else if constexpr (!std::convertible_to<const Light&, Sphere> && Vec4<Light>) {
                const void* const first_byte = array.data();
                const float* const numbers = static_cast<const float*>(first_byte);
                const Light& first = array.front();
                if (&first.x == numbers && &first.y == numbers + 1 && &first.z == numbers + 2 &&
                    &first.w == numbers + 3)
                    return first_byte;
            }
        }
        return nullptr;
    }
};

}  // namespace detail

/// Describes lights that are in view space, the space that the projection matrix is applied to. The array is read where
/// it is, so it must live until the Binner's call returns: a temporary array is refused by a compile error, unless it
/// is a std::span or another range that only refers to elements (std::ranges::borrowed_range).
///
/// lights    a contiguous range of any type
/// to_light  a callable that makes a Sphere, a Spot or a Box of an element. It is copied, and called as const
template <class Range, class ToLight = detail::AsLight>
auto view_space(Range&& lights, const ToLight& to_light = {}) {
    static_assert(std::is_lvalue_reference_v<Range> || std::ranges::enable_borrowed_range<std::remove_cvref_t<Range>>,
                  "lightbin: these lights are gone after the expression: give the array a name that lives on");
    const auto array = detail::checked_array(lights);
    const auto checked = detail::checked_to_light<typename decltype(array)::value_type>(to_light);
    using Lights = detail::Lights<typename decltype(array)::value_type, std::remove_const_t<decltype(checked)>>;
    return Lights{array, checked, {}};
}

/// Describes lights that are in world space. They are transformed by `view_matrix` as they are read, and enlarged by a
/// bound on the rounding error of the transform.
///
/// lights, to_light  as for view_space()
/// view_matrix       world space to view space, any type that matrix.hpp lists. Must be affine. If it is so far from a
///                   rotation and uniform scale that it would distort cones, spots become their bounding_sphere().
template <class Range, class ViewMatrix, class ToLight = detail::AsLight>
auto world_space(Range&& lights, const ViewMatrix& view_matrix, const ToLight& to_light = {}) {
    auto result = view_space(static_cast<Range&&>(lights), to_light);
    result.to_view = detail::WorldToView(detail::to_matrix(view_matrix));
    return result;
}

/// Describes lights in a large world. However far the eye is from the world's origin, no light is missed and the lists
/// are as short as at the origin: the exact place of a centre in view space is the matrix's upper left 3x3 part times
/// (centre - eye), where the difference is computed in double.
///
/// lights       as for view_space()
/// view_matrix  as for the other world_space(), but its translation is not read
/// eye          the eye in world space. Must be finite
/// to_light     makes a Placed<Sphere>, Placed<Spot> or Placed<Box> of an element. One that is farther from the eye
///              than floats reach, 3e38 units, is bad input: see Sphere
template <class Range, class ViewMatrix, class ToLight>
auto world_space(Range&& lights, const ViewMatrix& view_matrix, const WorldPoint& eye, const ToLight& to_light) {
    auto result = view_space(static_cast<Range&&>(lights), detail::FromEye<ToLight>{eye, to_light});
    result.to_view = detail::WorldToView(detail::to_matrix(view_matrix), eye);
    return result;
}

namespace detail {

/// What lights() returns: several arrays of lights, each of another kind.
template <class First, class Rest> struct JoinedLights {
    First first;
    Rest rest;
    static constexpr LightKind kind = LightKind::mixed;
};

/// Returns the Lights that a call was given. A plain range is taken for vec4s, Spheres, Spots or Boxes in view space.
template <class Range> auto as_lights(const Range& lights) {
    return view_space(lights);
}
template <class Light, class ToLight>
const Lights<Light, ToLight>& as_lights(const Lights<Light, ToLight>& lights) {
    return lights;
}
template <class First, class Rest>
const JoinedLights<First, Rest>& as_lights(const JoinedLights<First, Rest>& lights) {
    return lights;
}

/// Returns the number of lights in all arrays that a call was given.
template <class Light, class ToLight> std::size_t light_count(const Lights<Light, ToLight>& lights) {
    return lights.array.size();
}
template <class First, class Rest> std::size_t light_count(const JoinedLights<First, Rest>& lights) {
    return lights.first.array.size() + light_count(lights.rest);
}

/// Calls `visit` with each array of lights that a call was given, in the order of their ids. Empty arrays are left out,
/// unless all are empty: then `visit` is called with one of them.
template <class Light, class ToLight, class Visit>
void for_each_array(const Lights<Light, ToLight>& lights, const Visit& visit) {
    visit(lights);
}
template <class First, class Rest, class Visit>
void for_each_array(const JoinedLights<First, Rest>& lights, const Visit& visit) {
    const bool rest = light_count(lights.rest) > 0;
    if (!rest || lights.first.array.size() > 0) visit(lights.first);
    if (rest) for_each_array(lights.rest, visit);
}

/// The kind of the lights in the first of the arrays that a call was given.
template <class Given> inline constexpr LightKind first_kind = Given::kind;
template <class First, class Rest> inline constexpr LightKind first_kind<JoinedLights<First, Rest>> = First::kind;

/// Returns an argument of lights() as Lights that refer to its array. A temporary array is refused by a compile error.
template <class Range> auto lasting_lights(Range&& lights) {
    using Given = std::remove_cvref_t<decltype(as_lights(lights))>;
    if constexpr (std::is_same_v<Given, std::remove_cvref_t<Range>>)
        return Given(lights);
    else
        return view_space(static_cast<Range&&>(lights));
}

}  // namespace detail

/// Joins two or three arrays of lights of different kinds, for one call of a Binner: at most one of Spheres (or vec4s),
/// one of Spots and one of Boxes, in this order. Each array may be in a space of its own. Ids number the arrays
/// through, so the ids of Spots begin behind those of the Spheres, and in every list of a grid the Spheres come first,
/// then the Spots, then the Boxes. (With Slicing::z_bins ids are ranks, in order of depth.) Each kind costs what it
/// costs alone.
///
/// first, second  view_space(...), world_space(...), or a contiguous range of lights in view space. Arrays are read
///                where they are, so they must live until the Binner's call returns
template <class First, class Second> auto lights(First&& first, Second&& second) {
    auto one = detail::lasting_lights(static_cast<First&&>(first));
    auto other = detail::lasting_lights(static_cast<Second&&>(second));
    using One = decltype(one);
    using Other = decltype(other);
    static_assert(detail::first_kind<One> < detail::first_kind<Other>,
                  "lightbin: lights() takes Spheres, Spots and Boxes in this order, and one array of each kind");
    return detail::JoinedLights<One, Other>{one, other};
}
template <class First, class Second, class Third> auto lights(First&& first, Second&& second, Third&& third) {
    return lights(static_cast<First&&>(first), lights(static_cast<Second&&>(second), static_cast<Third&&>(third)));
}

}}  // namespace lightbin
