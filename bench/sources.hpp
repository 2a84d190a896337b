// SPDX-License-Identifier: MIT
// Forms of the lights: vec4s or structs, in view space or world space; and a loop of the program's own that moves them.
#pragma once

#include "builds.hpp"
#include "world.hpp"

#include <lightbin/lights.hpp>

#include <cstddef>
#include <vector>

enum Source { view_vec4s, world_vec4s, loop_vec4s, view_structs, world_structs };
inline constexpr const char* source_names[] = {"view_vec4s", "world_vec4s", "loop_vec4s", "view_structs",
                                               "world_structs"};

/// Moves lights as a user's loop would: GLM moves the centres, radii stay. Not inlined, and with a copy of the matrix,
/// which no store can change: so compilers make it fast.
[[gnu::noinline]] inline void move_lights(const Lights& lights, const glm::mat4 view_matrix, Lights& moved) {
    moved.resize(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        moved[i] = view_matrix * glm::vec4(glm::vec3(lights[i]), 1);
        moved[i].w = lights[i].w;
    }
}

/// Builds one frame's lists from each form of its lights.
class SourceBuilds {
public:
    SourceBuilds(const Lens& lens, int tile_size, lightbin::Isa isa)
        : view_(lens.view(tile_size)), build_(tile_size, isa) {}

    std::size_t operator()(Source source, const WorldFrame& frame) {
        switch (source) {
        case view_vec4s:
            return build_(view_, frame.view.lights);
        case world_vec4s:
            return build_(view_, lightbin::world_space(frame.lights, frame.view_matrix));
        case view_structs:
            return build_(view_, lightbin::view_space(frame.view_structs, sphere_of));
        case world_structs:
            return build_(view_, lightbin::world_space(frame.structs, frame.view_matrix, sphere_of));
        case loop_vec4s:
            move_lights(frame.lights, frame.view_matrix, moved_);
            break;
        }
        return build_(view_, moved_);
    }

private:
    lightbin::View view_;
    Build<lightbin::Options{}> build_;
    Lights moved_;
};
