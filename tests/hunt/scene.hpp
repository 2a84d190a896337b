// SPDX-License-Identifier: MIT
// Lights made to be missed, in view space or in a world of the caller's, and points inside them.
#pragma once

#include "camera.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hunt {

using lightbin::Sphere;

/// How often something was done, by name.
using Tally = std::map<std::string, std::uint64_t>;

inline constexpr const char* space_kinds[] = {"view",   "view space",    "rigid",     "far from origin",
                                              "scaled", "mirrored",      "sheared",   "squashed",
                                              "flat",   "extreme scale", "vast scale"};
inline constexpr std::uint32_t light_counts[] = {0,   1,    2,    3,    7,     8,     9,     16,    31,  33,
                                                 63,  64,   65,   100,  127,   129,   255,   256,   257, 300,
                                                 513, 1000, 4097, 8193, 65535, 65536, 65537, 131073};

/// A point inside a light, in the space of the lights.
struct Inside {
    std::uint32_t light;
    Point point;
};

struct Scene {
    bool in_world = false;  ///< the lights are given in world space, with `to_view`
    glm::dmat4 to_view = glm::dmat4(1);
    bool in_float = false;  ///< that matrix is given as floats
    std::vector<Sphere> lights;
    std::vector<Inside> inside;  ///< one a light made to touch something, just inside it
};

/// By the words of the library: skipped and counted.
bool is_bad(const Sphere& light);

/// Whether a point is in a sphere, surface included, beyond doubt.
bool surely_inside(const Sphere& light, const Point& point);

RealPoint in_view_space(const Scene& scene, const Point& point);

/// Makes `count` lights. At most `large` of them may cover the whole window, the others some tiles.
Scene make_scene(const Camera& camera, int space, std::uint32_t count, std::uint32_t large, Random& random);

/// Appends more points: the extremes of some lights on screen, and points all over the view with the lights they
/// are in.
void find_points(const Camera& camera, const Scene& scene, Random& random, std::vector<Inside>& points);

}  // namespace hunt
