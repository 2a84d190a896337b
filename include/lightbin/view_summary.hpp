// SPDX-License-Identifier: MIT
// What a View read from its matrix, for a person: print it once, and the usual mistakes show.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdio>
#include <string>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// What View::summary() returns.
struct ViewSummary {
    bool orthographic;
    /// The angles between the image's sides in degrees, or orthographic its width and height in view space.
    double x_size, y_size;
    double aspect;  ///< width by height of the image on a plane of equal depth
    double near_depth, far_depth;
    bool looks_down_negative_z;  ///< as right-handed view spaces do
    bool reversed_z;
    bool x_flipped, y_flipped;     ///< NDC x grows against view space's, and y
    int width, height, tile_size;  ///< in pixels

    /// What is seldom meant. A View with one of these is as right as any other if it is.
    ///
    /// A perspective matrix that has its one where a transposed one has it.
    bool looks_transposed;
    /// An orthographic one that scales nothing: an identity, or the view matrix.
    bool looks_like_view_matrix;
    /// As a field of view in degrees does where radians are wanted: the image is upside down.
    bool looks_turned;
    /// An orthographic one, all of whose depths are behind the eye, as with reversed Z that ViewOptions does not say.
    bool looks_behind;
    /// A perspective one with reversed Z whose depths end before -1 however far away, as with depths from 0 to 1 that
    /// ViewOptions does not say. The far plane is taken to be at infinity then.
    bool looks_zero_to_one;
    /// The viewport's pixels are not as wide as high, by more than 2 %: its size is stale, or the aspect is inverted.
    bool pixels_not_square;
};

/// Returns it in one line, with a question for each thing that is seldom meant. (A template, so that only who calls it
/// compiles it.)
template <class Text = std::string> Text to_string(const ViewSummary& view) {
    const bool flat = view.orthographic;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "%s, %.4g x %.4g %s, aspect %.4g, near %.6g, far %.6g, looks down %s, %d x %d pixels in tiles of %d",
        flat ? "orthographic" : "perspective", view.x_size, view.y_size, flat ? "units" : "degrees",
        view.aspect, view.near_depth, view.far_depth,
        view.looks_down_negative_z ? "-z (right-handed)" : "+z (left-handed)", view.width, view.height,
        view.tile_size);
    Text line = text;
    if (view.reversed_z) line += ", reversed Z";
    if (view.x_flipped) line += ", x flipped";
    if (view.y_flipped) line += ", y flipped";
    if (view.looks_transposed) line += "; is it transposed? See MatrixLayout";
    if (view.looks_like_view_matrix)
        line += "; is this the view matrix, or an identity, in place of the projection?";
    if (view.looks_turned) line += "; upside down: degrees where radians are wanted?";
    if (view.looks_behind) line += "; all of it is behind the eye: is ViewOptions::reversed_z right?";
    if (view.looks_zero_to_one) line += "; no depth reaches -1: is ViewOptions::clip_depth right?";
    if (view.pixels_not_square)
        line += "; pixels are not square: is the viewport's size stale, or the aspect inverted?";
    return line;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
