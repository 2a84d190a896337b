// SPDX-License-Identifier: MIT
// Forward with a mask for each column of tiles and each row in place of lists; with z-bins a fragment looks only at the
// words of the lights at its depth. No pre-pass.
#include "passes.hpp"
#include "technique.hpp"

#include <lightbin/masks.hpp>

#include <memory>

Technique masked_forward(lightbin::Slicing slicing) {
    const bool z_bins = slicing == lightbin::Slicing::z_bins;
    const auto binner = std::make_shared<lightbin::MaskBinner>();
    return {z_bins ? "MaskedForward z-bins" : "MaskedForward", [=](Stage& stage) {
                const auto slices = value_of(lightbin::Slices::linear(1024, 0, depth_of_lights(stage)));
                const auto masks = value_of(z_bins ? binner->bin(stage.view(), stage.lights(), slices)
                                                   : binner->bin(stage.view(), stage.lights()));
                stage.lap("bin");
                if (z_bins) upload_slices(stage, slices, {});
                stage.memory.read_texels(unit_lists, GL_R32UI, stage.memory.buffer("masks", masks.words()));
                stage.lap("upload");
                begin_picture(stage);
                shade_forward(stage, listed_lights({.slicing = slicing, .masks = true}));
            }};
}
