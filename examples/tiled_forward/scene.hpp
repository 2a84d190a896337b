// SPDX-License-Identifier: MIT
// A scene as the renderer wants it: triangles and lights in world space, and places to look from.
#pragma once

#include <glm/glm.hpp>

#include <limits>
#include <span>
#include <string>
#include <vector>

struct Vertex {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec3 colour;  // base colour, linear
};

// A point light or a spot light. What it gives falls with the squared distance and is windowed to zero at its
// range.
struct Light {
    glm::vec3 position{0};
    float range = 0;         // metres; infinity: lights everything
    glm::vec3 intensity{0};  // candela, linear colour
    bool spot = false;       // a spot light has a cone as well
    glm::vec3 direction{0};  // of the cone's axis, unit length
    float cos_inner = 1;     // full strength inside this angle,
    float cos_outer = -1;    // nothing outside this one
};

// A directional light: it has no range, so it is in no list; every fragment is shaded with it.
struct Sun {
    glm::vec3 direction{0};    // the way the light travels, unit length
    glm::vec3 illuminance{0};  // lux, linear colour
};

// A box, or with a taper below 1 a frustum, that changes the surfaces inside. `half_axes` lead from its centre to the
// middles of three faces and are at right angles; `taper` is as in lightbin::Box.
struct SceneBox {
    enum class Kind {
        decal,  // multiplies base colours by `colour`, in a round pattern, on what faces the third half axis
        probe,  // adds `colour` (lux) as light of the surroundings, most of it from the third half axis
        projector  // sends `colour` (candela) along the third half axis, in the pattern of a window
    };
    Kind kind = Kind::decal;
    glm::vec3 colour{1};
    glm::vec3 centre{0};
    glm::mat3 half_axes{1};
    float taper = 1;
};

struct Camera {
    std::string name;
    glm::dmat4 to_world{1};  // rigid; the camera looks down its -z, as in OpenGL and glTF
    bool orthographic = false;
    double height =
        1;  // perspective: the vertical field of view, radians; orthographic: of the picture, metres
    double near = 0.1;
    double far = std::numeric_limits<double>::infinity();
};

struct Scene {
    std::string name;
    std::vector<Vertex> triangles;    // opaque, three vertices each
    std::vector<Vertex> transparent;  // glass: adds its light to that from behind
    std::vector<Light> lights;
    std::vector<SceneBox> boxes;
    std::vector<Sun> suns;
    std::vector<Camera> cameras;     // at least one
    std::vector<std::string> notes;  // what was read in a way the user may not expect, a line each
};

// Reads a binary glTF 2.0 file. A light without a range gets the one at which it still gives `cutoff` lux
// (0: it stays infinite). Throws std::runtime_error with one line of text.
Scene load_glb(const std::string& path, float cutoff);

// The same of a file that was read; `path` is where it was found, and its errors' name.
Scene read_glb(std::span<const unsigned char> bytes, const std::string& path, float cutoff);

// A small city at night with this many coloured lights in its streets, decals and a probe. The same every time.
Scene make_scene(int light_count);

// A street at night: lamps, cars, shops and beams, nearly all of them lights with a cone, and projectors. The same every
// time.
Scene make_street();

// A camera that has all of the scene in sight, from the front and above.
Camera framing_camera(const std::vector<Vertex>& triangles);

// "1 light", "2 lights".
inline std::string counted(std::size_t n, const char* what) {
    return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
}
