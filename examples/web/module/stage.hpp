// SPDX-License-Identifier: MIT
// The scene on show and its frames: all that the page asks for, in plain C++. At first there is none. Errors are a
// std::runtime_error with one sentence; the scene from before is still there then.
#pragma once

#include "binned_lights.hpp"
#include "scene.hpp"

#include <lightbin/advise.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/shader_build.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct FrameSettings {
    Camera camera;
    int width = 0, height = 0, tile_size = 16;
    lightbin::ClipDepth clip_depth = lightbin::ClipDepth::minus_one_to_one;
    lightbin::WindowOrigin origin = lightbin::WindowOrigin::lower_left;
    BinSettings bin;
    double seconds = 0;   // where moving lights are; 0: in their places
    bool on_gpu = false;  // no lists, but what the shaders of lightbin::build_shader() make them of
};

// What a camera and a picture's size make of the scene, before any light.
struct Prepared {
    lightbin::View view;
    glm::mat4 projection, world_to_view;
    glm::vec3 moon;  // the way to it, in view space
};

// The spans are valid until the next frame.
struct Frame {
    std::span<const GpuLight> lights;  // and then suns; with z-bins in the order of rank
    std::span<const lightbin::ListRange> ranges, glass_ranges;  // glass may have the same ones
    std::span<const std::uint32_t> ids, glass_ids;
    std::vector<std::uint32_t> slices;
    std::span<const lightbin::BinRange> bins;
    lightbin::LightCounts counts;
    std::uint32_t longest = 0;
    double light_ms = 0, bin_ms = 0;  // to move and place the lights; to bin them

    // on_gpu: what build_shader() reads. Lists have at most build.room entries.
    std::vector<lightbin::ShaderFootprint> footprints;
    std::vector<lightbin::ShaderEdges> edges, slabs;
    lightbin::ShaderBuild build = {};
};

class Stage {
public:
    // A made scene: `city` with this many lights, or `street`.
    void make(const std::string& kind, int lights);

    // A binary glTF file.
    void open(std::span<const unsigned char> bytes, const std::string& name);

    const Scene& scene() const { return scene_; }
    const std::string& kind() const { return kind_; }  // `city`, `street` or `file`
    bool has_spots() const { return binned_ && binned_->has_spots(); }

    Prepared prepare(const FrameSettings& settings) const;

    // What is drawn in a prepared view.
    //
    // z_bounds  with DepthMethod::interval and box, unless on_gpu: of what is opaque, and where there is glass
    //           transparent_max
    const Frame& frame(const lightbin::View& view, const FrameSettings& settings,
                       const lightbin::ZBounds& z_bounds);

    // What the ways to light this view cost here. With Z bounds, which took so long: those with depth, too.
    lightbin::Advice advise(const lightbin::View& view, const FrameSettings& settings,
                            const lightbin::ZBounds& z_bounds, double z_bounds_ns);

private:
    void show(Scene scene, const std::string& kind);
    void place(const FrameSettings& settings);
    void make_lists(const lightbin::View& view, BinSettings settings, const lightbin::ZBounds& z_bounds);
    void make_footprints(const lightbin::View& view, const BinSettings& settings);

    Scene scene_;
    std::string kind_;
    std::vector<Light> places_;  // of the lights at rest
    std::optional<BinnedLights> binned_;
    Frame frame_;
};
