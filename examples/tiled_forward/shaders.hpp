// SPDX-License-Identifier: MIT
// The texts of the shaders, for GLSL 330 or 430, or GLSL ES 300 or 310.
#pragma once

#include <lightbin/shader_reduce.hpp>

#include <compare>
#include <string>

// What a text of lightbin's begins with.
std::string version_line(int glsl);

std::string geometry_vertex_shader(int glsl);
std::string depth_fragment_shader(int glsl);

// Texels a row of the lights' texture: whole lights, and no more than every device has.
constexpr int lights_width = 1536;

// Where lists, slices and bins lie: 330: buffer textures, 300: 2D textures, 430 and 310: storage buffers.
lightbin::ShaderBinding list_binding(int glsl);

// Z bounds of the tiles from a depth texture: a fragment a tile.
std::string reduce_fragment_shader(int glsl, int samples, bool orthographic, bool skip_background);

// How the lights of a fragment are found. Both call the same function for each of them, in ascending order of
// their ids.
enum class LightLoop {
    tile_list,   // the list of the fragment's tile, or as much of it as its depth needs
    every_light  // all there are, without any list: what --check compares with
};

// What the fragments of tile lists check, see lightbin::shader_snippet(). The picture is grey then, and what is wrong
// magenta.
struct ShaderChecks {
    bool view = false;   // is this fragment where the View has it?
    bool lists = false;  // has its list every light that reaches it?
    auto operator<=>(const ShaderChecks&) const = default;
};

// What a scene has beside lights that shine in all directions.
struct LightKinds {
    bool spots = false, boxes = false;
};
std::string forward_fragment_shader(int glsl, LightLoop loop, LightKinds kinds,
                                    lightbin::Slicing slicing = lightbin::Slicing::none,
                                    ShaderChecks checks = {});

// A triangle that covers the picture.
std::string overlay_vertex_shader(int glsl);

// The number of a fragment's lights as a colour. Without slicing to be drawn over the picture, with it over the surfaces.
std::string heat_map_fragment_shader(int glsl, lightbin::Slicing slicing);
