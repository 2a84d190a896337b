// SPDX-License-Identifier: MIT
// What all techniques draw with: the scene, the frame's view and lights, programs, targets and a clock.
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

/// Whether OpenGL draws on the CPU. Its times say little about a GPU's.
bool is_software_renderer();

/// A light in view: its tiles, ends included, and its least and greatest view depth. Shaders read it as two uvec4.
struct LightFootprint {
    std::uint32_t id;
    std::uint16_t x0, y0, x1, y1;
    float nearest, farthest;
    std::uint32_t unused[3] = {};
};
static_assert(sizeof(LightFootprint) == 32);

/// Throws std::runtime_error with one line on everything that this OpenGL can't do.
class Stage {
public:
    /// Needs a current OpenGL context, of this GLSL version, and leaves its objects to it.
    Stage(const Scene& scene, int glsl);

    Geometry geometry;
    GpuMemory memory;

    /// Sets what others drew with back to how a context begins.
    static void reset_state();
    /// Sets the camera, the lights and the settings of a frame.
    void begin(const Camera& camera, const Settings& settings);
    /// Ends a pass: all that was done since the last one, by the CPU and the GPU.
    void lap(const char* pass);
    /// Waits for the frame. Returns its passes, those of one name as one.
    std::vector<Pass> end();
    /// If they were counted: light evaluations, and words of masks that fragments went through.
    std::uint64_t evaluations() const { return counted(0); }
    std::uint64_t words() const { return counted(1); }

    int glsl() const { return glsl_; }
    const Settings& settings() const { return settings_; }
    Shaders shaders() const { return {glsl_, settings_}; }
    lightbin::View view(int tile_size = 0) const;  ///< 0: that of the settings
    /// In view space, in the order in which they begin in depth: so ids and ranks in depth ascend together.
    const std::vector<lightbin::Sphere>& lights() const { return spheres_; }
    /// Returns the footprints of the lights in view, by ascending id. Tile size 0 stands for the settings' tile size.
    std::vector<LightFootprint> footprints(int tile_size = 0) const;
    /// Hands the shaders these lights in this order: for lists of ranks.
    void order_lights(std::span<const std::uint32_t> order);

    /// Makes a program, once, and takes it into use. It reads the frame's view and its own units.
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
