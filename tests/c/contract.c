/* SPDX-License-Identifier: MIT */
/* What lightbin.h promises beyond lists: errors by name, structs of other sizes, memory that runs out.
 * This file is C99 and C++11 at once; languages.sh compiles it as each. */
#include <lightbin/lightbin.h>

#if defined(COUNTED_MEMORY)
#include "../guest/counted_new.hpp"
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                                                     \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                                  \
            ++failures;                                                                                      \
        }                                                                                                    \
    } while (0)

/* Makes a struct one with the defaults. */
#define CLEAR(given) (memset(&(given), 0, sizeof(given)), (given).size = sizeof(given))

/* Whether a result is an error and names the argument. */
static int refuses(lightbin_result result, int32_t error, const char* name) {
    char text[600];
    const size_t length = lightbin_error_text(result, text, sizeof text);
    if (result.error == error && strcmp(result.name, name) == 0 && length == strlen(text) && length > 10 &&
        strncmp(text, name, strlen(name)) == 0)
        return 1;
    fprintf(stderr, "error %d, name \"%s\": %s\n", (int)result.error, result.name, text);
    return 0;
}

/* Checks that a null pointer is refused, by the name of the argument. */
#define NEEDS(call, name) CHECK(refuses(call, LIGHTBIN_NULL_ARGUMENT, name))

/* ---- Inputs ---- */

enum {
    light_count = 300,
    box_count = 20,
    slice_count = 6,
    width = 320,
    height = 200,
    tile = 16,
    tile_count = 20 * 13
};

typedef struct Light {
    float position[3], range, axis[3], cosine;
} Light;

static float projection[16];
static Light lights_memory[light_count];
static float half_axes_memory[box_count][9];
static float bounds_memory[2][tile_count];

static void set_inputs(void) {
    const float near_plane = 0.5f, far_plane = 100.0f;
    unsigned state = 1;
    int i, j;
    projection[0] = 1;
    projection[5] = 1.5f;
    projection[10] = -(far_plane + near_plane) / (far_plane - near_plane);
    projection[11] = -1;
    projection[14] = -2 * far_plane * near_plane / (far_plane - near_plane);
    for (i = 0; i < light_count; ++i) {
        float numbers[8];
        for (j = 0; j < 8; ++j) {
            state = state * 1664525u + 1013904223u;
            numbers[j] = (float)(state >> 8) / 16777216.0f;
        }
        lights_memory[i].position[2] = -60 * numbers[2];
        lights_memory[i].position[0] = (2 * numbers[0] - 1) * (5 - lights_memory[i].position[2]);
        lights_memory[i].position[1] = (2 * numbers[1] - 1) * (5 - lights_memory[i].position[2]);
        lights_memory[i].range = 5 * numbers[3];
        lights_memory[i].axis[0] = numbers[4] - 0.5f;
        lights_memory[i].axis[1] = numbers[5] - 0.5f;
        lights_memory[i].axis[2] = numbers[6] - 0.5f;
        lights_memory[i].cosine = numbers[7];
    }
    for (i = 0; i < box_count; ++i)
        for (j = 0; j < 9; ++j)
            half_axes_memory[i][j] = (float)(j % 4 == 0) + 0.1f * (float)((i + j) % 5);
    for (i = 0; i < tile_count; ++i) {
        bounds_memory[0][i] = (float)(i % 30);
        bounds_memory[1][i] = (float)(i % 30 + 20);
    }
}

static lightbin_view_options view_options(void) {
    lightbin_view_options options;
    CLEAR(options);
    options.width = width;
    options.height = height;
    options.tile_size = tile;
    options.projection.floats = projection;
    return options;
}

static lightbin_lights lights_given(void) {
    lightbin_lights lights;
    CLEAR(lights);
    lights.spheres.count = 200;
    lights.spheres.centre.first = lights_memory[0].position;
    lights.spheres.centre.stride = sizeof(Light);
    lights.spheres.radius.first = &lights_memory[0].range;
    lights.spheres.radius.stride = sizeof(Light);
    lights.spots.count = 100;
    lights.spots.centre.first = lights_memory[200].position;
    lights.spots.centre.stride = sizeof(Light);
    lights.spots.radius.first = &lights_memory[200].range;
    lights.spots.radius.stride = sizeof(Light);
    lights.spots.axis.first = lights_memory[200].axis;
    lights.spots.axis.stride = sizeof(Light);
    lights.spots.cosine.first = &lights_memory[200].cosine;
    lights.spots.cosine.stride = sizeof(Light);
    return lights;
}

static void add_boxes(lightbin_lights* lights) {
    lights->boxes.count = box_count;
    lights->boxes.box_centre.first = lights_memory[0].position;
    lights->boxes.box_centre.stride = sizeof(Light);
    lights->boxes.half_axes.first = half_axes_memory;
    lights->boxes.half_axes.stride = sizeof half_axes_memory[0];
}

static lightbin_z_bounds bounds_given(void) {
    lightbin_z_bounds bounds;
    CLEAR(bounds);
    bounds.min = bounds_memory[0];
    bounds.max = bounds_memory[1];
    bounds.tiles = tile_count;
    return bounds;
}

static lightbin_binner_options options_given(int depth_test, int slicing) {
    lightbin_binner_options options;
    CLEAR(options);
    options.depth_test = depth_test;
    options.slicing = slicing;
    return options;
}

static lightbin_grid empty_grid(void) {
    lightbin_grid grid;
    CLEAR(grid);
    return grid;
}

/* ---- Tests ---- */

static void test_views(void) {
    lightbin_view_options options = view_options();
    lightbin_view_options larger[2], *alone;
    lightbin_view* view = NULL;
    lightbin_view_info info;
    float numbers[16];
    double point[3] = {0, 0, -1};
    float depths[2];
    char text[8] = "", line[512];
    CLEAR(info);

    NEEDS(lightbin_view_create(NULL, &view), "options");
    NEEDS(lightbin_view_create(&options, NULL), "view");
    options.size = 12;
    CHECK(refuses(lightbin_view_create(&options, &view), LIGHTBIN_WRONG_SIZE, "options"));
    options = view_options();
    options.projection.floats = NULL;
    NEEDS(lightbin_view_create(&options, &view), "options.projection");
    options = view_options();
    options.clip_depth = 2;
    CHECK(refuses(lightbin_view_create(&options, &view), LIGHTBIN_NOT_A_VALUE, "options.clip_depth"));
    options = view_options();
    options.origin = -1;
    CHECK(refuses(lightbin_view_create(&options, &view), LIGHTBIN_NOT_A_VALUE, "options.origin"));
    options = view_options();
    options.projection.layout = 3;
    CHECK(refuses(lightbin_view_create(&options, &view), LIGHTBIN_NOT_A_VALUE, "options.projection"));
    options = view_options();
    options.tile_size = -3;
    CHECK(lightbin_view_create(&options, &view).error == LIGHTBIN_TILE_SIZE_OUT_OF_RANGE);
    options = view_options();
    memcpy(numbers, projection, sizeof numbers);
    numbers[3] = 1;
    options.projection.floats = numbers;
    CHECK(lightbin_view_create(&options, &view).error >= LIGHTBIN_MATRIX_NOT_FINITE);
    CHECK(view == NULL);

    /* A struct of a later version: more members, which must be 0. */
    memset(larger, 0, sizeof larger);
    larger[0] = view_options();
    larger[0].size = sizeof larger;
    CHECK(lightbin_view_create(&larger[0], &view).error == LIGHTBIN_OK);
    larger[1].height = 1;
    CHECK(refuses(lightbin_view_update(view, &larger[0]), LIGHTBIN_WRONG_SIZE, "options"));
    /* A size of chance is not followed: nothing behind the struct is read, which the address sanitizer sees. */
    alone = (lightbin_view_options*)malloc(sizeof *alone);
    *alone = view_options();
    alone->size = 1025;
    CHECK(refuses(lightbin_view_update(view, alone), LIGHTBIN_WRONG_SIZE, "options"));
    alone->size = 0xffffffffu;
    CHECK(refuses(lightbin_view_update(view, alone), LIGHTBIN_WRONG_SIZE, "options"));
    free(alone);

    options = view_options();
    NEEDS(lightbin_view_update(NULL, &options), "view");
    options.width = 40000;
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_VIEWPORT_OUT_OF_RANGE);
    CHECK(lightbin_view_describe(view, &info).error == LIGHTBIN_OK);
    CHECK(info.width == width && info.tiles_x == 20 &&
          info.tiles_y == 13); /* as before the update that was refused */
    options = view_options();
    options.width = options.height = 0; /* forgotten, or of a minimised window: asked about */
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_OK);
    CHECK(lightbin_view_describe(view, &info).error == LIGHTBIN_OK);
    CHECK(info.viewport_empty == 1 && info.tiles_x == 0);
    lightbin_view_text(view, line, sizeof line);
    CHECK(strstr(line, "were width and height given?") != NULL);
    options = view_options();
    options.tile_size = 0;
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_OK);
    CHECK(lightbin_view_describe(view, &info).error == LIGHTBIN_OK);
    CHECK(info.tile_size == 32 && info.size == sizeof info && info.viewport_empty == 0);
    CHECK(info.turned == 0);
    options.columns = 16;
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_TILE_COUNT_OUT_OF_RANGE);
    options.rows = 9;
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_OK);
    CHECK(lightbin_view_describe(view, &info).error == LIGHTBIN_OK);
    CHECK(info.tile_size == 0 && info.tiles_x == 16 && info.tiles_y == 9);
    options.max_tiles = 1;
    CHECK(lightbin_view_update(view, &options).error == LIGHTBIN_OK);
    CHECK(lightbin_view_describe(view, &info).error == LIGHTBIN_OK);
    CHECK(info.tiles_x == 1 && info.tiles_y == 1);
    NEEDS(lightbin_view_describe(NULL, &info), "view");
    NEEDS(lightbin_view_describe(view, NULL), "info");
    CHECK(lightbin_view_text(view, text, sizeof text) > 40 && strcmp(text, "perspec") == 0);
    CHECK(lightbin_view_text(NULL, text, sizeof text) == 0);
    NEEDS(lightbin_view_project(view, NULL, point), "point");
    NEEDS(lightbin_view_unproject(view, point, NULL), "point");
    NEEDS(lightbin_view_depths(NULL, 0, 1, depths), "view");
    CHECK(isnan(lightbin_view_window_depth(NULL, point)));
    lightbin_view_destroy(view);
    lightbin_view_destroy(NULL);
}

static void test_slices(void) {
    lightbin_slices* slices = NULL;
    const float boundaries[3] = {1, 2, 2};
    CHECK(lightbin_slices_exponential(0, 1, 2, 0, &slices).error == LIGHTBIN_NO_SLICES);
    CHECK(lightbin_slices_linear(3, 2, 1, 0, &slices).error == LIGHTBIN_SLICE_RANGE_EMPTY);
    CHECK(lightbin_slices_from_boundaries(boundaries, 3, 0, &slices).error ==
          LIGHTBIN_SLICES_DO_NOT_ASCEND);
    NEEDS(lightbin_slices_from_boundaries(NULL, 3, 0, &slices), "boundaries");
    CHECK(refuses(lightbin_slices_from_boundaries(boundaries, 2, 0.6f, &slices), LIGHTBIN_NOT_A_VALUE,
                  "margin"));
    NEEDS(lightbin_slices_linear(3, 1, 2, 0, NULL), "slices");
    CHECK(slices == NULL);
    CHECK(lightbin_slices_from_boundaries(NULL, 0, 0, &slices).error == LIGHTBIN_OK);
    CHECK(lightbin_slices_count(slices) == 1 && lightbin_slices_at(slices, 9) == 0);
    CHECK(lightbin_slices_count(NULL) == 0 && lightbin_slices_boundaries(NULL) == NULL);
    lightbin_slices_destroy(slices);
    lightbin_slices_destroy(NULL);
}

static void test_binners(void) {
    lightbin_view_options view_given = view_options();
    lightbin_binner_options options = options_given(0, LIGHTBIN_NO_SLICING);
    lightbin_lights lights = lights_given();
    lightbin_grid grid = empty_grid();
    lightbin_inputs inputs;
    lightbin_z_bounds bounds = bounds_given();
    lightbin_binner *binner = NULL, *boxes = NULL;
    lightbin_view* view = NULL;
    lightbin_slices* slices = NULL;
    float not_affine[16];
    double eye[3];
    CLEAR(inputs);
    memset(not_affine, 0, sizeof not_affine);
    memset(eye, 0xff, sizeof eye); /* three NaNs */

    NEEDS(lightbin_binner_create(NULL, NULL), "binner");
    options.ids = LIGHTBIN_U8;
    CHECK(refuses(lightbin_binner_create(&options, &binner), LIGHTBIN_NOT_A_VALUE, "options.ids"));
    options = options_given(1, 3);
    CHECK(refuses(lightbin_binner_create(&options, &binner), LIGHTBIN_NOT_A_VALUE, "options.slicing"));
    CHECK(binner == NULL);
    options = options_given(1, LIGHTBIN_NO_SLICING);
    CHECK(lightbin_binner_create(NULL, &binner).error == LIGHTBIN_OK);
    CHECK(lightbin_binner_create(&options, &boxes).error == LIGHTBIN_OK);
    CHECK(lightbin_view_create(&view_given, &view).error == LIGHTBIN_OK);
    CHECK(lightbin_slices_linear(3, 1, 9, 0, &slices).error == LIGHTBIN_OK);

    NEEDS(lightbin_bin(NULL, view, &lights, NULL, &grid), "binner");
    NEEDS(lightbin_bin(binner, NULL, &lights, NULL, &grid), "view");
    NEEDS(lightbin_bin(binner, view, NULL, NULL, &grid), "lights");
    NEEDS(lightbin_bin(binner, view, &lights, NULL, NULL), "grid");
    grid.size = 4;
    CHECK(refuses(lightbin_bin(binner, view, &lights, NULL, &grid), LIGHTBIN_WRONG_SIZE, "grid"));
    grid = empty_grid();
    lights.spheres.radius.first = NULL;
    NEEDS(lightbin_bin(binner, view, &lights, NULL, &grid), "lights.spheres.radius");
    lights = lights_given();
    lights.spots.axis.stride = 8;
    CHECK(refuses(lightbin_bin(binner, view, &lights, NULL, &grid), LIGHTBIN_STRIDE_TOO_SMALL,
                  "lights.spots.axis"));
    lights = lights_given();
    add_boxes(&lights);
    lights.boxes.half_axes.stride = 32;
    CHECK(refuses(lightbin_bin(binner, view, &lights, NULL, &grid), LIGHTBIN_STRIDE_TOO_SMALL,
                  "lights.boxes.half_axes"));
    lights = lights_given();
    add_boxes(&lights);
    lights.boxes.radius.first = lights_memory;
    NEEDS(lightbin_bin(binner, view, &lights, NULL, &grid), "lights.boxes.centre");
    lights = lights_given();
    lights.view_matrix.floats = not_affine;
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_VIEW_MATRIX_NOT_AFFINE);
    CHECK(grid.ranges == NULL);
    lights.eye = eye;
    lights.view_matrix.floats = NULL;
    NEEDS(lightbin_bin(binner, view, &lights, NULL, &grid), "lights.view_matrix");
    lights.view_matrix.floats = projection;
    lights.spots.centre.stride = 23;
    CHECK(refuses(lightbin_bin(binner, view, &lights, NULL, &grid), LIGHTBIN_STRIDE_TOO_SMALL,
                  "lights.spots.centre"));
    lights.spheres.count = lights.spots.count = 0;
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_EYE_NOT_FINITE);
    lights = lights_given();
    inputs.slices = slices;
    CHECK(refuses(lightbin_bin(binner, view, &lights, &inputs, &grid), LIGHTBIN_NOT_READ, "inputs.slices"));
    inputs.slices = NULL;
    inputs.bounds = &bounds;
    CHECK(refuses(lightbin_bin(binner, view, &lights, &inputs, &grid), LIGHTBIN_NOT_READ, "inputs.bounds"));
    CHECK(
        refuses(lightbin_bin(boxes, view, &lights, NULL, &grid), LIGHTBIN_NO_BOUNDS_GIVEN, "inputs.bounds"));
    bounds.tiles = 7;
    CHECK(lightbin_bin(boxes, view, &lights, &inputs, &grid).error == LIGHTBIN_Z_BOUNDS_TOO_SMALL);
    bounds = bounds_given();
    CHECK(lightbin_bin(boxes, view, &lights, &inputs, &grid).error == LIGHTBIN_OK);

    /* Encodings. */
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_OK);
    CHECK(grid.range_count == tile_count && grid.id_count > 0 && grid.lights == light_count);
    {
        lightbin_format format;
        lightbin_encoded encoded;
        char out[9];
        memset(&format, 0, sizeof format);
        CLEAR(encoded);
        CHECK(refuses(lightbin_encode(&grid, &format, NULL, 0, &encoded), LIGHTBIN_WRONG_SIZE, "format"));
        format.size = sizeof format;
        format.ids = 3;
        CHECK(refuses(lightbin_encode(&grid, &format, NULL, 0, &encoded), LIGHTBIN_NOT_A_VALUE, "format"));
        format.ids = LIGHTBIN_U8;
        format.encoding = LIGHTBIN_SENTINEL;
        CHECK(lightbin_encode(&grid, &format, NULL, 0, &encoded).error == LIGHTBIN_CAPACITY_UNKNOWN);
        format.capacity = 4;
        CHECK(lightbin_encode(&grid, &format, NULL, 0, &encoded).error == LIGHTBIN_OK);
        CHECK(encoded.bytes == 4 * tile_count && encoded.capacity_needed == 0);
        CHECK(lightbin_encode(&grid, &format, out, sizeof out, &encoded).error == LIGHTBIN_LIST_BUFFER_TOO_SMALL);
        grid.id_bytes = 3;
        CHECK(refuses(lightbin_encode(&grid, &format, NULL, 0, &encoded), LIGHTBIN_NOT_A_VALUE,
                      "grid.id_bytes"));
    }

    /* No lights are no error. */
    CLEAR(lights);
    grid = empty_grid();
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_OK);
    CHECK(grid.range_count == tile_count && grid.id_count == 0);
    lightbin_binner_destroy(binner);
    lightbin_binner_destroy(boxes);
    lightbin_binner_destroy(NULL);
    lightbin_view_destroy(view);
    lightbin_slices_destroy(slices);
}

/* Masks of columns and rows, and the text of a frame, as far as they are refused. */
static void test_masks(void) {
    lightbin_view_options view_given = view_options();
    lightbin_binner_options options = options_given(0, LIGHTBIN_NO_SLICING);
    lightbin_lights lights = lights_given();
    lightbin_inputs inputs;
    lightbin_z_bounds bounds = bounds_given();
    lightbin_masks masks;
    lightbin_binner *binner = NULL, *refused = NULL;
    lightbin_view* view = NULL;
    lightbin_slices* slices = NULL;
    char text[9] = "x";
    size_t size = 0;
    int test, slicing;
    CLEAR(inputs);
    CLEAR(masks);
    CHECK(lightbin_view_create(&view_given, &view).error == LIGHTBIN_OK);
    CHECK(lightbin_binner_create(NULL, &binner).error == LIGHTBIN_OK);
    CHECK(lightbin_slices_linear(3, 1, 9, 0, &slices).error == LIGHTBIN_OK);
    NEEDS(lightbin_bin_masks(NULL, view, &lights, NULL, &masks), "binner");
    NEEDS(lightbin_bin_masks(binner, NULL, &lights, NULL, &masks), "view");
    NEEDS(lightbin_bin_masks(binner, view, NULL, NULL, &masks), "lights");
    NEEDS(lightbin_bin_masks(binner, view, &lights, NULL, NULL), "masks");
    inputs.bounds = &bounds;
    CHECK(refuses(lightbin_bin_masks(binner, view, &lights, &inputs, &masks), LIGHTBIN_NOT_READ,
                  "inputs.bounds"));
    inputs.bounds = NULL;
    inputs.slices = slices;
    CHECK(refuses(lightbin_bin_masks(binner, view, &lights, &inputs, &masks), LIGHTBIN_NOT_READ,
                  "inputs.slices"));
    for (test = 0; test <= 1; ++test)
        for (slicing = LIGHTBIN_NO_SLICING; slicing <= LIGHTBIN_Z_BINS; ++slicing) {
            if (test == 0 && slicing != LIGHTBIN_CLUSTERS) continue;
            options = options_given(test, slicing);
            CHECK(lightbin_binner_create(&options, &refused).error == LIGHTBIN_OK);
            CHECK(lightbin_bin_masks(refused, view, &lights, &inputs, &masks).error ==
                  LIGHTBIN_NO_SUCH_SLICING_SHADER);
            lightbin_binner_destroy(refused);
        }
    CHECK(masks.words == NULL);
    inputs.slices = NULL;
    CHECK(lightbin_bin_masks(binner, view, &lights, &inputs, &masks).error == LIGHTBIN_OK);
    NEEDS(lightbin_dump(NULL, view, &lights, NULL, NULL, &masks, NULL, 0, &size), "binner");
    NEEDS(lightbin_dump(binner, NULL, &lights, NULL, NULL, &masks, NULL, 0, &size), "view");
    NEEDS(lightbin_dump(binner, view, NULL, NULL, NULL, &masks, NULL, 0, &size), "lights");
    NEEDS(lightbin_dump(binner, view, &lights, NULL, NULL, NULL, NULL, 0, &size), "grid");
    CHECK(lightbin_dump(binner, view, &lights, NULL, NULL, &masks, NULL, 0, &size).error == LIGHTBIN_OK);
    CHECK(size > 300);
    CHECK(refuses(lightbin_dump(binner, view, &lights, NULL, NULL, &masks, text, sizeof text, NULL),
                  LIGHTBIN_BUFFER_TOO_SMALL, "text"));
    CHECK(text[0] == 'x'); /* it is all or nothing */
    masks.words = NULL;
    NEEDS(lightbin_dump(binner, view, &lights, NULL, NULL, &masks, NULL, 0, &size), "masks.words");
    lightbin_binner_destroy(binner);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
}

/* Shaders that read lists. */
static void test_snippet(void) {
    lightbin_snippet_options options;
    lightbin_shader* shader = NULL;
    CLEAR(options);
    NEEDS(lightbin_shader_snippet(NULL, &shader), "options");
    NEEDS(lightbin_shader_snippet(&options, NULL), "shader");
    options.masks = 1;
    options.slicing = LIGHTBIN_CLUSTERS;
    CHECK(lightbin_shader_snippet(&options, &shader).error == LIGHTBIN_NO_SUCH_SLICING_SHADER);
    options.masks = 0;
    options.tile_size = -1;
    CHECK(lightbin_shader_snippet(&options, &shader).error == LIGHTBIN_TILE_SIZE_OUT_OF_RANGE);
    CHECK(shader == NULL);
}

/* The shaders that make grids on the GPU of lights there, and their plans. */
static void test_cull(void) {
    lightbin_view_options view_given = view_options();
    lightbin_cull_options options;
    lightbin_cull_plan plan;
    lightbin_matrix to_view;
    lightbin_view* view = NULL;
    lightbin_slices* slices = NULL;
    lightbin_shader* shader = NULL;
    float distorts[16];
    CLEAR(options);
    CLEAR(plan);
    memset(&to_view, 0, sizeof to_view);
    memset(distorts, 0, sizeof distorts);
    distorts[0] = 100;
    distorts[5] = distorts[10] = distorts[15] = 1;
    options.language = LIGHTBIN_GLSL_430;
    CHECK(lightbin_view_create(&view_given, &view).error == LIGHTBIN_OK);
    CHECK(lightbin_slices_linear(65536, 1, 2000, 0, &slices).error == LIGHTBIN_OK);

    NEEDS(lightbin_cull_shader(NULL, &shader), "options");
    NEEDS(lightbin_cull_shader(&options, NULL), "shader");
    options.pass = 6;
    CHECK(refuses(lightbin_cull_shader(&options, &shader), LIGHTBIN_NOT_A_VALUE, "options.pass"));
    options.pass = LIGHTBIN_CULL_FILL;
    options.kind = 4;
    CHECK(refuses(lightbin_cull_shader(&options, &shader), LIGHTBIN_NOT_A_VALUE, "options.kind"));
    options.kind = LIGHTBIN_CULL_SPOT;
    options.ids = 3;
    CHECK(refuses(lightbin_cull_shader(&options, &shader), LIGHTBIN_NOT_A_VALUE, "options.ids"));
    options.ids = LIGHTBIN_U8;
    CHECK(lightbin_cull_shader(&options, &shader).error == LIGHTBIN_IDS_TOO_NARROW);
    options.ids = LIGHTBIN_U16;
    options.language = LIGHTBIN_ESSL_300;
    CHECK(lightbin_cull_shader(&options, &shader).error == LIGHTBIN_NO_STORAGE_BUFFERS);
    options.language = LIGHTBIN_GLSL_430;
    options.size = 20;
    CHECK(refuses(lightbin_cull_shader(&options, &shader), LIGHTBIN_WRONG_SIZE, "options"));
    options.size = sizeof options;
    CHECK(shader == NULL);
    CHECK(lightbin_cull_shader(&options, &shader).error == LIGHTBIN_OK);
    lightbin_shader_destroy(shader);

    NEEDS(lightbin_plan_cull(NULL, &options, 9, 9, NULL, NULL, &plan), "view");
    NEEDS(lightbin_plan_cull(view, NULL, 9, 9, NULL, NULL, &plan), "options");
    NEEDS(lightbin_plan_cull(view, &options, 9, 9, NULL, NULL, NULL), "plan");
    CHECK(
        refuses(lightbin_plan_cull(view, &options, 9, 9, slices, NULL, &plan), LIGHTBIN_NOT_READ, "slices"));
    CHECK(refuses(lightbin_plan_cull(view, &options, 9, 9, NULL, &to_view, &plan), LIGHTBIN_NOT_READ,
                  "to_view"));
    CHECK(lightbin_plan_cull(view, &options, 65537, 9, NULL, NULL, &plan).error == LIGHTBIN_TOO_MANY_LIGHTS);
    options.kind = LIGHTBIN_CULL_MIXED;
    options.spots = options.boxes = 30000;
    CHECK(lightbin_plan_cull(view, &options, 5537, 9, NULL, NULL, &plan).error == LIGHTBIN_TOO_MANY_LIGHTS);
    options.ids = LIGHTBIN_U32;
    CHECK(lightbin_plan_cull(view, &options, 0xffffffffu, 9, NULL, NULL, &plan).error == LIGHTBIN_TOO_MANY_LIGHTS);
    options.ids = LIGHTBIN_U16;
    options.kind = LIGHTBIN_CULL_SPOT;
    options.slicing = LIGHTBIN_Z_BINS;
    CHECK(lightbin_plan_cull(view, &options, 9, 9, slices, NULL, &plan).error == LIGHTBIN_NO_SUCH_SLICING_SHADER);
    options.slicing = LIGHTBIN_CLUSTERS;
    NEEDS(lightbin_plan_cull(view, &options, 9, 9, NULL, NULL, &plan), "slices");
    CHECK(lightbin_plan_cull(view, &options, 9, 9, slices, NULL, &plan).error == LIGHTBIN_TOO_MANY_SLICES);
    lightbin_slices_destroy(slices);
    CHECK(lightbin_slices_linear(1025, 1, 2000, 0, &slices).error == LIGHTBIN_OK);
    options.ids = LIGHTBIN_U32;
    CHECK(lightbin_plan_cull(view, &options, 0xffffffffu, 9, slices, NULL, &plan).error ==
          LIGHTBIN_SCRATCH_TOO_LARGE);
    options.slicing = LIGHTBIN_NO_SLICING;
    options.world_space = 1;
    NEEDS(lightbin_plan_cull(view, &options, 9, 9, NULL, NULL, &plan), "to_view");
    NEEDS(lightbin_plan_cull(view, &options, 9, 9, NULL, &to_view, &plan), "to_view");
    to_view.floats = distorts;
    CHECK(lightbin_plan_cull(view, &options, 9, 9, NULL, &to_view, &plan).error ==
          LIGHTBIN_VIEW_MATRIX_DISTORTS);
    plan.size = 8;
    CHECK(refuses(lightbin_plan_cull(view, &options, 9, 9, NULL, &to_view, &plan), LIGHTBIN_WRONG_SIZE,
                  "plan"));
    plan.size = sizeof plan;
    CHECK(plan.scratch_bytes == 0 && plan.constants[0] == 0);
    distorts[0] = 1;
    CHECK(lightbin_plan_cull(view, &options, 9, 1000, NULL, &to_view, &plan).error == LIGHTBIN_OK);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
}

/* Everything once. Returns the first error. */
static lightbin_result use_everything(uint64_t* sum) {
    lightbin_view_options view_given = view_options();
    lightbin_snippet_options snippet;
    lightbin_lights lights = lights_given();
    lightbin_z_bounds bounds = bounds_given();
    lightbin_view* view = NULL;
    lightbin_slices* slices = NULL;
    lightbin_shader* shader = NULL;
    lightbin_result result;
    int test, slicing;
    *sum = 0;
    add_boxes(&lights);
    CLEAR(snippet);
    snippet.language = LIGHTBIN_WGSL;
    result = lightbin_view_create(&view_given, &view);
    if (result.error == LIGHTBIN_OK)
        result = lightbin_slices_exponential(slice_count, 2, 50, 0.01f, &slices);
    if (result.error == LIGHTBIN_OK) result = lightbin_shader_snippet(&snippet, &shader);
    for (test = 0; test <= 1; ++test)
        for (slicing = LIGHTBIN_NO_SLICING; slicing <= LIGHTBIN_Z_BINS; ++slicing) {
            lightbin_binner_options options = options_given(test, slicing);
            lightbin_binner* binner = NULL;
            lightbin_inputs inputs;
                    lightbin_grid grid = empty_grid();
            uint64_t i;
            CLEAR(inputs);
            if (slicing != LIGHTBIN_NO_SLICING) inputs.slices = slices;
            if (test != 0 && slicing != LIGHTBIN_CLUSTERS) inputs.bounds = &bounds;
            if (result.error == LIGHTBIN_OK) result = lightbin_binner_create(&options, &binner);
            if (result.error == LIGHTBIN_OK) {
                result = lightbin_bin(binner, view, &lights, &inputs, &grid);
                if (result.error == LIGHTBIN_OUT_OF_MEMORY) { /* the next call is right */
                    const lightbin_result next = lightbin_bin(binner, view, &lights, &inputs, &grid);
                    CHECK(next.error == LIGHTBIN_OK);
                    if (next.error == LIGHTBIN_OK)
                        CHECK(grid.id_count > 0 && grid.lights == light_count + box_count);
                }
            }
            for (i = 0; result.error == LIGHTBIN_OK && i < grid.id_count; ++i)
                *sum = *sum * 31 + ((const uint32_t*)grid.ids)[i];
            if (result.error == LIGHTBIN_OK && test == 0 && slicing != LIGHTBIN_CLUSTERS) {
                lightbin_masks masks;
                CLEAR(masks);
                result = lightbin_bin_masks(binner, view, &lights, &inputs, &masks);
                if (result.error == LIGHTBIN_OUT_OF_MEMORY)
                    CHECK(lightbin_bin_masks(binner, view, &lights, &inputs, &masks).error == LIGHTBIN_OK);
                for (i = 0; i < masks.word_count; ++i)
                    *sum = *sum * 31 + masks.words[i];
            }
            lightbin_binner_destroy(binner);
        }
    lightbin_shader_destroy(shader);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
    return result;
}

#if defined(COUNTED_MEMORY) /* linked with counted_new.cpp, in C++ */
static void test_memory(void) {
    const size_t before = allocations;
    const long kept = blocks;
    uint64_t expected = 0, sum = 0;
    size_t calls, at;
    lightbin_view_options view_given = view_options();
    lightbin_lights lights = lights_given();
    lightbin_grid grid = empty_grid();
    lightbin_masks masks;
    lightbin_view* view = NULL;
    lightbin_binner* binner = NULL;
    CLEAR(masks);
    CHECK(use_everything(&expected).error == LIGHTBIN_OK);
    CHECK(blocks == kept); /* nothing leaks */
    calls = allocations - before;
    CHECK(calls > 50);
    for (at = 1; at <= calls; ++at) {
        const int before_this = failures;
        allocations_left = at;
        CHECK(use_everything(&sum).error == LIGHTBIN_OUT_OF_MEMORY);
        CHECK(blocks == kept && allocations_left == 0);
        if (failures != before_this) {
            fprintf(stderr, "when allocation %ld of %ld fails\n", (long)at, (long)calls);
            break;
        }
    }
    CHECK(use_everything(&sum).error == LIGHTBIN_OK && sum == expected);

    /* No allocation once warm. */
    CHECK(lightbin_view_create(&view_given, &view).error == LIGHTBIN_OK);
    CHECK(lightbin_binner_create(NULL, &binner).error == LIGHTBIN_OK);
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_OK);
    CHECK(lightbin_bin_masks(binner, view, &lights, NULL, &masks).error == LIGHTBIN_OK);
    calls = allocations;
    CHECK(lightbin_bin(binner, view, &lights, NULL, &grid).error == LIGHTBIN_OK);
    CHECK(lightbin_bin_masks(binner, view, &lights, NULL, &masks).error == LIGHTBIN_OK);
    CHECK(lightbin_view_update(view, &view_given).error == LIGHTBIN_OK);
    CHECK(allocations == calls);
    lightbin_binner_destroy(binner);
    lightbin_view_destroy(view);
}
#endif

int main(void) {
    uint64_t sum = 0;
    char text[4] = "abc";
    lightbin_result unknown = {99, 0, NULL, 0, 0};
    set_inputs();
    CHECK(lightbin_version() > 0);
    CHECK(lightbin_error_text(unknown, NULL, 0) == strlen("unknown error"));
    CHECK(lightbin_error_text(unknown, text, 3) == strlen("unknown error") && strcmp(text, "un") == 0);
    test_views();
    test_slices();
    test_binners();
    test_masks();
    test_snippet();
    test_cull();
    CHECK(use_everything(&sum).error == LIGHTBIN_OK && sum != 0);
#if defined(COUNTED_MEMORY)
    test_memory();
#endif
    if (failures == 0) puts("every check passed");
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
