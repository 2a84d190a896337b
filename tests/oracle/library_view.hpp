// SPDX-License-Identifier: MIT
// A camera as the library sees it.
#pragma once

#include "cameras.hpp"

#include <lightbin/view.hpp>

namespace oracle {

inline lightbin::Result<lightbin::View> library_view(const Camera& camera) {
    lightbin::ViewOptions options;
    options.tile_size = camera.tile;
    options.clip_depth =
        camera.zero_to_one ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one;
    options.origin =
        camera.upper_left ? lightbin::WindowOrigin::upper_left : lightbin::WindowOrigin::lower_left;
    options.reversed_z = camera.reversed;
    // The matrix has float entries unless the camera says otherwise, so conversion to double changes nothing.
    return lightbin::View::from_projection(camera.m, {camera.width, camera.height}, options);
}

}  // namespace oracle
