/* SPDX-License-Identifier: MIT */
/* Stability: settled, also for programs that are not compiled again; but what begins with lightbin_cull,
 * lightbin_plan_cull or lightbin_reduce may change.
 *
 * lightbin for C99, every C++ and whatever language calls C. Header-only: in one file of the program, compiled as
 * C++20,
 *
 *     #define LIGHTBIN_IMPLEMENTATION
 *     #include <lightbin/lightbin.h>
 *
 * and everywhere else the include alone. docs/c.md has a whole program.
 *
 * What it does: a renderer gives it a camera and its lights each frame. The screen is divided into tiles, squares of
 * pixels. The library returns for each tile the list of the lights that can reach what is seen there, in two arrays
 * that are ready to be uploaded to the GPU, and it writes shader code that reads them. No light is ever missed. The C++
 * headers beside this one have the same library for C++20; the same input gives the same bytes.
 *
 *     lightbin_view_create()    once for each camera          lightbin_view_update()  when it changes
 *     lightbin_binner_create()  once                          lightbin_bin()          each frame
 *     lightbin_shader_snippet() once for each shader
 *
 * Words
 *   View space    the space that the projection matrix is applied to, with the eye at the origin
 *   View depth    the distance of a point from the eye along the viewing direction: positive in front of the eye
 *   Window depth  what a depth buffer holds, from 0 to 1
 *   Cell          a tile or, if the view depths are divided into slices, a tile in one slice
 *   Entry         a light in the list of one cell
 *
 * Conventions that hold for every function
 *   Results   A function that can refuse its input returns a lightbin_result. It worked if result.error is LIGHTBIN_OK;
 *             lightbin_error_text() writes a sentence. After an error nothing was written to the caller's memory and no
 *             handle was made or changed, unless the function says otherwise; the next call works as usual. Any
 *             function may return LIGHTBIN_OUT_OF_MEMORY, LIGHTBIN_NULL_ARGUMENT, LIGHTBIN_WRONG_SIZE,
 *             LIGHTBIN_LEFT_OUT and LIGHTBIN_NOT_A_VALUE; comments list all others.
 *   Structs   A struct whose first member is `size` is passed with size = sizeof of the struct, and all members that
 *             are not set must be 0, which is the default of each. Later versions add members at the end. A struct that
 *             is newer than the library works as long as the members that the library does not know are 0. No struct
 *             will have more than 1,024 bytes: a greater `size` is refused, as that of a struct that was not set up.
 *   Enums     Members of structs that hold an enum's value have the type int32_t, so that their size is the same for
 *             all compilers and languages. A number that is no value of the enum is refused.
 *   Handles   A handle, such as a lightbin_view, is made by functions whose comments name the one that frees it. That
 *             one ends in _destroy, and accepts a null pointer. Different handles may be used on different threads at
 *             the same time; one handle may be used by one thread at a time, except that a view or slices may be read
 *             by several calls at once.
 *   Pointers  Null where something is needed, and sizes too small, are refused; lightbin_result.name says which. Memory
 *             to be written must not overlap other memory of the call. Pointers are not kept after the call.
 *   Memory    All memory is of C++'s operator new, which a program may replace: docs/c.md says how. Handles keep theirs
 *             for the next call, so that calls allocate nothing once warm. If memory runs out, the error is
 *             LIGHTBIN_OUT_OF_MEMORY; a library that is compiled without exceptions ends the program by abort().
 */
#ifndef LIGHTBIN_LIGHTBIN_H
#define LIGHTBIN_LIGHTBIN_H

#include <stddef.h>
#include <stdint.h>

/* LIGHTBIN_API: how the functions are declared. Define LIGHTBIN_SHARED to use lightbin as a shared library, and
 * LIGHTBIN_BUILD_SHARED, too, in the file that implements it. */
#if defined(LIGHTBIN_API)
#elif !defined(LIGHTBIN_SHARED)
#define LIGHTBIN_API
#elif !defined(_WIN32)
#define LIGHTBIN_API __attribute__((visibility("default")))
#elif defined(LIGHTBIN_BUILD_SHARED)
#define LIGHTBIN_API __declspec(dllexport)
#else
#define LIGHTBIN_API __declspec(dllimport)
#endif

#if defined(__cplusplus)
extern "C" {
#endif

/* ---- Results ---- */

/* Why a call was refused. Values are never given to another error; new ones are added. From 100 on they are the causes
 * that the C++ side has, in ErrorCode of error_code.hpp. */
typedef enum lightbin_error {
    LIGHTBIN_OK = 0,
    LIGHTBIN_OUT_OF_MEMORY = 1,
    LIGHTBIN_NULL_ARGUMENT = 2,    /* a pointer that the call needs is null */
    LIGHTBIN_WRONG_SIZE = 3,       /* a struct's `size` is not that of a version that the library knows */
    LIGHTBIN_LEFT_OUT = 4,         /* compiled without this option or kind of lights, see docs/c.md */
    LIGHTBIN_NOT_A_VALUE = 5,      /* a number that is no value of its enum, or outside of its range */
    LIGHTBIN_STRIDE_TOO_SMALL = 6, /* a stride is less than the element that it steps over */
    LIGHTBIN_NO_SLICES_GIVEN = 7,  /* the binner's options read slices */
    LIGHTBIN_NO_BOUNDS_GIVEN = 8,  /* the binner's options read Z bounds */
    LIGHTBIN_NOT_READ = 9,         /* slices, Z bounds or a matrix were given that the options do not read */
    LIGHTBIN_BUFFER_TOO_SMALL = 10,

    LIGHTBIN_MATRIX_NOT_FINITE = 100,
    LIGHTBIN_NOT_A_PROJECTION = 101,
    LIGHTBIN_PROJECTION_TRANSPOSED = 102,
    LIGHTBIN_EYE_NOT_AT_ORIGIN = 103,
    LIGHTBIN_IMAGE_AXES_ROTATED = 104,
    LIGHTBIN_LOOKS_ALONG_X = 105,
    LIGHTBIN_LOOKS_ALONG_Y = 106,
    LIGHTBIN_NO_NEAR_PLANE = 107,
    LIGHTBIN_NEAR_PLANE_TOO_CLOSE = 108,
    LIGHTBIN_DEPTH_RANGE_NOT_FINITE = 109,
    LIGHTBIN_DEGENERATE_SCALE = 110,
    LIGHTBIN_IMAGE_OFFSET_OUT_OF_RANGE = 111,
    LIGHTBIN_VIEWPORT_OUT_OF_RANGE = 112,
    LIGHTBIN_TILE_SIZE_OUT_OF_RANGE = 113,
    LIGHTBIN_TILE_COUNT_OUT_OF_RANGE = 114,
    LIGHTBIN_VIEW_MATRIX_NOT_AFFINE = 115,
    LIGHTBIN_VIEW_MATRIX_TRANSPOSED = 116,
    LIGHTBIN_TOO_MANY_LIGHTS = 117,
    LIGHTBIN_TOO_MANY_ENTRIES = 118,
    LIGHTBIN_TOO_MANY_PAIRS = 119,
    LIGHTBIN_RANGE_BUFFER_TOO_SMALL = 120, /* in C++ alone */
    LIGHTBIN_ID_BUFFER_TOO_SMALL = 121,    /* in C++ alone */
    LIGHTBIN_GRIDS_DIFFER = 122,           /* in C++ alone */
    LIGHTBIN_Z_BOUNDS_TOO_SMALL = 123,
    LIGHTBIN_DEPTH_BUFFER_TOO_SMALL = 124, /* in C++ alone */
    LIGHTBIN_SAMPLES_OUT_OF_RANGE = 125,
    LIGHTBIN_ROW_PITCH_TOO_SMALL = 126, /* in C++ alone */
    LIGHTBIN_NO_SLICES = 127,
    LIGHTBIN_SLICE_RANGE_EMPTY = 128,
    LIGHTBIN_SLICES_DO_NOT_ASCEND = 129,
    LIGHTBIN_TOO_MANY_CELLS = 130,
    LIGHTBIN_TOO_FEW_WEIGHTS = 131,        /* in C++ alone */
    LIGHTBIN_LIGHT_BUFFER_TOO_SMALL = 132, /* in C++ alone */
    LIGHTBIN_IDS_TOO_NARROW = 133,
    LIGHTBIN_LIST_BUFFER_TOO_SMALL = 134,
    LIGHTBIN_CAPACITY_UNKNOWN = 135,
    LIGHTBIN_BLOCK_SIZE_UNKNOWN = 136,
    LIGHTBIN_UNIFORM_BLOCK_TOO_SMALL = 137,
    LIGHTBIN_NO_STORAGE_BUFFERS = 138,
    LIGHTBIN_NO_TEXEL_BUFFERS = 139,
    LIGHTBIN_SLOT_OUT_OF_RANGE = 140,
    LIGHTBIN_VIEWS_OUT_OF_RANGE = 141,
    LIGHTBIN_NO_SETS = 142,
    LIGHTBIN_NO_PUSH_CONSTANTS = 143,
    LIGHTBIN_NO_MULTISAMPLE_TEXTURES = 144,
    LIGHTBIN_NO_SUCH_SLICING_SHADER = 145,
    LIGHTBIN_NO_WAVE_OPERATIONS = 146,
    LIGHTBIN_TEXTURE_WIDTH_OUT_OF_RANGE = 147,
    LIGHTBIN_BINDINGS_OVERLAP = 148,
    LIGHTBIN_NOT_A_PREFIX = 149,
    LIGHTBIN_TOO_MANY_SLICES = 150,
    LIGHTBIN_VIEW_MATRIX_DISTORTS = 151,
    LIGHTBIN_SCRATCH_TOO_LARGE = 152,
    LIGHTBIN_EYE_NOT_FINITE = 153,

    LIGHTBIN_ERROR_32_BITS = 0x7fffffff /* no error: makes the enum as wide as int32_t */
} lightbin_error;

/* What a call returns. The numbers are those of Error in result.hpp: the size that was needed and the one that there
 * was, or the number given and the greatest one allowed. */
typedef struct lightbin_result {
    int32_t error; /* a lightbin_error */
    int32_t unused;
    /* The parameter or member that was refused, such as "lights.spheres.centre", or an empty text */
    const char* name;
    uint64_t needed;
    uint64_t available;
} lightbin_result;

/* Writes an English sentence that names the cause and a remedy, and a 0 after it. Returns the number of characters of
 * the whole sentence; what exceeds capacity - 1 characters is not written. Sentences have less than 512 characters.
 *
 * text  `capacity` characters; may be null if capacity is 0 */
LIGHTBIN_API size_t lightbin_error_text(lightbin_result result, char* text, size_t capacity);

/* Returns the version of the library that implements these functions, as 10000 * major + 100 * minor + patch. */
LIGHTBIN_API uint32_t lightbin_version(void);

/* ---- Matrices and views ---- */

/* How sixteen numbers in memory make a matrix. */
typedef enum lightbin_matrix_layout {
    /* The columns of a matrix for M v, one after another: OpenGL's, GLM's, cglm's */
    LIGHTBIN_COLUMN_MAJOR = 0,
    LIGHTBIN_ROW_MAJOR = 1,  /* the rows of a matrix for M v, one after another: as it is written on paper */
    /* Row after row of a matrix that is multiplied by a row vector from the left: Direct3D's */
    LIGHTBIN_ROW_VECTORS = 2
} lightbin_matrix_layout;

/* Sixteen numbers: either floats or doubles are given, and the other pointer is null. If both are given, the floats are
 * read. */
typedef struct lightbin_matrix {
    const float* floats;
    const double* doubles;
    int32_t layout; /* a lightbin_matrix_layout */
    int32_t unused;
} lightbin_matrix;

/* The range of clip-space depth, a setting of the graphics API that a matrix does not show. */
typedef enum lightbin_clip_depth {
    LIGHTBIN_MINUS_ONE_TO_ONE = 0, /* OpenGL */
    LIGHTBIN_ZERO_TO_ONE = 1       /* Direct3D, Vulkan, Metal, WebGPU, OpenGL with glClipControl */
} lightbin_clip_depth;

/* The corner of the window that holds pixel (0, 0) and tile (0, 0), where the lower side is the one with NDC y = -1. */
typedef enum lightbin_window_origin {
    LIGHTBIN_LOWER_LEFT = 0, /* OpenGL, Vulkan */
    LIGHTBIN_UPPER_LEFT = 1  /* Direct3D, Metal, WebGPU */
} lightbin_window_origin;

typedef struct lightbin_view_options {
    uint32_t size;
    /* Of the viewport, 0 to 32768 pixels. An empty viewport, as of a minimised window, has no tiles and no lists: its
     * frames are to be skipped. */
    int32_t width, height;
    int32_t tile_size; /* side of a square tile in pixels, 1 or more; 0: 32 */
    /* Maps view space to clip space: any perspective or orthographic projection, also off-centre, with an infinite far
     * plane, with reversed Z, and of a right-handed or left-handed view space. Any other matrix is an error. */
    lightbin_matrix projection;
    int32_t clip_depth; /* a lightbin_clip_depth */
    int32_t origin;     /* a lightbin_window_origin */
    /* Not 0: the near plane has the larger window depth. Read for orthographic matrices alone */
    int32_t reversed_z;
    /* In place of tile_size: so many columns and rows of tiles, 1 to 32768 each, whose sides need not be whole pixels;
     * both 0: not read */
    int32_t columns, rows;
    int32_t max_tiles; /* in place of all three: about square tiles, at most so many; 0: not read */
} lightbin_view_options;

/* A projection, a viewport and a tile size, which fix the tile grid. Tile (x, y) has index y * tiles_x + x. */
typedef struct lightbin_view lightbin_view;

/* Makes a view. On success *view is the view, to be freed with lightbin_view_destroy().
 *
 * Errors: LIGHTBIN_MATRIX_NOT_FINITE to LIGHTBIN_TILE_COUNT_OUT_OF_RANGE, which say what is wrong with the matrix, the
 * viewport or the tile size. */
LIGHTBIN_API lightbin_result lightbin_view_create(const lightbin_view_options* options, lightbin_view** view);

/* Gives a view another projection, viewport or tile size, as when the camera or the window changes. Allocates nothing.
 * Errors: those of lightbin_view_create(); the view is then as before. */
LIGHTBIN_API lightbin_result lightbin_view_update(lightbin_view* view, const lightbin_view_options* options);
LIGHTBIN_API void lightbin_view_destroy(lightbin_view* view);

/* What lightbin_view_describe() returns: what was read from the matrix, and what looks like a mistake. */
typedef struct lightbin_view_info {
    uint32_t size;
    int32_t width, height, tile_size; /* in pixels; tile_size is 0 if numbers of tiles were given */
    int32_t tiles_x, tiles_y;
    int32_t orthographic, reversed_z; /* 0 or 1 */
    float near_depth, far_depth;      /* rounded outward; far_depth is +inf if there is no far plane */
    int32_t x_flipped, y_flipped;     /* 1: NDC x (or y) falls where view-space x (or y) grows */
    int32_t looks_down_negative_z;    /* 1 for right-handed view spaces */
    /* Each of these is 1 where the matrix or the viewport looks like a common mistake, and 0 elsewhere. A view with a 1
     * is right if that was intended. */
    int32_t looks_transposed; /* the entry of 1 is where a transposed perspective matrix has it */
    /* An orthographic matrix that scales nothing: an identity, or the view matrix? */
    int32_t looks_like_view_matrix;
    int32_t looks_turned;      /* upside down and mirrored: degrees where radians are wanted? */
    int32_t looks_behind;      /* all orthographic depths are behind the eye: is reversed_z right? */
    int32_t looks_zero_to_one; /* no depth reaches NDC -1: is clip_depth right? */
    int32_t pixels_not_square; /* by more than 2 %: is the viewport's size stale, or the aspect inverted? */
    int32_t viewport_empty;    /* the width or the height is 0: were they given? */
    int32_t oblique;           /* 0 or 1: the near plane is oblique, as for mirrors */
    /* The projection turns the image by 90 or 270 degrees. Tile columns are counted along y of the viewport then, tile
     * rows along x; x_flipped is that of view-space y, y_flipped that of x. */
    int32_t turned;
} lightbin_view_info;

/* Describes a view. Set info->size before. */
LIGHTBIN_API lightbin_result lightbin_view_describe(const lightbin_view* view, lightbin_view_info* info);

/* Writes what was read from the matrix as one line of text, with a question for each likely mistake. Returns the number
 * of characters, as lightbin_error_text() does; 0 if view is null. */
LIGHTBIN_API size_t lightbin_view_text(const lightbin_view* view, char* text, size_t capacity);

/* Computes where in the image a point of view space lies: x and y in pixels from the corner of the window origin, and
 * its view depth. Where the depth of a perspective view is 0 or less, x and y mean nothing. */
LIGHTBIN_API lightbin_result lightbin_view_project(const lightbin_view* view, const double point[3], double image[3]);

/* Computes the point of view space that an image point (x, y, view depth) shows: the inverse of
 * lightbin_view_project(). The viewport must not be empty. */
LIGHTBIN_API lightbin_result lightbin_view_unproject(const lightbin_view* view, const double image[3], double point[3]);

/* Computes the view depths that the window depths from `lower` to `upper` stand for, rounded outward: depths[0] is the
 * least of them, depths[1] the greatest. */
LIGHTBIN_API lightbin_result lightbin_view_depths(const lightbin_view* view, double lower, double upper,
                                                  float depths[2]);

/* Returns the window depth of an image point (x, y, view depth), up to rounding. x and y matter, and the viewport must
 * not be empty, with an oblique near plane alone. NaN for an infinite view depth, or if a pointer is null. */
LIGHTBIN_API float lightbin_view_window_depth(const lightbin_view* view, const double image[3]);

/* ---- Lights ---- */

/* Where the lights' floats are, in an array of the caller's structs or in an array of their own. For an array `lamps`
 * of structs with a member float position[3] it is {lamps[0].position, sizeof lamps[0]}. Addresses need no alignment.
 */
typedef struct lightbin_floats {
    const void* first; /* the first light's floats */
    size_t stride;     /* bytes from one light's floats to the next light's: not less than these floats take */
} lightbin_floats;

/* Spheres outside of which lights give no light. A radius of +inf covers everything. A light whose radius is -1 is
 * switched off: it is in no list, and counts as culled. A light with a NaN or infinite centre, or a radius that is NaN
 * or another negative number, is skipped and counted as rejected. Both hold for spots and boxes, too. */
typedef struct lightbin_spheres {
    size_t count;
    lightbin_floats centre; /* 3 floats */
    lightbin_floats radius; /* 1 float */
} lightbin_spheres;

/* Spots: spheres that are cut by a cone whose tip is the centre. A cosine of -1 makes a whole sphere, whatever the axis
 * is. Other spots whose axis is zero or not finite, and spots whose cosine is NaN or not from 1 to -1, are skipped and
 * counted, as bad spheres are. */
typedef struct lightbin_spots {
    size_t count;
    lightbin_floats centre; /* 3 floats */
    lightbin_floats radius; /* 1 float */
    lightbin_floats axis;   /* 3 floats: the direction in which the light shines, of any length but zero */
    lightbin_floats cosine; /* 1 float: of the angle between the axis and the cone's side, from 1 to -1 */
} lightbin_spots;

/* Boxes: oriented boxes or frustums, which may be cut by a sphere: decals, probes, projectors, lights in a room. The
 * points of a box are
 *
 *     box_centre + a k u + b k v + c w     with a, b and c from -1 to 1, and k = (1 + taper + c (1 - taper)) / 2
 *
 * where u, v and w are its three half axes. A box whose numbers are NaN or infinite, whose taper is not from 0 to 1, or
 * all of whose half axes are zero, is skipped and counted, as bad spheres are. (A radius may be +inf.) */
typedef struct lightbin_boxes {
    size_t count;
    /* 3 floats and 1 float: the sphere. Null in both: no sphere cuts the boxes, as if each radius were +inf. */
    lightbin_floats centre, radius;
    lightbin_floats box_centre; /* 3 floats */
    /* 9 floats: three vectors, one after another, from the box's centre to the middles of three of its faces. They need
     * not be at right angles. One of zero makes the box flat. */
    lightbin_floats half_axes;
    /* 1 float from 0 to 1: the size of the face at centre - third vector, as a fraction of the face at centre + third
     * vector. Null: 1, for boxes. */
    lightbin_floats taper;
} lightbin_boxes;

/* Lights whose floats lie as in an array of these structs are read without a copy. */
typedef struct lightbin_sphere {
    float centre[3], radius;
} lightbin_sphere;
typedef struct lightbin_spot {
    float centre[3], radius, axis[3], cosine;
} lightbin_spot;
typedef struct lightbin_box {
    float centre[3], radius, box_centre[3], half_axes[9], taper;
} lightbin_box;

/* The lights of a call. Ids number the arrays through: the id of a sphere is its position in its array, ids of spots
 * begin behind those of the spheres, and ids of boxes behind those of the spots. */
typedef struct lightbin_lights {
    uint32_t size;
    uint32_t unused;
    /* World space to view space: the lights are in world space, and are enlarged by a bound on the rounding of the
     * transform. It must be affine. Without numbers the lights are in view space. */
    lightbin_matrix view_matrix;
    lightbin_spheres spheres;
    lightbin_spots spots;
    lightbin_boxes boxes;
    /* For worlds so large that floats round too much: the eye in world space, 3 doubles. Each `centre` and `box_centre`
     * is then 3 doubles in place of 3 floats, and of the view matrix, which must be given, the translation is not read.
     * Centres relative to the eye are computed in double. May be null. */
    const double* eye;
} lightbin_lights;

/* Returns the distance at which a point light has fallen to a cutoff, sqrt(intensity / cutoff), rounded up: in metres
 * for an intensity in candela and a cutoff in lux. An intensity of 0 or less gives 0; a cutoff of 0 or less gives +inf.
 */
LIGHTBIN_API float lightbin_light_range(float intensity, float cutoff);

/* ---- Slices ---- */

/* Adjacent intervals of view depth, for clusters and z-bins. */
typedef struct lightbin_slices lightbin_slices;

/* Make slices. In all three the first slice begins at the near plane, the last one ends at the far plane, and *slices
 * is to be freed with lightbin_slices_destroy().
 *
 *   exponential      the first slice ends at depth `first`, and each further one at a constant times the depth where it
 *                    begins, so that the last would end at `last`: cells are then about as deep as they are wide
 *   linear           the depths from `begin` to `end` are divided into equal parts
 *   from_boundaries  one slice more than there are boundaries, which ascend
 *
 * margin     from 0 to 1/2. A shader that finds the slice of a depth d by a formula of its own, which may be wrong by
 *            up to margin * |d|, finds all lights in the slice that it reads. 0 for shaders with the library's own text
 *
 * Errors: LIGHTBIN_NO_SLICES, a count below 1; LIGHTBIN_SLICE_RANGE_EMPTY, not 0 < first < last, or not begin < end,
 * with two slices or more; LIGHTBIN_SLICES_DO_NOT_ASCEND, boundaries that do not ascend, are not finite, or are equal
 * once they are rounded to float. */
LIGHTBIN_API lightbin_result lightbin_slices_exponential(int32_t count, float first, float last, float margin,
                                                         lightbin_slices** slices);
LIGHTBIN_API lightbin_result lightbin_slices_linear(int32_t count, float begin, float end, float margin,
                                                    lightbin_slices** slices);
LIGHTBIN_API lightbin_result lightbin_slices_from_boundaries(const float* boundaries, size_t count, float margin,
                                                             lightbin_slices** slices);
LIGHTBIN_API void lightbin_slices_destroy(lightbin_slices* slices);

/* Returns the number of slices; 0 if slices is null. */
LIGHTBIN_API int32_t lightbin_slices_count(const lightbin_slices* slices);

/* Returns the boundaries in ascending order, one less than there are slices. Valid as long as the slices; null if
 * slices is null. */
LIGHTBIN_API const float* lightbin_slices_boundaries(const lightbin_slices* slices);

/* Returns the index of the slice that contains a depth, which must not be NaN; -1 if slices is null. */
LIGHTBIN_API int32_t lightbin_slices_at(const lightbin_slices* slices, float depth);

/* ---- Z bounds ---- */

/* The view depths that bound what is drawn in each tile: arrays of one float for each tile, row by row, such as the
 * shader of lightbin_reduce_shader() writes; or lightbin_view_depths() of the window depths in a tile, widened by a
 * step of the depth buffer's format. Where a pointer is null, lights are not tested against that bound. A tile whose
 * min is greater than its max shows nothing and lists no light. A NaN stands for no bound. */
typedef struct lightbin_z_bounds {
    uint32_t size;
    uint32_t unused;
    const float *min, *max;
    size_t tiles; /* the number of floats in each array, the view's number of tiles or more */
} lightbin_z_bounds;

/* ---- Binners ---- */

/* The width of an id in bytes. 0 stands for LIGHTBIN_U32. */
typedef enum lightbin_ids {
    LIGHTBIN_U8 = 1,  /* made by lightbin_encode(), not by a binner */
    LIGHTBIN_U16 = 2, /* up to 65,536 lights */
    LIGHTBIN_U32 = 4
} lightbin_ids;

/* How slices narrow the lights of a tile by depth. */
typedef enum lightbin_slicing {
    LIGHTBIN_NO_SLICING = 0,
    LIGHTBIN_CLUSTERS = 1, /* each tile has one list for each slice */
    /* Each tile has one list, whose ids are ranks: places of the lights in order of depth. Each slice is a bin that has
     * the least and greatest rank of its lights, and a shader reads the part of the list between them. */
    LIGHTBIN_Z_BINS = 2
} lightbin_slicing;

typedef struct lightbin_binner_options {
    uint32_t size;
    int32_t ids; /* LIGHTBIN_U32 or LIGHTBIN_U16 */
    /* Not 0: a light is listed in a tile only if it meets the tile's Z bounds and the box, in view space, around the
     * tile between them. Needs Z bounds, or clusters, whose cells lie between the depths of a slice. */
    int32_t depth_test;
    int32_t slicing; /* a lightbin_slicing */
} lightbin_binner_options;

/* Bins lights into tiles, and keeps the memory that this takes. */
typedef struct lightbin_binner lightbin_binner;

/* Makes a binner. On success *binner is the binner, to be freed with lightbin_binner_destroy().
 *
 * options  null: the defaults, all 0 */
LIGHTBIN_API lightbin_result lightbin_binner_create(const lightbin_binner_options* options, lightbin_binner** binner);
LIGHTBIN_API void lightbin_binner_destroy(lightbin_binner* binner);

/* The inputs of a call beside the lights. Slices are read with CLUSTERS and Z_BINS, bounds with a depth test. What is
 * read must be given, and what is not read must be null. With CLUSTERS bounds may be given or not: the cells whose
 * slice does not meet the Z bounds of their tile then list no light. */
typedef struct lightbin_inputs {
    uint32_t size;
    uint32_t unused;
    const lightbin_slices* slices;
    const lightbin_z_bounds* bounds;
} lightbin_inputs;

/* The list of one tile: `count` ids from index `offset` on. 8 bytes, laid out as a GPU's uvec2. */
typedef struct lightbin_range {
    uint32_t offset, count;
} lightbin_range;

/* With LIGHTBIN_Z_BINS, the least and greatest rank (place in the order of depth) of the lights that meet a slice;
 * least > greatest if there is none. */
typedef struct lightbin_bin_range {
    uint32_t least, greatest;
} lightbin_bin_range;

/* A finished light grid. Set `size` before the call that fills it in. The arrays are memory of the binner, which is
 * valid until the binner's next call. */
typedef struct lightbin_grid {
    uint32_t size;
    int32_t tiles_x, tiles_y;
    int32_t slices; /* 1 unless made with clusters */
    /* tiles_x * tiles_y ranges, row-major; with clusters as many for each slice: the range of tile (x, y) in slice s is
     * ranges[(s * tiles_y + y) * tiles_x + x] */
    const lightbin_range* ranges;
    const void* ids; /* the light index list: uint16_t or uint32_t, as id_bytes says */
    uint64_t range_count, id_count;
    uint32_t id_bytes;
    uint32_t lights, rejected,
        culled; /* how many lights were given, are bad input, and are outside of the view or switched off */
    /* With z-bins, else null: for each rank the light's id, and the ranks in each bin. */
    const uint32_t* order;
    const lightbin_bin_range* bins;
    uint64_t order_count, bin_count;
    uint32_t first_spot, first_box; /* ids below first_spot are spheres, from there to first_box spots, others boxes */
} lightbin_grid;

/* Makes the lists. On success every cell's list has, in ascending order, the id of every light that meets the cell.
 *
 * inputs  null: none
 *
 * Errors: LIGHTBIN_TOO_MANY_LIGHTS, more than the ids can number, or than 2^30; LIGHTBIN_TOO_MANY_ENTRIES,
 * LIGHTBIN_TOO_MANY_CELLS and LIGHTBIN_TOO_MANY_PAIRS, more than 2^32 - 1 tiles in all lights' rectangles, cells, or
 * pairs of a light and a slice; LIGHTBIN_VIEW_MATRIX_NOT_AFFINE, LIGHTBIN_VIEW_MATRIX_TRANSPOSED and
 * LIGHTBIN_EYE_NOT_FINITE; LIGHTBIN_STRIDE_TOO_SMALL; LIGHTBIN_NO_SLICES_GIVEN, LIGHTBIN_NO_BOUNDS_GIVEN,
 * LIGHTBIN_Z_BOUNDS_TOO_SMALL and LIGHTBIN_NOT_READ, of the inputs. */
LIGHTBIN_API lightbin_result lightbin_bin(lightbin_binner* binner, const lightbin_view* view,
                                          const lightbin_lights* lights, const lightbin_inputs* inputs,
                                          lightbin_grid* grid);

/* Masks of the columns and rows of tiles. A light that is listed in a rectangle of tiles is in tile (x, y) exactly if
 * it is in column x and in row y: the lights of the tile are those whose bits are set in
 *
 *     words[1 + x * mask_words + w] & words[1 + (tiles_x + 1 + y) * mask_words + w]      for w < mask_words
 *
 * Bit b stands for the light ids[32 * w + b]. Set `size` before the call that fills the struct in. The arrays are
 * memory of the binner, which is valid until the binner's next call. */
typedef struct lightbin_masks {
    uint32_t size;
    int32_t tiles_x, tiles_y;
    uint32_t mask_words; /* in each mask: enough for all lights in view, and 0 if there are none */
    /* All that a shader reads, to be uploaded as it is: mask_words; the masks of all columns, and an empty one; those
     * of all rows; 32 * mask_words ids, which are 0 beyond the lights in view; and the bins. */
    const uint32_t* words;
    const uint32_t* ids;            /* of the lights in view, in ascending order, or with z-bins in order of depth */
    const lightbin_bin_range* bins; /* with z-bins, else null: for each the range in `ids` of the lights that meet it */
    uint64_t word_count, id_count, bin_count;
    uint32_t lights, rejected, culled, first_spot, first_box; /* as in lightbin_grid */
    uint32_t unused;
} lightbin_masks;

/* Makes masks in place of lists. Every tile has the same lights, in memory whose size depends on the numbers of
 * columns, rows, z-bins and lights in view, but not on how many tiles each light covers. docs/tiles.md says when to use
 * them.
 *
 * binner, inputs  as for lightbin_bin(); the binner has no depth test and no clusters
 *
 * Errors: those of lightbin_bin(); LIGHTBIN_NO_SUCH_SLICING_SHADER, of such a binner. */
LIGHTBIN_API lightbin_result lightbin_bin_masks(lightbin_binner* binner, const lightbin_view* view,
                                                const lightbin_lights* lights, const lightbin_inputs* inputs,
                                                lightbin_masks* masks);

/* Writes a frame as text, to be kept in a file when a picture is wrong: the view, the binner's options, the lights and
 * the lists or masks that were made of them. The text is JSON, which dump.hpp describes, and ends with a 0.
 *
 * binner, view, lights, inputs  what lightbin_bin() or lightbin_bin_masks() was given. Lights are read once more
 * grid, masks                   what it filled in; the other one is null
 * text                          `capacity` characters; null: only *size is written
 * size                          becomes the number of characters of the whole text, with the 0; may be null
 *
 * Errors: LIGHTBIN_BUFFER_TOO_SMALL, the text does not fit, and only *size is written; those of lightbin_bin() that are
 * not of the lights' transform or of numbers. */
LIGHTBIN_API lightbin_result lightbin_dump(const lightbin_binner* binner, const lightbin_view* view,
                                           const lightbin_lights* lights, const lightbin_inputs* inputs,
                                           const lightbin_grid* grid, const lightbin_masks* masks, char* text,
                                           size_t capacity, size_t* size);

/* ---- Encodings ---- */

/* How the list of a tile is stored. */
typedef enum lightbin_encoding {
    LIGHTBIN_OFFSET_COUNT = 0, /* a grid's ranges and one list of ids */
    LIGHTBIN_SENTINEL = 1      /* memory for `capacity` ids a tile; a shorter list ends with the largest id */
} lightbin_encoding;

typedef struct lightbin_format {
    uint32_t size;
    int32_t encoding;  /* a lightbin_encoding */
    int32_t ids;       /* a lightbin_ids */
    uint32_t capacity; /* for SENTINEL: the ids that a tile has memory for, 1 or more */
} lightbin_format;

/* What lightbin_encode() returns beside the lists: what it left out of those that are longer than the capacity of a
 * sentinel format. */
typedef struct lightbin_encoded {
    uint32_t size;
    uint32_t tiles_cut; /* the number of tiles whose list was cut */
    uint64_t entries_cut;
    uint64_t bytes;           /* that the lists take */
    uint32_t capacity_needed; /* the length of the longest list: the least capacity that cuts none */
    uint32_t unused;
} lightbin_encoded;

/* Writes the lists of a grid in another format, in this machine's byte order; with OFFSET_COUNT the ids alone, which
 * grid->ranges still index. All offsets and ids must be inside of the arrays that they refer to, as in a grid that
 * lightbin_bin() filled in. Every list is complete, except that the sentinel format cuts lists that are longer than its
 * capacity and counts what it cut.
 *
 * out  `out_bytes` bytes; null: only encoded->bytes is computed
 *
 * Errors: LIGHTBIN_CAPACITY_UNKNOWN, of the format; LIGHTBIN_IDS_TOO_NARROW, an id is too large for the format;
 * LIGHTBIN_LIST_BUFFER_TOO_SMALL. */
LIGHTBIN_API lightbin_result lightbin_encode(const lightbin_grid* grid, const lightbin_format* format, void* out,
                                             uint64_t out_bytes, lightbin_encoded* encoded);

/* ---- Shader text that reads the lists ---- */

typedef enum lightbin_shader_language {
    LIGHTBIN_GLSL_430 = 0,    /* OpenGL 4.3 and later */
    LIGHTBIN_GLSL_330 = 1,    /* OpenGL 3.3 to 4.2 */
    LIGHTBIN_GLSL_VULKAN = 2, /* GLSL 450 for Vulkan */
    LIGHTBIN_ESSL_300 = 3,    /* OpenGL ES 3.0, WebGL 2 */
    LIGHTBIN_ESSL_310 = 4,    /* OpenGL ES 3.1 and later */
    LIGHTBIN_HLSL_5_0 = 5,    /* shader model 5.0: Direct3D 11 */
    LIGHTBIN_HLSL_5_1 = 6,    /* shader models 5.1 and 6.x: Direct3D 12 */
    LIGHTBIN_WGSL = 7         /* WebGPU */
} lightbin_shader_language;

/* The kind of resource that holds the lists. */
typedef enum lightbin_list_storage {
    LIGHTBIN_STORAGE_BUFFER = 0,
    LIGHTBIN_TEXEL_BUFFER = 1, /* buffer textures in GLSL, Buffer in HLSL; ES and WGSL have none */
    LIGHTBIN_TEXTURE_2D = 2,   /* 2D textures, in every language */
    LIGHTBIN_UNIFORM_BLOCK = 3
} lightbin_list_storage;

/* Where a resource is bound: binding and set in GLSL, register number and space in HLSL, binding and group in WGSL. */
typedef struct lightbin_slot {
    int32_t binding, set;
} lightbin_slot;

/* What lightbin_shader_snippet() generates. An option that is 0 is off and leaves nothing in the text. */
typedef struct lightbin_snippet_options {
    uint32_t size;
    int32_t language;              /* a lightbin_shader_language */
    int32_t storage;               /* a lightbin_list_storage */
    int32_t slicing;               /* a lightbin_slicing, that of the binner */
    const lightbin_format* format; /* of the lists; null: those of a binner whose ids have 32 bits */
    const char* prefix;            /* every name in the text begins with it; null: "lightbin_" */
    int32_t tile_size;             /* in pixels, fixed in the text; 0: read at run time from the constant `grid` */
    /* Read the ranges from a uniform block, and only the ids from `storage` */
    int32_t tiles_in_uniform_block;
    int32_t packed_ids;      /* texels of 32 bits hold several ids of 8 or 16 bits, as storage buffers do */
    int32_t flip_y;          /* the shader counts pixel rows from the opposite end to the view's origin */
    int32_t viewport_corner; /* the shader counts pixels in the window: subtract the constant `corner` */
    int32_t heat_map;        /* add the functions `count` and `heat`, which show a pixel's number of lights */
    int32_t wave_loop;       /* with masks: the lanes of a wave (subgroup) loop together over all that any lane has */
    int32_t view_check;      /* add the function `check_view`: whether a pixel shows a view-space position */
    int32_t list_check;      /* add the loop `for_each_missing` over the lights that a pixel's list lacks */
    int32_t window;          /* add the function `window`, which falls smoothly from 1 at a light to 0 at its range */
    int32_t push_constants;  /* Vulkan: `grid` and `corner` are push constants */
    uint32_t texture_width;  /* of 2D textures: texels in a row, up to 16384; 0: 2048 */
    /* With uniform blocks, which have a fixed size: the most tiles in all slices and views, ids in all lists, slices.
     * */
    uint32_t max_tiles, max_entries, max_slices;
    uint32_t uniform_block_bytes; /* the device's limit for one block; 0: 16384 */
    int32_t slots_given;          /* 0: the slots are the bindings 0 to 5 of set 0 in the order below */
    lightbin_slot tiles, lists, grid, slices, bins, view;
    /* How many views' lists lie one after another in the buffers, up to 512; 0: 1. To each offset of a view is added
     * the number of ids of the views before it. */
    uint32_t views;
    int32_t masks;  /* read lightbin_masks::words, bound at `lists`, in place of lists and their format */
    int32_t columns_and_rows; /* for views of which numbers of tiles were given; tile_size is not read */
    int32_t turned;           /* that of lightbin_view_info */
} lightbin_snippet_options;

/* A shader text and the resources to bind for it. */
typedef struct lightbin_shader lightbin_shader;

/* Makes shader text that reads the lists, to be inserted after `#version`. In the shader, with the default prefix,
 *
 *     lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), view_depth) { colour += shade(light.id); }
 *
 * then loops over the lights of a pixel. docs/opengl.md, vulkan.md, direct3d.md and webgpu.md have whole shaders, and
 * the comment at shader_snippet() in shader.hpp lists all that the text declares. On success *shader is to be freed
 * with lightbin_shader_destroy(). Errors name the option that the language, the lists or the device do not allow:
 * LIGHTBIN_NO_STORAGE_BUFFERS, LIGHTBIN_NO_TEXEL_BUFFERS, LIGHTBIN_NO_WAVE_OPERATIONS;
 * LIGHTBIN_NO_SUCH_SLICING_SHADER, masks with clusters; LIGHTBIN_TILE_SIZE_OUT_OF_RANGE,
 * LIGHTBIN_VIEWS_OUT_OF_RANGE, LIGHTBIN_TEXTURE_WIDTH_OUT_OF_RANGE; LIGHTBIN_CAPACITY_UNKNOWN, LIGHTBIN_IDS_TOO_NARROW,
 * of the format; LIGHTBIN_BLOCK_SIZE_UNKNOWN, LIGHTBIN_UNIFORM_BLOCK_TOO_SMALL; LIGHTBIN_NOT_A_PREFIX,
 * LIGHTBIN_SLOT_OUT_OF_RANGE, LIGHTBIN_NO_SETS, LIGHTBIN_BINDINGS_OVERLAP, LIGHTBIN_NO_PUSH_CONSTANTS. */
LIGHTBIN_API lightbin_result lightbin_shader_snippet(const lightbin_snippet_options* options, lightbin_shader** shader);
LIGHTBIN_API void lightbin_shader_destroy(lightbin_shader* shader);

/* Returns the text, which ends with a 0. Valid as long as the shader; null if shader is null. */
LIGHTBIN_API const char* lightbin_shader_text(const lightbin_shader* shader);

/* Returns the number of resources that the text reads; 0 if shader is null. */
LIGHTBIN_API size_t lightbin_shader_binding_count(const lightbin_shader* shader);

/* The kind of resource that a name in the text stands for. */
typedef enum lightbin_shader_resource {
    LIGHTBIN_RESOURCE_UNIFORM_VECTOR = 0, /* OpenGL: a uniform by itself, such as `grid` (uvec4) */
    /* GLSL: std140 block; HLSL: cbuffer, register b; WGSL: var<uniform> */
    LIGHTBIN_RESOURCE_UNIFORM_BLOCK = 1,
    LIGHTBIN_RESOURCE_PUSH_CONSTANTS = 2, /* Vulkan */
    /* Read-only; GLSL: std430 block; HLSL: StructuredBuffer, register t */
    LIGHTBIN_RESOURCE_STORAGE_BUFFER = 3,
    LIGHTBIN_RESOURCE_TEXEL_BUFFER = 4,   /* GLSL: buffer texture; HLSL: Buffer, register t */
    LIGHTBIN_RESOURCE_TEXTURE_2D = 5,     /* read without a sampler; GLSL: set NEAREST and no mipmaps */
    LIGHTBIN_RESOURCE_WRITABLE_BUFFER = 6 /* a storage buffer that is written; HLSL: register u */
} lightbin_shader_resource;

/* One resource that the program has to bind. */
typedef struct lightbin_binding {
    uint32_t size;
    int32_t resource; /* a lightbin_shader_resource */
    const char* name; /* the name in the text; valid as long as the shader */
    lightbin_slot slot;
    uint32_t stride; /* bytes of an element of a buffer */
    uint32_t bytes;  /* the size of a uniform vector, a uniform block or push constants; 0 for others */
    uint32_t width;  /* texels in a row of a 2D texture; 0 for others */
    /* The format of texels in each graphics API's numbers: glTexImage2D()'s three arguments, of which glTexBuffer()
     * needs the first; VkFormat; DXGI_FORMAT. 0 if there are no texels. */
    uint32_t gl_internal_format, gl_format, gl_type, vk_format, dxgi_format;
    const char* webgpu_format; /* such as "r32uint"; an empty text if there are no texels */
} lightbin_binding;

/* Writes the resource with an index, which is less than lightbin_shader_binding_count(). Set binding->size before. */
LIGHTBIN_API lightbin_result lightbin_shader_binding(const lightbin_shader* shader, size_t index,
                                                     lightbin_binding* binding);

/* The constants `grid` and `corner` of the text, with the layout of its uniform block. `corner` is the least x and y of
 * the viewport's pixels in the shader's own coordinates; only shaders with viewport_corner read it. */
typedef struct lightbin_grid_constants {
    /* Of a turned view, width and height are exchanged, and 2^30 is added to tile_size. Of a view with numbers of
     * columns and rows, tile_size is the number of rows, and 2^31 is added to it. */
    uint32_t tile_size, tiles_x, width, height;
    int32_t corner_x, corner_y, unused[2];
} lightbin_grid_constants;
LIGHTBIN_API lightbin_result lightbin_get_grid_constants(const lightbin_view* view, int32_t corner_x, int32_t corner_y,
                                                         lightbin_grid_constants* constants);

/* The constants `image` and `depths` that the text's function `check_view` reads.
 *
 * tolerance  how many pixels a position may be projected from its pixel's centre; 2 is usual */
typedef struct lightbin_view_constants {
    float scale_x, scale_y, offset_x, offset_y, forward, perspective, nearest, tolerance;
} lightbin_view_constants;
LIGHTBIN_API lightbin_result lightbin_get_view_constants(const lightbin_view* view, float tolerance,
                                                         lightbin_view_constants* constants);

/* Writes the content of the text's buffer `slices`: lightbin_slices_count() + 3 words. Errors:
 * LIGHTBIN_BUFFER_TOO_SMALL. */
LIGHTBIN_API lightbin_result lightbin_shader_slices(const lightbin_slices* slices, uint32_t* words, size_t capacity);

/* ---- Shaders that reduce depth on the GPU ---- */

/* The number format of a depth buffer, which decides how much rounding the bounds allow for. */
typedef enum lightbin_depth_format {
    LIGHTBIN_FLOAT32 = 0,
    LIGHTBIN_UNORM24 = 1,
    LIGHTBIN_UNORM16 = 2,
    /* No window depths, but view depths as 32-bit floats, as of a logarithmic depth buffer. Background is +inf. */
    LIGHTBIN_VIEW_DEPTH = 3
} lightbin_depth_format;

/* What lightbin_reduce_shader() generates: a shader that reduces a depth texture to the least and greatest view depth
 * of each tile. As a compute shader it is dispatched with one work group for each tile, and writes a vec2 for each tile
 * to the storage buffer `z_bounds`. As a fragment shader it draws one fragment for each tile to a target of two 32-bit
 * floats. */
typedef struct lightbin_reduce_options {
    uint32_t size;
    int32_t language;                 /* a lightbin_shader_language */
    const char* prefix;               /* null: "lightbin_" */
    int32_t fragment;                 /* 0: a compute shader; not 0: a fragment shader */
    int32_t samples;                  /* a pixel of the depth texture, 1 to 8; 0: 1 */
    int32_t format;                   /* a lightbin_depth_format */
    int32_t reversed_z, orthographic, oblique; /* those of lightbin_view_info */
    int32_t skip_background;          /* not 0: ignore samples at the far plane, where nothing is drawn */
    int32_t flip_y;                   /* not 0: row 0 of the texture is opposite to the view's origin */
    int32_t viewport_corner;          /* not 0: the viewport begins at the texel `corner` of the texture */
    int32_t push_constants;           /* not 0: Vulkan: the constants are push constants */
    int32_t slots_given;              /* 0: the slots are the bindings 0 to 2 of set 0 in the order below */
    lightbin_slot depth, z_bounds, grid;
    int32_t unused;
} lightbin_reduce_options;

/* On success *shader is to be freed with lightbin_shader_destroy(). Errors name the option that the language or the
 * device does not allow: LIGHTBIN_NO_STORAGE_BUFFERS, LIGHTBIN_NO_MULTISAMPLE_TEXTURES,
 * LIGHTBIN_SAMPLES_OUT_OF_RANGE, LIGHTBIN_NOT_A_PREFIX, LIGHTBIN_SLOT_OUT_OF_RANGE, LIGHTBIN_NO_SETS,
 * LIGHTBIN_BINDINGS_OVERLAP, LIGHTBIN_NO_PUSH_CONSTANTS. */
LIGHTBIN_API lightbin_result lightbin_reduce_shader(const lightbin_reduce_options* options, lightbin_shader** shader);

/* The constants `grid`, `planes`, `corner` and `tilt` of lightbin_reduce_shader(), with its uniform block's layout. */
typedef struct lightbin_reduce_constants {
    uint32_t tile_size, tiles_x, width, height;
    float far_end, slope, margin, unused;
    int32_t corner_x, corner_y, unused_corner[2];
    float tilt_x, tilt_y, unused_tilt[2];
} lightbin_reduce_constants;
LIGHTBIN_API lightbin_result lightbin_get_reduce_constants(const lightbin_view* view, int32_t corner_x,
                                                           int32_t corner_y, lightbin_reduce_constants* constants);

/* ---- Shaders that make light grids on the GPU of lights there ---- */

/* The compute shaders that make a whole light grid of lights in a buffer on the GPU, in the order of their dispatches,
 * with a barrier between any two. docs/gpu.md shows their use. */
typedef enum lightbin_cull_pass {
    LIGHTBIN_CULL_PROJECT = 0, /* finds each light's rectangle of tiles, and the blocks of tiles that it meets */
    LIGHTBIN_CULL_COUNT = 1,   /* counts the lights of each cell */
    LIGHTBIN_CULL_SUMS = 2,    /* adds the counts up, over 128 cells at a time */
    LIGHTBIN_CULL_OFFSETS = 3, /* adds the sums up, and finds the total */
    LIGHTBIN_CULL_FILL = 4,    /* writes the lists */
    LIGHTBIN_CULL_MASKS = 5    /* in place of count to fill: writes masks of the columns and rows of tiles */
} lightbin_cull_pass;

/* The kind of lights that lightbin_cull_shader() bins on the GPU. */
typedef enum lightbin_cull_kind {
    LIGHTBIN_CULL_SPHERE = 0,
    LIGHTBIN_CULL_SPOT = 1, /* those with a half angle beyond 138 degrees count as whole spheres */
    LIGHTBIN_CULL_BOX = 2,
    /* Spheres, behind them spots, and behind them boxes, as many of each as there is room for. Ids number them in this
     * order, as binners do. */
    LIGHTBIN_CULL_MIXED = 3
} lightbin_cull_kind;

/* What lightbin_cull_shader() generates. All passes of a build, and its plan, need the same options except for `pass`.
 * Every device with OpenGL ES 3.1, Vulkan or WebGPU can run them: docs/gpu.md says what they use. */
typedef struct lightbin_cull_options {
    uint32_t size;
    int32_t language;   /* a lightbin_shader_language */
    const char* prefix; /* null: "lightbin_" */
    int32_t pass;       /* a lightbin_cull_pass */
    int32_t kind;       /* a lightbin_cull_kind */
    /* Where the numbers of a light lie in the buffer `lights`, in words of 32 bits. stride: from one light to the next;
     * 0: lights lie side by side, as arrays of lightbin_sphere, lightbin_spot and lightbin_box, and the next four and
     * box_centre to box_stride are not read. centre and axis: x, y and z, side by side. cosine: of the half angle. */
    uint32_t stride, centre, radius, axis, cosine;
    int32_t world_space;     /* not 0: the lights are in world space, and are transformed to view space */
    int32_t count_in_buffer; /* not 0: the number of lights is read from the buffer `light_count` */
    /* With count_in_buffer: the index of the word that holds the number; with LIGHTBIN_CULL_MIXED that of spheres,
     * behind which are those of spots and boxes */
    uint32_t count_at;
    int32_t ids;             /* LIGHTBIN_U32, or LIGHTBIN_U16: then each word of `lists` holds two ids */
    int32_t depth_test;      /* not 0: test lights against the boxes around cells, as binners do */
    int32_t slicing;         /* LIGHTBIN_NO_SLICING or LIGHTBIN_CLUSTERS */
    /* Not 0: test with the maximum Z bound alone, for transparent geometry; not with clusters */
    int32_t max_only;
    int32_t orthographic; /* that of lightbin_view_info */
    int32_t slots_given;  /* 0: bindings 0, 0, 1, 2, 2, 3, 3 and 4 of set 0 in the order below */
    lightbin_slot lights, z_bounds, scratch, slices, tiles, light_count, lists, grid;
    /* Not 0, with clusters: the cells whose slice does not meet their tile's Z bounds list no light */
    int32_t bounded;
    /* Where the numbers of boxes lie, as above. box_centre: x, y and z, side by side. half_axes: nine numbers, side by
     * side. With LIGHTBIN_CULL_MIXED, `stride` is that of spheres, and the last two are those of the others. */
    uint32_t box_centre, half_axes, taper, spot_stride, box_stride;
    /* With LIGHTBIN_CULL_MIXED: the number of spots and of boxes, with count_in_buffer the greatest. Only
     * lightbin_plan_cull() reads them: its argument `lights` is the number of spheres. */
    uint32_t spots, boxes;
} lightbin_cull_options;

/* Makes the text of one pass, a whole compute shader except for `#version`, with the buffers to bind. The name of a
 * binding is the prefix, the buffer's name in lightbin_cull_options and, in GLSL, `_block`; that of the constants ends
 * in `grid_block`. On success *shader is to be freed with lightbin_shader_destroy().
 *
 * After project to fill, the buffers `tiles` and `lists` hold what a binner's grid has in ranges and ids: the shader
 * text of lightbin_shader_snippet() reads them. No light that reaches a cell is missing in its list, and ids ascend in
 * each. Lists also have lights that do not reach the cell, a few others than the binner's: see docs/gpu.md. The same
 * input gives the same bytes on every run. If the lists have more entries than there is room for, the list of the first
 * tile that does not fit is cut, and the lists after it are empty; lightbin_cull_totals has the number that was needed.
 *
 * After project and masks, the buffer `lists` holds what the shader text of lightbin_shader_snippet() reads with the
 * option masks: docs/gpu.md says more.
 *
 * Errors name the option that the language or the passes do not allow: LIGHTBIN_NO_STORAGE_BUFFERS,
 * LIGHTBIN_IDS_TOO_NARROW, LIGHTBIN_NO_SUCH_SLICING_SHADER, LIGHTBIN_NOT_A_PREFIX, LIGHTBIN_SLOT_OUT_OF_RANGE,
 * LIGHTBIN_NO_SETS, LIGHTBIN_BINDINGS_OVERLAP. */
LIGHTBIN_API lightbin_result lightbin_cull_shader(const lightbin_cull_options* options, lightbin_shader** shader);

/* The work groups of a dispatch, in x and y; z is 1. Neither exceeds 65,535. */
typedef struct lightbin_cull_groups {
    uint32_t x, y;
} lightbin_cull_groups;

/* All that a program needs to run the shaders of lightbin_cull_shader() for a view. */
typedef struct lightbin_cull_plan {
    uint32_t size;
    uint32_t masks_suit; /* 1 where masks, in two dispatches, are meant for so few lights (up to 1,024) and no lists */
    /* The sizes of the buffers of a build, in bytes, each a multiple of 4 and at least 16. They need no initial
     * content. */
    uint64_t scratch_bytes;         /* the first words of `scratch` are lightbin_cull_totals afterwards */
    uint64_t tile_bytes;            /* of `tiles`: a lightbin_range for each cell */
    uint64_t list_bytes;            /* of `lists`: the ids */
    uint64_t mask_bytes;            /* of `lists`, where it is for the pass masks */
    lightbin_cull_groups groups[6]; /* by lightbin_cull_pass */
    /* The content of the uniform block `grid`, all 256 bytes. Its layout is that of the texts of the same version of
     * lightbin: make both in the same program. */
    uint32_t constants[64];
} lightbin_cull_plan;

/* What the shaders of lightbin_cull_shader() leave in the first words of the buffer `scratch`. */
typedef struct lightbin_cull_totals {
    uint32_t entries;  /* of the complete lists, at most 2^32 - 1; undefined if there are masks */
    uint32_t rejected; /* lights left out as bad input: see lightbin_spheres, lightbin_spots and lightbin_boxes */
    uint32_t visible;  /* lights in view */
    /* How many were given, of all kinds: with count_in_buffer, it may exceed those that there is room for */
    uint32_t lights;
} lightbin_cull_totals;

/* Computes the constants, buffer sizes and group counts for a view. Where only the camera moves, not the viewport, the
 * tile size or the room, only the constants change. Set plan->size before.
 *
 * options   those of the texts; `pass` is not read
 * lights    the number of lights, with count_in_buffer the greatest; with LIGHTBIN_CULL_MIXED that of spheres
 * entries   how many ids fit in `lists`
 * slices    with clusters, else null. The buffer `slices` holds what lightbin_shader_slices() writes
 * to_view   with world_space the matrix from world space to view space, else null
 *
 * Without clusters, the buffer `z_bounds` holds the minimum and maximum of each tile, as the shader of
 * lightbin_reduce_shader() writes them, and with a depth test behind them what lightbin_shader_edges() writes. With
 * clusters and a depth test, it holds what lightbin_shader_slabs() writes and behind that lightbin_shader_edges(). With
 * `bounded` it holds these two, and behind them the minimum and maximum of each tile.
 *
 * Errors: those of lightbin_cull_shader(); LIGHTBIN_VIEW_MATRIX_NOT_AFFINE, LIGHTBIN_VIEW_MATRIX_TRANSPOSED and
 * LIGHTBIN_VIEW_MATRIX_DISTORTS, it is not close enough to a rotation with a uniform scale; LIGHTBIN_TOO_MANY_SLICES,
 * more than 65,535; LIGHTBIN_TOO_MANY_LIGHTS for the ids; LIGHTBIN_SCRATCH_TOO_LARGE, more than 2^32 - 1 words;
 * LIGHTBIN_TOO_MANY_ENTRIES, masks of more words than that; LIGHTBIN_NOT_READ, slices or a matrix that the options do
 * not read. */
LIGHTBIN_API lightbin_result lightbin_plan_cull(const lightbin_view* view, const lightbin_cull_options* options,
                                                uint32_t lights, uint32_t entries, const lightbin_slices* slices,
                                                const lightbin_matrix* to_view, lightbin_cull_plan* plan);

/* The ends of an interval: the sides of a tile column or row, or the view depths of a slice. */
typedef struct lightbin_edges {
    float low, high;
} lightbin_edges;

/* Write what the shaders of lightbin_cull_shader() read in the buffer `z_bounds` with a depth test: the two sides of
 * each of tiles_x columns and then of tiles_y rows; the depths of each slice. Errors: LIGHTBIN_BUFFER_TOO_SMALL. */
LIGHTBIN_API lightbin_result lightbin_shader_edges(const lightbin_view* view, lightbin_edges* edges, size_t capacity);
LIGHTBIN_API lightbin_result lightbin_shader_slabs(const lightbin_slices* slices, lightbin_edges* slabs,
                                                   size_t capacity);

#if defined(__cplusplus)
} /* extern "C" */
#endif

#endif /* LIGHTBIN_LIGHTBIN_H */

#if defined(LIGHTBIN_IMPLEMENTATION)
#if !defined(__cplusplus)
#error "lightbin: the file that defines LIGHTBIN_IMPLEMENTATION is C++20, not C: give it a name such as lightbin.cpp"
#else
#include <lightbin/detail/c/implementation.hpp>
#endif
#endif
