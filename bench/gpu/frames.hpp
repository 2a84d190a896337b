// SPDX-License-Identifier: MIT
// The lights that lists are made of: random ones in view space (bench/sets.hpp), Bevy's many_lights in world space.
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

/// The lights of one frame. Lights in world space are the same in all frames, so they stay on the GPU.
struct GpuFrame {
    Lens lens;
    Lights lights;
    std::optional<glm::mat4> to_view;  ///< the view matrix, if lights are in world space
};

struct LightSource {
    std::string name;
    float reach;  ///< the greatest depth, up to which slices reach
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
