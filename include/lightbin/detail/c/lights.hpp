// SPDX-License-Identifier: MIT
// The C side's lights: floats that are some bytes apart in the caller's memory.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

#include <lightbin/detail/project/footprints.hpp>

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
template <class Given> struct InPlace { Given from; };

/// Reads `count` floats of light i.
template <std::size_t count> void read_floats(const lightbin_floats& floats, std::size_t i, float* to) {
    std::memcpy(to, static_cast<const char*>(floats.first) + i * floats.stride, count * sizeof(float));
}

/// Whether one float follows three floats in each of the caller's structs, so that the four can be read at once.
inline bool adjacent(const lightbin_floats& three, const lightbin_floats& one) {
    return three.stride == one.stride && reinterpret_cast<std::uintptr_t>(three.first) + 3 * sizeof(float) ==
                                             reinterpret_cast<std::uintptr_t>(one.first);
}

/// Writes three floats and one of each of the lights first..first + count - 1 to `to`.
inline void read_fours(const lightbin_floats& three, const lightbin_floats& one, std::size_t first,
                       std::size_t count, Sphere* to) {
    if (adjacent(three, one)) {
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(to + i, static_cast<const char*>(three.first) + (first + i) * three.stride,
                        sizeof *to);
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            float position[3], last = 0;
            read_floats<3>(three, first + i, position);
            read_floats<1>(one, first + i, &last);
            to[i] = {position[0], position[1], position[2], last};
        }
    }
}

/// Return light i of the caller's array.
inline Sphere read_light(const lightbin_spheres& from, std::size_t i) {
    Sphere sphere;
    read_fours(from.centre, from.radius, i, 1, &sphere);
    return sphere;
}
inline Spot read_light(const lightbin_spots& from, std::size_t i) {
    Sphere ball, cone;
    read_fours(from.centre, from.radius, i, 1, &ball);
    read_fours(from.axis, from.cosine, i, 1, &cone);
    return {ball.x, ball.y, ball.z, ball.radius, cone.x, cone.y, cone.z, cone.radius};
}
inline Box read_light(const lightbin_boxes& from, std::size_t i) {
    float centre[3], middle[3], radius = std::numeric_limits<float>::infinity(), taper = 1, half_axes[9];
    read_floats<3>(from.box_centre, i, middle);
    read_floats<9>(from.half_axes, i, half_axes);
    read_floats<3>(from.centre.first != nullptr ? from.centre : from.box_centre, i, centre);
    if (from.radius.first != nullptr) read_floats<1>(from.radius, i, &radius);
    if (from.taper.first != nullptr) read_floats<1>(from.taper, i, &taper);
    Box box = {centre[0], centre[1], centre[2], radius, middle[0], middle[1], middle[2], {}, taper};
    std::memcpy(box.half_axes, half_axes, sizeof half_axes);
    return box;
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
    c::LightCount array;
    c::InPlace<Given> to_light;
    std::optional<detail::WorldToView> to_view;

    static constexpr detail::LightKind kind =
        std::is_same_v<Given, lightbin_spheres> ? detail::LightKind::sphere
        : std::is_same_v<Given, lightbin_spots> ? detail::LightKind::spot
                                                : detail::LightKind::box;

    /// Returns the Sphere, Spot or Box with an index in the caller's array.
    auto made(std::size_t i) const { return c::read_light(to_light.from, i); }

    /// Returns a sphere, in view space, that contains the light with an index in the caller's array.
    Sphere view_sphere(std::size_t i) const {
        const Sphere sphere = c::read_light(to_light.from, i);
        return to_view ? (*to_view)(sphere) : sphere;
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

/// Returns why the floats of lights are refused.
inline lightbin_result check_floats(const lightbin_floats& floats, std::size_t count, std::size_t each,
                                    const char* name) {
    if (count > 0 && floats.first == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    if (count > 1 && floats.stride < each * sizeof(float))
        return refused(LIGHTBIN_STRIDE_TOO_SMALL, name, each * sizeof(float), floats.stride);
    return succeeded();
}

/// The lights of a call.
struct CallLights {
    SphereLights spheres;
    SpotLights spots;
    BoxLights boxes;

    /// Returns the kind of all lights of the call.
    detail::LightKind kind() const {
        const std::size_t balls = spheres.array.count, cones = spots.array.count, rooms = boxes.array.count;
        if (cones + rooms == 0) return detail::LightKind::sphere;
        if (balls + rooms == 0) return detail::LightKind::spot;
        return balls + cones == 0 ? detail::LightKind::box : detail::LightKind::mixed;
    }

    /// Returns the lights of all kinds that the program has, for the engine. The result refers to this object.
#if defined(LIGHTBIN_NO_SPOTS) && defined(LIGHTBIN_NO_BOXES)
    const SphereLights& all() const {
        return spheres;
    }
#elif defined(LIGHTBIN_NO_BOXES)
    JoinedLights<const SphereLights&, const SpotLights&> all() const {
        return {spheres, spots};
    }
#elif defined(LIGHTBIN_NO_SPOTS)
    JoinedLights<const SphereLights&, const BoxLights&> all() const {
        return {spheres, boxes};
    }
#else
    JoinedLights<const SphereLights&, JoinedLights<const SpotLights&, const BoxLights&>> all() const {
        return {spheres, {spots, boxes}};
    }
#endif

    /// Whether memory of the caller overlaps that of the lights.
    bool overlaps(const Bytes& memory) const {
        const auto meets = [&](const lightbin_floats& floats, std::size_t count, std::size_t each) {
            if (count == 0 || floats.first == nullptr) return false;
            const std::uint64_t before_last = detail::product_of_sizes(count - 1, floats.stride);
            return overlap(memory, {floats.first, detail::sum_of_sizes(before_last, each * sizeof(float))});
        };
        const lightbin_spheres& balls = spheres.to_light.from;
        const lightbin_spots& cones = spots.to_light.from;
        const lightbin_boxes& rooms = boxes.to_light.from;
        return meets(balls.centre, balls.count, 3) || meets(balls.radius, balls.count, 1) ||
               meets(cones.centre, cones.count, 3) || meets(cones.radius, cones.count, 1) ||
               meets(cones.axis, cones.count, 3) || meets(cones.cosine, cones.count, 1) ||
               meets(rooms.centre, rooms.count, 3) || meets(rooms.radius, rooms.count, 1) ||
               meets(rooms.box_centre, rooms.count, 3) || meets(rooms.half_axes, rooms.count, 9) ||
               meets(rooms.taper, rooms.count, 1);
    }
};

/// Reads what describes the caller's lights, but not the lights; or returns why that is refused.
inline lightbin_result read_lights(const lightbin_lights* given, CallLights& lights) {
    lightbin_lights known;
    lightbin_result result = read(given, known, "lights");
    if (result.error != LIGHTBIN_OK) return result;
    const lightbin_spheres& spheres = known.spheres;
    const lightbin_spots& spots = known.spots;
    const lightbin_boxes& boxes = known.boxes;
    const bool whole = boxes.centre.first == nullptr && boxes.radius.first == nullptr;
    result = first_error(
        check_floats(spheres.centre, spheres.count, 3, "lights.spheres.centre"),
        check_floats(spheres.radius, spheres.count, 1, "lights.spheres.radius"),
        check_floats(spots.centre, spots.count, 3, "lights.spots.centre"),
        check_floats(spots.radius, spots.count, 1, "lights.spots.radius"),
        check_floats(spots.axis, spots.count, 3, "lights.spots.axis"),
        check_floats(spots.cosine, spots.count, 1, "lights.spots.cosine"),
        check_floats(boxes.centre, whole ? 0 : boxes.count, 3, "lights.boxes.centre"),
        check_floats(boxes.radius, whole ? 0 : boxes.count, 1, "lights.boxes.radius"),
        check_floats(boxes.box_centre, boxes.count, 3, "lights.boxes.box_centre"),
        check_floats(boxes.half_axes, boxes.count, 9, "lights.boxes.half_axes"),
        check_floats(boxes.taper, boxes.taper.first != nullptr ? boxes.count : 0, 1, "lights.boxes.taper"));
    if (result.error != LIGHTBIN_OK) return result;
#if defined(LIGHTBIN_NO_SPOTS)
    if (spots.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_SPOTS");
#endif
#if defined(LIGHTBIN_NO_BOXES)
    if (boxes.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BOXES");
#endif
    std::optional<detail::WorldToView> to_view;
    if (known.view_matrix.floats != nullptr || known.view_matrix.doubles != nullptr) {
        Matrix matrix;
        result = read_matrix(known.view_matrix, matrix, "lights.view_matrix");
        if (result.error != LIGHTBIN_OK) return result;
        to_view = detail::WorldToView(matrix);
    }
    // The engine adds the counts without a check for overflow.
    constexpr std::uint64_t most = 0xffffffff;
    const std::uint64_t count =
        detail::sum_of_sizes(detail::sum_of_sizes(spheres.count, spots.count), boxes.count);
    if (count > most) return refused(Error{ErrorCode::too_many_lights, count, most});
    lights = {{{spheres.count}, {spheres}, to_view},
              {{spots.count}, {spots}, to_view},
              {{boxes.count}, {boxes}, to_view}};
    return result;
}

}  // namespace c
}  // namespace lightbin
