// SPDX-License-Identifier: MIT
// Writes the .glb files that the runs of tiled_forward need to the current folder.
#include "glb.hpp"

int main() {
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
