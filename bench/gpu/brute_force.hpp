// SPDX-License-Identifier: MIT
// The baseline of builds on the GPU: every light in view is tested against every tile. Many engines cull their lights
// so, and so did the compute shaders that lightbin had at first.
#pragma once

#include "device.hpp"
#include "gpu_build.hpp"

#include <lightbin/coverage.hpp>
#include <lightbin/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

/// Three passes: a group for each tile counts its lights, one group adds up the counts, and a group for each tile
/// writes its list. The lists are those of plain tiles, with ascending ids. Takes the device's passes, and makes its buffers
/// `tiles` and `lists` anew.
class BruteForce {
public:
    BruteForce(GpuDevice& device, const lightbin::View& view, std::size_t lights, std::uint32_t entries);

    /// The lights in view with their rectangles, which the CPU has found.
    void upload(std::span<const lightbin::LightCoverage> lights);
    /// Returns the milliseconds of the three passes.
    double run() { return device_.run(false).front(); }
    ReadLists read();

private:
    GpuDevice& device_;
    std::size_t tiles_;
    std::array<std::uint32_t, 4> constants_;  ///< tile columns, tile rows, lights, room for entries
};
