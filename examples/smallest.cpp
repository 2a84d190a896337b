// SPDX-License-Identifier: MIT
// The smallest of all: a window by GLFW, OpenGL 3.3, 1,500 moving lights, in one file. Copy it and go on from here.
// `smallest --check` draws four frames by the masks and by every light for every pixel, and compares them. As they add
// the lights up in another order, bytes may be one apart.
#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

// 400 boxes and a floor, 36 corners each, made of their numbers alone.
const char* const vertex_text = R"(#version 330 core
uniform mat4 to_clip;
out vec3 position;  // in the world
out float depth;    // of the view
const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

void main() {
    position = vec3(corners[gl_VertexID % 6], gl_VertexID < 18 ? 1 : -1);
    for (int turn = 0; turn < gl_VertexID / 6 % 3; ++turn) position = position.yzx;
    int x = gl_InstanceID % 20, z = gl_InstanceID / 20;
    if (z == 20) position *= vec3(42, 0, 42);
    else position = position * vec3(0.7, x * z % 5 + 1, 0.7) + vec3(4 * x - 38, 0, 4 * z - 38);
    gl_Position = to_clip * vec4(position, 1);
    depth = gl_Position.w;  // of a perspective matrix
}
)";

// Goes below lightbin's text.
const char* const fragment_text = R"(
uniform samplerBuffer lights;  // centre and range, in the world
uniform bool every_light;
in vec3 position;
in float depth;
out vec4 pixel;

// Zero at the range and beyond: else the edges of tiles would show.
vec3 shade(int light, vec3 normal) {
    vec4 sphere = texelFetch(lights, light);
    vec3 way = sphere.xyz - position;
    float reached = dot(way, way) / (sphere.w * sphere.w), window = max(1 - reached, 0);
    float facing = max(dot(normal, normalize(way)), 0);
    return facing * window * window / (0.02 + reached) * (1 + cos(light + vec3(0, 2.1, 4.2)));
}

void main() {
    vec3 normal = normalize(cross(dFdx(position), dFdy(position))), sum = vec3(0.2);
    if (every_light)
        for (int i = 0; i < textureSize(lights); ++i) sum += shade(i, normal);
    else
        lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), depth) sum += shade(int(light.id), normal);
    pixel = vec4(pow(1 - exp(-0.1 * sum), vec3(0.45)), 1);
}
)";

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "smallest: %s\n", why.c_str());
    std::exit(EXIT_FAILURE);
}

void add_shader(GLuint program, GLenum stage, const char* text) {
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    char log[1000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    if (*log) std::fputs(log, stderr);
    glAttachShader(program, shader);
}

int main(int count, char** words) {
    const bool check = count > 1 && std::string(words[1]) == "--check";
    if (!glfwInit()) fail("no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* const window = glfwCreateWindow(1280, check ? 90 : 720, "lightbin", nullptr, nullptr);
    if (!window) fail("no OpenGL 3.3");
    glfwMakeContextCurrent(window);
    const auto snippet = lightbin::shader_snippet(
        {.language = lightbin::ShaderLanguage::glsl_330, .storage = lightbin::ListStorage::texel_buffer,
         .slicing = lightbin::Slicing::z_bins, .masks = true});
    const GLuint program = glCreateProgram();
    add_shader(program, GL_VERTEX_SHADER, vertex_text);
    add_shader(program, GL_FRAGMENT_SHADER, ("#version 330 core\n" + snippet->text + fragment_text).c_str());
    glLinkProgram(program);
    glUseProgram(program);
    const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
    GLuint no_vertices = 0, buffers[3] = {}, textures[3] = {};
    glGenVertexArrays(1, &no_vertices);
    glBindVertexArray(no_vertices);
    glGenBuffers(3, buffers);
    glGenTextures(3, textures);
    glEnable(GL_DEPTH_TEST);
    const auto upload = [&](GLuint unit, const char* sampler, GLenum format, const auto& array) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_BUFFER, textures[unit]);
        glBindBuffer(GL_TEXTURE_BUFFER, buffers[unit]);
        glBufferData(GL_TEXTURE_BUFFER, array.size() * sizeof array[0], array.data(), GL_STREAM_DRAW);
        glTexBuffer(GL_TEXTURE_BUFFER, format, buffers[unit]);
        glUniform1i(uniform(sampler), unit);
    };
    lightbin::MaskBinner binner;  // keeps its memory from frame to frame
    const auto slices = lightbin::Slices::exponential(128, 0.5, 200);  // z-bins between the near and the far plane
    if (!slices) fail(slices.error().message());
    upload(1, "lightbin_slices", GL_R32UI, lightbin::shader_slices(*slices));
    std::vector<glm::vec4> lights(1500);
    std::vector<unsigned char> picture;
    for (int frame = 0; !glfwWindowShouldClose(window) && !(check && frame == 8); ++frame) {
        const bool every_light = check && frame % 2 == 1;
        glfwPollEvents();
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (check) width = frame < 4 ? 152 : 188;
        if (width == 0 || height == 0) continue;  // minimised
        const double seconds = check ? frame / 2 : glfwGetTime();
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const double n = static_cast<double>(i), angle = n + std::sin(n) * seconds;
            const double x = 84 * glm::fract(0.755 * n) - 42, z = 84 * glm::fract(0.57 * n) - 42;
            lights[i] = glm::vec4(x + 2 * std::cos(angle), 2 + std::cos(5 * n), z + 2 * std::sin(angle), 3);
        }
        const glm::vec3 eye(38 * std::sin(0.1 * seconds), 14, 38 * std::cos(0.1 * seconds));
        const glm::mat4 camera = glm::lookAt(eye, glm::vec3(0, -6, 0), glm::vec3(0, 1, 0));
        const glm::mat4 projection = glm::perspective(0.9, static_cast<double>(width) / height, 0.5, 200.0);

        const auto view = lightbin::View::from_projection(projection, {width, height});  // as it is drawn
        if (!view) fail(view.error().message());
        const auto masks = binner.bin(*view, lightbin::world_space(lights, camera), *slices);
        if (!masks) fail(masks.error().message());
        const lightbin::GridConstants grid = lightbin::grid_constants(*view);
        upload(0, "lightbin_masks", GL_R32UI, masks->words());
        upload(2, "lights", GL_RGBA32F, lights);
        glUniform4ui(uniform("lightbin_grid"), grid.tile_size, grid.tiles_x, grid.width, grid.height);
        glUniformMatrix4fv(uniform("to_clip"), 1, GL_FALSE, &(projection * camera)[0][0]);
        glUniform1i(uniform("every_light"), every_light);
        glViewport(0, 0, width, height);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glDrawArraysInstanced(GL_TRIANGLES, 0, 36, 401);
        if (check) {
            std::vector<unsigned char> bytes(static_cast<std::size_t>(3 * width * height));
            glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
            const bool same = std::equal(bytes.begin(), bytes.end(), picture.begin(), picture.end(),
                                         [](int a, int b) { return std::abs(a - b) <= 1; });
            if (same != every_light) fail(every_light ? "DIFFERENT" : "nothing moves");
            picture = bytes;
        }
        glfwSwapBuffers(window);
    }
    if (check) std::puts("identical");
}
