// SPDX-License-Identifier: MIT
// Runs the passes of shader_cull on a device, with all buffers that they need.
#pragma once

#include "device.hpp"
#include "frames.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader_cull.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Lists as shaders read them.
struct ReadLists {
    lightbin::CullTotals totals;
    std::vector<lightbin::ListRange> ranges;
    std::vector<std::uint32_t> ids;
};

/// The lists that masks stand for.
ReadLists lists_of(const lightbin::LightMasks& masks);

/// What the work groups of `count` and `fill` did.
struct GroupWork {
    /// For each light in view, of both passes together. A test is a word of a mask or of its summary that a work group
    /// reads, a rectangle that it compares with its tiles, a staged light that an invocation looks at for a column and
    /// a row, or a word of a column AND one of a row.
    double tests_a_light = 0;
    std::size_t groups = 0;  ///< of each of the two passes
    std::size_t idle = 0;  ///< of these, how many skip all lights: no cell is drawn, or the mask block has none
};

/// Builds lists on the GPU. All frames must have the lens and the number of lights of the first one.
class GpuBuild {
public:
    /// masks   whether it makes masks in place of lists
    /// bounds  the tiles' Z bounds, or empty: clusters read them, too
    GpuBuild(GpuDevice& device, const lightbin::Options& options, bool masks, int tile_size,
             const GpuFrame& first, std::uint32_t entries, const lightbin::Slices* slices,
             const lightbin::ZBounds& bounds);

    /// Uploads what changes between frames: constants, and lights in view space. Returns milliseconds.
    double upload(const GpuFrame& frame);
    /// See GpuDevice::run().
    std::vector<double> run(bool each_pass) { return device_.run(each_pass); }
    ReadLists read();
    /// After run(), of lists.
    GroupWork work_of_groups();

    const lightbin::CullPlan& plan() const { return plan_; }

private:
    /// Whether the Z bounds leave anything of the 8x8 cells from this one on.
    bool draws(std::uint32_t slice, std::uint32_t x, std::uint32_t y) const;

    GpuDevice& device_;
    std::span<const lightbin::CullPass> passes_;
    lightbin::View view_;
    lightbin::ZBounds bounds_;
    std::vector<lightbin::ShaderEdges> slabs_ = {{-INFINITY, INFINITY}};
    lightbin::CullOptions options_;
    lightbin::CullCapacity room_;
    std::optional<lightbin::Slices> slices_;
    lightbin::CullPlan plan_;
};
