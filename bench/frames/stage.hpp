// SPDX-License-Identifier: MIT
// What all techniques draw with: scene, view and lights of a frame, shader programs, textures to draw to, a clock.
#pragma once

#include "geometry.hpp"
#include "gpu_memory.hpp"
#include "settings.hpp"
#include "shading.hpp"

#include <scene.hpp>
#include <value_of.hpp>

#include <lightbin/lightbin.hpp>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

struct Pass {
    std::string name;
    double milliseconds;
};

/// Returns whether OpenGL draws on the CPU, whose times say little about a GPU.
bool is_software_renderer();

/// The tiles that a light covers, first and last included, as an uvec4.
struct LightFootprint {
    std::uint32_t id;
    std::uint16_t x0, y0, x1, y1;
    std::uint32_t unused = 0;
};
static_assert(sizeof(LightFootprint) == 16);

/// All functions throw std::runtime_error with one line if this OpenGL lacks what they need.
class Stage {
public:
    /// Needs a current OpenGL context of this GLSL version, which owns the objects that it makes.
    Stage(const Scene& scene, int glsl);

    Geometry geometry;
    GpuMemory memory;

    /// Resets the OpenGL state that others changed to that of a new context.
    static void reset_state();
    /// Sets the camera, the lights and the settings of a frame.
    void begin(const Camera& camera, const Settings& settings);
    /// Ends a pass: takes the time of all work on the CPU and the GPU since the last call.
    void lap(const char* pass);
    /// Waits for the frame's end and returns its passes; passes of the same name are added up.
    std::vector<Pass> end();
    /// Returns, if they were counted, the light evaluations and the words of masks that fragments read.
    std::uint64_t evaluations() const { return counted(0); }
    std::uint64_t words() const { return counted(1); }

    int glsl() const { return glsl_; }
    const Settings& settings() const { return settings_; }
    Shaders shaders() const { return {glsl_, settings_}; }
    lightbin::View view(int tile_size = 0) const;  ///< a tile size of 0 means the settings' tile size
    /// Returns the lights in view space, sorted by the depth where they begin: ids are then ranks in depth.
    const std::vector<lightbin::Sphere>& lights() const { return spheres_; }
    /// Returns the tiles of the lights in view, by ascending id. A tile size of 0 means the settings' tile size.
    std::vector<LightFootprint> footprints(int tile_size = 0) const;
    /// Uploads the lights in this order, for lists of ranks in depth.
    void order_lights(std::span<const std::uint32_t> order);

    /// Compiles a program, if it is not known yet, and binds it together with the constants of the frame.
    GLuint use(const std::string& vertex, const std::string& fragment);

    /// Targets of the frame's size.
    GLuint target(const char* name, GLenum format);
    GLuint drawn() { return target("picture", GL_RGBA8); }
    GLuint depth() { return target("depth", GL_DEPTH_COMPONENT32F); }
    std::vector<std::uint8_t> read_picture();

private:
    GLuint set(GLuint program) const;
    std::uint64_t counted(std::size_t place) const;

    const Scene& scene_;
    int glsl_;
    bool software_;
    std::map<std::string, GLuint> programs_;
    GLuint constants_ = 0, counter_ = 0;

    Settings settings_;
    glm::mat4 projection_{1};
    std::vector<lightbin::Sphere> spheres_;
    std::vector<glm::vec4> gpu_lights_;  // two a light: centre and range, intensity
    std::vector<std::string> laps_;
    std::vector<GLuint> clocks_;
};
