// SPDX-License-Identifier: MIT
// Builds on the CPU and on the GPU in turns.
#pragma once

#include "compare.hpp"
#include "device.hpp"
#include "frames.hpp"
#include "gpu_build.hpp"

#include "../console.hpp"
#include "../measure.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/coverage.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

struct GpuRow {
    std::string device, source, method;
    std::size_t lights = 0, in_view = 0;
    double cpu_ms = 0, cpu_upload_ms = 0;  ///< medians, as all times; one core
    double gpu_ms = 0, gpu_upload_ms = 0;
    std::vector<std::pair<std::string, double>> passes;  ///< milliseconds of each pass of the GPU
    std::size_t scratch = 0;                             ///< bytes
    double tests = 0;  ///< of a light against a cell on the GPU, in count and fill together
    Difference difference;
};

/// How many turns are timed, and how many are made before them: a GPU that was idle takes its time to get fast.
struct TurnsOf {
    int timed, before;
};

/// In count and in fill, each light is tested against all cells of the mask blocks that it meets.
template <class Coverages>
double tests_of(const Coverages& lights, const lightbin::CullPlan& plan, const lightbin::Slices* slices) {
    const lightbin::ShaderCull& c = plan.constants;
    const double cells = double(1u << (2 * c.block_shift + c.slice_shift));
    double blocks = 0;
    for (const lightbin::LightCoverage& light : lights) {
        const auto across = [](unsigned first, unsigned last, unsigned shift) {
            return double((last >> shift) - (first >> shift) + 1);
        };
        double met = across(light.x0, light.x1, c.block_shift) * across(light.y0, light.y1, c.block_shift);
        if (slices)
            met *= across(unsigned(slices->slice_at(light.nearest)),
                          unsigned(slices->slice_at(light.farthest)), c.slice_shift);
        blocks += met;
    }
    return 2 * cells * blocks;
}

template <lightbin::Options options> class CpuBuild {
public:
    explicit CpuBuild(const lightbin::Slices& slices, const lightbin::ZBounds& bounds)
        : inputs_(lightbin::inputs_for<options>(bounds, slices)) {}

    auto operator()(const GpuFrame& frame, const lightbin::View& view) {
        return frame.to_view
                   ? *binner_.bin(view, lightbin::world_space(frame.lights, *frame.to_view), inputs_)
                   : *binner_.bin(view, frame.lights, inputs_);
    }

private:
    lightbin::Inputs<options.depth_test, options.slicing> inputs_;
    lightbin::Binner<options> binner_;
};

/// What each light of a frame covers.
inline std::vector<lightbin::LightCoverage> coverage_of(const GpuFrame& frame, const lightbin::View& view) {
    return frame.to_view ? *lightbin::coverage(view, lightbin::world_space(frame.lights, *frame.to_view))
                         : *lightbin::coverage(view, frame.lights);
}

/// Throws std::runtime_error with one line where the device can't do it.
template <lightbin::Options options>
GpuRow measure(GpuDevice& device, const LightSource& source, int tile_size, const TurnsOf& turns,
               const lightbin::Slices& slices, const lightbin::ZBounds& bounds) {
    constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
    const GpuFrame& first = source.frames.front();
    const lightbin::View view = first.lens.view(tile_size);
    GpuRow row;
    row.device = device.name();
    row.source = source.name;
    row.lights = first.lights.size();

    // What lists the CPU makes of each frame, and so how long the GPU's may be.
    CpuBuild<options> cpu(slices, bounds);
    std::size_t longest = 0;
    for (const GpuFrame& frame : source.frames)
        longest = std::max<std::size_t>(longest, cpu(frame, view).ids().size());
    const std::size_t room = longest + longest / 8 + 1024;
    GpuBuild gpu(device, options, tile_size, first, std::uint32_t(room), clusters ? &slices : nullptr,
                 bounds);
    row.scratch = std::size_t(gpu.plan().bytes.scratch);
    device.make_buffer("sent ranges", gpu.plan().bytes.tiles);
    device.make_buffer("sent ids", 4 * room);
    const auto send = [&](const auto& grid) {
        const auto write = [&](const char* name, const auto& values) {
            const auto bytes = std::as_bytes(std::span(values));
            return bytes.empty() ? 0 : device.write(name, bytes);
        };
        return write("sent ranges", grid.ranges()) + write("sent ids", grid.ids());
    };

    // The lists, of each frame once.
    for (const GpuFrame& frame : source.frames) {
        gpu.upload(frame);
        gpu.run(false);
        const auto grid = cpu(frame, view);
        row.difference += compare(gpu.read(), grid.ranges(), grid.ids());
    }
    {
        const std::vector<lightbin::LightCoverage> covered = coverage_of(first, view);
        row.in_view = covered.size();
        row.tests = tests_of(covered, gpu.plan(), clusters ? &slices : nullptr);
    }

    std::vector<double> builds, sends, uploads, runs;
    std::vector<std::vector<double>> passes;
    for (int turn = -turns.before; turn < turns.timed; ++turn) {
        const GpuFrame& frame = source.frames[std::size_t(turn + turns.before) % source.frames.size()];
        const double begin = time_now();
        const auto grid = cpu(frame, view);
        const double build = 1e3 * (time_now() - begin);
        const double sent = send(grid), upload = gpu.upload(frame), run = gpu.run(false).front();
        const std::vector<double> each = gpu.run(true);
        if (turn < 0) continue;
        builds.push_back(build), sends.push_back(sent), uploads.push_back(upload), runs.push_back(run);
        passes.resize(each.size());
        for (std::size_t i = 0; i < each.size(); ++i)
            passes[i].push_back(each[i]);
    }
    row.cpu_ms = median(builds), row.cpu_upload_ms = median(sends);
    row.gpu_ms = median(runs), row.gpu_upload_ms = median(uploads);
    for (std::size_t i = 0; i < passes.size(); ++i)
        row.passes.emplace_back(to_string(lightbin::cull_passes[i]), median(passes[i]));
    return row;
}
