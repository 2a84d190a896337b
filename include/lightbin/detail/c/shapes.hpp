// SPDX-License-Identifier: MIT
// The C side's functions that make lights of shapes: spheres around them, and boxes.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

#include <lightbin/box.hpp>
#include <lightbin/spot.hpp>

namespace lightbin {
namespace c {

// The structs of both sides have the same members in the same order.
static_assert(offsetof(lightbin_box, half_axes) == offsetof(Box, half_axes) &&
              offsetof(lightbin_box, taper) == offsetof(Box, taper));

/// Returns the light of one side that has the numbers of the other side's.
template <class To, class From> To same_numbers(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    To to = {};
    std::memcpy(static_cast<void*>(&to), &from, sizeof to);
    return to;
}

/// Writes the light that make() returns to the caller's struct, or says which of the pointers is null.
template <class Light, class Make>
lightbin_result make_light(std::initializer_list<Needed> pointers, Light* to, const Make& make) {
    return call_if(check_pointers(pointers), [&] {
        *to = same_numbers<Light>(make());
        return succeeded();
    });
}

inline detail::Triple triple_at(const float* from) {
    return {static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2])};
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_spot_sphere(const lightbin_spot* spot, lightbin_sphere* sphere) {
    using namespace lightbin;
    return c::make_light({{spot, "spot"}, {sphere, "sphere"}}, sphere,
                         [&] { return bounding_sphere(c::same_numbers<Spot>(*spot)); });
}

lightbin_result lightbin_tube_sphere(const float* a, const float* b, float radius, lightbin_sphere* sphere) {
    using namespace lightbin;
    return c::make_light({{a, "a"}, {b, "b"}, {sphere, "sphere"}}, sphere,
                         [&] { return tube_sphere(c::triple_at(a), c::triple_at(b), radius); });
}

lightbin_result lightbin_rectangle_sphere(const float* centre, const float* half_x, const float* half_y,
                                          float range, lightbin_sphere* sphere) {
    using namespace lightbin;
    return c::make_light(
        {{centre, "centre"}, {half_x, "half_x"}, {half_y, "half_y"}, {sphere, "sphere"}}, sphere, [&] {
            return rectangle_sphere(c::triple_at(centre), c::triple_at(half_x), c::triple_at(half_y), range);
        });
}

#if !defined(LIGHTBIN_NO_BOXES)
lightbin_result lightbin_box_sphere(const lightbin_box* box, lightbin_sphere* sphere) {
    using namespace lightbin;
    return c::make_light({{box, "box"}, {sphere, "sphere"}}, sphere,
                         [&] { return bounding_sphere(c::same_numbers<Box>(*box)); });
}

lightbin_result lightbin_oriented_box(const float* centre, const float* half_axes, lightbin_box* box) {
    using namespace lightbin;
    return c::make_light({{centre, "centre"}, {half_axes, "half_axes"}, {box, "box"}}, box, [&] {
        return oriented_box(c::triple_at(centre), c::triple_at(half_axes), c::triple_at(half_axes + 3),
                         c::triple_at(half_axes + 6));
    });
}

lightbin_result lightbin_cube_box(const lightbin_matrix* transform, double half_side, lightbin_box* box) {
    using namespace lightbin;
    Matrix matrix;
    lightbin_result result = c::check_pointers({{transform, "transform"}});
    if (result.error == LIGHTBIN_OK) result = c::read_member(*transform, matrix, "transform");
    if (result.error != LIGHTBIN_OK) return result;
    return c::make_light({{box, "box"}}, box, [&] { return oriented_box(matrix, half_side); });
}

lightbin_result lightbin_half_sphere(const lightbin_sphere* sphere, const float* direction,
                                     lightbin_box* box) {
    using namespace lightbin;
    return c::make_light({{sphere, "sphere"}, {direction, "direction"}, {box, "box"}}, box, [&] {
        return half_sphere(c::same_numbers<Sphere>(*sphere), c::triple_at(direction));
    });
}

lightbin_result lightbin_projector_box(const float* eye, const float* forward, const float* half_x,
                                       const float* half_y, double begin, lightbin_box* box) {
    using namespace lightbin;
    return c::make_light(
        {{eye, "eye"}, {forward, "forward"}, {half_x, "half_x"}, {half_y, "half_y"}, {box, "box"}}, box, [&] {
            return projector_box(c::triple_at(eye), c::triple_at(forward), c::triple_at(half_x),
                                 c::triple_at(half_y), begin);
        });
}

lightbin_result lightbin_tube_box(const float* a, const float* b, float radius, lightbin_box* box) {
    using namespace lightbin;
    return c::make_light({{a, "a"}, {b, "b"}, {box, "box"}}, box,
                         [&] { return tube_box(c::triple_at(a), c::triple_at(b), radius); });
}
#endif

}  // extern "C"
