// SPDX-License-Identifier: MIT
// The texts of the shaders: one surface, one function that lights it, however its lights are found.
#pragma once

#include "settings.hpp"

#include <lightbin/shader.hpp>

#include <string>

/// How a technique's shaders find the lights of a surface.
struct LightLookup {
    /// Defines the macro each_light(light, pixel, view_depth), before a statement that reads light.id; with masks also
    /// MASKS.
    std::string text;
};
LightLookup every_light();
LightLookup listed_lights(const lightbin::SnippetOptions& options = {});

/// Writes the texts for one version of GLSL and one kind of frame.
class Shaders {
public:
    Shaders(int glsl, const Settings& settings) : glsl_(glsl), settings_(settings) {}

    std::string surface_vertex() const;     ///< of triangles in world space
    std::string everywhere_vertex() const;  ///< of a triangle over the picture
    std::string depth_fragment() const;

    /// Lights what it draws.
    std::string forward_fragment(const LightLookup& lights) const;

    /// Writes surfaces to the G-buffer.
    std::string g_buffer_fragment() const;
    /// Lights a pixel of the G-buffer.
    std::string deferred_fragment(const LightLookup& lights) const;

    /// One light after another, added up in radiance_texture: the ambient light, one light, and what is shown.
    std::string ambient_fragment() const;
    std::string one_light_fragment() const;
    std::string show_fragment() const;
    /// Of rectangles around the footprints, an instance each; and of balls around the lights, one at a time.
    std::string rectangle_vertex() const;
    std::string ball_vertex() const;

private:
    std::string head() const;  ///< the version, and what the settings say

    int glsl_;
    Settings settings_;
};
