// SPDX-License-Identifier: MIT
// A camera as the library sees it.
#pragma once

#include "cameras.hpp"

#include <lightbin/view.hpp>

namespace oracle {

inline lightbin::Result<lightbin::View> library_view(const Camera& camera) {
    lightbin::ViewOptions options;
    options.tile_size = camera.tile;
    options.columns = camera.turned ? camera.rows : camera.columns;
    options.rows = camera.turned ? camera.columns : camera.rows;
    options.clip_depth =
        camera.zero_to_one ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one;
    options.origin =
        camera.upper_left ? lightbin::WindowOrigin::upper_left : lightbin::WindowOrigin::lower_left;
    options.reversed_z = camera.reversed;
    // The matrix has float entries unless the camera says otherwise, so conversion to double changes nothing.
    if (!camera.turned) return lightbin::View::from_projection(camera.m, {camera.width, camera.height}, options);
    // Turned so that the columns and rows of tiles stay the same: y of the image counts what was x, and x what was y,
    // from the same ends. Only y is counted from the upper end.
    Matrix turned = camera.m;
    const int up = camera.upper_left ? -1 : 1;
    for (int column = 0; column < 4; ++column) {
        turned[column][0] = up * camera.m[column][1];
        turned[column][1] = up * camera.m[column][0];
    }
    return lightbin::View::from_projection(turned, {camera.height, camera.width}, options);
}

}  // namespace oracle
