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

/// Returns the View that options describe, or why they are refused.
inline lightbin_result read_view(const lightbin_view_options* given, std::optional<View>& view) {
    lightbin_view_options options;
    Matrix projection;
    lightbin_result result = read(given, options, "options");
    if (result.error != LIGHTBIN_OK) return result;
    result = first_error(read_matrix(options.projection, projection, "options.projection"),
                         check_value(options.clip_depth, LIGHTBIN_ZERO_TO_ONE, "options.clip_depth"),
                         check_value(options.origin, LIGHTBIN_UPPER_LEFT, "options.origin"));
    if (result.error != LIGHTBIN_OK) return result;
    const auto made = View::from_projection(projection, {options.width, options.height},
                                            {.tile_size = options.tile_size != 0 ? options.tile_size : 32,
                                             .clip_depth = static_cast<ClipDepth>(options.clip_depth),
                                             .origin = static_cast<WindowOrigin>(options.origin),
                                             .reversed_z = options.reversed_z != 0});
    if (!made) return refused(made.error());
    view = *made;
    return result;
}

/// Makes a handle of the slices that make() returns.
template <class Make>
lightbin_result make_slices(float margin, lightbin_slices** slices, const Make& make) {
    if (slices == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "slices");
    if (!(0 <= margin && margin <= 0.5f)) return refused(LIGHTBIN_NOT_A_VALUE, "margin");
    return guarded([&] {
        const Result<Slices> made = make();
        if (!made) return refused(made.error());
        return make_handle(slices, margin > 0 ? made->with_margin(margin) : *made);
    });
}

inline std::span<const float> bound_of(const float* bound, std::size_t tiles) {
    if (bound == nullptr) return {};
    return {bound, tiles};
}

/// Returns the Z bounds that the caller describes for a view, or why they are refused.
inline lightbin_result read_bounds(const lightbin_z_bounds* given, const View& view, ZBounds& bounds) {
    lightbin_z_bounds known;
    const lightbin_result result = read(given, known, "inputs.bounds");
    if (result.error != LIGHTBIN_OK) return result;
    const auto side = [&](const float* bound) { return bound_of(bound, known.tiles); };
    for (const float* const bound : {known.min, known.max})
        if (bound != nullptr && known.tiles < view.tile_count())
            return refused(LIGHTBIN_Z_BOUNDS_TOO_SMALL, "inputs.bounds", view.tile_count(), known.tiles);
    bounds = {side(known.min), side(known.max)};
    return result;
}

}  // namespace c
}  // namespace lightbin

extern "C" {

std::size_t lightbin_error_text(lightbin_result result, char* text, std::size_t capacity) {
    const lightbin::Text whole = lightbin::c::text_of(result);
    return lightbin::c::write_text(whole.c_str(), whole.size(), text, capacity);
}

lightbin_isa lightbin_machine_isa(void) {
    return static_cast<lightbin_isa>(LIGHTBIN_SCALAR + static_cast<int>(lightbin::machine_isa()));
}

std::uint32_t lightbin_version(void) {
    return 10000 * LIGHTBIN_VERSION_MAJOR + 100 * LIGHTBIN_VERSION_MINOR + LIGHTBIN_VERSION_PATCH;
}

lightbin_result lightbin_view_create(const lightbin_view_options* options, lightbin_view** view) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    std::optional<lightbin::View> made;
    const lightbin_result result = read_view(options, made);
    return result.error != LIGHTBIN_OK ? result : make_handle(view, *made);
}

lightbin_result lightbin_view_update(lightbin_view* view, const lightbin_view_options* options) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    std::optional<lightbin::View> made;
    const lightbin_result result = read_view(options, made);
    if (result.error == LIGHTBIN_OK) view->value = *made;
    return result;
}

void lightbin_view_destroy(lightbin_view* view) {
    delete view;
}

lightbin_result lightbin_view_describe(const lightbin_view* view, lightbin_view_info* info) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    const lightbin_result result = check_size(info, "info");
    if (result.error != LIGHTBIN_OK) return result;
    const lightbin::View& value = view->value;
    const lightbin::ViewSummary summary = value.summary();
    lightbin_view_info known = {};
    known.width = value.viewport().width;
    known.height = value.viewport().height;
    known.tile_size = value.tile_size();
    known.tiles_x = value.tiles_x();
    known.tiles_y = value.tiles_y();
    known.orthographic = value.orthographic();
    known.reversed_z = value.reversed_z();
    known.near_depth = value.near_depth();
    known.far_depth = value.far_depth();
    known.x_flipped = summary.x_flipped;
    known.y_flipped = summary.y_flipped;
    known.looks_down_negative_z = summary.looks_down_negative_z;
    known.looks_transposed = summary.looks_transposed;
    known.looks_like_view_matrix = summary.looks_like_view_matrix;
    known.looks_turned = summary.looks_turned;
    known.looks_behind = summary.looks_behind;
    known.looks_zero_to_one = summary.looks_zero_to_one;
    known.pixels_not_square = summary.pixels_not_square;
    known.viewport_empty = summary.viewport_empty;
    write(known, info);
    return result;
}

std::size_t lightbin_view_text(const lightbin_view* view, char* text, std::size_t capacity) {
    if (view == nullptr) return 0;
    const lightbin::Text whole = to_string(view->value.summary());
    return lightbin::c::write_text(whole.c_str(), whole.size(), text, capacity);
}

lightbin_result lightbin_view_project(const lightbin_view* view, const double* point, double* image) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (point == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "point");
    if (image == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "image");
    const auto [x, y, depth] = view->value.image_point({point[0], point[1], point[2]});
    image[0] = x;
    image[1] = y;
    image[2] = depth;
    return succeeded();
}

lightbin_result lightbin_view_unproject(const lightbin_view* view, const double* image, double* point) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (image == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "image");
    if (point == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "point");
    const auto [x, y, z] = view->value.view_point({image[0], image[1], image[2]});
    point[0] = x;
    point[1] = y;
    point[2] = z;
    return succeeded();
}

lightbin_result lightbin_view_depths(const lightbin_view* view, double lower, double upper, float* depths) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (depths == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "depths");
    const lightbin::DepthInterval range = view->value.view_depths(lower, upper);
    depths[0] = range.min;
    depths[1] = range.max;
    return succeeded();
}

double lightbin_view_window_depth(const lightbin_view* view, double view_depth) {
    return view != nullptr ? view->value.window_depth(view_depth) : std::numeric_limits<double>::quiet_NaN();
}

lightbin_result lightbin_slices_exponential(std::int32_t count, float first, float last, float margin,
                                            lightbin_slices** slices) {
    return lightbin::c::make_slices(margin, slices,
                                    [=] { return lightbin::Slices::exponential(count, first, last); });
}

lightbin_result lightbin_slices_linear(std::int32_t count, float begin, float end, float margin,
                                       lightbin_slices** slices) {
    return lightbin::c::make_slices(margin, slices,
                                    [=] { return lightbin::Slices::linear(count, begin, end); });
}

lightbin_result lightbin_slices_from_boundaries(const float* boundaries, std::size_t count, float margin,
                                                lightbin_slices** slices) {
    if (boundaries == nullptr && count > 0) return lightbin::c::refused(LIGHTBIN_NULL_ARGUMENT, "boundaries");
    return lightbin::c::make_slices(margin, slices, [=] {
        return lightbin::Slices::from_boundaries({boundaries, count});
    });
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

lightbin_result lightbin_reduce_depth(const lightbin_view* view, const lightbin_depth_buffer* buffer,
                                      const lightbin_z_bounds_buffers* out, lightbin_z_bounds* bounds) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    lightbin_depth_buffer from;
    lightbin_z_bounds_buffers to;
    lightbin_result result =
        first_error(read(buffer, from, "buffer"), read(out, to, "out"), check_size(bounds, "bounds"));
    if (result.error == LIGHTBIN_OK) result = check_value(from.format, LIGHTBIN_UNORM16, "buffer.format");
    lightbin::Isa isa = lightbin::compiled_isa;
    if (result.error == LIGHTBIN_OK) result = read_isa(to.isa, isa, "out.isa");
    if (result.error != LIGHTBIN_OK) return result;
    if (from.depth == nullptr && from.count > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "buffer.depth");
    for (const float* const bound : {to.min, to.max})
        if (bound != nullptr && to.tiles < view->value.tile_count())
            return refused(LIGHTBIN_Z_BOUNDS_TOO_SMALL, "out", view->value.tile_count(), to.tiles);
    const auto side = [&](float* bound) {
        return bound != nullptr ? std::span<float>{bound, to.tiles} : std::span<float>{};
    };
    return guarded([&] {
        const auto reduced = lightbin::reduce_depth(
            view->value,
            {{from.depth, from.count},
             from.samples != 0 ? from.samples : 1,
             from.row_pitch,
             static_cast<lightbin::DepthFormat>(from.format),
             from.skip_background != 0},
            {side(to.min), side(to.max)}, isa);
        if (!reduced) return refused(reduced.error());
        lightbin_z_bounds known = {};
        const auto first = [](std::span<const float> bound) {
            return bound.empty() ? nullptr : bound.data();
        };
        known.min = first(reduced->min);
        known.max = first(reduced->max);
        known.tiles = to.tiles;
        write(known, bounds);
        return succeeded();
    });
}

}  // extern "C"
