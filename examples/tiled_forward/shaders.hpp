// SPDX-License-Identifier: MIT
// The texts of the shaders, for GLSL 330 or 430.
#pragma once

#include <string>

std::string geometry_vertex_shader(int glsl);
std::string depth_fragment_shader(int glsl);

// How the lights of a fragment are found. Both call the same function for each of them, in ascending order of
// their ids.
enum class LightLoop {
    tile_list,   // the list of the fragment's tile
    every_light  // all there are, without any list: what --check compares with
};
std::string forward_fragment_shader(int glsl, LightLoop loop, bool has_spots);

// A triangle that covers the picture, and on it the length of each tile's list as a colour.
std::string overlay_vertex_shader(int glsl);
std::string heat_map_fragment_shader(int glsl);
