/* SPDX-License-Identifier: MIT */
/* A program whose lightbin has plain tiles of spheres alone: that works, and options and kinds of lights that are left
 * out are refused by name. */
#include <lightbin/lightbin.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void refuses(lightbin_result result, const char* define) {
    if (result.error == LIGHTBIN_LEFT_OUT && strcmp(result.name, define) == 0) return;
    fprintf(stderr, "not refused by %s: error %d, %s\n", define, (int)result.error, result.name);
    exit(EXIT_FAILURE);
}

static void works(lightbin_result result) {
    char text[512];
    lightbin_error_text(result, text, sizeof text);
    if (result.error == LIGHTBIN_OK) return;
    fprintf(stderr, "%s\n", text);
    exit(EXIT_FAILURE);
}

static lightbin_result create(int ids, int depth_test, int slicing) {
    lightbin_binner* binner = NULL;
    const lightbin_binner_options options = {
        .size = sizeof options, .ids = ids, .depth_test = depth_test, .slicing = slicing};
    return lightbin_binner_create(&options, &binner);
}

int main(void) {
    static const float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0};
    static const float lights[8] = {0, 0, -5, 1, 0, 0, -1, 0.5f};
    static const float half_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const lightbin_view_options view_options = {
        .size = sizeof view_options, .width = 100, .height = 100, .projection = {.floats = projection}};
    lightbin_lights given = {.size = sizeof given,
                             .spheres = {.count = 1, .centre = {.first = lights}, .radius = {.first = lights + 3}}};
    lightbin_grid grid = {.size = sizeof grid};
    lightbin_view* view = NULL;
    lightbin_binner* binner = NULL;
    works(lightbin_view_create(&view_options, &view));
    works(lightbin_binner_create(NULL, &binner));
    works(lightbin_bin(binner, view, &given, NULL, &grid));
    if (grid.range_count != 16 || grid.id_count == 0) return EXIT_FAILURE;

    refuses(create(LIGHTBIN_U16, 0, 0), "LIGHTBIN_NO_U16");
    refuses(create(0, 1, 0), "LIGHTBIN_NO_DEPTH_TEST");
    refuses(create(0, 0, LIGHTBIN_CLUSTERS), "LIGHTBIN_NO_DEPTH_SLICES");
    refuses(create(0, 0, LIGHTBIN_Z_BINS), "LIGHTBIN_NO_DEPTH_SLICES");
    given.spots.count = 1;
    given.spots.centre.first = lights;
    given.spots.radius.first = lights + 3;
    given.spots.axis.first = lights + 4;
    given.spots.cosine.first = lights + 7;
    refuses(lightbin_bin(binner, view, &given, NULL, &grid), "LIGHTBIN_NO_SPOTS");
    given.spots.count = 0;
    given.boxes.count = 1;
    given.boxes.box_centre.first = lights;
    given.boxes.half_axes.first = half_axes;
    refuses(lightbin_bin(binner, view, &given, NULL, &grid), "LIGHTBIN_NO_BOXES");
    lightbin_binner_destroy(binner);
    lightbin_view_destroy(view);
    puts("every check passed");
    return EXIT_SUCCESS;
}
