// SPDX-License-Identifier: MIT
// The texts of the shaders: one surface, one function that lights it, however its lights are found.
#pragma once

#include "settings.hpp"

#include <lightbin/shader.hpp>

#include <glm/glm.hpp>

#include <string>
#include <vector>

/// How a technique's shaders find the lights of a surface.
struct LightLookup {
    /// Defines the macro each_light(light, pixel, view_depth), before a statement that reads light.id.
    std::string text;
    std::string id = "int(light.id)";  ///< of the light in the frame's array
};
LightLookup every_light();
LightLookup listed_lights(const lightbin::ShaderOptions& options = {});

/// Writes the texts for one version of GLSL and one kind of frame.
class Shaders {
public:
    /// sample_places  of a pixel's samples, in 0..1
    Shaders(int glsl, const Settings& settings, const std::vector<glm::vec2>& sample_places)
        : glsl_(glsl), settings_(settings), sample_places_(sample_places) {}

    std::string surface_vertex() const;     ///< of triangles in world space
    std::string everywhere_vertex() const;  ///< of a triangle over the picture
    std::string depth_fragment() const;

    /// Lights what it draws. `material`: one of three, or 0 where all are the same; `alpha` below 1: of glass.
    std::string forward_fragment(const LightLookup& lights, int material = 0, float alpha = 1) const;

    /// Writes surfaces to the G-buffer.
    std::string g_buffer_fragment() const;
    /// Lights a pixel of the G-buffer, whatever the number of samples.
    std::string deferred_fragment(const LightLookup& lights) const;
    /// The same of a compute shader: declares vec3 lit_pixel(ivec2 pixel).
    std::string deferred_functions(const LightLookup& lights) const;

    /// One light after another, added up in radiance_texture: the ambient light, one light, and what is shown.
    std::string ambient_fragment() const;
    std::string one_light_fragment() const;
    std::string show_fragment() const;
    /// Of rectangles around the footprints, an instance each; and of balls around the lights, one at a time.
    std::string rectangle_vertex() const;
    std::string ball_vertex() const;

    std::string head() const;  ///< the version, and what the settings say

private:
    int glsl_;
    Settings settings_;
    std::vector<glm::vec2> sample_places_;
};
