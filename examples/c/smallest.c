/* SPDX-License-Identifier: MIT */
/* The smallest renderer in C99: a window by GLFW, OpenGL 3.3, 1,500 moving lights. Copy it and go on from here.
 * `smallest_c --check` draws four frames by the masks and by every light for every pixel, and compares them. As they add
 * the lights up in another order, bytes may be one apart. */
#include <lightbin/lightbin.h>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* 400 boxes and a floor, 36 corners each, made of their numbers alone. */
static const char* const vertex_text =
    "#version 330 core\n"
    "uniform mat4 projection, camera;\n"
    "out vec3 position;  // in the world\n"
    "out float depth;    // of the view\n"
    "const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));\n"
    "void main() {\n"
    "    position = vec3(corners[gl_VertexID % 6], gl_VertexID < 18 ? 1 : -1);\n"
    "    for (int turn = 0; turn < gl_VertexID / 6 % 3; ++turn) position = position.yzx;\n"
    "    int x = gl_InstanceID % 20, z = gl_InstanceID / 20;\n"
    "    if (z == 20) position *= vec3(42, 0, 42);\n"
    "    else position = position * vec3(0.7, x * z % 5 + 1, 0.7) + vec3(4 * x - 38, 0, 4 * z - 38);\n"
    "    gl_Position = projection * (camera * vec4(position, 1));\n"
    "    depth = gl_Position.w;  // of a perspective matrix\n"
    "}\n";

/* Goes below lightbin's text. */
static const char* const fragment_text =
    "uniform samplerBuffer lights;  // centre and range, in the world\n"
    "uniform bool every_light;\n"
    "in vec3 position;\n"
    "in float depth;\n"
    "out vec4 pixel;\n"
    "// Zero at the range and beyond: else the edges of tiles would show.\n"
    "vec3 shade(int light, vec3 normal) {\n"
    "    vec4 sphere = texelFetch(lights, light);\n"
    "    vec3 way = sphere.xyz - position;\n"
    "    float reached = dot(way, way) / (sphere.w * sphere.w), window = max(1 - reached, 0);\n"
    "    float facing = max(dot(normal, normalize(way)), 0);\n"
    "    return facing * window * window / (0.02 + reached) * (1 + cos(light + vec3(0, 2.1, 4.2)));\n"
    "}\n"
    "void main() {\n"
    "    vec3 normal = normalize(cross(dFdx(position), dFdy(position))), sum = vec3(0.2);\n"
    "    if (every_light)\n"
    "        for (int i = 0; i < textureSize(lights); ++i) sum += shade(i, normal);\n"
    "    else\n"
    "        lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), depth) sum += shade(int(light.id), normal);\n"
    "    pixel = vec4(pow(1 - exp(-0.1 * sum), vec3(0.45)), 1);\n"
    "}\n";

/* The program's light; lightbin reads position and range where they are. */
typedef struct Light {
    float position[3], range;
} Light;

enum { light_count = 1500 };

static void fail(const char* why) {
    fprintf(stderr, "smallest_c: %s\n", why);
    exit(EXIT_FAILURE);
}

/* Ends the program with lightbin's sentence if a call was refused. */
static void succeed(lightbin_result result) {
    char text[512];
    if (result.error == LIGHTBIN_OK) return;
    lightbin_error_text(result, text, sizeof text);
    fail(text);
}

static void add_shader(GLuint program, GLenum stage, int count, const char* const* texts) {
    char log[1000] = "";
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, count, texts, NULL);
    glCompileShader(shader);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (*log) fputs(log, stderr);
    glAttachShader(program, shader);
}

/* A buffer texture that shaders read. */
typedef struct Upload {
    GLuint buffer, texture;
    GLint sampler;
    GLenum format;
} Upload;

static Upload make_upload(GLuint program, const char* sampler, GLenum format) {
    Upload upload;
    glGenBuffers(1, &upload.buffer);
    glGenTextures(1, &upload.texture);
    upload.sampler = glGetUniformLocation(program, sampler);
    upload.format = format;
    return upload;
}

static void send(const Upload* upload, GLuint unit, const void* data, uint64_t bytes) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_BUFFER, upload->texture);
    glBindBuffer(GL_TEXTURE_BUFFER, upload->buffer);
    glBufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, data, GL_STREAM_DRAW);
    glTexBuffer(GL_TEXTURE_BUFFER, upload->format, upload->buffer);
    glUniform1i(upload->sampler, (GLint)unit);
}

/* A camera that turns around the scene and looks down at it, by columns. */
static void look(float camera[16], double seconds) {
    const double x = sin(0.1 * seconds), z = cos(0.1 * seconds), slope = 20 / 38.0, length = sqrt(1 + slope * slope);
    const double back[3] = {x / length, slope / length, z / length}, right[3] = {z, 0, -x};
    const double up[3] = {back[1] * right[2], back[2] * right[0] - back[0] * right[2], -back[1] * right[0]};
    const double eye[3] = {38 * x, 14, 38 * z};
    const double* const axes[3] = {right, up, back};
    int row, column;
    memset(camera, 0, 16 * sizeof *camera);
    camera[15] = 1;
    for (row = 0; row < 3; ++row)
        for (column = 0; column < 3; ++column) {
            camera[4 * column + row] = (float)axes[row][column];
            camera[12 + row] -= (float)(axes[row][column] * eye[column]);
        }
}

int main(int count, char** arguments) {
    const int check = count > 1 && strcmp(arguments[1], "--check") == 0;
    const lightbin_binner_options ordered = {.size = sizeof ordered, .slicing = LIGHTBIN_Z_BINS};
    lightbin_snippet_options snippet = {.size = sizeof snippet,
                                        .language = LIGHTBIN_GLSL_330,
                                        .storage = LIGHTBIN_TEXEL_BUFFER,
                                        .slicing = LIGHTBIN_Z_BINS,
                                        .masks = 1};
    lightbin_shader* shader = NULL;
    lightbin_view* view = NULL;
    lightbin_binner* binner = NULL; /* keeps its memory from frame to frame */
    lightbin_slices* slices = NULL; /* z-bins between the near and the far plane */
    uint32_t slice_words[128 + 3];
    Light* const lights = (Light*)malloc(light_count * sizeof *lights);
    unsigned char *picture = NULL, *before = NULL;
    size_t bytes_before = 0;
    if (lights == NULL || !glfwInit()) fail("no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* const window = glfwCreateWindow(1280, check ? 90 : 720, "lightbin in C", NULL, NULL);
    if (!window) fail("no OpenGL 3.3");
    glfwMakeContextCurrent(window);

    succeed(lightbin_binner_create(&ordered, &binner));
    succeed(lightbin_slices_exponential(128, 0.5f, 200, 0, &slices));
    succeed(lightbin_shader_slices(slices, slice_words, sizeof slice_words / sizeof *slice_words));
    succeed(lightbin_shader_snippet(&snippet, &shader));
    const char* const fragment_texts[] = {"#version 330 core\n", lightbin_shader_text(shader), fragment_text};
    const GLuint program = glCreateProgram();
    add_shader(program, GL_VERTEX_SHADER, 1, &vertex_text);
    add_shader(program, GL_FRAGMENT_SHADER, 3, fragment_texts);
    glLinkProgram(program);
    glUseProgram(program);
    lightbin_shader_destroy(shader);

    GLuint no_vertices = 0;
    glGenVertexArrays(1, &no_vertices);
    glBindVertexArray(no_vertices);
    glEnable(GL_DEPTH_TEST);
    const Upload words = make_upload(program, "lightbin_masks", GL_R32UI),
                 bounds = make_upload(program, "lightbin_slices", GL_R32UI),
                 spheres = make_upload(program, "lights", GL_RGBA32F);
    send(&bounds, 1, slice_words, sizeof slice_words);
    for (int frame = 0; !glfwWindowShouldClose(window) && !(check && frame == 8); ++frame) {
        const int every_light = check && frame % 2 == 1;
        int width = 0, height = 0;
        glfwPollEvents();
        glfwGetFramebufferSize(window, &width, &height);
        if (check) width = frame < 4 ? 152 : 188;
        if (width == 0 || height == 0) continue; /* minimised */
        const double seconds = check ? frame / 2 : glfwGetTime();
        for (int i = 0; i < light_count; ++i) {
            const double angle = i + sin(i) * seconds, x = 84 * fmod(0.755 * i, 1) - 42,
                         z = 84 * fmod(0.57 * i, 1) - 42;
            lights[i] =
                (Light){{(float)(x + 2 * cos(angle)), (float)(2 + cos(5.0 * i)), (float)(z + 2 * sin(angle))}, 3};
        }
        float camera[16], projection[16] = {0};
        const float near_plane = 0.5f, far_plane = 200;
        look(camera, seconds);
        projection[5] = 1 / tanf(0.45f);
        projection[0] = projection[5] * (float)height / (float)width;
        projection[10] = -(far_plane + near_plane) / (far_plane - near_plane);
        projection[11] = -1;
        projection[14] = -2 * far_plane * near_plane / (far_plane - near_plane);

        const lightbin_view_options options = {
            .size = sizeof options, .width = width, .height = height, .projection = {.floats = projection}};
        succeed(view == NULL ? lightbin_view_create(&options, &view) : lightbin_view_update(view, &options));
        const lightbin_lights given = {.size = sizeof given,
                                       .view_matrix = {.floats = camera},
                                       .spheres = {.count = light_count,
                                                   .centre = {lights[0].position, sizeof *lights},
                                                   .radius = {&lights[0].range, sizeof *lights}}};
        const lightbin_inputs inputs = {.size = sizeof inputs, .slices = slices};
        lightbin_masks masks = {.size = sizeof masks};
        succeed(lightbin_bin_masks(binner, view, &given, &inputs, &masks));
        lightbin_grid_constants constants;
        succeed(lightbin_get_grid_constants(view, 0, 0, &constants));
        send(&words, 0, masks.words, masks.word_count * sizeof *masks.words);
        send(&spheres, 2, lights, light_count * sizeof *lights);
        glUniform4ui(glGetUniformLocation(program, "lightbin_grid"), constants.tile_size, constants.tiles_x,
                     constants.width, constants.height);
        glUniformMatrix4fv(glGetUniformLocation(program, "projection"), 1, GL_FALSE, projection);
        glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE, camera);
        glUniform1i(glGetUniformLocation(program, "every_light"), every_light);
        glViewport(0, 0, width, height);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glDrawArraysInstanced(GL_TRIANGLES, 0, 36, 401);
        if (check) {
            const size_t bytes = (size_t)width * (size_t)height * 4;
            picture = (unsigned char*)malloc(bytes);
            if (picture == NULL) fail("no memory");
            glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, picture);
            int same = bytes == bytes_before;
            for (size_t i = 0; same && i < bytes; ++i)
                same = abs(picture[i] - before[i]) <= 1;
            if (same != every_light) fail(every_light ? "DIFFERENT" : "nothing moves");
            free(before);
            before = picture;
            bytes_before = bytes;
        }
        glfwSwapBuffers(window);
    }
    if (check) puts("identical");
    free(before);
    free(lights);
    lightbin_binner_destroy(binner);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
    return EXIT_SUCCESS;
}
