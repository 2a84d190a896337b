// SPDX-License-Identifier: MIT
// Stability: may change.
// A summary of what a View read from its matrix, to be printed: it shows the usual mistakes with matrices.
#pragma once

#include <lightbin/detail/base/text.hpp>

#include <cstdio>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What View::summary() returns: what was read from the projection matrix, and what looks like a mistake.
struct ViewSummary {
    bool orthographic;
    /// The image's width and height. Perspective: the field of view, in degrees. Orthographic: in view-space units.
    double x_size, y_size;
    double aspect;  ///< the width divided by the height of the image on a plane of equal depth
    double near_depth, far_depth;
    bool looks_down_negative_z;  ///< whether the view looks along -z: true for right-handed view spaces
    bool reversed_z;
    bool oblique;             ///< the near plane is oblique: near_depth and far_depth are those of the image's corners
    /// The near plane in view space. A point (px, py, pz) is drawn where x px + y py + z pz + w >= 0, and the length of
    /// (x, y, z) is 1.
    double near_plane[4];
    bool x_flipped, y_flipped;     ///< NDC x (or y) falls where view-space x (or y; if turned, y or x) grows
    bool turned;                   ///< by 90 or 270 degrees: NDC x is made of view-space y, and NDC y of x
    int width, height, tile_size;  ///< in pixels; tile_size is 0 if the view was made with numbers of tiles
    int tiles_x, tiles_y;

    // Each flag below is set where the matrix or the viewport looks like a common mistake. A View with
    // a flag set is right if that was intended.

    bool looks_transposed;  ///< the matrix is a perspective one, and its entry of 1 is where a transposed matrix has it
    /// The matrix is orthographic and scales nothing: it may be an identity, or the view matrix.
    bool looks_like_view_matrix;
    /// The image is upside down and mirrored, as by a field of view in degrees where radians are wanted.
    bool looks_turned;
    bool looks_behind;  ///< all orthographic depths are behind the eye: is ViewOptions::reversed_z right?
    /// No depth of a perspective projection with reversed Z reaches NDC -1, so that its far plane is taken to be at
    /// infinity: should ViewOptions::clip_depth be zero_to_one?
    bool looks_zero_to_one;
    /// The viewport's pixels are off square by more than 2 %: its size may be stale, or the aspect inverted.
    bool pixels_not_square;
    bool viewport_empty;  ///< the width or the height is 0, so that there are no tiles: was it given?
};

/// Returns a summary in one line of text, with a question for each flag that is set.
inline Text to_string(const ViewSummary& view) {
    const bool flat = view.orthographic;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "%s, %.4g x %.4g %s, aspect %.4g, near %.6g, far %.6g, looks down %s, %d x %d pixels in ",
        flat ? "orthographic" : "perspective", view.x_size, view.y_size, flat ? "units" : "degrees",
        view.aspect, view.near_depth, view.far_depth,
        view.looks_down_negative_z ? "-z (right-handed)" : "+z (left-handed)", view.width, view.height);
    Text line;
    line.append(text);
    if (view.tile_size > 0)
        std::snprintf(text, sizeof text, "tiles of %d", view.tile_size);
    else
        std::snprintf(text, sizeof text, "%d x %d tiles", view.tiles_x, view.tiles_y);
    line.append(text);
    if (view.turned) line.append(", turned");
    if (view.reversed_z) line.append(", reversed Z");
    if (view.oblique) {
        const double* const plane = view.near_plane;
        std::snprintf(text, sizeof text, ", oblique near plane (%.4g, %.4g, %.4g, %.4g)", plane[0], plane[1], plane[2],
                      plane[3]);
        line.append(text);
    }
    if (view.x_flipped) line.append(", x flipped");
    if (view.y_flipped) line.append(", y flipped");
    if (view.looks_transposed) line.append("; is it transposed: is its layout right?");
    if (view.looks_like_view_matrix)
        line.append("; is this the view matrix, or an identity, in place of the projection?");
    if (view.looks_turned) line.append("; upside down: degrees where radians are wanted?");
    if (view.looks_behind) line.append("; all of it is behind the eye: is the option reversed_z right?");
    if (view.looks_zero_to_one) line.append("; no depth reaches -1: is the option clip_depth right?");
    if (view.pixels_not_square)
        line.append("; pixels are not square: is the viewport's size stale, or the aspect inverted?");
    if (view.viewport_empty)
        line.append("; no pixels: were width and height given? Frames of a minimised window are to be skipped");
    return line;
}

}}  // namespace lightbin
