// SPDX-License-Identifier: MIT
// In a unit of its own, as it has Binners of all kinds in it.
#include "stage.hpp"

lightbin::Advice Stage::advise(const lightbin::View& view, const FrameSettings& settings) {
    place(settings);
    return binned_->visit_lights(settings.bin.dropped_light, [&](const auto& lights) {
        return value_of(lightbin::advise(view, lights));
    });
}
