// SPDX-License-Identifier: MIT
// Tiled forward shading of a scene: renderer.cpp has the frame from top to bottom.
#pragma once

#include "binned_lights.hpp"
#include "culled_lights.hpp"
#include "frame_buffer.hpp"
#include "picture.hpp"
#include "projection.hpp"
#include "scene.hpp"
#include "shaders.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

// What is known of depth before the lights are drawn.
enum class DepthUse {
    none,      // nothing: each fragment has the list of its tile
    pre_pass,  // a depth buffer: so does it, with Z bounds from that buffer
    z_bins,    // nothing, but the list is entered and left by the bin of the fragment's depth
    clusters   // nothing, but each tile has a list for each slice of depth
};
enum class ZBoundsUse { none, max, both };

struct FrameSettings {
    int width = 1280;
    int height = 720;
    int samples = 1;             // a pixel, up to 8
    bool shade_samples = false;  // each of them, where once a pixel is right, too: see shades_samples()
    int tile_size = 16;
    bool gpu_reduction = false;  // Z bounds on the GPU; OpenGL ES has it so in any case
    bool gpu_build =
        false;  // lists on the GPU, and the Z bounds too; not with z-bins, nor in GLSL 330 and 300
    DepthUse depth = DepthUse::pre_pass;
    ZBoundsUse z_bounds = ZBoundsUse::both;  // of the pre-pass
    bool count_evaluations = false;          // takes longer than the picture
    float exposure = 1;                      // 0: linear radiance, see Renderer::meter
    ShaderChecks checks;
    int dropped_light = -1;   // a light's or box's id, left out of the lists, to see --check fail
    bool stale_size = false;  // lists for a smaller picture than is drawn, to see --check-in-shader fail

    bool has_z_bounds() const { return depth == DepthUse::pre_pass && z_bounds != ZBoundsUse::none; }
    // Z bounds are right for the depths of samples alone (docs/depth.md, several samples a pixel).
    bool shades_samples() const { return samples > 1 && (shade_samples || has_z_bounds()); }
};

// What a frame cost and what its lists hold.
struct FrameReport {
    int tiles_x = 0, tiles_y = 0;
    std::uint64_t lights_in_view = 0;
    std::uint64_t rejected = 0;
    std::uint64_t entries = 0;
    std::uint32_t longest_list = 0;
    std::uint64_t transparent_entries = 0;  // 0: no lists are needed
    // Of the opaque surfaces that are seen, if they were counted. With several samples: of one shading of each pixel,
    // by the deepest sample.
    double evaluations_per_pixel = 0;
    struct {
        double pre_pass, reduce, bin, upload, draw;
    } milliseconds{};
};

class Renderer {
public:
    // Needs a current OpenGL context, and leaves its objects to it: they live as long as the program. Keeps
    // the scene, whose lights may move from one draw to the next.
    Renderer(const Scene& scene, int glsl);

    // Draws the scene, each fragment lit by the list of its tile.
    FrameReport draw(const Camera& camera, const FrameSettings& settings);

    // Draws the same with every light in every fragment.
    void draw_every_light(const Camera& camera, const FrameSettings& settings);

    // Lays the number of each fragment's lights, as of the last draw(), over the picture.
    void draw_heat_map(const FrameReport& report, const FrameSettings& settings);

    // Returns the exposure that shows this view well, from a small picture of it.
    float meter(const Camera& camera, const FrameSettings& settings);

    Picture read_picture() const { return frame_buffer_.read(); }

    // Copies the picture to the window.
    void show() const { frame_buffer_.show(); }

private:
    // What shaders read as a storage buffer, a buffer texture or a 2D texture.
    struct GpuBuffer {
        lightbin::ShaderResource resource = lightbin::ShaderResource::storage_buffer;
        lightbin::GlFormat format = {};  // of a texel
        int texel_bytes = 0;
        GLuint buffer = 0;
        GLuint texture = 0;
    };
    struct Lists {
        GpuBuffer tiles, indices;
    };

    class Stopwatch;
    // What the program says of a frame's lists.
    struct Listed {
        std::function<std::size_t(int x, int y, float depth)>
            evaluations;            // of a pixel, x and y those of its tile
        std::uint32_t longest = 0;  // for glass, too
    };

    void start(const Camera& camera, const FrameSettings& settings);
    void set_camera(const Camera& camera);
    bool shows_glass(const FrameSettings& settings) const;
    void draw_depth() const;
    GLuint tiled_program(const FrameSettings& settings);
    GLuint heat_map_program(lightbin::Slicing slicing);
    void set_matrices(GLuint program) const;
    void draw_triangles(GLuint program, bool with_lists, const FrameSettings& settings) const;
    void bind_lists(GLuint program, const Lists& lists) const;
    void bind_texture(GLuint program, int unit, const GpuBuffer& source, const char* name) const;
    void upload(const GpuBuffer& target, const void* data, std::size_t bytes, int width,
                const char* what) const;
    void upload_lights();
    void upload_lists(const Lists& target, const lightbin::LightGrid<std::uint32_t>& grid) const;
    Listed list_on_cpu(const lightbin::View& view, const FrameSettings& settings, Stopwatch& watch,
                       FrameReport& report);
    Listed list_on_gpu(const lightbin::View& view, const FrameSettings& settings, Stopwatch& watch,
                       FrameReport& report);
    double count_evaluations(const FrameSettings& settings, const Listed& listed);
    void reduce_on_gpu(const lightbin::View& view, bool skip_background, std::span<float> min,
                       std::span<float> max);

    const Scene& scene_;
    int glsl_;

    lightbin::ShaderBinding list_binding_;
    BinnedLights binned_;
    CulledLights culled_;
    GLuint depth_program_, brute_force_program_;
    std::map<std::tuple<lightbin::Slicing, ShaderChecks>, GLuint> tiled_programs_;
    GLuint heat_map_programs_[3] = {};  // [slicing]
    GLuint vertex_array_ = 0;
    std::map<std::tuple<int, bool, bool>, GLuint> reduce_programs_;  // [samples, orthographic, skip]
    FrameBuffer frame_buffer_;
    GLuint reduce_framebuffer_ = 0, reduced_ = 0;
    GpuBuffer lights_, boxes_;
    Lists opaque_lists_, transparent_lists_;
    GpuBuffer slices_buffer_, bins_buffer_;

    // Of the frame
    glm::mat4 projection_{1}, view_{1};
    lightbin::GridConstants grid_{};
    lightbin::ViewConstants shader_view_{};
    std::optional<lightbin::Slices> slices_;  // with z-bins or clusters
    std::vector<float> depth_buffer_, min_depth_, max_depth_, glass_max_, pixel_depth_;
};
