// SPDX-License-Identifier: MIT
// The C side's lights: floats that are some bytes apart in the caller's memory.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

#include <lightbin/box.hpp>
#include <lightbin/detail/stages/footprints.hpp>
#include <lightbin/spot.hpp>

#include <iterator>
#include <utility>

namespace lightbin {
namespace c {

/// The radius and the taper of boxes that are given without: single floats that all boxes of a call share.
inline constexpr float unbounded = std::numeric_limits<float>::infinity(), untapered = 1;

/// Describes one property of a light, such as its centre: the member of the C struct that says where the caller's
/// floats are, the number of floats of each light, and the byte of a C++ Sphere, Spot or Box from which on they are
/// stored.
template <class Given> struct Member {
    lightbin_floats Given::*floats;
    std::size_t each, offset;
    const char* name;
    bool is_point = false;  ///< a centre, of which the caller has doubles if there is an eye
};

/// Describes a kind of lights, lightbin_spheres, lightbin_spots or lightbin_boxes: the C++ struct that each light is
/// copied to, and the members on both sides.
template <class Given> struct Kind;
template <> struct Kind<lightbin_spheres> {
    using Made = Sphere;
    static constexpr detail::LightKind kind = detail::LightKind::sphere;
    static constexpr Member<lightbin_spheres> members[] = {
        {&lightbin_spheres::centre, 3, offsetof(Sphere, x), "lights.spheres.centre", true},
        {&lightbin_spheres::radius, 1, offsetof(Sphere, radius), "lights.spheres.radius"}};
};
template <> struct Kind<lightbin_spots> {
    using Made = Spot;
    static constexpr detail::LightKind kind = detail::LightKind::spot;
    static constexpr Member<lightbin_spots> members[] = {
        {&lightbin_spots::centre, 3, offsetof(Spot, x), "lights.spots.centre", true},
        {&lightbin_spots::radius, 1, offsetof(Spot, radius), "lights.spots.radius"},
        {&lightbin_spots::axis, 3, offsetof(Spot, axis_x), "lights.spots.axis"},
        {&lightbin_spots::cosine, 1, offsetof(Spot, cos_half_angle), "lights.spots.cosine"}};
};
template <> struct Kind<lightbin_boxes> {
    using Made = Box;
    static constexpr detail::LightKind kind = detail::LightKind::box;
    static constexpr Member<lightbin_boxes> members[] = {
        {&lightbin_boxes::box_centre, 3, offsetof(Box, box_x), "lights.boxes.box_centre", true},
        {&lightbin_boxes::half_axes, 9, offsetof(Box, half_axes), "lights.boxes.half_axes"},
        {&lightbin_boxes::taper, 1, offsetof(Box, taper), "lights.boxes.taper"},
        {&lightbin_boxes::centre, 3, offsetof(Box, x), "lights.boxes.centre", true},
        {&lightbin_boxes::radius, 1, offsetof(Box, radius), "lights.boxes.radius"}};
};

/// Calls body.operator()<m>(floats) for each member of a kind of lights, where Kind<Given>::members[m] is the member
/// and `floats` says where the caller has it.
template <class Given, class Body> LIGHTBIN_INLINE void for_each_member(const Given& from, const Body& body) {
    [&]<std::size_t... m>(std::index_sequence<m...>) {
        (body.template operator()<m>(from.*Kind<Given>::members[m].floats), ...);
    }
    (std::make_index_sequence<std::size(Kind<Given>::members)>());
}

inline std::uintptr_t address_of(const void* pointer) {
    return reinterpret_cast<std::uintptr_t>(pointer);
}

}  // namespace c

inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The caller's lightbin_spheres, lightbin_spots or lightbin_boxes, as the engine reads lights.
template <class Given> struct Lights<Given, c::Kind<Given>> {
    using Made = typename c::Kind<Given>::Made;
    static constexpr LightKind kind = c::Kind<Given>::kind;

    /// Stands for the caller's array, which other Lights have as a span, where only the number of lights is asked for.
    struct Count {
        std::size_t count;
        std::size_t size() const { return count; }
    };
    Count array;
    const Given& from;
    const WorldToView* to_view;
    const double* eye;  ///< null, or three doubles

    /// Writes the Spheres, Spots or Boxes first..first + count - 1 of the caller's array. All floats of a light are
    /// copied before those of the next light, as they mostly lie side by side in memory.
    void make(std::size_t first, std::size_t count, Made* to) const {
        const Given arrays = from;  // a local copy, so that compilers need not reload it after each store
        for (std::size_t i = 0; i < count; ++i)
            c::for_each_member(arrays, [&]<std::size_t m>(const lightbin_floats& floats) {
                constexpr const c::Member<Given>& member = c::Kind<Given>::members[m];
                std::memcpy(reinterpret_cast<char*>(to + i) + member.offset,
                            static_cast<const char*>(floats.first) + (first + i) * floats.stride,
                            member.each * sizeof(float));
            });
        if (eye == nullptr) return;
        for (std::size_t i = 0; i < count; ++i)
            c::for_each_member(arrays, [&]<std::size_t m>(const lightbin_floats& doubles) {
                constexpr const c::Member<Given>& member = c::Kind<Given>::members[m];
                if constexpr (member.is_point) {
                    WorldPoint origin;
                    std::memcpy(&origin, static_cast<const char*>(doubles.first) + (first + i) * doubles.stride,
                                sizeof origin);
                    float* const centre = &to[i].x + member.offset / sizeof(float);
                    centre[0] = centre[1] = centre[2] = 0;
                    move_from_eye(origin, {eye[0], eye[1], eye[2]}, centre[0], centre[1], centre[2]);
                }
            });
    }

    /// Returns the caller's lights if they lie in memory as Spheres, Spots or Boxes do, so that kernels can read them
    /// directly; else null.
    const void* as_they_are() const {
        const void* const first = from.centre.first;
        bool same = eye == nullptr && from.count > 0 && first != nullptr && c::address_of(first) % alignof(float) == 0;
        c::for_each_member(from, [&]<std::size_t m>(const lightbin_floats& floats) {
            same = same && (floats.stride == sizeof(Made) || from.count == 1) &&
                   c::address_of(floats.first) == c::address_of(first) + c::Kind<Given>::members[m].offset;
        });
        return same ? first : nullptr;
    }
};

}}  // namespace detail

namespace c {

/// Returns why the floats of a kind of lights are refused.
template <class Given> lightbin_result check_lights(const Given& lights, const double* eye) {
    lightbin_result result = succeeded();
    for_each_member(lights, [&]<std::size_t m>(const lightbin_floats& floats) {
        constexpr const Member<Given>& member = Kind<Given>::members[m];
        if (result.error != LIGHTBIN_OK || floats.first == &unbounded || floats.first == &untapered) return;
        const std::size_t bytes = member.each * (member.is_point && eye != nullptr ? sizeof(double) : sizeof(float));
        if (floats.first == nullptr)
            result = refused(LIGHTBIN_NULL_ARGUMENT, member.name);
        else if (lights.count > 1 && floats.stride < bytes)
            result = refused(LIGHTBIN_STRIDE_TOO_SMALL, member.name, bytes, floats.stride);
    });
    return lights.count > 0 ? result : succeeded();
}

/// Whether the library is compiled for spheres alone, by LIGHTBIN_NO_SPOTS and LIGHTBIN_NO_BOXES.
inline constexpr bool spheres_alone = !detail::kinds_have_spots && !detail::kinds_have_boxes;

/// The lights that a caller gave to a function, and the transform to view space if they are in world space.
struct CallLights {
    lightbin_lights given;
    std::optional<detail::WorldToView> to_view;

    /// Returns the lights of all kinds that the program has, for the engine. The result refers to this object.
    auto all() const {
        const auto of = [this]<class Given>(const Given& from) {
            return detail::Lights<Given, Kind<Given>>{{from.count}, from, to_view ? &*to_view : nullptr, given.eye};
        };
        const auto spheres = of(given.spheres);
        if constexpr (spheres_alone)
            return spheres;
        else if constexpr (!detail::kinds_have_boxes)
            return lightbin::lights(spheres, of(given.spots));
        else if constexpr (!detail::kinds_have_spots)
            return lightbin::lights(spheres, of(given.boxes));
        else
            return lightbin::lights(spheres, of(given.spots), of(given.boxes));
    }
};

/// Reads what describes the caller's lights, but not the lights; or returns why that is refused.
inline lightbin_result read_lights(const lightbin_lights* from, CallLights& lights) {
    lightbin_lights& given = lights.given;
    lightbin_result result = read(from, given, "lights");
    if (result.error != LIGHTBIN_OK) return result;
    lightbin_boxes& boxes = given.boxes;
    if (boxes.centre.first == nullptr && boxes.radius.first == nullptr) {
        boxes.centre = boxes.box_centre;
        boxes.radius = {&unbounded, 0};
    }
    if (boxes.taper.first == nullptr) boxes.taper = {&untapered, 0};
    result = first_error(check_lights(given.spheres, given.eye), check_lights(given.spots, given.eye),
                         check_lights(boxes, given.eye));
    if (result.error != LIGHTBIN_OK) return result;
    if (!detail::kinds_have_spots && given.spots.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_SPOTS");
    if (!detail::kinds_have_boxes && boxes.count > 0) return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_BOXES");
    if (given.view_matrix.floats != nullptr || given.view_matrix.doubles != nullptr) {
        Matrix matrix;
        result = read_member(given.view_matrix, matrix, "lights.view_matrix");
        if (result.error != LIGHTBIN_OK) return result;
        if (given.eye != nullptr)
            lights.to_view.emplace(matrix, WorldPoint{given.eye[0], given.eye[1], given.eye[2]});
        else
            lights.to_view.emplace(matrix);
    } else if (given.eye != nullptr) {
        return refused(LIGHTBIN_NULL_ARGUMENT, "lights.view_matrix");
    }
    // The binner adds the numbers of lights of all kinds without a check for overflow.
    constexpr std::uint64_t most = 0xffffffff;
    const std::uint64_t count =
        detail::sum_of_sizes(detail::sum_of_sizes(given.spheres.count, given.spots.count), boxes.count);
    return count > most ? refused(Error{ErrorCode::too_many_lights, count, most}) : result;
}

}  // namespace c
}  // namespace lightbin
