// SPDX-License-Identifier: MIT
// The function of lightbin.h that writes a frame as text.
#pragma once

#include <lightbin/detail/c/grids.hpp>
#include <lightbin/dump.hpp>

extern "C" {

lightbin_result lightbin_dump(const lightbin_binner* binner, const lightbin_view* view,
                              const lightbin_lights* given_lights, const lightbin_inputs* given_inputs,
                              const lightbin_grid* grid, const lightbin_masks* masks, char* text,
                              std::size_t capacity, std::size_t* size) {
    using namespace lightbin::c;
    CallLights lights;
    lightbin_inputs inputs = {};
    lightbin_masks known = {};
    lightbin::ZBounds bounds;
    lightbin_result result =
        first_error(read_call(masks != nullptr, binner, view, given_lights, given_inputs, lights, inputs),
                    masks != nullptr ? read(masks, known, "masks") : check_size(grid, "grid"));
    if (result.error == LIGHTBIN_OK) result = check_array(known.words, known.word_count, "masks.words");
    if (result.error == LIGHTBIN_OK && inputs.bounds != nullptr)
        result = read_bounds(inputs.bounds, view->value, bounds);
    return call_if(result, [&] {
        const lightbin::Slices* const slices = inputs.slices != nullptr ? &inputs.slices->value : nullptr;
        const auto write = [&](const std::string& made) {
            if (size != nullptr) *size = made.size() + 1;
            return text == nullptr ? succeeded()
                                   : write_items(made.c_str(), made.size() + 1, text, capacity, "text");
        };
        if (masks != nullptr)
            return write(lightbin::detail::dump(
                view->value, lights.all(), slices,
                lightbin::LightMasks(known.tiles_x, known.tiles_y,
                                     {known.words, static_cast<std::size_t>(known.word_count)},
                                     {known.lights, known.rejected, known.culled}, {})));
        return with_grid(grid, [&](const auto& from) {
            return write(
                lightbin::detail::dump(view->value, lights.all(), {binner->how.is, slices, bounds}, from));
        });
    });
}

}  // extern "C"
