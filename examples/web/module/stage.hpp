// SPDX-License-Identifier: MIT
// The scene on show and its lights: what the page asks for beside lightbin, in plain C++. At first there is none. Errors
// are a std::runtime_error with one sentence; the scene from before is still there then.
#pragma once

#include "gpu_light.hpp"
#include "scene.hpp"

#include <lightbin/spot.hpp>
#include <lightbin/view.hpp>

#include <span>
#include <string>
#include <vector>

// What a camera makes of the scene, before any light.
struct Look {
    glm::mat4 projection, world_to_view;
    glm::vec3 moon;  // the way to it, in view space
};

// In view space.
struct PlacedLights {
    std::vector<GpuLight> lights;        // and then the suns, which are in no list
    std::vector<lightbin::Spot> shapes;  // of the lights: what they reach
    float reach = 0;                     // the greatest depth that a light reaches
};

class Stage {
public:
    // A made scene: `city` with this many lights, or `street`.
    void make(const std::string& kind, int lights);

    // A binary glTF file.
    void open(std::span<const unsigned char> bytes, const std::string& name);

    const Scene& scene() const { return scene_; }
    bool has_spots() const { return has_spots_; }

    // aspect  the picture's width over its height
    Look look(const Camera& camera, double aspect, lightbin::ClipDepth clip_depth) const;

    // The lights as a camera sees them, some seconds after they were in their places. Valid until the next call.
    //
    // dropped_light  the id of a light that is to be in no list, so that a check can be seen to fail; or -1
    const PlacedLights& place(const glm::dmat4& camera_to_world, double seconds, int dropped_light);

private:
    void show(Scene scene);

    Scene scene_;
    bool has_spots_ = false;
    std::vector<Light> moved_;
    PlacedLights placed_;
};
