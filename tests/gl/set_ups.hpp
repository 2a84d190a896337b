// SPDX-License-Identifier: MIT
// The set-up of a frame, each usual mistake as a change of it, and changes that are not mistakes.
#pragma once

#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

constexpr int width = 96, height = 64;
constexpr float aspect = 1.5f;
constexpr std::size_t light_count = 48;

inline const glm::mat4 camera =
    glm::lookAt(glm::vec3(1, 1.5f, 4), glm::vec3(-1, -0.5f, -6), glm::vec3(0, 1, 0));

// Returns a point of the camera's view space in world space.
inline glm::vec3 before_eye(float x, float y, float z) {
    return glm::vec3(glm::inverse(camera) * glm::vec4(x, y, z, 1));
}

// Returns world-space lights. The last one is small and close to the eye.
inline std::vector<lightbin::Sphere> world_lights() {
    std::mt19937 engine(3);
    const auto number = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(engine() >> 8) / 16777216.0f;
    };
    std::vector<lightbin::Sphere> lights;
    for (std::size_t i = 1; i < light_count; ++i)
        lights.push_back({number(-8, 8), number(-1, 2), number(-14, 3), number(1, 3.5f)});
    const glm::vec3 close = before_eye(0.05f, 0.02f, -0.28f);
    lights.push_back({close.x, close.y, close.z, 0.1f});
    return lights;
}

// What is drawn and what the library is told; a mistake makes the two differ.
struct Setup {
    glm::mat4 projection = glm::perspective(1.1f, aspect, 0.2f, 50.0f);
    glm::mat4 view = camera;
    std::vector<lightbin::Sphere> lights = world_lights();  // as the shader has them
    float floor_size = 20;                                  // of its two triangles
    bool windowed = true;                                   // lights end at their range
    int samples = 1;
    bool centroid = true;
    std::array<int, 2> corner = {0, 0};

    glm::mat4 given_projection = projection, given_view = view;
    lightbin::ImageSize given_size = {width, height};
    lightbin::ViewOptions view_options = {.tile_size = 8};
    std::vector<lightbin::Sphere> given_lights = lights;
    lightbin::SnippetOptions shader = {.language = lightbin::ShaderLanguage::glsl_330,
                                      .storage = lightbin::ListStorage::texel_buffer,
                                      .view_check = true,
                                      .list_check = true,
                                      .window = true};
    bool narrow_ids = false;  // of the Binner
    /// A logarithmic depth buffer that Z bounds are made of, given as such of this format: view depths are converted.
    std::optional<lightbin::DepthFormat> logarithmic;
    bool looked_at = true;    // whether Results are
    bool ranked = true;       // z-bins: whether the shader has the lights in the order of their ranks
    bool depth_grows = true;  // away from the eye, as the shader has it
    bool samplers_set = true, grid_set = true, image_set = true, tiles_uploaded = true;

    void project(const glm::mat4& both) { projection = given_projection = both; }
    void give_transposed(const glm::mat4& drawn) {
        projection = drawn;
        given_projection = glm::transpose(drawn);
    }
    void give_size(int given_width, int given_height) { given_size = {given_width, given_height}; }
    void start_at(int x, int y) { corner = {x, y}; }
};

struct Case {
    std::string name;
    std::function<void(Setup&)> change;
};

inline glm::mat4 jittered(glm::mat4 projection) {
    projection[2][0] += 0.7f / width;
    projection[2][1] -= 0.3f / height;
    return projection;
}

// Returns the mistakes, with their names on the page docs/troubleshooting.md.
inline std::vector<Case> mistakes() {
    using glm::perspective;
    using glm::transpose;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {
        {"projection transposed", [](Setup& s) { s.give_transposed(s.projection); }},
        {"projection transposed, near plane at 0.5",
         [](Setup& s) { s.give_transposed(perspective(1.1f, aspect, 0.5f, 50.0f)); }},
        {"projection transposed, with jitter", [](Setup& s) { s.give_transposed(jittered(s.projection)); }},
        {"view matrix transposed", [](Setup& s) { s.given_view = transpose(s.view); }},
        {"camera's matrix in place of its inverse", [](Setup& s) { s.given_view = glm::inverse(s.view); }},
        {"world space lights given as view space", [](Setup& s) { s.given_view = glm::mat4(1); }},
        {"view space lights given as world space",
         [](Setup& s) {
             for (lightbin::Sphere& light : s.given_lights) {
                 const glm::vec4 moved = s.view * glm::vec4(light.x, light.y, light.z, 1);
                 light = {moved.x, moved.y, moved.z, light.radius};
             }
         }},
        {"projection times view", [](Setup& s) { s.given_projection = s.projection * s.view; }},
        {"identity as projection", [](Setup& s) { s.given_projection = glm::mat4(1); }},
        {"view matrix as projection, turned", [](Setup& s) { s.given_projection = s.view; }},
        {"view matrix as projection, only moved",
         [](Setup& s) { s.given_projection = glm::translate(glm::mat4(1), glm::vec3(1, -2, -5)); }},
        {"wrong window origin", [](Setup& s) { s.view_options.origin = lightbin::WindowOrigin::upper_left; }},
        {"flip_y where rows agree", [](Setup& s) { s.shader.flip_y = true; }},
        {"wrong clip depth", [](Setup& s) { s.view_options.clip_depth = lightbin::ClipDepth::zero_to_one; }},
        {"near plane not the drawn one",
         [](Setup& s) { s.given_projection = perspective(1.1f, aspect, 1.0f, 50.0f); }},
        {"degrees where radians are wanted",
         [](Setup& s) { s.given_projection = perspective(60.0f, aspect, 0.2f, 50.0f); }},
        {"half of the field of view",
         [](Setup& s) { s.given_projection = perspective(0.55f, aspect, 0.2f, 50.0f); }},
        {"aspect inverted",
         [](Setup& s) { s.given_projection = perspective(1.1f, 1 / aspect, 0.2f, 50.0f); }},
        {"jitter drawn, not given", [](Setup& s) { s.projection = jittered(s.projection); }},
        {"stale size", [](Setup& s) { s.give_size(64, 48); }},
        {"stale size of the same aspect", [](Setup& s) { s.give_size(width * 3 / 4, height * 3 / 4); }},
        {"stale view matrix",
         [](Setup& s) { s.given_view = glm::rotate(glm::mat4(1), 0.1f, glm::vec3(0, 1, 0)) * s.view; }},
        {"16-bit Binner, format of 32 bits", [](Setup& s) { s.narrow_ids = true; }},
        {"samplers unset", [](Setup& s) { s.samplers_set = false; }},
        {"grid uniform unset", [](Setup& s) { s.grid_set = false; }},
        {"constants of the view check unset", [](Setup& s) { s.image_set = false; }},
        {"viewport's corner not given", [](Setup& s) { s.start_at(40, 24); }},
        {"tile_size of the text not the View's", [](Setup& s) { s.shader.tile_size = 16; }},
        {"lists of this frame, tiles of another",
         [](Setup& s) {
             s.tiles_uploaded = false;
             for (lightbin::Sphere& light : s.lights)
                 light.x = -light.x;
             s.given_lights = s.lights;
         }},
        {"lights reordered after bin()", [](Setup& s) { std::swap(s.lights[3], s.lights[40]); }},
        {"range halved",
         [](Setup& s) {
             for (lightbin::Sphere& light : s.given_lights)
                 light.radius /= 2;
         }},
        {"no window: light beyond the range", [](Setup& s) { s.windowed = false; }},
        {"view depth with the wrong sign",
         [](Setup& s) {
             s.shader.slicing = lightbin::Slicing::clusters;
             s.depth_grows = false;
         }},
        {"z-bins, lights not in the order of ranks",
         [](Setup& s) {
             s.shader.slicing = lightbin::Slicing::z_bins;
             s.ranked = false;
         }},
        {"storage buffers in GLSL 3.30",
         [](Setup& s) { s.shader.storage = lightbin::ListStorage::storage_buffer; }},
        {"a light of NaN", [=](Setup& s) { s.given_lights[3].x = s.lights[3].x = nan; }},
        {"70,000 lights in 16 bits",
         [](Setup& s) {
             s.narrow_ids = true;
             s.given_lights.resize(70000);
         }},
        {"logarithmic depth buffer, read as window depths",
         [](Setup& s) { s.logarithmic = lightbin::DepthFormat::float32; }},
        {"Result not looked at",
         [](Setup& s) {
             s.looked_at = false;
             s.given_projection = glm::mat4(0);
         }},
    };
}

// Returns set-ups that are not mistakes: no diagnostic may report them.
inline std::vector<Case> right_ones() {
    using glm::perspective;
    using lightbin::WindowOrigin;
    return {
        {"plain", [](Setup&) {}},
        {"no far plane", [](Setup& s) { s.project(glm::infinitePerspective(1.1f, aspect, 0.2f)); }},
        {"reversed Z", [](Setup& s) { s.project(perspective(1.1f, aspect, 50.0f, 0.2f)); }},
        {"orthographic", [](Setup& s) { s.project(glm::ortho(-9.0f, 9.0f, -6.0f, 6.0f, 0.1f, 40.0f)); }},
        {"off-centre", [](Setup& s) { s.project(glm::frustum(-0.05f, 0.2f, -0.1f, 0.07f, 0.2f, 60.0f)); }},
        {"jittered", [](Setup& s) { s.project(jittered(s.projection)); }},
        {"mirrored", [](Setup& s) { s.project(glm::scale(s.projection, glm::vec3(-1, 1, 1))); }},
        {"flip_y",
         [](Setup& s) {
             s.view_options.origin = WindowOrigin::upper_left;
             s.shader.flip_y = true;
         }},
        {"corner",
         [](Setup& s) {
             s.start_at(40, 24);
             s.shader.viewport_corner = true;
         }},
        {"corner and flip_y",
         [](Setup& s) {
             s.start_at(40, 24);
             s.shader.viewport_corner = s.shader.flip_y = true;
             s.view_options.origin = WindowOrigin::upper_left;
         }},
        {"constant tile size", [](Setup& s) { s.shader.tile_size = 8; }},
        {"logarithmic depth buffer", [](Setup& s) { s.logarithmic = lightbin::DepthFormat::view_depth; }},
        {"four samples", [](Setup& s) { s.samples = 4; }},
        {"four samples, at pixels' centres",
         [](Setup& s) {
             s.samples = 4;
             s.centroid = false;
         }},
        {"large triangles, clipped", [](Setup& s) { s.floor_size = 5000; }},
        {"clusters", [](Setup& s) { s.shader.slicing = lightbin::Slicing::clusters; }},
        {"z-bins", [](Setup& s) { s.shader.slicing = lightbin::Slicing::z_bins; }},
        {"16 bits on both sides",
         [](Setup& s) {
             s.narrow_ids = true;
             s.shader.format =
                 lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u16}>::list_format;
             s.shader.packed_ids = true;
         }},
    };
}
