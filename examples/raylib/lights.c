/* SPDX-License-Identifier: MIT */
/* 1,000 moving point lights in a raylib program. Each pixel's shader reads its lights from masks in one uniform block,
 * which OpenGL 3.3 has. Hold the space bar to draw by every light for every pixel instead.
 * `lights --check [PICTURE.png]` draws frames off screen in both ways and compares them byte by byte: masks give the
 * lights in ascending order, so that even sums of floats are the same. */
#include <lightbin/lightbin.h>

#include <epoxy/gl.h> /* the calls of OpenGL for a uniform block, which raylib does not have */

#include <raylib.h>
#include <rlgl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The attributes and matrices are named as raylib expects them. */
static const char* const vertex_text = "#version 330\n"
                                       "in vec3 vertexPosition, vertexNormal;\n"
                                       "uniform mat4 mvp, matModel, matNormal;\n"
                                       "out vec3 position, normal;  // in the world\n"
                                       "void main() {\n"
                                       "    position = vec3(matModel * vec4(vertexPosition, 1));\n"
                                       "    normal = normalize(mat3(matNormal) * vertexNormal);\n"
                                       "    gl_Position = mvp * vec4(vertexPosition, 1);\n"
                                       "}\n";

/* Goes below lightbin's text. */
static const char* const fragment_text =
    "in vec3 position, normal;\n"
    "uniform sampler2D lights;  // a row for each Light\n"
    "uniform vec4 colDiffuse;\n"
    "uniform int every_light;\n"
    "out vec4 pixel;\n"
    "vec3 shade(int light) {\n"
    "    vec4 sphere = texelFetch(lights, ivec2(0, light), 0);\n"
    "    vec3 way = sphere.xyz - position;\n"
    "    float apart = max(length(way), 0.01), facing = max(dot(normal, way) / apart, 0);\n"
    "    float strength = facing * lightbin_window(apart, sphere.w) / (0.5 + apart * apart);\n"
    "    return strength * texelFetch(lights, ivec2(1, light), 0).rgb;\n"
    "}\n"
    "void main() {\n"
    "    vec3 sum = vec3(0.05);\n"
    "    if (every_light != 0)\n"
    "        for (int light = 0; light < textureSize(lights, 0).y; ++light) sum += shade(light);\n"
    "    else\n"
    "        lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), 0.0) sum += shade(int(light.id));\n"
    "    pixel = vec4(pow(1 - exp(-colDiffuse.rgb * sum), vec3(0.45)), 1);\n"
    "}\n";

/* The program's light, two texels of four floats. lightbin reads position and range where they are. */
typedef struct Light {
    float position[3], range, colour[4];
} Light;

enum { light_count = 1000, block_bytes = 16384, lights_unit = 15 /* raylib uses the first ones */ };

static Light lights[light_count];
static lightbin_view* view;
static lightbin_binner* binner; /* keeps its memory from frame to frame */
static Shader shader;
static Texture2D light_texture;
static GLuint block;
static Model box;

static void fail(const char* why) {
    fprintf(stderr, "lights: %s\n", why);
    exit(EXIT_FAILURE);
}

/* Ends the program with lightbin's sentence if a call was refused. */
static void succeed(lightbin_result result) {
    char text[512];
    if (result.error == LIGHTBIN_OK) return;
    lightbin_error_text(result, text, sizeof text);
    fail(text);
}

static void load(void) {
    const lightbin_snippet_options options = {.size = sizeof options,
                                              .language = LIGHTBIN_GLSL_330,
                                              .storage = LIGHTBIN_UNIFORM_BLOCK,
                                              .window = 1,
                                              .uniform_block_bytes = block_bytes,
                                              .masks = 1};
    const int unit = lights_unit;
    lightbin_shader* snippet = NULL;
    succeed(lightbin_binner_create(NULL, &binner));
    succeed(lightbin_shader_snippet(&options, &snippet));
    const char* const texts[] = {"#version 330\n", lightbin_shader_text(snippet), fragment_text};
    char* const whole = (char*)calloc(strlen(texts[0]) + strlen(texts[1]) + strlen(texts[2]) + 1, 1);
    if (whole == NULL) fail("no memory");
    for (int i = 0; i < 3; ++i)
        strcat(whole, texts[i]);
    shader = LoadShaderFromMemory(vertex_text, whole);
    free(whole);
    lightbin_shader_destroy(snippet);

    const GLuint index = glGetUniformBlockIndex(shader.id, "lightbin_masks_block");
    if (index == GL_INVALID_INDEX) fail("the shader does not compile");
    glUniformBlockBinding(shader.id, index, 0);
    glGenBuffers(1, &block);
    glBindBuffer(GL_UNIFORM_BUFFER, block);
    glBufferData(GL_UNIFORM_BUFFER, block_bytes, NULL, GL_STREAM_DRAW);

    const Image image = {lights, 2, light_count, 1, PIXELFORMAT_UNCOMPRESSED_R32G32B32A32};
    light_texture = LoadTextureFromImage(image);
    SetShaderValue(shader, GetShaderLocation(shader, "lights"), &unit, SHADER_UNIFORM_INT);
    box = LoadModelFromMesh(GenMeshCube(1, 1, 1));
    box.materials[0].shader = shader;
}

static void move_lights(double seconds) {
    for (int i = 0; i < light_count; ++i) {
        const double angle = i + sin(i) * seconds, x = 84 * fmod(0.755 * i, 1) - 42,
                     z = 84 * fmod(0.57 * i, 1) - 42;
        const Light light = {
            {(float)(x + 2 * cos(angle)), (float)(2 + cos(5.0 * i)), (float)(z + 2 * sin(angle))},
            4,
            {(float)(2 + 2 * cos(i)), (float)(2 + 2 * cos(i + 2.1)), (float)(2 + 2 * cos(i + 4.2)), 1}};
        lights[i] = light;
    }
    UpdateTexture(light_texture, lights);
}

/* Makes and uploads the masks. To be called inside of BeginMode3D(), as raylib has the two matrices only there. */
static void upload_masks(int width, int height) {
    const Matrix projection = rlGetMatrixProjection(), camera = rlGetMatrixModelview();
    const lightbin_view_options options = {
        .size = sizeof options,
        .width = width,
        .height = height,
        .projection = {.floats = &projection.m0, .layout = LIGHTBIN_ROW_MAJOR}};
    const lightbin_lights given = {.size = sizeof given,
                                   .view_matrix = {.floats = &camera.m0, .layout = LIGHTBIN_ROW_MAJOR},
                                   .spheres = {.count = light_count,
                                               .centre = {lights[0].position, sizeof *lights},
                                               .radius = {&lights[0].range, sizeof *lights}}};
    lightbin_masks masks = {.size = sizeof masks};
    lightbin_grid_constants grid;
    succeed(view == NULL ? lightbin_view_create(&options, &view) : lightbin_view_update(view, &options));
    succeed(lightbin_bin_masks(binner, view, &given, NULL, &masks));
    succeed(lightbin_get_grid_constants(view, 0, 0, &grid));
    if (masks.word_count > block_bytes / 4) fail("the block is too small: take larger tiles");

    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, (GLsizeiptr)(masks.word_count * 4), masks.words);
    rlEnableShader(shader.id);
    glUniform4ui(GetShaderLocation(shader, "lightbin_grid"), grid.tile_size, grid.tiles_x, grid.width,
                 grid.height);
}

static void draw(int width, int height, double seconds, int every_light) {
    const Vector3 up = {0, 1, 0};
    const Camera3D camera = {{(float)(38 * sin(0.1 * seconds)), 20, (float)(38 * cos(0.1 * seconds))},
                             {0, 0, 0},
                             up,
                             50,
                             CAMERA_PERSPECTIVE};
    move_lights(seconds);
    ClearBackground(BLACK);
    BeginMode3D(camera);
    upload_masks(width, height);
    SetShaderValue(shader, GetShaderLocation(shader, "every_light"), &every_light, SHADER_UNIFORM_INT);
    rlActiveTextureSlot(lights_unit);
    rlEnableTexture(light_texture.id);
    rlActiveTextureSlot(0);
    for (int i = 0; i < 400; ++i) {
        const int x = i % 20, z = i / 20, high = x * z % 5 + 1;
        const Vector3 place = {(float)(4 * x - 38), 0.5f * (float)high, (float)(4 * z - 38)},
                      size = {1.4f, (float)high, 1.4f};
        DrawModelEx(box, place, up, 0, size, WHITE);
    }
    DrawModelEx(box, (Vector3){0, -0.5f, 0}, up, 0, (Vector3){84, 1, 84}, LIGHTGRAY);
    EndMode3D();
}

static int check(const char* path) {
    enum { width = 640, height = 360 };
    const RenderTexture2D target = LoadRenderTexture(width, height);
    long different = 0, lit = 0;
    double spent[2] = {0, 0}; /* of the last frames, as the first one compiles the shader */
    for (int frame = 0; frame < 3; ++frame) {
        Image pictures[2];
        for (int every_light = 0; every_light < 2; ++every_light) {
            const double start = GetTime();
            BeginTextureMode(target);
            draw(width, height, 20 * frame, every_light);
            EndTextureMode();
            pictures[every_light] = LoadImageFromTexture(target.texture);
            spent[every_light] = GetTime() - start;
        }
        const unsigned char *masks = (const unsigned char*)pictures[0].data,
                            *every = (const unsigned char*)pictures[1].data;
        for (int i = 0; i < 4 * width * height; i += 4) {
            different += memcmp(masks + i, every + i, 4) != 0;
            lit += every[i] + every[i + 1] + every[i + 2] > 240;
        }
        ImageFlipVertical(&pictures[0]); /* row 0 of a texture is the lowest */
        if (path != NULL && !ExportImage(pictures[0], path)) fail("cannot write the picture");
        UnloadImage(pictures[0]);
        UnloadImage(pictures[1]);
    }
    UnloadRenderTexture(target);
    printf("%d lights, 3 frames of %d x %d pixels, %ld of them bright\n", light_count, width, height, lit);
    printf("a frame by every light %.0f ms, by masks %.0f ms\n", 1000 * spent[1], 1000 * spent[0]);
    printf("different pixels: %ld\n", different);
    return different == 0 && lit > width * height ? EXIT_SUCCESS
                                                  : EXIT_FAILURE; /* dark ones would prove nothing */
}

int main(int count, char** arguments) {
    const int checks = count > 1 && strcmp(arguments[1], "--check") == 0;
    int status = EXIT_SUCCESS;
    SetTraceLogLevel(LOG_WARNING);
    if (checks) SetConfigFlags(FLAG_WINDOW_HIDDEN);
    InitWindow(1280, 720, "lightbin in raylib");
    if (!IsWindowReady()) fail("no window");
    load();
    if (checks) status = check(count > 2 ? arguments[2] : NULL);
    while (!checks && !WindowShouldClose()) {
        BeginDrawing();
        draw(GetRenderWidth(), GetRenderHeight(), GetTime(), IsKeyDown(KEY_SPACE));
        DrawFPS(10, 10);
        EndDrawing();
    }
    UnloadModel(box);
    UnloadTexture(light_texture);
    UnloadShader(shader);
    CloseWindow();
    lightbin_binner_destroy(binner);
    lightbin_view_destroy(view);
    return status;
}
