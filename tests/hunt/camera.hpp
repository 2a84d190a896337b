// SPDX-License-Identifier: MIT
// Cameras of every kind, and the caller's way from view space to the caller's pixels.
#pragma once

#include "random.hpp"
#include "real.hpp"

#include <lightbin/lightbin.hpp>

#include <glm/glm.hpp>

#include <optional>

namespace hunt {

inline constexpr const char* camera_kinds[] = {
    "symmetric",     "off-centre",   "jittered",    "infinite far", "reversed Z",   "reversed Z, infinite",
    "scaled matrix", "narrow",       "wide",        "near extreme", "far extreme",  "thin depth range",
    "aside",         "orthographic", "ortho aside", "ortho thin",   "ortho extreme"};
inline constexpr const char* grid_kinds[] = {
    "ordinary",     "tile multiples", "one-pixel tiles", "kernel widths", "kernel heights",
    "kernel both",  "one tile wide",  "one tile high",   "one pixel",     "huge tiles",
    "longest side", "longest tall",   "longest wide",    "empty"};

/// A projection as the caller has it, in clip space as the caller's graphics API has it.
struct Camera {
    glm::dmat4 matrix = glm::dmat4(0);
    bool in_float = false;  ///< the matrix is given as floats, and its entries are such
    lightbin::Extent viewport;
    lightbin::ViewOptions options;
    bool orthographic = false;
    long double toward = -1;             ///< view depth = toward * z
    double near_hint = 0, far_hint = 0;  ///< about where the planes are; far may be infinite
};

/// Where a point of view space is seen.
struct Seen {
    Real x, y;          ///< in pixels from the window origin
    Real depth;         ///< view depth
    Real window_depth;  ///< 0 to 1
};

/// Returns where a point is seen; nothing where it is out of the clip volume, or may be by rounding.
std::optional<Seen> see(const Camera& camera, const RealPoint& point);

/// About the point at a place in the window and a view depth: no promise goes with it.
Point point_at(const Camera& camera, long double x, long double y, long double depth);

/// Whether an ordinary renderer would have this camera: the library has to take it.
bool ordinary(int kind);

Camera make_camera(int kind, Random& random);

/// Gives the camera a viewport and a tile size.
void set_grid(Camera& camera, int kind, Random& random);

}  // namespace hunt
