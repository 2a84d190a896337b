// SPDX-License-Identifier: MIT
// The lights as the caller has them: vec4 arrays or the caller's own structs, in view space or world space.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/world_to_view.hpp>
#include <lightbin/sphere.hpp>

#include <functional>
#include <optional>
#include <ranges>
#include <span>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Lights made by view_space() or world_space(): a view of the caller's array, how an element becomes a sphere, and how
/// that is moved to view space.
template <class Light, class ToSphere> struct Lights {
    std::span<const Light> array;
    ToSphere to_sphere;
    std::optional<detail::WorldToView> to_view;

    /// Returns a light of the array as a sphere in view space.
    Sphere view_sphere(const Light& light) const {
        const Sphere sphere = std::invoke(to_sphere, light);
        return to_view ? (*to_view)(sphere) : sphere;
    }
};

/// Returns lights in view space (the space that the projection matrix takes). The array is read in place: it
/// must live until the Binner's call returns.
///
/// to_sphere  a callable that makes a Sphere of an element; it is copied, and called as const
template <std::ranges::contiguous_range Range, class ToSphere = AsSphere>
auto view_space(const Range& lights, ToSphere to_sphere = {}) {
    using Light = std::ranges::range_value_t<const Range>;
    return Lights<Light, ToSphere>{
        std::span<const Light>(std::ranges::data(lights), std::ranges::size(lights)), to_sphere, {}};
}

/// Returns lights in world space, moved by `view_matrix` (view_matrix[column][row], affine: rotation,
/// translation, scale) as they are read. The rounding of the move is in the spheres: no light is missed by
/// it.
template <std::ranges::contiguous_range Range, class Matrix, class ToSphere = AsSphere>
auto world_space(const Range& lights, const Matrix& view_matrix, ToSphere to_sphere = {}) {
    auto result = view_space(lights, to_sphere);
    result.to_view.emplace(view_matrix);
    return result;
}

namespace detail {

/// Lights passed as a plain range are view-space vec4s or Spheres.
template <class Range> auto as_lights(const Range& lights) {
    return view_space(lights);
}
template <class Light, class ToSphere>
const Lights<Light, ToSphere>& as_lights(const Lights<Light, ToSphere>& lights) {
    return lights;
}

/// The caller's array as spheres, if its elements are Spheres, or vec4s laid out like them; else null. Read it with
/// load_sphere.
template <class Light, class ToSphere> const Sphere* as_they_are(const Lights<Light, ToSphere>& lights) {
    if constexpr (std::is_same_v<ToSphere, AsSphere> && sizeof(Light) == sizeof(Sphere) &&
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

}  // namespace detail
}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
