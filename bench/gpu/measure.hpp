// SPDX-License-Identifier: MIT
// Times builds on the CPU and on the GPU, which take turns.
#pragma once

#include "compare.hpp"
#include "device.hpp"
#include "frames.hpp"
#include "gpu_build.hpp"

#include "../console.hpp"
#include "../measure.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

struct GpuRow {
    std::string device, source, method;
    std::size_t lights = 0, in_view = 0;
    double cpu_ms = 0, cpu_upload_ms = 0;  ///< medians, like all times here; on one core
    double gpu_ms = 0, gpu_upload_ms = 0;
    std::vector<std::pair<std::string, double>> passes;  ///< median milliseconds of each pass
    std::size_t scratch = 0;                             ///< bytes
    GroupWork work;                                      ///< for the last frame's lists
    Difference difference;
};

/// How many turns are timed, and how many come before them: an idle GPU needs time to reach its full clock rate.
struct TurnsOf {
    int timed, before;
};

/// Returns the lists or masks that a binner makes of a frame's lights.
template <class Binner, class... Inputs>
auto bin_frame(Binner& binner, const GpuFrame& frame, const lightbin::View& view, const Inputs&... inputs) {
    return frame.to_view ? *binner.bin(view, lightbin::world_space(frame.lights, *frame.to_view), inputs...)
                         : *binner.bin(view, frame.lights, inputs...);
}

/// Throws std::runtime_error with one line if the device can't run the passes.
template <lightbin::Options options, bool masks>
GpuRow measure(GpuDevice& device, const LightSource& source, int tile_size, const TurnsOf& turns,
               const lightbin::Slices& slices, const lightbin::ZBounds& bounds) {
    constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
    const GpuFrame& first = source.frames.front();
    const lightbin::View view = first.lens.view(tile_size);
    GpuRow row;
    row.device = device.name();
    row.source = source.name;
    row.lights = first.lights.size();

    // Makes each frame's lists on the CPU first, to know how much memory the GPU's lists need.
    std::conditional_t<masks, lightbin::MaskBinner, lightbin::Binner<options>> binner;
    const auto cpu = [&](const GpuFrame& frame) {
        if constexpr (masks)
            return bin_frame(binner, frame, view);
        else {
            auto inputs = lightbin::inputs_for<options>(bounds, slices);
            if constexpr (clusters) inputs.bounds = bounds;
            return bin_frame(binner, frame, view, inputs);
        }
    };
    std::size_t longest = 0;
    for (const GpuFrame& frame : source.frames)
        longest = std::max<std::size_t>(longest, cpu(frame).ids().size());
    const std::size_t room = longest + longest / 8 + 1024;
    GpuBuild gpu(device, options, masks, tile_size, first, std::uint32_t(room), clusters ? &slices : nullptr,
                 bounds);
    row.scratch = std::size_t(gpu.plan().bytes.scratch);
    device.make_buffer("sent ranges", gpu.plan().bytes.tiles);
    // Room for ids or masks. A MaskBinner may add a word to each mask.
    device.make_buffer("sent ids", std::max(4 * room, std::size_t(gpu.plan().bytes.masks) + 4096));
    const auto send = [&](const auto& made) {
        const auto write = [&](const char* name, const auto& values) {
            const auto bytes = std::as_bytes(std::span(values));
            return bytes.empty() ? 0 : device.write(name, bytes);
        };
        if constexpr (masks)
            return write("sent ids", made.words());
        else
            return write("sent ranges", made.ranges()) + write("sent ids", made.ids());
    };

    // The lists, of each frame once.
    for (const GpuFrame& frame : source.frames) {
        gpu.upload(frame);
        gpu.run(false);
        const auto made = cpu(frame);
        const ReadLists lists = gpu.read();
        row.in_view = lists.totals.visible;
        if constexpr (masks) {
            const ReadLists expected = lists_of(made);
            row.difference += compare(lists, expected.ranges, expected.ids);
        } else {
            row.difference += compare(lists, made.ranges(), made.ids());
            row.work = gpu.work_of_groups();
        }
    }

    std::vector<double> builds, sends, uploads, runs;
    std::vector<std::vector<double>> passes;
    for (int turn = -turns.before; turn < turns.timed; ++turn) {
        const GpuFrame& frame = source.frames[std::size_t(turn + turns.before) % source.frames.size()];
        const double begin = time_now();
        const auto made = cpu(frame);
        const double build = 1e3 * (time_now() - begin);
        const double sent = send(made), upload = gpu.upload(frame), run = gpu.run(false).front();
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
        row.passes.emplace_back(to_string(masks ? lightbin::cull_mask_passes[i] : lightbin::cull_passes[i]),
                                median(passes[i]));
    return row;
}
