// SPDX-License-Identifier: MIT
// Makes a frame's lists again by the C API, whose options are chosen at run time.
#include "frame.hpp"

#include <lightbin/lightbin.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace {

/// Throws the sentence of an error.
void succeed(const lightbin_result& result) {
    char text[512];
    if (result.error == LIGHTBIN_OK) return;
    lightbin_error_text(result, text, sizeof text);
    throw std::runtime_error(text);
}

/// Returns one of the structs whose first member is their size, with that size set.
template <class Struct> Struct sized() {
    Struct made = {};
    made.size = sizeof made;
    return made;
}

template <auto destroy> struct Destroy {
    template <class Handle> void operator()(Handle* handle) const { destroy(handle); }
};
using View = std::unique_ptr<lightbin_view, Destroy<lightbin_view_destroy>>;
using Slices = std::unique_ptr<lightbin_slices, Destroy<lightbin_slices_destroy>>;
using Binner = std::unique_ptr<lightbin_binner, Destroy<lightbin_binner_destroy>>;

View view_of(const Frame& frame) {
    auto options = sized<lightbin_view_options>();
    options.width = frame.width;
    options.height = frame.height;
    options.tile_size = frame.tile_size;
    options.columns = frame.columns;
    options.rows = frame.rows;
    options.projection.doubles = frame.projection.data();
    options.clip_depth = frame.zero_to_one ? LIGHTBIN_ZERO_TO_ONE : LIGHTBIN_MINUS_ONE_TO_ONE;
    options.origin = frame.upper_left ? LIGHTBIN_UPPER_LEFT : LIGHTBIN_LOWER_LEFT;
    options.reversed_z = frame.reversed_z;
    lightbin_view* view = nullptr;
    succeed(lightbin_view_create(&options, &view));
    return View(view);
}

/// The arrays of a frame as the C API takes them: all in the space of the first.
struct Lights {
    lightbin_lights all = sized<lightbin_lights>();
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<double>> centres;

    explicit Lights(const Frame& frame) {
        for (const LightArray& array : frame.arrays) {
            const LightArray& first = frame.arrays.front();
            if (array.view_matrix != first.view_matrix || array.from_eye != first.from_eye)
                throw std::runtime_error(
                    "its arrays of lights are in different spaces, which the C API does not take");
            if (array.view_matrix) all.view_matrix.doubles = array.view_matrix->data();
            if (array.from_eye) all.eye = eye;
            std::vector<float>& numbers = floats.emplace_back();
            for (const std::vector<float>& light : array.lights)
                numbers.insert(numbers.end(), light.begin(), light.end());
            const std::size_t count = array.lights.size(), stride = numbers.size() / count * sizeof(float);
            const auto part = [&](std::size_t at) { return lightbin_floats{numbers.data() + at, stride}; };
            const auto centre = [&](std::size_t at) {
                if (!array.from_eye) return part(at);
                std::vector<double>& points = centres.emplace_back();
                for (const std::vector<float>& light : array.lights)
                    points.insert(points.end(), light.data() + at, light.data() + at + 3);
                return lightbin_floats{points.data(), 3 * sizeof(double)};
            };
            if (array.kind == "spheres")
                all.spheres = {count, centre(0), part(3)};
            else if (array.kind == "spots")
                all.spots = {count, centre(0), part(3), part(4), part(7)};
            else
                all.boxes = {count, centre(0), part(3), centre(4), part(7), part(16)};
        }
    }

private:
    static constexpr double eye[3] = {0, 0, 0};
};

}  // namespace

Frame::Made bin_again(const Frame& frame) {
    const View view = view_of(frame);
    const Lights lights(frame);
    auto options = sized<lightbin_binner_options>();
    options.ids = frame.narrow_ids ? LIGHTBIN_U16 : LIGHTBIN_U32;
    options.depth_test = frame.depth_test;
    options.slicing = frame.clusters ? LIGHTBIN_CLUSTERS
                      : frame.z_bins ? LIGHTBIN_Z_BINS
                                     : LIGHTBIN_NO_SLICING;
    auto bounds = sized<lightbin_z_bounds>();
    bounds.min = frame.min.empty() ? nullptr : frame.min.data();
    bounds.max = frame.max.empty() ? nullptr : frame.max.data();
    bounds.tiles = std::max(frame.min.size(), frame.max.size());
    auto inputs = sized<lightbin_inputs>();
    lightbin_slices* slices = nullptr;
    if (frame.clusters || frame.z_bins)
        succeed(lightbin_slices_from_boundaries(frame.boundaries.data(), frame.boundaries.size(),
                                                frame.margin, &slices));
    const Slices slices_end(slices);
    inputs.slices = slices;
    if (frame.clusters ? bounds.tiles > 0 : frame.depth_test) inputs.bounds = &bounds;
    lightbin_binner* made = nullptr;
    succeed(lightbin_binner_create(&options, &made));
    const Binner binner(made);
    const auto copy = [](const auto* from, std::uint64_t count) {
        return std::vector<std::uint32_t>(from, from + (from != nullptr ? count : 0));
    };
    if (frame.masks) {
        auto masks = sized<lightbin_masks>();
        succeed(lightbin_bin_masks(binner.get(), view.get(), &lights.all, &inputs, &masks));
        return {{masks.lights, masks.rejected, masks.culled}, {}, {}, {}, {},
                copy(masks.words, masks.word_count)};
    }
    auto grid = sized<lightbin_grid>();
    succeed(lightbin_bin(binner.get(), view.get(), &lights.all, &inputs, &grid));
    return {{grid.lights, grid.rejected, grid.culled},
            copy(grid.ranges != nullptr ? &grid.ranges->offset : nullptr, 2 * grid.range_count),
            grid.id_bytes == 2 ? copy(static_cast<const std::uint16_t*>(grid.ids), grid.id_count)
                               : copy(static_cast<const std::uint32_t*>(grid.ids), grid.id_count),
            copy(grid.order, grid.order_count),
            copy(grid.bins != nullptr ? &grid.bins->least : nullptr, 2 * grid.bin_count),
            {}};
}
