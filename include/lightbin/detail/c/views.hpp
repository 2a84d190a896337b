// SPDX-License-Identifier: MIT
// The C side's errors as text, views, slices and Z bounds.
#pragma once

#include <lightbin/detail/c/arguments.hpp>

#include <lightbin/slices.hpp>
#include <lightbin/version.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

struct lightbin_view {
    lightbin::View value;
};

struct lightbin_slices {
    lightbin::Slices value;
};

namespace lightbin {
namespace c {

/// Reads the View that options describe, or returns why they are refused.
inline lightbin_result read_view(const lightbin_view_options* options, std::optional<View>& view) {
    lightbin_view_options given;
    ViewOptions known;
    Matrix projection;
    lightbin_result result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        result = first_error(read_member(given.projection, projection, "options.projection"),
                             LIGHTBIN_MEMBER(tile_size), LIGHTBIN_MEMBER(clip_depth), LIGHTBIN_MEMBER(origin),
                             LIGHTBIN_MEMBER(reversed_z), LIGHTBIN_MEMBER(columns), LIGHTBIN_MEMBER(rows),
                             LIGHTBIN_MEMBER(max_tiles));
    if (result.error != LIGHTBIN_OK) return result;
    const auto made = View::from_projection(projection, {given.width, given.height}, known);
    if (!made) return refused(made.error());
    view = *made;
    return result;
}

/// Reads the Z bounds that the caller describes for a view, or returns why they are refused.
inline lightbin_result read_bounds(const lightbin_z_bounds* from, const View& view, ZBounds& bounds) {
    lightbin_z_bounds given;
    const lightbin_result result = read(from, given, "inputs.bounds");
    if (result.error != LIGHTBIN_OK) return result;
    if ((given.min != nullptr || given.max != nullptr) && given.tiles < view.tile_count())
        return refused(LIGHTBIN_Z_BOUNDS_TOO_SMALL, "inputs.bounds", view.tile_count(), given.tiles);
    if (given.min != nullptr) bounds.min = {given.min, given.tiles};
    if (given.max != nullptr) bounds.max = {given.max, given.tiles};
    return result;
}

/// Makes a lightbin_slices, a handle of C, of the slices that make() returns.
template <class Make>
lightbin_result make_slices(float margin, const lightbin_result& checked, lightbin_slices** slices, const Make& make) {
    lightbin_result result = first_error(checked, check_pointers({{slices, "slices"}}));
    if (result.error == LIGHTBIN_OK && !(0 <= margin && margin <= 0.5f))
        result = refused(LIGHTBIN_NOT_A_VALUE, "margin");
    return call_if(result, [&] {
        const Result<Slices> made = make();
        if (!made) return refused(made.error());
        return make_handle(slices, margin > 0 ? made->with_margin(margin) : *made);
    });
}

}  // namespace c
}  // namespace lightbin

extern "C" {

std::size_t lightbin_error_text(lightbin_result result, char* text, std::size_t capacity) {
    return lightbin::c::write_text(lightbin::c::text_of(result), text, capacity);
}

std::uint32_t lightbin_version(void) {
    return 10000 * LIGHTBIN_VERSION_MAJOR + 100 * LIGHTBIN_VERSION_MINOR + LIGHTBIN_VERSION_PATCH;
}

lightbin_result lightbin_view_create(const lightbin_view_options* options, lightbin_view** view) {
    using namespace lightbin::c;
    std::optional<lightbin::View> made;
    return call_if(first_error(check_pointers({{view, "view"}}), read_view(options, made)),
                   [&] { return make_handle(view, *made); });
}

lightbin_result lightbin_view_update(lightbin_view* view, const lightbin_view_options* options) {
    using namespace lightbin::c;
    std::optional<lightbin::View> made;
    const lightbin_result result = first_error(check_pointers({{view, "view"}}), read_view(options, made));
    if (result.error == LIGHTBIN_OK) view->value = *made;
    return result;
}

void lightbin_view_destroy(lightbin_view* view) {
    delete view;
}

lightbin_result lightbin_view_describe(const lightbin_view* view, lightbin_view_info* info) {
    using namespace lightbin::c;
    return call_if(first_error(check_pointers({{view, "view"}}), check_size(info, "info")), [&] {
        const lightbin::View& of = view->value;
        const lightbin::ViewSummary summary = of.summary();
        return write({0, summary.width, summary.height, summary.tile_size, of.tiles_x(), of.tiles_y(),
                      summary.orthographic, summary.reversed_z, of.near_depth(), of.far_depth(), summary.x_flipped,
                      summary.y_flipped, summary.looks_down_negative_z, summary.looks_transposed,
                      summary.looks_like_view_matrix, summary.looks_turned, summary.looks_behind,
                      summary.looks_zero_to_one, summary.pixels_not_square, summary.viewport_empty, summary.oblique,
                      summary.turned},
                     info);
    });
}

std::size_t lightbin_view_text(const lightbin_view* view, char* text, std::size_t capacity) {
    return view != nullptr ? lightbin::c::write_text(to_string(view->value.summary()), text, capacity) : 0;
}

lightbin_result lightbin_view_project(const lightbin_view* view, const double* point, double* image) {
    using namespace lightbin::c;
    return call_if(check_pointers({{view, "view"}, {point, "point"}, {image, "image"}}),
                   [&] { return write_numbers(view->value.image_point({point[0], point[1], point[2]}), image); });
}

lightbin_result lightbin_view_unproject(const lightbin_view* view, const double* image, double* point) {
    using namespace lightbin::c;
    return call_if(check_pointers({{view, "view"}, {image, "image"}, {point, "point"}}),
                   [&] { return write_numbers(view->value.view_point({image[0], image[1], image[2]}), point); });
}

lightbin_result lightbin_view_depths(const lightbin_view* view, double lower, double upper, float* depths) {
    using namespace lightbin::c;
    return call_if(check_pointers({{view, "view"}, {depths, "depths"}}),
                   [&] { return write_numbers(view->value.view_depths(lower, upper), depths); });
}

float lightbin_view_window_depth(const lightbin_view* view, const double* image) {
    if (view == nullptr || image == nullptr) return std::numeric_limits<float>::quiet_NaN();
    return view->value.window_depth({image[0], image[1], image[2]});
}

lightbin_result lightbin_slices_exponential(std::int32_t count, float first, float last, float margin,
                                            lightbin_slices** slices) {
    using namespace lightbin::c;
    return make_slices(margin, succeeded(), slices,
                       [=] { return lightbin::Slices::exponential(count, first, last); });
}

lightbin_result lightbin_slices_linear(std::int32_t count, float begin, float end, float margin,
                                       lightbin_slices** slices) {
    using namespace lightbin::c;
    return make_slices(margin, succeeded(), slices, [=] { return lightbin::Slices::linear(count, begin, end); });
}

lightbin_result lightbin_slices_from_boundaries(const float* boundaries, std::size_t count, float margin,
                                                lightbin_slices** slices) {
    using namespace lightbin::c;
    return make_slices(margin, check_array(boundaries, count, "boundaries"), slices,
                       [=] { return lightbin::Slices::from_boundaries({boundaries, count}); });
}

void lightbin_slices_destroy(lightbin_slices* slices) {
    delete slices;
}

std::int32_t lightbin_slices_count(const lightbin_slices* slices) {
    return slices != nullptr ? slices->value.count() : 0;
}

const float* lightbin_slices_boundaries(const lightbin_slices* slices) {
    return slices != nullptr ? slices->value.boundaries().data() : nullptr;
}

std::int32_t lightbin_slices_at(const lightbin_slices* slices, float depth) {
    return slices != nullptr ? slices->value.slice_at(depth) : -1;
}

}  // extern "C"
