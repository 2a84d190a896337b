// SPDX-License-Identifier: MIT
// The lights of which lists are made: those of the field sets, in view space, and Bevy's many_lights, in world space.
#pragma once

#include "../lens.hpp"
#include "../sets.hpp"
#include "../world.hpp"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Lights of one frame. Those in world space stay on the GPU, as they are the same in all frames.
struct GpuFrame {
    Lens lens;
    Lights lights;
    std::optional<glm::mat4> to_view;  ///< of lights in world space
};

struct LightSource {
    std::string name;
    float reach;  ///< the depth that slices divide
    std::vector<GpuFrame> frames;
};

/// A field set, met in turn; see field().
inline LightSource field_source(std::size_t count, float median_radius, const std::string& name) {
    LightSource source = {name, 200, {}};
    for (std::uint32_t seed = 0; seed < (count < 100000 ? 8 : 2); ++seed)
        source.frames.push_back({{}, field(count, median_radius, seed), {}});
    return source;
}

inline LightSource many_lights_source() {
    LightSource source = {"many_lights", 51, {}};
    for (const WorldFrame& frame : many_lights_frames())
        source.frames.push_back({frame.view.lens, frame.lights, frame.view_matrix});
    return source;
}
