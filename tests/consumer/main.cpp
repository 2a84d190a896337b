// A user's program: one light, four tiles, a known answer.
#include <lightbin/lightbin.hpp>

#include <array>
#include <cstdio>

int main() {
    // OpenGL, 90 degrees each way, near 0.1, far infinite; m[column][row].
    const float projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2f, 0}};
    const auto view = lightbin::View::from_projection(projection, {64, 64}, {.tile_size = 32});
    if (!view) {
        std::printf("%s\n", view.error().message().c_str());
        return 1;
    }

    // A light ahead, to the right and up, so that only the upper right tile lists it.
    const std::array<lightbin::Sphere, 1> lights{{{3, 3, -5, 1}}};
    lightbin::Binner<> binner;
    const auto grid = binner.bin(*view, lights);
    if (!grid) {
        std::printf("%s\n", grid.error().message().c_str());
        return 1;
    }

    bool right = grid->tiles_x() == 2 && grid->tiles_y() == 2 && grid->ranges().size() == 4;
    for (int y = 0; right && y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            right = right && grid->lights_in(x, y).size() == (x == 1 && y == 1 ? 1u : 0u);
    right = right && grid->lights_in(1, 1)[0] == 0;
    std::printf("lightbin %d.%d.%d: %s\n", LIGHTBIN_VERSION_MAJOR, LIGHTBIN_VERSION_MINOR,
                LIGHTBIN_VERSION_PATCH, right ? "right" : "WRONG");
    return right ? 0 : 1;
}
