// SPDX-License-Identifier: MIT
// Writes the .glb files that tests of tiled_forward need to the current folder.
#include "glb.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace {

// Turns the point lights of a file into spots along the six directions of the axes, with narrow and wide cones.
std::string as_spots(const std::string& file) {
    constexpr float half = 0.70710678f;
    constexpr std::array<std::array<float, 4>, 6> turns = {{{0, 0, 0, 1},
                                                            {0, 1, 0, 0},
                                                            {0, half, 0, half},
                                                            {0, -half, 0, half},
                                                            {half, 0, 0, half},
                                                            {-half, 0, 0, half}}};
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, file.data() + 12, sizeof json_size);
    nlohmann::json json = nlohmann::json::parse(file.substr(20, json_size));
    for (std::size_t i = 0; auto& node : json["nodes"])
        if (node.contains("extensions")) node["rotation"] = turns[i++ % turns.size()];
    for (int i = 0; auto& light : json["extensions"]["KHR_lights_punctual"]["lights"]) {
        light["type"] = "spot";
        light["spot"]["outerConeAngle"] = 0.05 + 0.1 * (i++ % 16);
    }
    return glb(json.dump(), file.substr(20 + json_size + 8));
}

}  // namespace

int main() {
    std::ifstream nova(LIGHTBIN_FIXTURES "/nova.glb", std::ios::binary);
    write_file("nova_spots.glb", as_spots({std::istreambuf_iterator<char>(nova), {}}));
    const std::string everything = everything_glb();
    write_file("everything.glb", everything);
    write_file("no_camera.glb", with(with(everything, "\"camera\": 0,", ""), "\"camera\": 1,", ""));
    // With a near plane this close, floats cannot tell depths apart in the scene's farther half.
    write_file("tiny_near.glb", with(everything, "\"znear\": 0.5", "\"znear\":6e-7"));
    write_file("empty.glb", "");
}
