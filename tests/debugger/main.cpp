// A program to be stopped in a debugger: prints its lists as the debugger shows them.
#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>

#include <array>
#include <cstdio>

template <class Ids> void print_cell(const char* where, const Ids& ids) {
    if (ids.empty()) return;
    std::printf("%s = {", where);
    for (const auto& id : ids)
        std::printf(&id == ids.data() ? "%u" : ", %u", static_cast<unsigned>(id));
    std::printf("}\n");
}

// Where the debugger stops.
template <class Grid> void stop(const Grid& grid, const lightbin::LightMasks& masks) {
    (void)grid;
    (void)masks;
}

int main() {
    const float projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2f, 0}};
    const auto view = lightbin::View::from_projection(projection, {192, 128}, {.tile_size = 32});
    std::array<lightbin::Sphere, 40> lights;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto step = static_cast<float>(i);
        lights[i] = {0.2f * step - 4, 3 - 0.01f * step, -5 - step / 4, i == 39 ? 2.f : 0.4f};
    }
    const auto slices = lightbin::Slices::exponential(3, 5, 12);
    lightbin::Binner<{.ids = lightbin::IdWidth::u16, .slicing = lightbin::Slicing::clusters}> binner;
    const auto grid = binner.bin(*view, lights, {.slices = *slices});
    lightbin::MaskBinner mask_binner;
    const auto masks = mask_binner.bin(*view, lights);

    char where[40];
    std::printf("LightGrid of %d x %d tiles, %d slices, %zu entries\n", grid->tiles_x(), grid->tiles_y(),
                grid->slices(), grid->ids().size());
    for (int slice = 0; slice < grid->slices(); ++slice)
        for (int y = 0; y < grid->tiles_y(); ++y)
            for (int x = 0; x < grid->tiles_x(); ++x) {
                std::snprintf(where, sizeof where, "[%d, %d, %d]", x, y, slice);
                print_cell(where, grid->lights_in(x, y, slice));
            }
    lightbin::Binner<> whole;
    const auto tiles = whole.bin(*view, lights);
    std::printf("LightMasks of %d x %d tiles, %zu z-bins\n", masks->tiles_x(), masks->tiles_y(),
                masks->bins().size());
    for (int y = 0; y < tiles->tiles_y(); ++y)
        for (int x = 0; x < tiles->tiles_x(); ++x) {
            std::snprintf(where, sizeof where, "[%d, %d]", x, y);
            print_cell(where, tiles->lights_in(x, y));
        }
    std::fflush(stdout);
    stop(*grid, *masks);
    return 0;
}
