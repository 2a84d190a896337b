// SPDX-License-Identifier: MIT
// Every fragment is lit by every light. This is the reference picture for all other techniques.
#include "passes.hpp"
#include "technique.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>

Technique forward_every_light() {
    return {"Forward with every light", [](Stage& stage) {
                // Mesa's software renderer silently ends loops that are longer than this.
                if (const std::size_t lights = stage.lights().size(); lights > 65000)
                    throw std::runtime_error("a fragment would loop over " + std::to_string(lights) +
                                             " lights, and some drivers end a loop after 65,535");
                begin_picture(stage);
                depth_pre_pass(stage);
                shade_forward(stage, every_light());
            }};
}
