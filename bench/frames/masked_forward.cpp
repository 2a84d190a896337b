// SPDX-License-Identifier: MIT
// Forward shading with a bit mask of lights for each column and each row of tiles in place of lists; with z-bins a
// fragment reads only the words with lights at its depth. No depth pre-pass.
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
