// SPDX-License-Identifier: MIT
// Every fragment is lit by every light: the picture that all others are held against.
#include "passes.hpp"
#include "technique.hpp"

Technique forward_every_light() {
    return {"Forward with every light", [](Stage& stage) {
                begin_picture(stage);
                depth_pre_pass(stage);
                shade_forward(stage, every_light());
                if (stage.settings().transparent) shade_panes(stage, every_light());
                stage.resolve();
            }};
}
