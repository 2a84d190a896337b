// SPDX-License-Identifier: MIT
// Build: a Binner of any options, with Z bounds and depth slices that fit all generated sets of lights.
#pragma once

#include "lens.hpp"

#include <lightbin/binner.hpp>

#include <cstddef>

/// Tiles of clusters are larger than those of the other methods.
constexpr int usual_tile_size(const lightbin::Options& options) {
    return options.slicing == lightbin::Slicing::clusters ? 64 : 32;
}

template <lightbin::Options options> class Build {
public:
    explicit Build(int tile_size, lightbin::Isa isa = lightbin::compiled_isa)
        : made_(tile_size),
          slices_(options.slicing == lightbin::Slicing::clusters ? cluster_slices() : z_bin_slices()), binner_(isa) {}

    /// Builds the lists of some lights, and returns how many entries they have.
    template <class AnyLights>
    std::size_t operator()(const lightbin::View& view, const AnyLights& lights,
                           const lightbin::Parallel& threads = {}) {
        return binner_.bin(view, lights, lightbin::inputs_for<options>(made_.bounds, slices_), threads)->ids().size();
    }

private:
    MadeBounds made_;
    lightbin::Slices slices_;
    lightbin::Binner<options> binner_;
};
