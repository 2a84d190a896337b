// SPDX-License-Identifier: MIT
// The projection in double of the boxes for which float has no error bound, one at a time, by the scalar tier's
// functions. It is the same function for every tier: few boxes of a scene are tiny or huge, or have a ball, the sphere
// that cuts them, that meets the near plane.
//
// Rounding, with e = 2^-53: let M be the sum of the absolute values of all terms in the three rows of the transform,
// for the centre and the half axes. Each term goes through at most 8 roundings, so corners are within 8e M = 2^-50 M;
// BoxLanes::error is 2^-46 M, more where the given centres are rounded: WorldToView::position_error().
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor
#pragma once
#include <lightbin/detail/kinds/boxes.inl>
#include <lightbin/detail/project/spheres_in_double.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

inline void project_box_in_double(const Camera& camera, const WorldToView* to_view, const Sphere& ball,
                                  const Box& given, std::uint32_t i, ProjectedChunk& chunk, ViewBox* to) {
    constexpr double infinite = static_cast<double>(infinity);
    const float signs[] = {camera.x.sign, camera.y.sign, camera.z_sign};
    double terms = 0;
    const auto transform = [&](const float(&from)[3], bool is_point, double(&image)[3]) {
        for (int row = 0; row < 3; ++row) {
            image[row] = 0;
            for (int column = 0; column < (is_point ? 4 : 3); ++column) {
                const double entry = to_view != nullptr ? to_view->matrix()[column][row] : column == row ? 1.0 : 0.0,
                             sign = static_cast<double>(signs[row]),
                             term = scalar::mul(sign * entry, column < 3 ? static_cast<double>(from[column]) : 1.0);
                image[row] = column == 0 ? term : image[row] + term;
                terms += abs_of(term);
            }
        }
    };
    scalar::BoxLanes<double> box;
    transform({given.box_x, given.box_y, given.box_z}, true, box.centre);
    for (unsigned axis = 0; axis < 3; ++axis)
        transform(given.half_axes[axis], false, box.half_axes[axis]);
    box.taper = static_cast<double>(given.taper);
    box.error = terms * (0x1p-46 + (to_view != nullptr ? to_view->position_error() : 0));
    // A box that is too large to be rounded to float bounds nothing: the light is then its whole ball.
    double view_size = scalar::size_of(box);
    if (!(view_size + box.error <= 0x1p60)) {
        box = {{}, {}, box.taper, infinite};
        view_size = infinite;
    }
    const double sphere[] = {static_cast<double>(ball.x), static_cast<double>(ball.y), static_cast<double>(ball.z),
                             static_cast<double>(ball.radius)};
    scalar::BoxBounds<double> bounds;
    bool visible = scalar::find_box_depths(camera, box, sphere, bounds);
    if (!camera.orthographic) {
        const double least = max_of(bounds.box_nearest, static_cast<double>(camera.near_depth));
        if (box.error <= 0.5 * least)
            scalar::clipped_corner_slopes(box, least, bounds.image);
        else
            bounds.image = {{-infinite, -infinite}, {infinite, infinite}};
    }
    scalar::ImageBounds<double> of_ball;
    bounds_in_double(camera, sphere, of_ball.low, of_ball.high);
    visible = scalar::narrow_to_balls<double>(camera, of_ball, bounds.radius, bounds.image, visible);
    visible = scalar::tile_rects<double>(camera, bounds.image, visible, chunk.rects, i);
    chunk.visible |= std::uint64_t{visible} << i;
    if (to == nullptr) return;

    // Rounding a box to float moves each point by less than 2^-24 of the box's size, see ViewBox.
    static_cast<Box&>(*to) = {ball.x, ball.y, ball.z, static_cast<float>(bounds.radius), 0, 0, 0, {}, given.taper};
    float* const centre[] = {&to->box_x, &to->box_y, &to->box_z};
    to->nearest = float_below(bounds.nearest);
    to->farthest = float_above(bounds.farthest);
    to->tolerance = static_cast<float>(box.error + scalar::mul(view_size, 0x1p-19) + 0x1p-120);
    for (unsigned k = 0; k < 3; ++k) {
        *centre[k] = static_cast<float>(box.centre[k]);
        for (unsigned axis = 0; axis < 3; ++axis)
            to->half_axes[axis][k] = static_cast<float>(box.half_axes[axis][k]);
    }
}

}}}  // namespace lightbin::detail
