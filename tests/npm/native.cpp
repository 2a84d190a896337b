// SPDX-License-Identifier: MIT
// native FILE: writes to FILE what tests/npm/module.mjs gives to the npm package too, and the lists that this machine's
// library makes of it: blocks of bytes, each after its length as 32 bits, in the order in which module.mjs reads them.
#include <lightbin/lightbin.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <limits>

enum { SPHERES = 400, SPOTS = 150, BOXES = 60, WIDTH = 500, HEIGHT = 290, TILE = 24, TILES = 21 * 13 };

static std::FILE* file;

static void succeed(lightbin_result result) {
    char text[512];
    if (result.error == LIGHTBIN_OK) return;
    lightbin_error_text(result, text, sizeof text);
    std::fprintf(stderr, "native: %s\n", text);
    std::exit(EXIT_FAILURE);
}

static void write_block(const void* bytes, size_t size) {
    const uint32_t length = (uint32_t)size;
    if (std::fwrite(&length, 4, 1, file) != 1 || (size > 0 && std::fwrite(bytes, size, 1,
        file) != 1)) std::exit(EXIT_FAILURE);
}

static float random_between(float low, float high) {
    static uint32_t state = 1;
    state = state * 1664525 + 1013904223;
    return low + (high - low) * (float)(state >> 8) / 16777216.0f;
}

static float spheres[SPHERES][4], spots[SPOTS][12], boxes[BOXES][16], nearest[TILES], farthest[TILES];

// A centre and a radius, most of them in front of a camera that is at (3, 1, 10) and looks down -z.
static void fill_sphere(float* to) {
    to[0] = random_between(-45, 50);
    to[1] = random_between(-25, 30);
    to[2] = random_between(-130, 15);
    to[3] = random_between(0, 9);
}

// Spheres in view space, or with a camera, all kinds in world space.
static lightbin_lights lights_of(const double* camera) {
    lightbin_lights lights = {};
    lights.size = sizeof lights;
    lights.view_matrix.doubles = camera;
    lights.spheres.count = SPHERES;
    lights.spheres.centre.first = spheres[0];
    lights.spheres.radius.first = spheres[0] + 3;
    lights.spheres.centre.stride = lights.spheres.radius.stride = sizeof spheres[0];
    if (camera != nullptr) {
        lights.spots.count = SPOTS;
        lights.spots.centre.first = spots[0];
        lights.spots.radius.first = spots[0] + 3;
        lights.spots.axis.first = spots[0] + 4;
        lights.spots.cosine.first = spots[0] + 7;
        lights.spots.centre.stride = lights.spots.radius.stride = lights.spots.axis.stride =
            lights.spots.cosine.stride = sizeof spots[0];
        lights.boxes.count = BOXES;
        lights.boxes.centre.first = boxes[0];
        lights.boxes.radius.first = boxes[0] + 3;
        lights.boxes.box_centre.first = boxes[0] + 4;
        lights.boxes.half_axes.first = boxes[0] + 7;
        lights.boxes.centre.stride = lights.boxes.radius.stride = lights.boxes.box_centre.stride =
            lights.boxes.half_axes.stride = sizeof boxes[0];
    }
    return lights;
}

int main(int count, char** names) {
    const double projection[16] = {1.3, 0, 0, 0, 0, 2.2, 0, 0, 0.02, 0, -1.001, -1, 0, 0, -0.2001, 0};
    const double camera[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, -1, -10, 1};
    lightbin_view_options view_options = {};
    lightbin_view* view = nullptr;
    lightbin_slices* slices = nullptr;
    if (count != 2 || (file = std::fopen(names[1], "wb")) == nullptr) return EXIT_FAILURE;

    for (int i = 0; i < SPHERES; ++i) fill_sphere(spheres[i]);
    for (int i = 0; i < SPOTS; ++i) {
        fill_sphere(spots[i]);
        for (int j = 4; j < 7; ++j) spots[i][j] = random_between(-1, 1);
        spots[i][7] = random_between(-0.2f, 1);
    }
    for (int i = 0; i < BOXES; ++i) {
        fill_sphere(boxes[i]);
        for (int j = 0; j < 3; ++j) boxes[i][4 + j] = boxes[i][j] + random_between(-1, 1);
        for (int j = 7; j < 16; ++j) boxes[i][j] = random_between(-3, 3);
    }
    // Bad input, and a light that reaches everything.
    spheres[7][0] = spheres[8][3] = std::numeric_limits<float>::infinity();
    for (int i = 0; i < TILES; ++i) {
        nearest[i] = random_between(0.1f, 40);
        farthest[i] = nearest[i] + random_between(0, 60);
    }

    view_options.size = sizeof view_options;
    view_options.width = WIDTH;
    view_options.height = HEIGHT;
    view_options.tile_size = TILE;
    view_options.projection.doubles = projection;
    succeed(lightbin_view_create(&view_options, &view));
    succeed(lightbin_slices_exponential(17, 1.5f, 120, 0, &slices));
    write_block(projection, sizeof projection);
    write_block(camera, sizeof camera);
    write_block(spheres, sizeof spheres);
    write_block(spots, sizeof spots);
    write_block(boxes, sizeof boxes);
    write_block(nearest, sizeof nearest);
    write_block(farthest, sizeof farthest);
    write_block(lightbin_slices_boundaries(slices), 16 * sizeof(float));

    // Each way to bin, in the order of module.mjs.
    for (int number = 0; number < 2 * 2 * 2 * 3; ++number) {
        lightbin_binner_options options = {};
        lightbin_z_bounds bounds = {};
        lightbin_inputs inputs = {};
        const lightbin_lights lights = lights_of(number % 2 == 1 ? camera : nullptr);
        lightbin_grid grid = {};
        lightbin_binner* binner = nullptr;
        uint32_t counts[4];
        options.size = sizeof options;
        options.ids = number / 2 % 2 == 0 ? LIGHTBIN_U32 : LIGHTBIN_U16;
        options.depth_test = number / 4 % 2;
        options.slicing = number / 8;
        succeed(lightbin_binner_create(&options, &binner));

        bounds.size = sizeof bounds;
        bounds.min = nearest;
        bounds.max = farthest;
        bounds.tiles = TILES;
        inputs.size = sizeof inputs;
        if (options.slicing != LIGHTBIN_NO_SLICING) inputs.slices = slices;
        if (options.depth_test != 0 && options.slicing != LIGHTBIN_CLUSTERS) inputs.bounds = &bounds;
        grid.size = sizeof grid;
        succeed(lightbin_bin(binner, view, &lights, &inputs, &grid));
        counts[0] = grid.lights;
        counts[1] = grid.rejected;
        counts[2] = grid.culled;
        counts[3] = (uint32_t)grid.slices;
        write_block(counts, sizeof counts);
        write_block(grid.ranges, (size_t)grid.range_count * sizeof *grid.ranges);
        write_block(grid.ids, (size_t)grid.id_count * grid.id_bytes);
        write_block(grid.order, (size_t)grid.order_count * sizeof *grid.order);
        write_block(grid.bins, (size_t)grid.bin_count * sizeof *grid.bins);
        lightbin_binner_destroy(binner);
    }

    // What shaders read that reduce depth and build the lists on the GPU.
    {
        lightbin_edges edges[WIDTH];
        lightbin_reduce_constants reduce = {};
        size_t written = 0;
        char text[1024];
        const size_t length = lightbin_view_text(view, text, sizeof text);
        if (length >= sizeof text) return EXIT_FAILURE;
        write_block(text, length);
        succeed(lightbin_shader_edges(view, edges, WIDTH, &written));
        write_block(edges, written * sizeof *edges);
        succeed(lightbin_shader_slabs(slices, edges, WIDTH, &written));
        write_block(edges, written * sizeof *edges);
        succeed(lightbin_shader_reduce(view, 3, 5, &reduce));
        write_block(&reduce, sizeof reduce);
    }
    for (const int fragment : {0, 1}) {
        lightbin_reduce_options options = {};
        lightbin_shader* shader = nullptr;
        options.size = sizeof options;
        options.language = fragment ? LIGHTBIN_ESSL_300 : LIGHTBIN_WGSL;
        options.fragment = fragment;
        options.skip_background = 1;
        succeed(lightbin_reduce_shader(&options, &shader));
        write_block(lightbin_shader_text(shader), std::strlen(lightbin_shader_text(shader)));
        lightbin_shader_destroy(shader);
    }
    // What shaders that make the lists of lights on the GPU need, and their texts.
    lightbin_slices* wide_slices = nullptr;
    succeed(lightbin_slices_exponential(17, 1.5f, 120, 0.02f, &wide_slices));
    for (const int slicing : {LIGHTBIN_NO_SLICING, LIGHTBIN_CLUSTERS}) {
        lightbin_cull_options options = {};
        lightbin_cull_plan plan = {};
        const lightbin_matrix to_view = {nullptr, camera, LIGHTBIN_COLUMN_MAJOR, 0};
        options.size = sizeof options;
        options.language = LIGHTBIN_WGSL;
        options.kind = LIGHTBIN_CULL_SPOT;
        options.stride = 12, options.radius = 3, options.axis = 4, options.cosine = 7;
        options.world_space = slicing != LIGHTBIN_CLUSTERS;
        options.depth_test = 1;
        options.slicing = slicing;
        plan.size = sizeof plan;
        succeed(lightbin_plan_cull(view, &options, SPOTS, 9000, slicing == LIGHTBIN_NO_SLICING ? nullptr : wide_slices,
                                   options.world_space ? &to_view : nullptr, &plan));
        write_block(&plan.scratch_bytes, 3 * sizeof plan.scratch_bytes);
        write_block(plan.constants, sizeof plan.constants);
        for (int pass = LIGHTBIN_CULL_PROJECT; pass <= LIGHTBIN_CULL_FILL; ++pass) {
            lightbin_shader* shader = nullptr;
            options.pass = pass;
            succeed(lightbin_cull_shader(&options, &shader));
            write_block(&plan.groups[pass], sizeof plan.groups[0]);
            write_block(lightbin_shader_text(shader), std::strlen(lightbin_shader_text(shader)));
            lightbin_shader_destroy(shader);
        }
    }
    lightbin_slices_destroy(wide_slices);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
    return std::fclose(file) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
