// SPDX-License-Identifier: MIT
// native FILE: writes to FILE the inputs that tests/npm/module.mjs gives to the npm package, and the lists that the
// native library makes: blocks of bytes, each after its length in 32 bits, in the order of module.mjs.
#include <lightbin/lightbin.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <vector>

namespace {

enum { SPHERES = 400, SPOTS = 150, BOXES = 60, WIDTH = 500, HEIGHT = 290, TILE = 24, TILES = 21 * 13 };

std::FILE* file;

void succeed(lightbin_result result) {
    char text[512];
    if (result.error == LIGHTBIN_OK) return;
    lightbin_error_text(result, text, sizeof text);
    std::fprintf(stderr, "native: %s\n", text);
    std::exit(EXIT_FAILURE);
}

void write_block(const void* bytes, std::size_t size) {
    const auto length = static_cast<std::uint32_t>(size);
    const bool written = std::fwrite(&length, 4, 1, file) == 1 && std::fwrite(bytes, 1, size, file) == size;
    if (!written) std::exit(EXIT_FAILURE);
}

void write_text(lightbin_shader* shader) {
    write_block(lightbin_shader_text(shader), std::strlen(lightbin_shader_text(shader)));
    lightbin_shader_destroy(shader);
}

template <class Number> void write_numbers(std::initializer_list<Number> numbers) {
    write_block(numbers.begin(), numbers.size() * sizeof(Number));
}

/// Returns one of the structs whose first member is their size, with that size set.
template <class Struct> Struct sized() {
    Struct made = {};
    made.size = sizeof made;
    return made;
}

float random_between(float low, float high) {
    static std::uint32_t state = 1;
    state = state * 1664525 + 1013904223;
    return low + (high - low) * static_cast<float>(state >> 8) / 16777216.0f;
}

float spheres[SPHERES][4], spots[SPOTS][12], boxes[BOXES][16], nearest[TILES], farthest[TILES];

/// Writes a random sphere: centre and radius. Most are in front of the camera at (3, 1, 10), which looks down -z.
void fill_sphere(float* to) {
    to[0] = random_between(-45, 50);
    to[1] = random_between(-25, 30);
    to[2] = random_between(-130, 15);
    to[3] = random_between(0, 9);
}

void fill_inputs() {
    for (float* sphere : spheres)
        fill_sphere(sphere);
    for (float* spot : spots) {
        fill_sphere(spot);
        for (int j = 4; j < 7; ++j)
            spot[j] = random_between(-1, 1);
        spot[7] = random_between(-0.2f, 1);
    }
    for (float* box : boxes) {
        fill_sphere(box);
        for (int j = 0; j < 3; ++j)
            box[4 + j] = box[j] + random_between(-1, 1);
        for (int j = 7; j < 16; ++j)
            box[j] = random_between(-3, 3);
    }
    // Makes one light bad input, and another one infinitely large.
    spheres[7][0] = spheres[8][3] = std::numeric_limits<float>::infinity();
    for (int i = 0; i < TILES; ++i) {
        nearest[i] = random_between(0.1f, 40);
        farthest[i] = nearest[i] + random_between(0, 60);
    }
}

/// Returns spheres in view space or, if a camera is given, lights of all kinds in world space.
lightbin_lights lights_of(const double* camera) {
    auto lights = sized<lightbin_lights>();
    const auto part = [](const auto& array, int at) { return lightbin_floats{array[0] + at, sizeof array[0]}; };
    lights.view_matrix.doubles = camera;
    lights.spheres = {SPHERES, part(spheres, 0), part(spheres, 3)};
    if (camera == nullptr) return lights;
    lights.spots = {SPOTS, part(spots, 0), part(spots, 3), part(spots, 4), part(spots, 7)};
    lights.boxes = {BOXES, part(boxes, 0), part(boxes, 3), part(boxes, 4), part(boxes, 7), {}};
    return lights;
}

/// What is made of a grid.
void write_uses(const lightbin_grid& grid) {
    const lightbin_format format = {sizeof format, LIGHTBIN_SENTINEL, LIGHTBIN_U32, 1};  // no element is left as it was
    auto encoded = sized<lightbin_encoded>();
    succeed(lightbin_encode(&grid, &format, nullptr, 0, &encoded));
    std::vector<char> out(encoded.bytes);
    succeed(lightbin_encode(&grid, &format, out.data(), out.size(), &encoded));
    write_block(out.data(), out.size());
    write_numbers({encoded.tiles_cut, static_cast<std::uint32_t>(encoded.entries_cut), encoded.capacity_needed});
}

void write_masks(const lightbin_masks& masks) {
    write_numbers({masks.lights, masks.rejected, masks.culled, masks.first_spot, masks.first_box, masks.mask_words});
    write_block(masks.words, masks.word_count * sizeof *masks.words);
    write_block(masks.ids, masks.id_count * sizeof *masks.ids);
    write_block(masks.bins, masks.bin_count * sizeof *masks.bins);
}

/// The text of a frame, of which lists or masks are given.
void write_dump(const lightbin_binner* binner, const lightbin_view* view, const lightbin_lights& lights,
                const lightbin_inputs& inputs, const lightbin_grid* grid, const lightbin_masks* masks) {
    std::size_t size = 0;
    const auto dump = [&](char* text) {
        return lightbin_dump(binner, view, &lights, &inputs, grid, masks, text, size, &size);
    };
    succeed(dump(nullptr));
    std::vector<char> text(size);
    succeed(dump(text.data()));
    write_block(text.data(), size - 1);
}

}  // namespace

int main(int count, char** names) {
    const double projection[16] = {1.3, 0, 0, 0, 0, 2.2, 0, 0, 0.02, 0, -1.001, -1, 0, 0, -0.2001, 0};
    const double camera[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, -1, -10, 1};
    if (count != 2 || (file = std::fopen(names[1], "wb")) == nullptr) return EXIT_FAILURE;

    fill_inputs();
    auto view_options = sized<lightbin_view_options>();
    view_options.width = WIDTH;
    view_options.height = HEIGHT;
    view_options.tile_size = TILE;
    view_options.origin = LIGHTBIN_UPPER_LEFT;
    view_options.clip_depth = LIGHTBIN_ZERO_TO_ONE;
    view_options.projection.doubles = projection;
    lightbin_view* view = nullptr;
    lightbin_slices *slices = nullptr, *wide_slices = nullptr;
    succeed(lightbin_view_create(&view_options, &view));
    succeed(lightbin_slices_exponential(17, 1.5f, 120, 0, &slices));
    succeed(lightbin_slices_exponential(17, 1.5f, 120, 0.02f, &wide_slices));
    write_block(projection, sizeof projection);
    write_block(camera, sizeof camera);
    write_block(spheres, sizeof spheres);
    write_block(spots, sizeof spots);
    write_block(boxes, sizeof boxes);
    write_block(nearest, sizeof nearest);
    write_block(farthest, sizeof farthest);
    write_block(lightbin_slices_boundaries(slices), 16 * sizeof(float));

    // Makes lists in each way that there is, in the order of module.mjs.
    auto bounds = sized<lightbin_z_bounds>();
    bounds.min = nearest;
    bounds.max = farthest;
    bounds.tiles = TILES;
    for (int number = 0; number < 2 * 2 * 2 * 3; ++number) {
        const lightbin_lights lights = lights_of(number % 2 == 1 ? camera : nullptr);
        auto options = sized<lightbin_binner_options>();
        options.ids = number / 2 % 2 == 0 ? LIGHTBIN_U32 : LIGHTBIN_U16;
        options.depth_test = number / 4 % 2;
        options.slicing = number / 8;
        auto inputs = sized<lightbin_inputs>();
        if (options.slicing != LIGHTBIN_NO_SLICING) inputs.slices = slices;
        if (options.depth_test != 0 && options.slicing != LIGHTBIN_CLUSTERS) inputs.bounds = &bounds;
        auto grid = sized<lightbin_grid>();
        lightbin_binner* binner = nullptr;
        succeed(lightbin_binner_create(&options, &binner));
        succeed(lightbin_bin(binner, view, &lights, &inputs, &grid));
        write_numbers({grid.lights, grid.rejected, grid.culled, static_cast<std::uint32_t>(grid.slices)});
        write_block(grid.ranges, grid.range_count * sizeof *grid.ranges);
        write_block(grid.ids, grid.id_count * grid.id_bytes);
        write_block(grid.order, grid.order_count * sizeof *grid.order);
        write_block(grid.bins, grid.bin_count * sizeof *grid.bins);
        write_uses(grid);
        write_dump(binner, view, lights, inputs, &grid, nullptr);
        if (options.depth_test == 0 && options.slicing != LIGHTBIN_CLUSTERS) {
            auto masks = sized<lightbin_masks>();
            succeed(lightbin_bin_masks(binner, view, &lights, &inputs, &masks));
            write_masks(masks);
            write_dump(binner, view, lights, inputs, nullptr, &masks);
        }
        lightbin_binner_destroy(binner);
    }

    // Points and depths.
    const double point[3] = {-4, 2.5, -10};
    double image[3], back[3];
    float depths[2];
    succeed(lightbin_view_project(view, point, image));
    write_block(image, sizeof image);
    succeed(lightbin_view_unproject(view, image, back));
    write_block(back, sizeof back);
    succeed(lightbin_view_depths(view, 0.25, 0.5, depths));
    write_block(depths, sizeof depths);
    write_numbers({lightbin_view_window_depth(view, image)});
    for (const float depth : {-3.0f, 1.5f, 20.0f, std::numeric_limits<float>::infinity()})
        write_numbers({lightbin_slices_at(slices, depth)});
    write_numbers({lightbin_light_range(100, 0.01f)});

    // What shaders read of views and slices.
    lightbin_grid_constants grid_constants = {};
    succeed(lightbin_get_grid_constants(view, 5, 7, &grid_constants));
    write_block(&grid_constants, sizeof grid_constants);
    lightbin_view_constants view_constants = {};
    succeed(lightbin_get_view_constants(view, 1.5f, &view_constants));
    write_block(&view_constants, sizeof view_constants);
    std::uint32_t words[17 + 3];
    succeed(lightbin_shader_slices(slices, words, 17 + 3));
    write_block(words, sizeof words);
    char text[1024];
    const std::size_t length = lightbin_view_text(view, text, sizeof text);
    if (length >= sizeof text) return EXIT_FAILURE;
    write_block(text, length);
    lightbin_edges edges[21 + 13], slabs[17];
    succeed(lightbin_shader_edges(view, edges, 21 + 13));
    write_block(edges, sizeof edges);
    succeed(lightbin_shader_slabs(slices, slabs, 17));
    write_block(slabs, sizeof slabs);
    lightbin_reduce_constants reduce = {};
    succeed(lightbin_get_reduce_constants(view, 3, 5, &reduce));
    write_block(&reduce, sizeof reduce);
    lightbin_shader* shader = nullptr;
    for (const int fragment : {0, 1}) {
        auto options = sized<lightbin_reduce_options>();
        options.language = fragment ? LIGHTBIN_ESSL_300 : LIGHTBIN_WGSL;
        options.fragment = fragment;
        options.skip_background = 1;
        succeed(lightbin_reduce_shader(&options, &shader));
        write_text(shader);
    }
    // Writes what shaders that make lists on the GPU need, and their texts.
    for (const int slicing : {LIGHTBIN_NO_SLICING, LIGHTBIN_CLUSTERS}) {
        const bool sliced = slicing != LIGHTBIN_NO_SLICING;
        const lightbin_matrix to_view = {nullptr, camera, LIGHTBIN_COLUMN_MAJOR, 0};
        auto options = sized<lightbin_cull_options>();
        options.language = LIGHTBIN_WGSL;
        options.kind = sliced ? LIGHTBIN_CULL_MIXED : LIGHTBIN_CULL_SPOT;
        options.stride = 12, options.radius = 3, options.axis = 4, options.cosine = 7;
        options.box_centre = 8, options.half_axes = 11, options.taper = 20, options.spot_stride = 13;
        options.box_stride = 21, options.spots = sliced ? 40 : 0, options.boxes = sliced ? 30 : 0;
        options.world_space = !sliced;
        options.depth_test = 1;
        options.slicing = slicing;
        auto plan = sized<lightbin_cull_plan>();
        succeed(lightbin_plan_cull(view, &options, SPOTS, 9000, sliced ? wide_slices : nullptr,
                                   sliced ? nullptr : &to_view, &plan));
        write_block(&plan.scratch_bytes, 4 * sizeof plan.scratch_bytes);
        write_block(plan.constants, sizeof plan.constants);
        for (int pass = LIGHTBIN_CULL_PROJECT; pass <= LIGHTBIN_CULL_MASKS; ++pass) {
            options.pass = pass;
            succeed(lightbin_cull_shader(&options, &shader));
            write_block(&plan.groups[pass], sizeof plan.groups[0]);
            write_text(shader);
        }
    }
    lightbin_slices_destroy(wide_slices);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
    return std::fclose(file) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
