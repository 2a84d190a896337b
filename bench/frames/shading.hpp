// SPDX-License-Identifier: MIT
// Writes the shaders' texts: one surface and one lighting function for all techniques, however lights are found.
#pragma once

#include "settings.hpp"

#include <lightbin/shader.hpp>

#include <string>

/// How a technique's shaders find the lights of a surface.
struct LightLookup {
    /// Defines the macro each_light(light, pixel, view_depth), which stands before a statement that reads light.id; if
    /// it reads masks, also the macro MASKS.
    std::string text;
};
LightLookup every_light();
LightLookup listed_lights(const lightbin::SnippetOptions& options = {});

/// Writes the texts for one version of GLSL and one kind of frame.
class Shaders {
public:
    Shaders(int glsl, const Settings& settings) : glsl_(glsl), settings_(settings) {}

    std::string surface_vertex() const;     ///< for triangles in world space
    std::string everywhere_vertex() const;  ///< for one triangle over the picture
    std::string depth_fragment() const;

    /// Lights what it draws.
    std::string forward_fragment(const LightLookup& lights) const;

    /// Writes surfaces to the G-buffer.
    std::string g_buffer_fragment() const;
    /// Lights a pixel of the G-buffer.
    std::string deferred_fragment(const LightLookup& lights) const;

    /// Fragment shaders that add up radiance_texture light by light: ambient, one light, and the final colours.
    std::string ambient_fragment() const;
    std::string one_light_fragment() const;
    std::string show_fragment() const;
    /// Vertex shaders for an instance of a rectangle around each light's pixels, and for a sphere around one light.
    std::string rectangle_vertex() const;
    std::string ball_vertex() const;

private:
    std::string head() const;  ///< the version line, and macros for the settings

    int glsl_;
    Settings settings_;
};
