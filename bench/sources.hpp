// SPDX-License-Identifier: MIT
// What the lights are: vec4s or structs, in view space or world space; and what a user has who moves them in a loop of the
// program's own.
#pragma once

#include "builds.hpp"
#include "world.hpp"

#include <lightbin/lights.hpp>

#include <cstddef>
#include <vector>

enum Source { view_vec4s, world_vec4s, loop_vec4s, view_structs, world_structs, loop_structs };
inline constexpr const char* source_names[] = {"view_vec4s",   "world_vec4s",   "loop_vec4s",
                                               "view_structs", "world_structs", "loop_structs"};

inline glm::vec4 centre_of(const glm::vec4& light) {
    return glm::vec4(light.x, light.y, light.z, 1);
}
inline glm::vec4 centre_of(const UserLight& light) {
    return glm::vec4(light.position, 1);
}
inline float radius_of(const glm::vec4& light) {
    return light.w;
}
inline float radius_of(const UserLight& light) {
    return light.radius;
}

/// The loop a user would write: GLM moves the centres, radii stay. Not inlined, and the matrix a copy that no store can
/// change: as quick as compilers make it.
template <class Light>
[[gnu::noinline]] void move_lights(const std::vector<Light>& lights, const glm::mat4 view_matrix,
                                   Lights& moved) {
    moved.resize(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        glm::vec4 light = view_matrix * centre_of(lights[i]);
        light.w = radius_of(lights[i]);
        moved[i] = light;
    }
}

/// Builds one frame's lists from each form of its lights.
template <lightbin::Options options> class SourceBuilds {
public:
    SourceBuilds(const Lens& lens, int tile_size) : view_(lens.view(tile_size)), build_(tile_size) {}

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
        case loop_structs:
            move_lights(frame.structs, frame.view_matrix, moved_);
            break;
        }
        return build_(view_, moved_);
    }

private:
    lightbin::View view_;
    Build<options> build_;
    Lights moved_;
};
