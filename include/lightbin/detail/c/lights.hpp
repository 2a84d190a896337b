// SPDX-License-Identifier: MIT
// The C side's lights: floats that are some bytes apart in the caller's memory.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

#include <lightbin/box.hpp>
#include <lightbin/detail/project/footprints.hpp>
#include <lightbin/spot.hpp>

namespace lightbin {
namespace c {

/// What Lights has in place of a span of the caller's array: the number of lights.
struct LightCount {
    std::size_t count;

    std::size_t size() const { return count; }
    std::size_t operator[](std::size_t i) const { return i; }
};

/// What Lights has in place of a callable that makes Spheres, Spots or Boxes: the caller's lightbin_spheres,
/// lightbin_spots or lightbin_boxes.
template <class Given> struct InPlace { const Given& from; };

/// A member of the caller's lights, with `each` floats, and the byte of a Sphere, Spot or Box that it goes to.
template <std::size_t each> struct Member {
    lightbin_floats floats;
    std::size_t offset;
};

/// Reads members of the lights first..first + count - 1 into the lights at `to`. It is one loop for all members, as
/// those of a light mostly lie side by side, in one line of the cache or two.
template <class Light, std::size_t... each>
void read_members(std::size_t first, std::size_t count, Light* to, Member<each>... members) {
    for (std::size_t i = 0; i < count; ++i) {
        char* const light = reinterpret_cast<char*>(to + i);
        (std::memcpy(light + members.offset,
                     static_cast<const char*>(members.floats.first) + (first + i) * members.floats.stride,
                     each * sizeof(float)),
         ...);
    }
}

/// Whether one float of each light lies behind three others, so that the four can be read at once.
inline bool side_by_side(const lightbin_floats& three, const lightbin_floats& one) {
    const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(three.first) + 3 * sizeof(float);
    return three.stride == one.stride && reinterpret_cast<std::uintptr_t>(one.first) == end;
}

/// Read the lights first..first + count - 1 of the caller's array.
inline void read_lights(const lightbin_spheres& from, std::size_t first, std::size_t count, Sphere* to) {
    if (side_by_side(from.centre, from.radius))
        read_members(first, count, to, Member<4>{from.centre, 0});
    else
        read_members(first, count, to, Member<3>{from.centre, 0},
                     Member<1>{from.radius, offsetof(Sphere, radius)});
}
inline void read_lights(const lightbin_spots& from, std::size_t first, std::size_t count, Spot* to) {
    if (side_by_side(from.centre, from.radius) && side_by_side(from.axis, from.cosine))
        read_members(first, count, to, Member<4>{from.centre, 0},
                     Member<4>{from.axis, offsetof(Spot, axis_x)});
    else
        read_members(first, count, to, Member<3>{from.centre, 0},
                     Member<1>{from.radius, offsetof(Spot, radius)},
                     Member<3>{from.axis, offsetof(Spot, axis_x)},
                     Member<1>{from.cosine, offsetof(Spot, cos_half_angle)});
}
inline void read_lights(const lightbin_boxes& from, std::size_t first, std::size_t count, Box* to) {
    read_members(first, count, to, Member<3>{from.box_centre, offsetof(Box, box_x)},
                 Member<9>{from.half_axes, offsetof(Box, half_axes)});
    if (from.radius.first != nullptr) {
        read_members(first, count, to, Member<3>{from.centre, 0},
                     Member<1>{from.radius, offsetof(Box, radius)});
    } else {
        read_members(first, count, to, Member<3>{from.box_centre, 0});
        for (std::size_t i = 0; i < count; ++i)
            to[i].radius = std::numeric_limits<float>::infinity();
    }
    if (from.taper.first != nullptr) {
        read_members(first, count, to, Member<1>{from.taper, offsetof(Box, taper)});
    } else {
        for (std::size_t i = 0; i < count; ++i)
            to[i].taper = 1;
    }
}

/// Whether floats lie in structs of type Light, one behind the other from `first` on, from byte `offset` of each.
template <class Light>
bool lie_at(const lightbin_floats& floats, std::size_t count, const void* first, std::size_t offset) {
    return (floats.stride == sizeof(Light) || count == 1) &&
           reinterpret_cast<std::uintptr_t>(floats.first) == reinterpret_cast<std::uintptr_t>(first) + offset;
}

/// Return whether the caller's lights have the layout of Spheres, Spots or Boxes.
inline bool have_own_layout(const lightbin_spheres& from, const void* first) {
    return lie_at<Sphere>(from.centre, from.count, first, 0) &&
           lie_at<Sphere>(from.radius, from.count, first, offsetof(Sphere, radius));
}
inline bool have_own_layout(const lightbin_spots& from, const void* first) {
    return lie_at<Spot>(from.centre, from.count, first, 0) &&
           lie_at<Spot>(from.radius, from.count, first, offsetof(Spot, radius)) &&
           lie_at<Spot>(from.axis, from.count, first, offsetof(Spot, axis_x)) &&
           lie_at<Spot>(from.cosine, from.count, first, offsetof(Spot, cos_half_angle));
}
inline bool have_own_layout(const lightbin_boxes& from, const void* first) {
    return lie_at<Box>(from.centre, from.count, first, 0) &&
           lie_at<Box>(from.radius, from.count, first, offsetof(Box, radius)) &&
           lie_at<Box>(from.box_centre, from.count, first, offsetof(Box, box_x)) &&
           lie_at<Box>(from.half_axes, from.count, first, offsetof(Box, half_axes)) &&
           lie_at<Box>(from.taper, from.count, first, offsetof(Box, taper));
}

/// Returns the caller's lights if they have the layout of Spheres, Spots or Boxes, which kernels read directly; else null.
template <class Given> const void* lights_of_own_layout(const Given& from) {
    const void* const first = from.centre.first;
    const bool aligned = reinterpret_cast<std::uintptr_t>(first) % alignof(float) == 0;
    return from.count > 0 && first != nullptr && aligned && have_own_layout(from, first) ? first : nullptr;
}

}  // namespace c

inline namespace LIGHTBIN_ABI_TAG {

template <class Given> struct Lights<c::LightCount, c::InPlace<Given>> {
    using Made = std::conditional_t<std::is_same_v<Given, lightbin_spheres>, Sphere,
                                    std::conditional_t<std::is_same_v<Given, lightbin_spots>, Spot, Box>>;

    c::LightCount array;
    c::InPlace<Given> to_light;
    const detail::WorldToView* to_view;

    static constexpr detail::LightKind kind = std::is_same_v<Made, Sphere> ? detail::LightKind::sphere
                                              : std::is_same_v<Made, Spot> ? detail::LightKind::spot
                                                                           : detail::LightKind::box;

    /// Writes the Spheres, Spots or Boxes first..first + count - 1 of the caller's array.
    void make(std::size_t first, std::size_t count, Made* to) const {
        c::read_lights(to_light.from, first, count, to);
    }

    /// Returns the Sphere, Spot or Box with an index in the caller's array.
    Made made(std::size_t i) const {
        Made light;
        make(i, 1, &light);
        return light;
    }
};

}  // namespace LIGHTBIN_ABI_TAG

namespace c {

using SphereLights = Lights<LightCount, InPlace<lightbin_spheres>>;
using SpotLights = Lights<LightCount, InPlace<lightbin_spots>>;
using BoxLights = Lights<LightCount, InPlace<lightbin_boxes>>;

}  // namespace c

inline namespace LIGHTBIN_ABI_TAG {
namespace detail {

template <> inline const void* as_they_are(const c::SphereLights& lights) {
    return c::lights_of_own_layout(lights.to_light.from);
}
template <> inline const void* as_they_are(const c::SpotLights& lights) {
    return c::lights_of_own_layout(lights.to_light.from);
}
template <> inline const void* as_they_are(const c::BoxLights& lights) {
    return c::lights_of_own_layout(lights.to_light.from);
}

}  // namespace detail
}  // namespace LIGHTBIN_ABI_TAG

namespace c {

/// Returns why the floats of lights, at least one, are refused.
inline lightbin_result check_floats(const lightbin_floats& floats, std::size_t count, std::size_t each,
                                    const char* name) {
    if (floats.first == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    if (count > 1 && floats.stride < each * sizeof(float))
        return refused(LIGHTBIN_STRIDE_TOO_SMALL, name, each * sizeof(float), floats.stride);
    return succeeded();
}

/// Whether spots and boxes are left out.
inline constexpr bool spheres_alone = !detail::kinds_have_spots && !detail::kinds_have_boxes;

/// The lights of a call.
struct CallLights {
    lightbin_lights given;
    std::optional<detail::WorldToView> to_view;

    /// Returns the kind of all lights of the call.
    detail::LightKind kind() const {
        const std::size_t spheres = given.spheres.count, spots = given.spots.count, boxes = given.boxes.count;
        if (spots + boxes == 0) return detail::LightKind::sphere;
        if (spheres + boxes == 0) return detail::LightKind::spot;
        return spheres + spots == 0 ? detail::LightKind::box : detail::LightKind::mixed;
    }

    SphereLights spheres() const { return in_place(given.spheres); }
    SpotLights spots() const { return in_place(given.spots); }
    BoxLights boxes() const { return in_place(given.boxes); }

    /// Returns the lights of all kinds that the program has, for the engine. The result refers to this object.
    auto all() const {
        if constexpr (spheres_alone)
            return spheres();
        else if constexpr (!detail::kinds_have_boxes)
            return JoinedLights<SphereLights, SpotLights>{spheres(), spots()};
        else if constexpr (!detail::kinds_have_spots)
            return JoinedLights<SphereLights, BoxLights>{spheres(), boxes()};
        else
            return JoinedLights<SphereLights, JoinedLights<SpotLights, BoxLights>>{spheres(),
                                                                                   {spots(), boxes()}};
    }

private:
    template <class Given> Lights<LightCount, InPlace<Given>> in_place(const Given& from) const {
        return {{from.count}, {from}, to_view ? &*to_view : nullptr};
    }
};

/// Reads what describes the caller's lights, but not the lights; or returns why that is refused.
inline lightbin_result read_lights(const lightbin_lights* given, CallLights& lights) {
    lightbin_result result = read(given, lights.given, "lights");
    if (result.error != LIGHTBIN_OK) return result;
    const lightbin_spheres& spheres = lights.given.spheres;
    const lightbin_spots& spots = lights.given.spots;
    const lightbin_boxes& boxes = lights.given.boxes;
    if (spheres.count > 0)
        result = first_error(check_floats(spheres.centre, spheres.count, 3, "lights.spheres.centre"),
                             check_floats(spheres.radius, spheres.count, 1, "lights.spheres.radius"));
    if (result.error == LIGHTBIN_OK && spots.count > 0)
        result = first_error(check_floats(spots.centre, spots.count, 3, "lights.spots.centre"),
                             check_floats(spots.radius, spots.count, 1, "lights.spots.radius"),
                             check_floats(spots.axis, spots.count, 3, "lights.spots.axis"),
                             check_floats(spots.cosine, spots.count, 1, "lights.spots.cosine"));
    if (result.error == LIGHTBIN_OK && boxes.count > 0) {
        const bool whole = boxes.centre.first == nullptr && boxes.radius.first == nullptr;
        result = first_error(
            whole ? result : check_floats(boxes.centre, boxes.count, 3, "lights.boxes.centre"),
            whole ? result : check_floats(boxes.radius, boxes.count, 1, "lights.boxes.radius"),
            check_floats(boxes.box_centre, boxes.count, 3, "lights.boxes.box_centre"),
            check_floats(boxes.half_axes, boxes.count, 9, "lights.boxes.half_axes"),
            boxes.taper.first == nullptr ? result
                                         : check_floats(boxes.taper, boxes.count, 1, "lights.boxes.taper"));
    }
    if (result.error != LIGHTBIN_OK) return result;
    if (!detail::kinds_have_spots && spots.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_SPOTS");
    if (!detail::kinds_have_boxes && boxes.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BOXES");
    const lightbin_matrix& view_matrix = lights.given.view_matrix;
    if (view_matrix.floats != nullptr || view_matrix.doubles != nullptr) {
        Matrix matrix;
        result = read_matrix(view_matrix, matrix, "lights.view_matrix");
        if (result.error != LIGHTBIN_OK) return result;
        lights.to_view.emplace(matrix);
    }
    // The engine adds the counts without a check for overflow.
    constexpr std::uint64_t most = 0xffffffff;
    const std::uint64_t count =
        detail::sum_of_sizes(detail::sum_of_sizes(spheres.count, spots.count), boxes.count);
    return count > most ? refused(Error{ErrorCode::too_many_lights, count, most}) : result;
}

}  // namespace c
}  // namespace lightbin
