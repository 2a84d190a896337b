// SPDX-License-Identifier: MIT
// lightbin without a GPU: a projection matrix and lights in, a list of lights for each screen tile out.
#include <lightbin/lightbin.hpp>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

int main() {
    // The camera: a projection matrix (any kind), the size of the picture and of a tile in pixels.
    const glm::mat4 projection = glm::perspective(glm::radians(60.0f), 1280.0f / 720.0f, 0.1f, 100.0f);
    const auto view = lightbin::View::from_projection(projection, {1280, 720}, {.tile_size = 20});
    if (!view) {
        std::fprintf(stderr, "minimal: %s\n", view.error().message().c_str());
        return 1;
    }

    // The lights: centre and radius, as the camera sees them, looking down -z. Lamps along a street.
    std::vector<glm::vec4> lights;
    for (float z = -4; z > -60; z -= 4) {
        lights.emplace_back(-4, 1, z, 3);
        lights.emplace_back(4, 1, z, 3);
    }

    // The lists. Keep the Binner: its memory serves the next frame.
    lightbin::Binner<> binner;
    const auto lists = binner.bin(*view, lights);
    if (!lists) {
        std::fprintf(stderr, "minimal: %s\n", lists.error().message().c_str());
        return 1;
    }

    // A renderer uploads lists->ranges() and lists->ids(). Here is how many lights each tile has, from the
    // upper rows down: row 0 is the lowest.
    for (int y = lists->tiles_y() - 1; y >= 0; --y) {
        for (int x = 0; x < lists->tiles_x(); ++x)
            std::putchar(" .:-=+*#%@"[std::min<std::size_t>(lists->lights_in(x, y).size(), 9)]);
        std::putchar('\n');
    }

    // And here is one of the lists: ids are places in `lights`, in ascending order.
    std::printf("%zu lights, %zu tiles, %zu entries in the lists; the lights of tile (26, 20) are",
                lights.size(), lists->ranges().size(), lists->ids().size());
    for (const auto light : lists->lights_in(26, 20))
        std::printf(" %u", light);
    std::printf("\n");
}
