// SPDX-License-Identifier: MIT
// Writes the .glb files that the runs of tiled_forward need to the current folder.
#include "glb.hpp"

#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>

namespace {

std::size_t size_at(const std::string& file, std::size_t place) {
    std::size_t size = 0;
    for (std::size_t i = 4; i-- > 0;)
        size = size << 8 | static_cast<unsigned char>(file[place + i]);
    return size;
}

// Puts texts that visit(0), visit(1) and so on return for every `from`.
template <class Visit> std::string replaced(const std::string& text, const std::string& from, Visit visit) {
    std::string result;
    std::size_t place = 0, number = 0;
    for (std::size_t next = 0; (next = text.find(from, place)) != std::string::npos;
         place = next + from.size())
        result += text.substr(place, next - place) + visit(number++);
    return result + text.substr(place);
}

// A scene of point lights as one of spots, which shine in all six directions of the axes, with narrow and wide cones.
std::string as_spots(const std::string& file) {
    const std::array<std::string, 6> turns = {"0, 0, 0, 1",
                                              "0, 1, 0, 0",
                                              "0, 0.70710678, 0, 0.70710678",
                                              "0, -0.70710678, 0, 0.70710678",
                                              "0.70710678, 0, 0, 0.70710678",
                                              "-0.70710678, 0, 0, 0.70710678"};
    const std::size_t json_size = size_at(file, 12), binary = 20 + json_size + 8;
    std::string json = replaced(file.substr(20, json_size),
                                "\"extensions\":{\"KHR_lights_punctual\":{\"light\"", [&](std::size_t i) {
                                    return "\"rotation\":[" + turns[i % turns.size()] +
                                           "],\"extensions\":{\"KHR_lights_punctual\":{\"light\"";
                                });
    json = replaced(json, "\"type\":\"point\"", [](std::size_t i) {
        return "\"type\":\"spot\",\"spot\":{\"outerConeAngle\":" +
               std::to_string(0.05 + 0.1 * static_cast<double>(i % 16)) + "}";
    });
    return glb(json, file.substr(binary));
}

}  // namespace

int main() {
    std::ifstream nova(LIGHTBIN_FIXTURES "/nova.glb", std::ios::binary);
    write_file("nova_spots.glb", as_spots({std::istreambuf_iterator<char>(nova), {}}));
    const std::string everything = everything_glb();
    write_file("everything.glb", everything);
    write_file("no_camera.glb", with(with(everything, "\"camera\": 0,", ""), "\"camera\": 1,", ""));
    // So near a near plane that float depth ends in the middle of the scene.
    write_file("tiny_near.glb", with(everything, "\"znear\": 0.5", "\"znear\":6e-7"));
    write_file("truncated.glb", everything.substr(0, everything.size() / 2));
    write_file("empty.glb", "");
    write_file("not_a_glb.glb", "This is no glTF file at all, but a line of text.\n");
    write_file("broken_json.glb", with(everything, "\"asset\":", "\"asset\";"));
    write_file("no_lights.glb", with(everything, "\"nodes\": [0, 1, 2, 5]", "\"nodes\": [0, 2]"));
    write_file("no_triangles.glb", with(everything, "\"nodes\": [0, 1, 2, 5]", "\"nodes\": [5]"));
    write_file("past_the_end.glb",
               with(everything, "\"byteOffset\": 20, \"componentType\": 5125, \"count\": 6",
                    "\"byteOffset\":20,\"componentType\":5125,\"count\":7"));
    write_file("loop.glb", with(everything, "\"children\": [3, 4]", "\"children\": [1, 4]"));
}
